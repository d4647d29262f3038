"""One call and one record for three fidelities; here the two that need no finite-element run."""

import json
from dataclasses import replace

import numpy as np
import pytest

from fem_impact.answers.compare import compare
from fem_impact.case.case import Case
from fem_impact.errors import SceneError, UsageError
from fem_impact.modal.impact import solve as modal_solve
from fem_impact.options import RunOptions
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.run.common import NO_PUSH, barrier_motion, motion, open_end, restitution
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict, read_toml
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS, digest, to_dict
from rigid import solve

REDUCED = ("rigid", "modal")


@pytest.mark.parametrize("fidelity", REDUCED)
def test_a_record_is_whole_and_reads_back(fidelity, tmp_path):
    scene = load("t6-60")
    outcome = simulate(scene, fidelity, RunOptions(out=tmp_path))
    assert outcome.provenance.fidelity == fidelity
    assert Outcome.read(tmp_path / "outcome.json") == outcome
    assert read_toml(tmp_path / "scene.toml") == scene
    assert (tmp_path / "contacts.csv").exists() == (fidelity == "modal")
    nulls = {name for name, value in outcome.to_dict().items() if value is None}
    assert nulls == set(outcome.reasons) and all(outcome.reasons.values())
    assert texts(outcome.validity.limitations, "model")


@pytest.mark.parametrize("fidelity", REDUCED)
@pytest.mark.parametrize("name", ["t2", "t5b", "t6-17"])
def test_the_shares_of_the_energy_add_up(fidelity, name):
    outcome = simulate(load(name), fidelity)
    shares = ("E_r", "E_vib", "W_friction", "E_plastic_rod", "E_plastic_barrier", "residual")
    total = sum(outcome.to_dict()[f"{share}_over_E_0"] or 0.0 for share in shares)
    assert total == pytest.approx(1, abs=2e-3)  # gravity works a little while the rod touches
    assert abs(outcome.energy.residual) < 1e-5
    lost = outcome.restitution.edge.E_ln + outcome.restitution.edge.E_lt
    spin = outcome.motion.mass * outcome.motion.k_squared * outcome.motion.Omega**2 / 2
    closed = spin * (1 + 1 / outcome.restitution.edge.e_m) / outcome.energy.E_0
    assert lost + outcome.energy.rigid - 1 == pytest.approx(closed, abs=1e-9)


@pytest.mark.parametrize("omega", [20.0, -30.0])
def test_coefficients_and_losses_take_a_spin_before_the_impact(omega):
    """A rigid rod's impulse acts at its contact point: e_m = -1, and the losses are all that is lost."""
    outcome = simulate(replace_all(load("t5b"), {"impact.omega": f"{omega} rad/s"}), "rigid")
    assert outcome.restitution.edge.e_m == pytest.approx(-1, abs=1e-9)
    assert outcome.restitution.impulse.e_m == pytest.approx(-1, abs=1e-9)
    assert outcome.restitution.impulse.d_c == pytest.approx(outcome.restitution.edge.d_c)
    kept = outcome.restitution.edge.E_ln + outcome.restitution.edge.E_lt + outcome.energy.rigid
    assert kept == pytest.approx(1, abs=1e-9)
    d_c, d_d = outcome.restitution.edge.d_c, outcome.restitution.edge.d_d
    left = outcome.motion.V_n + d_c * outcome.motion.Omega
    assert outcome.restitution.edge.e == pytest.approx(-left / (outcome.motion.v_n + d_c * omega))
    before = {"v_n": outcome.motion.v_n, "v_t": outcome.motion.v_t}
    body = {"e": outcome.restitution.edge.e, "d_c": d_c, "d_d": d_d, "k2": outcome.motion.k_squared}
    after = solve(**before, **body, mu=outcome.restitution.mu_c, omega=omega)
    assert after.V_t - d_d * after.Omega == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("fidelity", REDUCED)
@pytest.mark.parametrize("tip", [("A", "7 mm"), ("B", "9.5 mm")])
def test_an_upright_rod_does_not_turn_and_has_no_moment(fidelity, tip):
    upright = {"impact.angle": "0 deg", "impact.v_t": "0 m/s"}
    scene = replace_all(load("t5b"), {"projectile.tip": tip[0], "projectile.tip_radius": tip[1], **upright})
    outcome = simulate(scene, fidelity)
    assert outcome.motion.Omega == pytest.approx(0, abs=1e-4)
    assert isinstance(outcome.restitution.edge.e_m, Unknown)
    assert "no moment" in outcome.restitution.edge.e_m.reason
    assert 0 < outcome.restitution.edge.e < 1


