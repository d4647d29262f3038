"""What an elastic answer leaves out of a material, and the grounds that must be named as elastic."""

from math import pi, sqrt

import pytest

from fem_impact.case.case import Case
from fem_impact.case.elastic_only import LEFT_OUT, NOT_STATED, UNSORTED, VISCOUS, left_out
from fem_impact.case.metals import laws, unknowns
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import texts
from fem_impact.run.simulate import simulate
from fem_impact.scene.library import family_of, materials
from fem_impact.scene.material import Material, kind_of
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace, replace_all

OWN_STEEL = {"name": "own steel", "E": "210 GPa", "nu": 0.3, "rho": "7800 kg/m3"}
CONCRETE = {"name": "C30/37 concrete", "E": "33 GPa", "nu": 0.2, "rho": "2400 kg/m3"}


def drop(material, rod="s235", **more):
    """A steel ball on a half-space."""
    return {
        "id": "drop",
        "projectile": {"shape": "ball", "diameter": "20 mm", "material": rod},
        "barrier": {"material": material},
        "surface": {"state": "custom", "friction": 0.3, "source": "a test"},
        "impact": {"angle": "0 deg", "speed": "2 m/s"},
        **more,
    }


@pytest.mark.parametrize(
    ("name", "E", "kind"),
    [
        ("rubber", 4.485e6, "rubber"),
        ("alumina ball", 4e11, "brittle"),
        ("nylon 12", 2e9, "plastic"),
        ("white oak", 1.2e10, "wood"),
        ("some steel", 2e11, "metal"),
        ("granite", 5e10, "ground"),
    ],
)
def test_the_mechanism_is_that_of_the_family(name, E, kind):
    lost = NOT_STATED if kind in VISCOUS else ""
    assert left_out(Material(name, E, 0.3, 2000.0)) == LEFT_OUT[kind] + lost


@pytest.mark.parametrize(
    ("E", "words"), [(4e6, "viscous, as rubbers"), (3e9, "plastics"), (2e11, "flows, a ceramic")]
)
def test_without_a_family_it_is_told_by_the_stiffness(E, words):
    told = left_out(Material("thing", E, 0.3, 2000.0))
    assert words in told and told.removesuffix(NOT_STATED) in UNSORTED


@pytest.mark.parametrize(
    ("E", "rho", "asked"),
    [
        ("110 MPa", "4430 kg/m3", True),
        ("110 GPa", "4430 kg/m3", False),
        ("4.5 MPa", "1150 kg/m3", False),
        ("16 GPa", "11340 kg/m3", False),
    ],
)
def test_a_body_as_heavy_as_metal_and_as_soft_as_rubber_is_asked_for_its_unit(E, rho, asked):
    own = {"name": "my-titanium", "E": E, "nu": 0.34, "rho": rho}
    for fidelity in ("rigid", "solid"):
        case = Case(read_dict(drop("plate-steel", own)), fidelity)
        told = [one for one in texts(case.limitations, "input") if "is its unit right?" in one]
        assert len(told) == asked
        assert not asked or told[0].startswith(f"projectile.material.E = {E} (my-titanium): is its unit")


