"""Materials: rate laws, hardness, what a metal may leave out, and the library."""

import math
import tomllib

import pytest

from fem_impact.case.case import Case
from fem_impact.case.effects.heating import halves, thermal
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.case.metals import flow_stresses, unknowns
from fem_impact.errors import SceneError
from fem_impact.physics.flash import Half
from fem_impact.physics.hardening import CowperSymonds, JohnsonCook, rate_gain, rate_law, tabor_stress
from fem_impact.scene.inputs import UNSOURCED, inputs
from fem_impact.scene.library import family_of, intervals_of, materials
from fem_impact.scene.material import CowperSymondsRate, JohnsonCookRate, Material
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import digest, to_dict, to_toml

T5B = load("t5b")
PLATE = T5B.barrier.material
BODIES = ("projectile.material", "barrier.material")


def of(name):
    """t5b with another material of the rod."""
    return replace(T5B, "projectile.material", name)


def test_the_factor_is_that_over_the_tensile_test():
    """Johnson and Cook's line in ln(rate), 1 at the rate of the tests: .022 at .002 per second by hand."""
    law = rate_law(PLATE)
    assert law.factor(0.002) == 1.0 == law.factor(1e-5)
    assert law.factor(1e3) == pytest.approx(1.15197 / 0.86328, rel=1e-4)
    assert law.factor(1.0) == pytest.approx(1 / 0.86328, rel=1e-4)


def test_a_law_over_its_own_curve_is_printed_as_it_stands():
    rate = JohnsonCookRate(C=0.022, reference=1.0, tested=1.0)
    metal = Material("as printed", 206e9, 0.29, 7850, 320e6, 446e6, rate=rate)
    assert rate_law(metal) == JohnsonCook(0.022, 1.0)


def test_cowper_and_symonds_by_hand():
    assert CowperSymonds(40.4, 5.0).factor(1e3) == pytest.approx(1 + (1e3 / 40.4) ** 0.2)
    assert CowperSymonds(40.4, 5.0).factor(40.4) == 2.0


@pytest.mark.parametrize("body", BODIES)
def test_a_rate_law_is_set_on_the_command_line(body):
    changes = {f"{body}.rate.law": "cowper-symonds", f"{body}.rate.D": "3200 /s", f"{body}.rate.q": 5}
    changed = replace_all(T5B, changes)
    metal = changed.projectile.material if body.startswith("projectile") else changed.barrier.material
    assert metal.rate == CowperSymondsRate(3200.0, 5.0)
    assert metal.name.endswith("-steel (changed)")
    assert changed.measured == "t5b"
    assert read_dict(tomllib.loads(to_toml(changed))) == changed
    assert digest(changed) != digest(T5B)


def test_one_number_of_a_rate_law_is_changed_alone():
    changed = replace(T5B, "barrier.material.rate.C", 0.06)
    assert changed.barrier.material.rate == JohnsonCookRate(0.06, 1.0, 0.002)
    slower = replace(changed, "barrier.material.rate.tested_per_s", 1.0)
    assert slower.barrier.material.rate == JohnsonCookRate(0.06, 1.0, 1.0)


def test_hardness_stands_for_a_flow_stress():
    """HV 163 kgf/mm2 over 3 at 8 % plastic strain, through the yield stress and with the elastic slope."""
    metal = replace(T5B, "barrier.material.law", "hardness").barrier.material
    law = hardening_of(metal)
    assert law.flow_stress(0.08) == pytest.approx(163 * 9.80665e6 / 3, rel=1e-12)
    assert law.flow_stress(0.0) == 320e6
    assert law.slope * law.exponent < 206e9 / 320e6
    assert hardening_of(PLATE).flow_stress(0.08) == pytest.approx(481.85e6, rel=1e-4)


