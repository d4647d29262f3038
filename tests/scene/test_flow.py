"""Flow curves with fewer numbers: bilinear, perfectly plastic, Ramberg-Osgood, Johnson-Cook, a table."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fem_impact.case.case import Case
from fem_impact.case.effects.plasticity import hardening_of, strength_of
from fem_impact.cli.statement import statement_of
from fem_impact.errors import SceneError
from fem_impact.physics.hardening import Hardening, TabulatedHardening, rate_law
from fem_impact.run.simulate import simulate
from fem_impact.scene import curve
from fem_impact.scene.inputs import inputs
from fem_impact.scene.material import JohnsonCookFlow, Material, RambergOsgoodFlow, TableFlow
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest, to_dict, to_toml

COPPER = {"name": "cu", "E": "117 GPa", "nu": 0.35, "rho": "8930 kg/m3", "heat_capacity": "385 J/(kg K)"}
JC = {"law": "johnson-cook", "B": "292 MPa", "n": 0.31}
HEAT = {"m": 1.09, "melting": "1356 K", "reference": "293 K", "heat_share": 0.9}
TABLE = {"law": "table", "points": [[0, "200 MPa"], [0.01, "205 MPa"], [0.2, "350 MPa"]]}
LAWS = {
    "bilinear": {"yield_stress": "400 MPa", "tangent_modulus": "100 MPa"},
    "plastic modulus": {"yield_stress": "400 MPa", "hardening": "100 MPa"},
    "perfect": {"yield_stress": "400 MPa", "hardening": "0 MPa"},
    "ramberg-osgood": {"yield_stress": "276 MPa", "flow": {"law": "ramberg-osgood", "n": 20}},
    "johnson-cook": {"yield_stress": "90 MPa", "flow": JC},
    "with heat": {"yield_stress": "90 MPa", "flow": JC | HEAT},
    "table": {"flow": TABLE},
    "hardness": {"yield_stress": "90 MPa", "law": "hardness", "hardness": 100},
}


def scene(material, **more):
    """A copper rod that falls on a steel plate."""
    return read_dict(
        {
            "id": "law",
            "projectile": {
                "shape": "hemisphere",
                "length": "40 mm",
                "diameter": "10 mm",
                "material": material,
            },
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "machined"},
            "impact": {"angle": "0 deg", "speed": "10 m/s"},
            **more,
        }
    )


def metal(**law):
    return scene(COPPER | law).projectile.material


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_law_needs_no_ultimate_stress_and_is_read_back(law):
    made = scene(COPPER | law)
    assert read_dict(to_dict(made)) == made
    assert read_dict(tomllib.loads(to_toml(made))) == made
    case = Case.of(made)
    assert "rod-plasticity" in case.active
    assert case.slots.rod_law is not None
    assert simulate(made, "rigid").restitution.edge.e < 1
    assert 0 < simulate(made, "modal").restitution.edge.e < 1


def test_tangent_and_plastic_modulus_state_the_same():
    """H = Et / (1 - Et/E)."""
    tangent, plastic = metal(**LAWS["bilinear"]), metal(**LAWS["plastic modulus"])
    assert tangent.plastic_modulus == pytest.approx(100e6 / (1 - 100e6 / 117e9))
    assert hardening_of(tangent).flow_stress(0.5) == pytest.approx(400e6 + 0.5 * tangent.plastic_modulus)
    assert hardening_of(plastic).flow_stress(0.5) == pytest.approx(450e6)


def test_perfectly_plastic_does_not_harden():
    assert hardening_of(metal(**LAWS["perfect"])).flow_stress([0.0, 2.0]) == pytest.approx([400e6, 400e6])


def test_ramberg_and_osgood_by_hand():
    """p = .002 (sigma / 276 MPa)^20: 335.6 MPa at 10 %; it begins to flow at p = .0001."""
    law = hardening_of(metal(**LAWS["ramberg-osgood"]))
    assert law.flow_stress(0.002) == pytest.approx(276e6, rel=1e-12)
    assert law.flow_stress(0.1) == pytest.approx(276e6 * 50 ** (1 / 20), rel=3e-3)
    assert law.flow_stress(0.0) == pytest.approx(276e6 * 21 ** (-1 / 20))


def test_johnson_and_cook_by_hand():
    law = hardening_of(metal(**LAWS["johnson-cook"]))
    strain = np.array([0.01, 0.1, 0.5, 2.0])
    assert law.flow_stress(0.0) == 90e6
    assert law.flow_stress(strain) == pytest.approx(90e6 + 292e6 * strain**0.31, rel=2e-3)


def test_kept_heat_softens_as_the_equation_of_the_temperature_says():
    """dT = .9 sigma dp / (rho c), by an integrator of its own; the curve is held at its largest stress."""
    law = hardening_of(metal(**LAWS["with heat"]))

    def flow(strain, warmer):
        return (90e6 + 292e6 * strain**0.31) * (1 - np.clip(warmer / (1356 - 293), 0, 1) ** 1.09)

    def heated(strain, warmer):
        return 0.9 * flow(strain, warmer) / (8930 * 385)

    strain = np.array([0.05, 0.3, 1.0])
    warmer = solve_ivp(heated, (0.0, 1.0), [0.0], t_eval=strain, rtol=1e-9, atol=1e-9).y[0]
    assert law.flow_stress(strain) == pytest.approx(flow(strain, warmer), rel=5e-3)
    cold = hardening_of(metal(**LAWS["johnson-cook"]))
    assert law.flow_stress(1.0) < 0.95 * cold.flow_stress(1.0)
    stresses = [stress for _, stress in law.points]
    assert stresses == sorted(stresses)
    assert stresses[-1] == stresses[-2]


def test_johnson_and_cooks_curve_is_that_of_the_reference_rate():
    """(A + B p^n)(1 + C ln(rate / reference)); a slow test gives the strengths of other curves alone."""
    rate = {"law": "johnson-cook", "C": 0.025}
    law = rate_law(metal(**LAWS["johnson-cook"], rate=rate))
    assert law.factor(1000.0) == pytest.approx(1 + 0.025 * np.log(1000), rel=1e-12)
    assert law.factor(0.01) == 1.0
    fast = metal(**LAWS["johnson-cook"], rate=rate | {"reference": "10 /s"})
    assert fast.rate.tested == 10.0
    stated = metal(**LAWS["johnson-cook"], rate=rate | {"tested_per_s": 0.01})
    assert (stated.rate.tested, metal(**LAWS["perfect"], rate=rate).rate.tested) == (0.01, 0.002)


def test_the_rate_of_the_tests_follows_a_flow_or_a_reference_that_is_changed():
    """It was written out as if stated, and stayed .002 beside the curve of a textbook."""
    flow = {f"projectile.material.flow.{key}": value for key, value in JC.items()}
    scene = replace_all(load("t5b"), {"projectile.material": "steel-4340", **flow})
    assert scene.projectile.material.rate.tested == scene.projectile.material.rate.reference == 1.0
    later = replace_all(scene, {"projectile.material.rate.reference": "10 /s"})
    assert later.projectile.material.rate.tested == 10.0


def test_the_rate_of_the_tests_is_told_where_a_scene_states_none():
    def told(material):
        every = statement_of(Case.of(scene(COPPER | material), "rigid"))["defaults"]
        return {one["key"]: one["value"] for one in every if ".rate." in one["key"]}

    rate = {"law": "johnson-cook", "C": 0.025}
    keys = [f"projectile.material.rate.{key}" for key in ("reference", "tested")]
    assert told(LAWS["johnson-cook"] | {"rate": rate}) == dict.fromkeys(keys, "1 /s")
    assert told(LAWS["perfect"] | {"rate": rate}) == dict(zip(keys, ("1 /s", "0.002 /s"), strict=True))
    assert told(LAWS["perfect"] | {"rate": rate | {"tested": "5 /s", "reference": "2 /s"}}) == {}


def test_a_table_is_its_points():
    law = hardening_of(metal(**LAWS["table"]))
    assert law.flow_stress([0.0, 0.005, 0.01, 0.105, 0.2, 3.0]) == pytest.approx(
        [200e6, 202.5e6, 205e6, 277.5e6, 350e6, 350e6]
    )
    assert metal(**LAWS["table"]).yield_stress == 200e6


def test_measured_curves_become_plastic_strain_and_true_stress(tmp_path):
    """Of a power law, computed back: whole true strain, and engineering strain and stress, from a file."""
    plastic = np.array([0.0, 0.01, 0.05, 0.15])
    stress = 200e6 + 400e6 * plastic**0.5
    true = plastic + stress / 117e9
    engineering, force = np.expm1(true), stress / np.exp(true)
    rows = "\n".join(
        f"{e:.9f};{s / 1e6:.9f}".replace(".", ",") for e, s in zip(engineering, force, strict=True)
    )
    (tmp_path / "curve.csv").write_text(f"strain;stress_MPa\n0;0\n{rows}\n")
    points = [
        [0, "0 MPa"],
        *([e, f"{s / 1e6!r} MPa"] for e, s in zip(true.tolist(), stress.tolist(), strict=True)),
    ]
    for stated, strain in ((str(tmp_path / "curve.csv"), "engineering"), (points, "true")):
        law = metal(flow={"law": "table", "points": stated, "strain": strain})
        assert np.array(law.flow.points) == pytest.approx(
            np.column_stack([plastic, stress]), abs=2e-8, rel=1e-6
        )


def test_the_reduced_model_takes_the_nearest_power_law():
    power = Hardening(300e6, 640.0, 0.1)
    strain = np.concatenate([[0.0], np.geomspace(1e-5, 1.0, 400)])
    table = TabulatedHardening(tuple(zip(strain, power.flow_stress(strain), strict=True)))
    assert table.power.exponent == pytest.approx(0.1, rel=0.02)
    assert table.power.flow_stress([0.02, 0.2]) == pytest.approx(power.flow_stress([0.02, 0.2]), rel=2e-3)
    assert power.power is power


def test_the_limit_pressure_of_a_body_without_ultimate_stress_is_finite():
    """The flow stress at a plastic strain of one caps the pressure on the other body."""
    assert strength_of(metal(**LAWS["perfect"])) == 400e6
    assert strength_of(metal(**LAWS["plastic modulus"])) == pytest.approx(500e6)
    assert strength_of(metal(yield_stress="90 MPa", ultimate_stress="200 MPa")) == 200e6
    assert strength_of(metal()) == np.inf


def test_strains_in_per_cent_are_taken_as_such_or_refused(tmp_path):
    def points(header, kind="plastic"):
        (tmp_path / "curve.csv").write_text(f"{header},stress_MPa\n0,350\n2,500\n15,700\n")
        return curve.curve(str(tmp_path / "curve.csv"), kind, 2e11)

    for header in ("strain_%", "strain [%]", "strain (%)"):
        assert np.array(points(header)) == pytest.approx(np.array([[0, 350e6], [0.02, 500e6], [0.15, 700e6]]))
    for kind in ("plastic", "true", "engineering"):
        with pytest.raises(
            SceneError, match=r"points: has a strain of 15, above 3. .*0.15, not 15, for 15 %"
        ):
            points("strain", kind)
    with pytest.raises(SceneError, match="no two columns strain and stress"):
        points("strain,strain_%")
    with pytest.raises(SceneError, match="at most 3"):
        TableFlow(((0.0, 350e6), (15.0, 700e6)))


def test_the_numbers_of_a_flow_curve_are_changed_on_the_command_line():
    changed = replace_all(
        load("t5b"), {"barrier.material.flow.law": "ramberg-osgood", "barrier.material.flow.n": 9}
    )
    assert changed.barrier.material.flow == RambergOsgoodFlow(9.0)
    assert changed.barrier.material.name == "plate-steel (changed)"
    assert digest(changed) != digest(load("t5b"))
    again = replace_all(changed, {"barrier.material.flow.n": 11})
    assert again.barrier.material.flow == RambergOsgoodFlow(11.0)


def test_a_flow_curve_is_one_input():
    rows = {row[0]: row[1] for row in inputs(scene(COPPER | LAWS["johnson-cook"])).rows}
    assert rows["projectile.material.flow"] == "law johnson-cook, B 292 MPa, n 0.31"


MISTAKES = [
    ({"yield_stress": "90 MPa"}, 'ultimate_stress: is missing.*hardening .*"0 MPa": perfectly plastic'),
    ({"yield_stress": "90 MPa", "hardening": "1 GPa", "tangent_modulus": "1 GPa"}, "stands beside"),
    ({"yield_stress": "90 MPa", "hardening": "1 GPa", "flow": JC}, "hardening.*stands beside flow"),
    ({"yield_stress": "90 MPa", "tangent_modulus": "117 GPa"}, "not below E"),
    ({"tangent_modulus": "1 GPa"}, "means nothing without yield_stress"),
    ({"flow": JC}, "flow: means nothing without yield_stress"),
    ({"yield_stress": "90 MPa", "law": "hardness", "hardness": 100, "flow": JC}, "beside flow"),
    ({"yield_stress": "90 MPa", "flow": {"law": "voce"}}, "flow.law.*is not a choice"),
    ({"yield_stress": "90 MPa", "flow": {"law": "johnson-cook", "n": 0.3}}, r"flow.B: is missing"),
    ({"yield_stress": "90 MPa", "flow": JC | {"m": 1.0}}, "flow.melting: is missing beside"),
    ({"yield_stress": "90 MPa", "flow": JC | HEAT | {"melting": "250 K"}}, "is not above reference"),
    ({"yield_stress": "90 MPa", "flow": TABLE}, "yield_stress = .90 MPa.*Leave it out"),
    ({"flow": {"law": "table", "points": [[0, "200 MPa"]]}}, "2 to 200 points"),
    ({"flow": {"law": "table", "points": [[0.1, "200 MPa"], [0.2, "300 MPa"]]}}, "must begin at"),
    ({"flow": {"law": "table", "points": [[0, "200 MPa"], [0.2, "190 MPa"]]}}, "softening"),
    ({"flow": {"law": "table", "points": [[0, "200 MPa"], [0, "290 MPa"]]}}, "growing strains"),
    ({"flow": {"law": "table", "points": [[0, "200 mm"], [0.2, "190 MPa"]]}}, r"points\[1\]"),
    ({"flow": {"law": "table", "points": [0, 1]}}, "must be a list of pairs"),
    ({"flow": {"law": "table"}}, "flow.points: is missing"),
    ({"flow": TABLE | {"strain": "nominal"}}, "flow.strain.*is not a choice"),
    (
        {"flow": {**TABLE, "strain": "engineering", "points": [[0.004, "200 MPa"], [0.1, "300 MPa"]]}},
        "elastic line",
    ),
    (
        {
            "flow": {
                **TABLE,
                "strain": "engineering",
                "points": [[0, "200 MPa"], [0.1, "300 MPa"], [0.2, "290 MPa"]],
            }
        },
        "falls from 300 to 290 MPa at a strain of 0.2: the bar necks",
    ),
    (
        {
            "flow": {
                **TABLE,
                "strain": "engineering",
                "points": [[0, "0 MPa"], [0.17, "355 MPa"], [2, "400 MPa"]],
            }
        },
        "flow.points: leaves the elastic line.*at a true strain of 0.157, has 415.4 MPa.*in per cent",
    ),
    ({"flow": {"law": "table", "points": "none.csv"}}, "flow.points: none.csv: cannot be read"),
    ({"yield_stress": "90 MPa", "A": "90 MPa"}, "A is yield_stress; B and n stand in flow"),
    ({"flow": "table"}, "must be a table"),
]


@pytest.mark.parametrize(("law", "words"), MISTAKES)
def test_a_mistake_is_named_with_its_remedy(law, words):
    with pytest.raises(SceneError, match=words):
        scene(COPPER | law)


def test_heat_needs_a_heat_capacity():
    without = {key: value for key, value in COPPER.items() if key != "heat_capacity"}
    with pytest.raises(SceneError, match="heat_capacity: is missing for the heat"):
        scene(without | LAWS["with heat"])


@pytest.mark.parametrize("points", [(), ((0.0, 1.0),), ((0.0, 2.0), (1.0, 1.0)), ((0.1, 1.0), (1.0, 1.0))])
def test_a_table_that_is_no_curve_is_refused(points):
    with pytest.raises(ValueError, match=r"points|softening|unpack"):
        TabulatedHardening(points)


def test_flows_made_in_python_are_checked_too():
    with pytest.raises(SceneError, match=r"n .*at least"):
        JohnsonCookFlow(1e8, 0.0)
    whole = Material("m", 1e11, 0.3, 8e3, 2e8, flow=TableFlow(((0, 2e8), (0.1, 3e8))))
    with pytest.raises(SceneError, match="not that of the table"):
        replace(whole, yield_stress=1e8)