@pytest.mark.parametrize(
    ("stated", "asked"),
    [
        ({"rho": "785 kg/m3"}, "material.rho = 785 kg/m3 (my-steel): is its unit right? With E = 210 GPa"),
        ({"rho": "7850 kg/m3"}, ""),
        ({"E": "310 GPa", "rho": "1850 kg/m3"}, ""),
        ({"E": "1000 GPa", "rho": "785 kg/m3"}, ""),
        (
            {"hardness": 2000, "yield_stress": "355 MPa", "law": "hardness"},
            "hardness = 2000 (my-steel): is it",
        ),
        ({"hardness": 200, "yield_stress": "120 MPa", "law": "hardness"}, "5.45 times the yield stress"),
        (
            {"hardness": 1300, "yield_stress": "2000 MPa", "law": "hardness"},
            "hardness = 1300 (my-steel): is it",
        ),
        ({"hardness": 900, "yield_stress": "2000 MPa", "law": "hardness"}, ""),
        ({"hardness": 1500, "yield_stress": "4000 MPa", "law": "hardness", "family": "ceramic"}, ""),
    ],
)
def test_a_density_or_a_hardness_that_no_metal_has_is_asked_for_its_unit(stated, asked):
    own = {"name": "my-steel", "E": "210 GPa", "nu": 0.3, "rho": "7850 kg/m3", **stated}
    case = Case(read_dict(drop("plate-steel", own)), "rigid")
    told = " ".join(one for one in texts(case.limitations, "input") if ": is it" in one)
    assert asked in told and bool(told) == bool(asked)


def test_no_shipped_material_is_asked_for_a_unit():
    for name in (one for one, metal in materials().items() if kind_of(family_of(metal)) != "ground"):
        case = Case(read_dict(drop("plate-steel", name)), "rigid")
        assert not [one for one in texts(case.limitations, "input") if ": is it" in one]


def test_a_rubber_ball_is_not_warned_of_cracks():
    rubber = {"name": "rubber", "E": "4.485 MPa", "nu": 0.49, "rho": "1150 kg/m3"}
    told = " ".join(unknowns(Case.of(read_dict(drop("plate-steel", rubber))).bodies))
    assert "Rubber does not crack: it is viscous" in told
    assert "ceramic" not in told


@pytest.mark.parametrize("material", ["granite", CONCRETE, CONCRETE | {"name": "x", "family": "soil"}])
@pytest.mark.parametrize("fidelity", ["rigid", "modal", "solid"])
def test_a_ground_is_refused_until_the_elastic_answer_is_named(material, fidelity):
    scene = read_dict(drop(material))
    with pytest.raises(
        SceneError, match=r"barrier\.material.*crushes and cracks.*upper bound.*barrier-elastic"
    ):
        Case.of(scene, fidelity)
    named = replace(scene, "effects", ["auto", "barrier-elastic"])
    case = Case.of(named, fidelity)
    assert any("crushed and crack; neither is followed" in one for one in unknowns(case.bodies))


def test_a_projectile_of_rock_is_refused_alike():
    scene = read_dict(drop("plate-steel", "granite"))
    with pytest.raises(SceneError, match=r'projectile\.material.*"-rod-plasticity"'):
        Case.of(scene)
    assert simulate(replace(scene, "effects", ["auto", "-rod-plasticity"]), "rigid").validity.finished


def test_a_ground_with_a_flow_law_of_its_own_is_computed():
    own = CONCRETE | {"yield_stress": "30 MPa", "hardening": "0 MPa"}
    assert "barrier-elastoplastic" in Case.of(read_dict(drop(own))).active


def test_the_laws_in_force_are_told_by_place():
    t5b = load("t5b")
    told = laws(Case(t5b).bodies)
    assert told["projectile.material"].startswith(
        "rod-steel: yields at 546 MPa, power law through the ultimate"
    )
    assert told["projectile.material"].endswith("rate factor with C 0.0134")
    elastic = replace(t5b, "effects", ["auto", "-rod-plasticity", "-rate-hardening"])
    told = laws(Case(elastic).bodies)
    assert told["projectile.material"] == "rod-steel: elastic: the effect rod-plasticity is off"
    assert told["barrier.material"].endswith("at any strain rate")
    rigid = laws(Case(replace(t5b, "effects", ["auto", "barrier-rigid"])).bodies)
    assert rigid["barrier.material"] == "plate-steel: rigid, the effect barrier-rigid is on"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"tangent_modulus": "1 GPa"}, "hardens by 1005 MPa a unit of plastic strain (bilinear)"),
        ({"hardening": "0 MPa"}, "perfectly plastic"),
        ({"law": "hardness"}, "flow stress of HV 163 at 8 %"),
        ({"flow.law": "ramberg-osgood", "flow.n": 9}, "Ramberg and Osgood with n 9"),
        (
            {"flow.law": "johnson-cook", "flow.B": "300 MPa", "flow.n": 0.3},
            "B 300 MPa, n 0.3, without temperature",
        ),
        ({"rate.law": "cowper-symonds", "rate.D": "40 /s", "rate.q": 5}, "with D 40 /s, q 5"),
    ],
)
def test_each_law_has_its_words(changes, words):
    scene = replace_all(load("t5b"), {f"barrier.material.{key}": value for key, value in changes.items()})
    assert words in laws(Case(scene).bodies)["barrier.material"]


