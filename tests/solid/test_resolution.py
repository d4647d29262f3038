"""A contact that the mesh does not resolve: what is withheld, what is said beforehand, what stays."""

import re
from dataclasses import replace
from math import cos, radians, sin
from types import SimpleNamespace

import pytest
import solid_scenes as scenes

from fem_impact.case.case import Case
from fem_impact.cli.run import print_outcome
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.run.resolution import unresolved
from fem_impact.run.solid import reduce
from fem_impact.scene import shipped
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import Impact
from fem_impact.scene.material import Material
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load
from fem_impact.scene.types import MEASURED_SETS, digest, to_dict
from fem_impact.solid.run import solve


@pytest.fixture(scope="module")
def result():
    """A gentle blow: one node of the 1.6 mm mesh is pressed; e, mu and Omega depend on its place."""
    short = {"length": 0.06, "v_n": -0.3, "v_t": -0.3, "tip": 1.6e-3, "max_time": 4e-4}
    scene = scenes.scene("vibration", "friction", "barrier-elastic", "contact-heating", **short)
    return solve(Case.of(shipped.replace(scene, "accuracy.unresolved", "withhold")))


def test_a_contact_narrower_than_an_element_has_no_coefficients_and_no_shares(result, tmp_path):
    outcome = reduce(result)
    assert result.peak_nodes < 4
    withheld = {name for name, why in outcome.reasons.items() if "the contact was not resolved" in why}
    shares = (
        "E_r",
        "E_vib",
        "E_vib_check",
        "W_friction",
        "E_plastic_rod",
        "E_plastic_barrier",
        "W_contact_dissipation",
    )
    assert {f"{share}_over_E_0" for share in shares} <= withheld
    assert {"friction_power_W", "flash_rise_K", "flash_temperature_K", "flash_bound_K"} <= withheld
    assert {"mu", "e_edge", "e_m_edge", "e_impulse", "E_ln_edge_over_E_0", "peak_force_N"} <= withheld
    after = {f"{m}{k}_per_s" for m in ("", "marker_") for k in ("V_n_m", "V_t_m", "Omega_rad")}
    assert after <= withheld  # e follows from it
    assert outcome.energy.E_0 > 0 and outcome.energy.residual < 1e-4 and outcome.restitution.edge.d_c > 0
    assert any("the contact was not resolved" in words for words in texts(outcome.validity.limitations))
    assert Outcome.read(outcome.write(tmp_path / "outcome.json")) == outcome
    assert "e=not known, mu=not known" in repr(outcome)


def test_a_run_prints_what_is_withheld_with_e(result, tmp_path, capsys):
    print_outcome(reduce(result), tmp_path)
    shown = capsys.readouterr().out
    for label in ("V_n after", "Omega after", "peak force", "flash temperature"):
        assert re.search(rf"^  {label} +not known$", shown, re.MULTILINE)
    named = " ".join(shown.partition("not known (")[2].partition("): the contact was not")[0].split())
    assert "V_n after" in named and named.endswith("peak force; flash temperature")


def test_the_scene_may_ask_for_the_numbers_all_the_same(result):
    asked = shipped.replace(result.case.scene, "accuracy.unresolved", "report")
    outcome = reduce(replace(result, case=Case.of(asked)))
    assert outcome.heat.power > 0
    assert 0.0 < outcome.restitution.edge.e < 2.0 and 0.0 < outcome.energy.rigid < 2.0
    assert any("the contact was not resolved" in words for words in texts(outcome.validity.limitations))


def test_four_pressed_nodes_resolve_a_contact(result):
    assert isinstance(reduce(replace(result, peak_nodes=3)).restitution.mu, Unknown)
    resolved = reduce(replace(result, peak_nodes=4))
    assert isinstance(resolved.restitution.mu, float)
    assert not any("not resolved" in words for words in texts(resolved.validity.limitations))


def test_a_contact_that_loses_energy_by_its_mesh_is_not_resolved(result):
    """A sharp edge on coarse cells that meets the barrier at 16 m/s lost 17 % of E_0 without a word."""
    pressed = replace(result, peak_nodes=4)
    for lost, known in ((0.019, True), (0.021, False)):
        accounts = {**result.accounts, "contact_dissipation": lost * result.E_0}
        outcome = reduce(replace(pressed, accounts=accounts))
        assert isinstance(outcome.restitution.edge.e, float) == known
        assert any("lost 2.1 % of E_0" in words for words in texts(outcome.validity.limitations)) != known