def test_the_intervals_span_the_conventions():
    """c = 2.8 on the faces and c = 3 on the projected area are both inside, within half a per cent."""
    for name, hardness in (("plate-steel", 163), ("rod-steel", 235)):
        low, high = intervals_of(name)["hardness"]
        assert low == hardness
        assert high == pytest.approx(hardness / 0.927, rel=0.005)
        assert tabor_stress(high) > hardness * 9.80665e6 / 2.8
        factor = 1 + rate_gain(materials()[name], 1e3)
        assert intervals_of(name)["rate_factor"][0] < factor < intervals_of(name)["rate_factor"][1]


def test_check_tells_flow_stresses_at_rates():
    told = flow_stresses(Case(T5B).bodies)
    assert set(told) == {"rod", "barrier"}
    assert told["barrier"] == pytest.approx([481.85e6 * k for k in (1, 1.27573, 1.33441, 1.39309)], rel=1e-4)
    elastic = load("elastic-frictionless")
    assert flow_stresses(Case(elastic).bodies) == {}


MISTAKES = [
    ("barrier.material.law", "brinell", ["law", '"tensile" or "hardness"']),
    ("barrier.material.hardness", "163 HV", ["hardness", "text"]),
    ("barrier.material.hardness", 0.5, ["at least 1"]),
    ("barrier.material.rate.law", "zerilli", ["rate.law", '"johnson-cook" or "cowper-symonds"']),
    ("barrier.material.rate.D", "40 /s", ["rate.D", "is not a known key"]),
    ("barrier.material.rate.C", -0.1, ["rate.C", "at least 0"]),
    ("barrier.material.rate.tested", "0 /s", ["rate.tested", "at least"]),
    ("barrier.material.rate.tested", "2 ms", ["rate.tested", "unit"]),
    ("barrier.material.rate.law", "cowper-symonds", ["rate.D", "is missing"]),
    ("barrier.material", "peek", ["is a polymer", "J2"]),
    ("barrier.material", "aluminium-6061-t66", ["Did you mean aluminium-6061-t6"]),
    ("barrier.material.yield_stress_Pa", math.inf, ["yield_stress", "finite"]),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES)
def test_a_mistake_is_named_with_key_value_and_remedy(key, value, words):
    with pytest.raises(SceneError) as caught:
        replace(T5B, key, value)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"law": "hardness"}, "needs hardness"),
        ({"law": "hardness", "hardness": 163.0, "hardening": 1e9}, "beside a plastic modulus"),
        ({"ultimate_stress": math.inf}, "is missing beside yield_stress.*perfectly plastic"),
        ({"yield_stress": math.inf}, "ultimate_stress.*means nothing without yield_stress"),
        ({"ultimate_stress": 300e6}, "below the yield stress"),
        ({"yield_stress": 22e9, "ultimate_stress": 23e9}, "too soft for a yield stress of 2.2e.04 MPa"),
        ({"yield_stress": math.inf, "ultimate_stress": math.inf, "hardening": 1e9}, "means nothing"),
    ],
)
def test_a_material_that_contradicts_itself_is_refused(changes, words):
    stated = {"yield_stress": 320e6, "ultimate_stress": 446e6} | changes
    with pytest.raises(SceneError, match=words):
        Material("mine", 206e9, 0.29, 7850.0, **stated)


@pytest.mark.parametrize(
    ("rho", "words"), [(785.0, "16.2 km/s, in no metal"), (78500.0, "at most 2.3e.04|Osmium")]
)
def test_a_density_that_is_wrong_by_ten_is_refused(rho, words):
    with pytest.raises(SceneError, match=words):
        Material("mine", 206e9, 0.29, rho, 320e6, 446e6)
    assert Material("stiff and never yielding", 1e13, 0.29, 785.0).rho == 785.0


def test_a_hardness_below_yield_is_refused_before_any_work():
    soft = replace_all(T5B, {"barrier.material.law": "hardness", "barrier.material.hardness": 90})
    with pytest.raises(SceneError, match="HV 90 stands for a flow stress of 294 MPa"):
        Case.of(soft)