def test_only_the_first_segment_flows():
    told = laws(Case(load("heavy-tail")).bodies)
    assert told["projectile.segments[2].material"].endswith("only the first segment may yield")


def test_the_pressure_on_a_brittle_barrier_is_told_beside_its_strength():
    def told(**material):
        bodies = Case(read_dict(drop(CONCRETE | material, effects=["auto", "barrier-elastic"]))).bodies
        return bodies.estimate.pressure / 1e6, " ".join(unknowns(bodies))

    pressure, text = told()
    assert f"presses it with {pressure:.4g} MPa in the mean. State its strength in compression" in text
    pressure, text = told(strength="50 MPa")
    assert f", {pressure / 50:.2g} times its strength in compression, 50 MPa: it breaks there" in text
    pressure, text = told(strength="10 GPa", family="glass")
    assert f"at the edge with some {0.3 * pressure:.4g} MPa" in text and "it holds by this estimate" in text


def test_a_layer_leaves_less_of_the_pressure_on_what_lies_under_it():
    """Concrete under 3 mm of epoxy was told to break under the 332 MPa that press the epoxy."""
    layer = {"thickness": "3 mm", "material": "pmma"}
    scene = drop(CONCRETE | {"strength": "50 MPa"}, effects=["auto", "barrier-elastic"])
    bodies = Case(read_dict(scene | {"barrier": scene["barrier"] | {"layers": [layer]}})).bodies
    size = bodies.estimate
    pressure = 1.5e-6 * size.pressure / (1 + (3e-3 / size.radius) ** 2)
    assert f"presses it with {pressure:.4g} MPa 3 mm deep, {pressure / 50:.2g} times" in " ".join(
        unknowns(bodies)
    )


def test_a_tube_that_is_damped_is_not_told_to_lose_nothing_inside():
    """Damping took 1.4 % of the energy of one of which "what it loses inside is left out" was said."""
    scene = drop("aluminium-2024-t3", rod=OWN_STEEL | {"family": "plastic", "loss_factor": 0.012})
    for effects, told in (
        ("material-damping", "damps its vibration"),
        ("-material-damping", "is left out, so"),
    ):
        bodies = Case(read_dict(scene | {"effects": ["auto", "-contact-loss", effects]})).bodies
        assert told in " ".join(unknowns(bodies))


def test_a_note_calls_the_body_what_it_is():
    texts = [one.text for one in Case(read_dict(drop("s235", rod=OWN_STEEL))).limitations]
    assert any(text.startswith("The ball (own steel) has no yield stress") for text in texts)


@pytest.mark.parametrize("metal", ["pa66", "own"])
def test_the_pressure_on_what_would_flow_is_told(metal):
    """By Hertz: 3/2 of the mean is the largest."""
    rod = OWN_STEEL if metal == "own" else metal
    bodies = Case(read_dict(drop("alumina", rod=rod))).bodies
    size, modulus = bodies.estimate, bodies.contact.modulus
    largest = 2 / pi * modulus * sqrt(size.depth / sqrt(size.R1 * size.R2))
    told = f"presses it with {largest / 1.5e6:.4g} MPa in the mean: beyond three times its yield stress"
    assert told in " ".join(unknowns(bodies))
