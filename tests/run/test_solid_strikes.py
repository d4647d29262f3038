"""Finite elements over several strikes of one rod."""

import numpy as np
import pytest

from fem_impact.answers.simulate import simulate as simulate_levels
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.evidence.studies.strikes import scene_of
from fem_impact.modal.rod import modal_rod
from fem_impact.modal.sites import skin
from fem_impact.options import RunOptions
from fem_impact.outcome.groups import texts
from fem_impact.run.simulate import simulate
from fem_impact.run.solid_strikes import SolidCourse
from fem_impact.run.strikes import Followed
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import to_dict
from fem_impact.solid.run import solve

FALL = {
    "impact.slope": "0 deg",
    "impact.until": "3 strikes",
    "impact.v_n": "-1 m/s",
    "impact.v_t": "0 m/s",
    "impact.angle": "75 deg",
    "strikes.fidelity": "solid for the first 2, then modal",
    "accuracy.levels": 1,
    "accuracy.tip_size": "1 mm",
    "save.frames": 0,
}
ELASTIC = {"effects": ["vibration", "barrier-rigid", "gravity", "large-rotation"]}


def capsule(**changes):
    """A rod of 80 mm with a hemisphere at either end."""
    R, L = 9.5, 80.0
    arc = np.radians(np.linspace(0, 90, 46))
    end = [(R * (1 - np.cos(a)), R * np.sin(a)) for a in arc]
    points = [*end, *((L - z, r) for z, r in end[::-1])]
    data = to_dict(replace_all(load("quick"), FALL | ELASTIC | changes))
    data.pop("measured", None)
    rows = [[f"{z:.9f} mm", f"{r:.9f} mm"] for z, r in points]
    data["projectile"] = {"profile": rows, "material": "rod-steel"}
    return read_dict(data)


@pytest.fixture(scope="module")
def elastic():
    return simulate(capsule(), "solid")


@pytest.mark.long
def test_the_vibration_of_a_strike_meets_the_next(elastic):
    first, second, third = elastic.strikes.each
    assert [one.fidelity for one in elastic.strikes.each] == ["solid", "solid", "modal"]
    assert [one.part for one in elastic.strikes.each] == ["tip", "tail", third.part]
    assert second.taken == pytest.approx(first.vibration, rel=1e-12)  # nothing damps it
    assert first.vibration > 0.05 * first.before
    assert [one.dent for one in elastic.strikes.each] == [0.0, 0.0, None]


def test_motion_and_vibration_keep_the_energy_of_an_elastic_rod(elastic):
    """What is lost closes nodes on the plane, or vibrates above the modes: less on finer meshes."""
    s, E_0 = elastic.strikes, elastic.energy.E_0
    assert abs(s.residual) < 1e-12
    assert all(0.0 < one.other < 2e-3 * E_0 for one in s.each[:2])


def test_tail_and_time_are_those_of_the_modes(elastic):
    modal = simulate(capsule(**{"impact.until": "2 strikes"}), "modal").strikes.each[1]
    second = elastic.strikes.each[1]
    assert second.approach == pytest.approx(modal.approach, rel=0.03)
    assert second.time == pytest.approx(modal.time, rel=0.03)


def test_what_is_carried_on_is_told(elastic):
    told = " ".join(texts(elastic.validity.limitations, "model"))
    assert "2 strikes are computed with finite elements of one body" in told
    assert "Strikes after the first 2 are those of the modal model" in told


def test_modes_take_over_the_vibration_of_finite_elements():
    """Where the rod may touch, both move alike at the same time."""
    case = Case.of(capsule(**{"accuracy.tip_size": "2 mm", "impact.until": "2 strikes"}), "solid")
    course = SolidCourse.at_first(Followed.of(case), solve(case))
    rod, last = modal_rod(case.bodies), course.last
    q, rate = course.in_modes_of(rod)
    held = 0.5 * float((rate**2 + (rod.omega * q) ** 2).sum())
    assert held == pytest.approx(course.vibration, rel=0.02)
    points = last.model.geometry.rod_points - last.view.rigid(last.model.initial_state()).centre
    modes = course.flight.modes
    for s in range(len(rod.sites.along_t)):
        node = int(np.hypot(*(points[:, [0, 2]] - skin(rod.sites, s, 0.0)).T).argmin())
        moves = modes.shape[last.model.layout.rod[node]]
        moved, speed = moves @ course.flight.a, moves @ (modes.omega * course.flight.b)
        along = rod.sites.along_t[s], rod.sites.along_n[s]
        assert [one @ q for one in along] == pytest.approx(moved[[0, 2]], abs=0.1 * np.abs(moved).max())
        assert [one @ rate for one in along] == pytest.approx(speed[[0, 2]], abs=0.1 * np.abs(speed).max())