@pytest.mark.parametrize("name", materials())
def test_every_shipped_material_makes_a_plan(name):
    scene = of(name)
    if family_of(scene.projectile.material) == "rock":  # whose elastic answer has to be named
        scene = replace(scene, "effects", ["auto", "-rod-plasticity"])
    planned = Case.of(scene, "modal")
    assert read_dict(to_dict(scene)) == scene
    metal = scene.projectile.material
    assert ("rod-plasticity" in planned.active) <= metal.yields
    told = " ".join(unknowns(planned.bodies))
    silent = metal.rate is None and "rod-plasticity" in planned.active
    assert (f"({name}) has no rate data" in told) == silent
    assert (f"({name}) has no yield stress" in told) == (not metal.yields)
    assert ("heat of the contact is not known" in told) == (None in (metal.conductivity, metal.heat_capacity))
    assert (f"is that of steel on steel, not of {name}" in told) == (family_of(metal) != "steel")
    if name == "plate-steel":
        assert told == ""


def test_the_model_of_the_earlier_constants_is_the_earlier_model():
    """Tensile law, C = .022 over the tensile curve, and heat of carbon steel."""
    earlier = {"C": 0.022, "tested": "1 /s"}
    scene = replace_all(T5B, {f"{body}.rate.{key}": earlier[key] for body in BODIES for key in earlier})
    slots = Case.of(scene).slots
    for law, E, strength, exponent in (
        (slots.rod_law, 219e9, 546e6, 0.042629108901212936),
        (slots.barrier_law, 206e9, 320e6, 0.10334158957939037),
    ):
        assert (law.yield_stress, law.slope, law.rate) == (strength, E / strength, JohnsonCook(0.022, 1.0))
        assert law.exponent == pytest.approx(exponent, rel=1e-13)
    assert slots.rod_skin is None and slots.barrier_skin is None
    assert halves(Case(scene).bodies) == (Half(53.0, 7850 * 440.0),) * 2
    assert thermal(Case(T5B).bodies) == thermal(Case(scene).bodies)


def test_what_a_scene_states_of_heat_overrides_the_material():
    assert halves(Case(replace(T5B, "heating.rod_conductivity", "20 W/(m K)")).bodies)[0].conductivity == 20.0
    known = {"heating.rod_conductivity": "44 W/(m K)", "effects": ["auto", "contact-heating"]}
    scene = of("steel-4340")
    assert Case.of(replace_all(scene, known)).slots.heat
    with pytest.raises(SceneError, match=r"heating.rod_conductivity.*is not known"):
        Case.of(replace_all(scene, {"effects": known["effects"]}))


def test_no_metal_has_the_law_of_another():
    """A soft metal without rate data makes the model no stronger at any rate, beside a plate that has one."""
    scene = of("lead")
    assert rate_law(scene.projectile.material) is None
    slots = Case.of(scene, "modal").slots
    assert slots.rod_law is not None and slots.rod_law.rate is None
    assert slots.barrier_law is None or slots.barrier_law.rate is not None


def test_what_never_yields_cannot_be_told_to():
    with pytest.raises(SceneError, match="yield_stress of alumina"):
        Case.of(replace(of("alumina"), "effects", ["auto", "rod-plasticity"]))


def test_each_value_has_the_source_that_the_user_states():
    """One for all values, or of each; what is changed of a shipped material keeps none of its source."""
    own = {"name": "mine", "E": "70 GPa", "nu": 0.33, "rho": "2700 kg/m3", "source": "sheet 3"}
    scene = replace(T5B, "barrier.material", own | {"sources": {"nu": "a guess"}})
    told = {row[0]: row[2] for row in inputs(scene).rows}
    assert [told[f"barrier.material.{key}"] for key in ("E", "nu", "rho")] == [
        "sheet 3",
        "a guess",
        "sheet 3",
    ]
    assert read_dict(to_dict(scene)) == scene
    changed = {row[0]: row[2] for row in inputs(replace(T5B, "barrier.material.E", "200 GPa")).rows}
    assert changed["barrier.material.E"] == UNSOURCED
    assert "handbook" in changed["barrier.material.nu"]
    with pytest.raises(SceneError, match=r"sources.Em"):
        replace(T5B, "barrier.material", own | {"sources": {"Em": "sheet 3"}})