def test_what_gravity_adds_is_told_and_closes_the_sum():
    slow = {"impact.v_n": "-0.1 m/s", "impact.v_t": "-0.1 m/s"}
    outcome = simulate(replace_all(load("quick"), slow), "modal")
    parts = ("E_r", "E_vib", "W_friction", "E_plastic_rod", "E_plastic_barrier", "residual")
    assert outcome.energy.gravity > 0.01
    total = sum(outcome.to_dict()[f"{part}_over_E_0"] or 0.0 for part in parts)
    assert total == pytest.approx(1 + outcome.energy.gravity, abs=1e-9)
    assert isinstance(simulate(load("quick"), "modal").energy.gravity, Unknown)


def test_only_effects_of_the_model_are_named():
    every = replace(
        load("t5b"), effects=("auto", "radiation", "gravity", "material-damping", "large-rotation")
    )
    rigid, modal = (simulate(every, fidelity).provenance.effects for fidelity in REDUCED)
    plastic = ("rod-plasticity", "barrier-elastoplastic")
    assert rigid == ("friction", *plastic, "contact-heating")
    assert modal == ("vibration", "friction", *plastic, "rate-hardening", "gravity", "large-rotation")


def test_a_thick_rod_has_modes_too():
    thick = {"projectile.length": "300 mm", "projectile.diameter": "60 mm"}
    assert simulate(replace_all(load("t5b"), thick), "modal").energy.vibration > 0


def test_a_rod_that_gravity_draws_in_more_than_it_is_pushed_away_has_no_coefficients():
    case = Case.of(load("t5b"), "rigid")
    still = barrier_motion(case, 0.0, 0.0, 0.0)
    found = restitution(case, motion(case, -1.6, -0.5, 90.0, 0.17, 5.56e-4), still)
    for number in (found.mu, found.mu_c, found.edge.e, found.paper.E_ln, found.impulse.d_c):
        assert number == NO_PUSH
    pushed = restitution(case, motion(case, -1.4, -0.5, 90.0, 0.17, 5.56e-4), still)
    assert pushed.mu > 0


def test_arms_that_do_not_approach_have_no_restitution():
    case = Case.of(replace_all(load("t5b"), {"impact.omega": "60 rad/s"}), "rigid")
    still = barrier_motion(case, 0.0, 0.0, 0.0)
    found = restitution(case, motion(case, 0.4, -0.5, 90.0, 0.17, 5.56e-4), still)
    assert found.impulse.d_c > 1.502 / 60
    assert isinstance(found.impulse.e, Unknown)
    assert "approach" in found.impulse.e.reason
    assert not isinstance(found.edge.e, Unknown)


@pytest.mark.slow
def test_a_long_rod_is_followed_until_its_bending_cannot_bring_it_back():
    long = {"projectile.length": "1.5 m", "accuracy.max_time": "60 ms"}
    case = Case.of(replace_all(load("t3-machined"), long), "modal")
    result = modal_solve(case)
    assert result.finished
    assert 0.1 * case.one_impact < np.diff(result.contacts[:, 0]).max() < case.one_impact


def test_compare_and_tables_take_what_is_not_known():
    rows = compare(simulate(load("t5b"), "rigid"))
    by_name = {row["quantity"]: row for row in rows}
    assert by_name["vibration/E_0"]["model"] is None
    assert "not known: a rigid body" in by_name["vibration/E_0"]["verdict"]
    assert by_name["mu"]["verdict"] == "inside"


def test_the_rigid_fidelity_names_the_source_of_its_restitution():
    scene = load("t5b")
    law, own = simulate(scene, "rigid"), simulate(replace(scene, restitution=0.5), "rigid")
    elastic = simulate(replace(scene, effects=("vibration", "barrier-elastic")), "rigid")
    assert law.restitution.edge.e == pytest.approx(0.306, abs=0.01)
    assert "Thornton" in texts(law.validity.limitations, "model")[0]
    assert (own.restitution.edge.e, texts(own.validity.limitations, "model")[0]) == (
        pytest.approx(0.5, abs=0.02),
        "Restitution 0.5 (energetic) is the scene's own.",
    )
    assert elastic.restitution.edge.e == pytest.approx(1)
    assert "no body of the scene may yield" in texts(elastic.validity.limitations, "model")[0]
    assert elastic.restitution.mu == elastic.energy.friction == 0.0