def test_the_books_close_where_a_rigid_body_goes_on():
    changes = {"accuracy.tip_size": "2 mm", "strikes.fidelity": "solid for the first 1, then rigid"}
    s = simulate(capsule(**changes), "solid").strikes
    assert [one.fidelity for one in s.each] == ["solid", "rigid", "rigid"]
    assert abs(s.residual) < 1e-12
    assert s.left > s.each[0].vibration > 0.0  # it vibrates on, felt by nothing


@pytest.mark.slow
def test_an_elastic_rod_keeps_its_energy_over_two_strikes_to_a_ten_thousandth():
    fine = {"accuracy.tip_size": "0.4 mm", "impact.until": "2 strikes"}
    s = simulate(capsule(**fine), "solid").strikes
    E_0 = s.each[0].before
    assert abs(E_0 + s.gravity - s.left) < 1e-4 * E_0
    assert s.left > 0.9 * E_0


@pytest.mark.slow
def test_a_yielding_rod_strikes_in_the_order_of_the_reduced_model():
    """One of the ten of the study strikes, which tells of all."""
    scene = replace_all(
        scene_of("75 degrees, 2.1 m/s"), {"strikes.fidelity": "solid for the first 3, then modal"}
    )
    solid, modal = simulate(scene, "solid").strikes, simulate(scene, "modal").strikes
    assert [one.fidelity for one in solid.each] == ["solid"] * 3
    assert [one.part for one in solid.each] == [one.part for one in modal.each] == ["tip", "tail", "tip"]
    assert solid.other_end == pytest.approx(modal.other_end, rel=0.02)
    E_0 = modal.each[0].before
    assert solid.friction == pytest.approx(modal.friction, abs=0.02 * E_0)
    assert solid.plastic == pytest.approx(modal.plastic, abs=0.05 * E_0)


@pytest.mark.slow
def test_a_ball_that_comes_down_on_its_dent_rebounds_nearly_as_from_an_elastic_barrier():
    """On a fresh surface the second strike has e = 0.68 and 1.9 kN: dent and hardening count."""
    changes = {"strikes.fidelity": "solid for the first 2, then rigid", "accuracy.tip_size": "0.3 mm"}
    straight = {"impact.angle": "0 deg", "impact.v_n": "-2 m/s"}
    data = to_dict(replace_all(load("quick"), FALL | changes | straight))
    data.pop("measured", None)
    data["projectile"] = {"shape": "ball", "diameter": "20 mm", "material": "rod-steel"}
    outcome = simulate(read_dict(data), "solid")
    first, second, _ = outcome.strikes.each
    assert first.e < 0.65
    assert second.e > 0.9
    assert second.force == pytest.approx(first.force, rel=0.1)
    assert second.plastic < 0.1 * first.plastic
    assert first.dent == pytest.approx(outcome.contact.readings.dent_depth)
    assert second.dent > 0.9 * first.dent > 1e-5
    told = " ".join(texts(outcome.validity.limitations, "model"))
    assert "on the barrier strikes 2 meet the dents of earlier ones" in told


@pytest.mark.slow
def test_a_run_that_is_killed_between_strikes_goes_on_to_the_same_end(tmp_path, monkeypatch):
    def killed(*_):
        raise KeyboardInterrupt

    scene = capsule(**{"accuracy.tip_size": "2 mm", "impact.until": "2 strikes"})
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(SolidCourse, "_strike", killed)
        simulate(scene, "solid", RunOptions(tmp_path, checkpoint_s=0.0))
    whole, again = (
        simulate(scene, "solid", options) for options in (RunOptions(), RunOptions(tmp_path, resume=True))
    )
    assert again.strikes.each == whole.strikes.each


@pytest.mark.slow
def test_levels_of_meshes_run_the_sequence_and_tell_how_far_they_differ():
    """The tail of the pilot's mesh is too coarse to touch: there finite elements stop, and say so."""
    usual = {key: value for key, value in FALL.items() if not key.startswith("accuracy")}
    outcome = simulate_levels(replace_all(load("quick"), usual | {"impact.v_n": "-1.5 m/s"}))
    assert [one.fidelity for one in outcome.strikes.each] == ["solid", "solid", "modal"]
    told = " ".join(texts(outcome.validity.limitations, "resolution"))
    assert "From the last level of meshes but one to the last: strike 1" in told
    assert "strike 2" in told


def test_what_is_not_handed_on_is_refused():
    scene = replace_all(load("quick"), FALL | {"effects": ["auto", "-vibration"]})
    with pytest.raises(SceneError, match=r"strikes.fidelity.*solid for the first 1, then rigid"):
        simulate(scene, "solid")