def test_a_narrow_contact_is_told_before_the_run(result):
    (told,) = (words for words in texts(result.case.limitations) if "too narrow" in words)
    size = told.partition("accuracy.tip_size = ")[2].partition(" or less")[0]
    assert not [
        w
        for w in texts(Case.of(shipped.replace(result.case.scene, "accuracy.tip_size", size)).limitations)
        if w == told
    ]


@pytest.mark.parametrize("name", [*MEASURED_SETS, "quick", "elastic-frictionless"])
def test_shipped_scenes_resolve_their_contact(name):
    assert not [words for words in texts(Case.of(load(name)).limitations) if "too narrow" in words]


def test_a_choice_that_differs_is_written_and_another_refused():
    scene = load("quick")
    asked = shipped.replace(scene, "accuracy.unresolved", "report")
    assert read_dict(to_dict(asked)) == asked
    assert digest(asked) != digest(scene)
    assert "unresolved" not in to_dict(scene)["accuracy"]
    with pytest.raises(SceneError, match=r"accuracy\.unresolved"):
        shipped.replace(scene, "accuracy.unresolved", "hide")


@pytest.fixture(scope="module")
def thick():
    """A thick steel rod that brushes an aluminium block: a contact of .8 mm radius on cells of 3.7 mm."""
    base = scenes.scene("vibration", "friction", "barrier-elastoplastic", f=0.07, tip=3.67e-3, across=8)
    steel = Material("mild steel", 210e9, 0.29, 7850.0, 350e6, 520e6)
    soft = Material("aluminium", 70e9, 0.33, 2700.0, 270e6, 310e6)
    angle = radians(56)
    return replace(
        base,
        projectile=ProjectileSpec(0.158, 58.7e-3, "A", 13.2e-3, steel),
        barrier=Barrier(soft),
        impact=Impact(angle, -0.35 * cos(angle), -0.35 * sin(angle)),
    )


def test_a_thick_rod_on_coarse_cells_is_not_resolved(thick):
    """One node slides down the slope of a facet: e = 1.43 where the reduced model has .70, and mu = 2.8 f."""
    result = solve(Case.of(thick))
    told = reduce(result)
    assert told.restitution.edge.e > 1.3
    assert told.restitution.mu > 2.5 * 0.07
    assert any("is above 1" in words for words in texts(told.validity.limitations))
    assert any("beyond f = 0.07" in words for words in texts(told.validity.limitations))
    withheld = reduce(
        replace(result, case=Case.of(shipped.replace(thick, "accuracy.unresolved", "withhold")))
    )
    for value in (withheld.restitution.mu, withheld.restitution.edge.e, withheld.energy.rigid):
        assert "the contact was not resolved" in value.reason
        assert "Give accuracy.tip_size = 0.11 mm or less" in value.reason
    assert not any(words.startswith(("e = ", "mu = ")) for words in texts(withheld.validity.limitations))


@pytest.mark.slow
def test_a_thick_rod_on_the_advised_cells_is_resolved(thick):
    """Half the size moves e by .018 and mu by 4 %."""
    outcome = reduce(solve(Case.of(shipped.replace(thick, "accuracy.tip_size", "0.25 mm"))))
    assert outcome.restitution.edge.e == pytest.approx(0.78, abs=0.03)
    assert outcome.restitution.mu == pytest.approx(0.07, abs=0.006)


def test_one_row_of_nodes_is_not_resolved_where_the_contact_yields():
    """An own mesh had e 0.96, 0.98, 0.99 and 0.98 on such levels, and 0.79 and 0.56 on two more."""
    case = Case(load("t5b"))

    def found(rows, case):
        result = SimpleNamespace(
            case=case,
            peak_nodes=1000,
            record=SimpleNamespace(rows=rows),
            accounts={"contact_dissipation": 0.0},
            E_0=1.0,
        )
        return unresolved(result)

    assert "one row of nodes wide" in found(1, case) and "accuracy.tip_size" in found(1, case)
    assert found(2, case) == found(1, Case(load("elastic-frictionless"))) == ""