def test_a_frictionless_elastic_rod_turns_as_momentum_says():
    scene = replace(load("t5b"), effects=("vibration", "barrier-elastic"))
    rod = scene.projectile.rigid_body
    d_c = float(rod.arms(scene.impact.angle)[0])
    Omega = 2 * -scene.impact.v_n * d_c / (rod.k2 + d_c**2)
    assert simulate(scene, "rigid").motion.Omega == pytest.approx(Omega)
    assert Case.of(scene, "rigid").bodies.contact.effective_mass == pytest.approx(
        rod.mass / (1 + d_c**2 / rod.k2)
    )


@pytest.mark.parametrize("name", [n for n in MEASURED_SETS if n.startswith("t5")])
def test_a_short_rod_hardly_vibrates_and_its_yielding_tip_is_not_held_by_all_of_f(name):
    rigid, modal = (simulate(load(name), fidelity) for fidelity in REDUCED)
    assert modal.energy.vibration < 4e-3
    assert modal.restitution.mu < 0.95 * rigid.restitution.mu
    assert modal.energy.friction < 0.6 * rigid.energy.friction


def test_restitution_is_a_key_of_the_scene():
    data = to_dict(load("t5b")) | {"restitution": 0.4}
    scene = read_dict(data)
    assert scene.restitution == 0.4
    assert read_dict(to_dict(scene)) == scene
    assert digest(scene) != digest(load("t5b"))
    with pytest.raises(SceneError, match=r"restitution = 1.4"):
        read_dict(data | {"restitution": 1.4})


def test_an_unknown_fidelity_is_refused():
    with pytest.raises(UsageError, match=r'fidelity="modl": is not a fidelity. Did you mean modal\?'):
        simulate(load("t5b"), "modl")


def test_the_command_takes_a_fidelity(cli):
    code, out, _ = cli("run", "t5b", "--fidelity", "rigid", "--json")
    assert (code, json.loads(out)["fidelity"]) == (0, "rigid")
    code, out, _ = cli("run", "t5b", "--fidelity", "modal")
    assert code == 0
    assert "results: results/t5b-modal" in out
    assert "model: The forces of a sliding tip that ploughs" in out
    code, _, err = cli("run", "t5b", "--fidelity", "none")
    assert code == 2
    assert "--fidelity" in err


@pytest.mark.parametrize("fidelity", ["rigid", "modal"])
def test_friction_that_is_not_known_for_a_material_is_told_in_every_fidelity(fidelity):
    scene = replace_all(load("t5b"), {"projectile.material": "aluminium-6061-t6"})
    told = texts(simulate(scene, fidelity).validity.limitations)
    assert any("friction" in sentence.lower() and "aluminium-6061-t6" in sentence for sentence in told)


SOFT_TIP = {"projectile.material": "copper"}


@pytest.mark.parametrize(
    ("changes", "where"),
    [({"effects": ["auto", "barrier-rigid"]}, "tip"), ({}, "tip"), (None, "barrier")],
    ids=["rigid barrier", "both may yield", "steel tip"],
)
def test_the_skin_and_the_dent_are_those_of_the_body_that_flows(changes, where):
    scene = load("t5b") if changes is None else replace_all(load("t5b"), SOFT_TIP | changes)
    outcome = simulate(scene, "modal")
    energy, told = outcome.energy, " ".join(texts(outcome.validity.limitations, "model"))
    assert f"the dent that the first one left in the {where}." in told
    if changes is None:
        assert energy.skin == pytest.approx(energy.friction + energy.skin_barrier)
        assert energy.skin_barrier > 0.0
        assert "the skin of the body that yields first alone" in energy.skin_rod.reason
    else:
        assert "softer than the barrier is known by finite elements alone" in energy.skin.reason
        assert energy.skin_rod == energy.skin
        assert (energy.skin_barrier == energy.plastic_barrier == 0.0) == bool(changes)


@pytest.mark.long
def test_no_dent_where_nothing_yields():
    assert "dent" not in " ".join(
        texts(simulate(load("elastic-frictionless"), "modal").validity.limitations, "model")
    )


@pytest.mark.parametrize("angle", ["45 deg", "86 deg"])
def test_a_scene_in_another_size_has_the_same_answer(angle):
    """Without gravity and rate effects no length or time of the model's own decides anything.

    By round-off a cell more or less touches, and what is ploughed up stands on a cell more or less.
    """
    changes = {"impact.angle": angle, "impact.v_n": "-2 m/s", "effects": ["auto", "-gravity"]}
    changes |= {"projectile.material": "100cr6", "barrier.material": "aluminium-7075-t6"}
    small = {"projectile.length": "16 mm", "projectile.diameter": "3.8 mm", "projectile.tip_radius": "0.6 mm"}
    here, there = (simulate(replace_all(load("t5b"), changes | size), "modal") for size in ({}, small))
    for key in ("e_edge", "mu", "E_vib_over_E_0", "W_friction_over_E_0"):
        assert there.estimate(key)[0] == pytest.approx(here.estimate(key)[0], rel=1e-4)


@pytest.mark.long
def test_an_impact_ends_before_the_other_end_strikes_on_a_plane_too():
    """All skin of a rod that deforms may touch a rigid plane: its other end comes 0.8 ms later."""
    changed = {"projectile.length": "0.24 m", "impact.angle": "89 deg", "impact.v_n": "-2 m/s"}
    elastic = {"effects": ["vibration", "barrier-rigid"], "impact.v_t": "0 m/s", "accuracy.levels": 1}
    scene = replace_all(load("t5b"), changed | elastic)
    modal, solid = (simulate(scene, fidelity) for fidelity in ("modal", "solid"))
    assert "other end strikes 0.7" in solid.validity.stopped_because
    assert len(solid.contact.intervals) == len(modal.contact.intervals) == 2
    assert solid.motion.Omega == pytest.approx(modal.motion.Omega, rel=0.05)


@pytest.mark.long
def test_an_impact_ends_before_the_other_end_strikes_a_meshed_barrier_too():
    """Both ends may touch: finite elements went on to the slap, e -0.14, where the reduced model stopped."""
    changed = {"impact.angle": "89.8 deg", "impact.v_n": "-1.5 m/s", "impact.v_t": "-0.2 m/s"}
    scene = replace_all(load("t5b"), changed | {"accuracy.levels": 1, "accuracy.tip_size": "1.2 mm"})
    modal, solid = (simulate(scene, fidelity) for fidelity in ("modal", "solid"))
    for found in (modal, solid):
        assert "other end strikes 0.0" in found.validity.stopped_because
        assert len(found.contact.intervals) == 1
    assert solid.motion.Omega == pytest.approx(modal.motion.Omega, rel=0.1)


@pytest.mark.long
def test_an_impact_of_the_tail_ends_before_the_tip_strikes():
    """The other end was the half of the tail, which had touched: the slap of the tip was counted with it."""
    taper = {"profile": [["0 mm", "5 mm"], ["80 mm", "7 mm"]], "material": "rod-steel"}
    scene = load(
        {
            "id": "taper",
            "projectile": taper,
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "custom", "friction": 0.3, "source": "assumed"},
            "impact": {"angle": "88.9 deg", "v_n": "-1.5 m/s", "v_t": "-0.2 m/s"},
            "accuracy": {"tip_size": "1.2 mm", "levels": 1},
        }
    )
    for fidelity in ("modal", "solid"):
        assert "other end strikes 0.0" in simulate(scene, fidelity).validity.stopped_because


def test_an_other_end_that_strikes_at_once_leaves_the_end_of_the_impact_open():
    case, contacts = Case.of(load("t5b"), "modal"), np.array([[0.0, 100e-6]])
    assert open_end(case, contacts, 1.0, 0.0, 20e-6).startswith("The other end strikes 20 us after")
    # a dumb-bell of brass, level but for 0.1 degrees: V_n -1.37 m/s, 36 us before the other end and after
    # 48 us; by finite elements +0.84 m/s, as both ends touch from 0 to 132 us
    assert open_end(case, np.array([[0.0, 48e-6]]), -1.37, 26.6, 36e-6)
    assert open_end(case, contacts, 1.0, 0.0, 110e-6) == ""
