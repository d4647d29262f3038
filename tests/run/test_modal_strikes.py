"""Strikes of the reduced model one after the other."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fem_impact.case.case import Case
from fem_impact.outcome.groups import texts
from fem_impact.outcome.strikes import hardest_force, told
from fem_impact.run.certain import _agree
from fem_impact.run.modal_strikes import ModalCourse, modal_loss
from fem_impact.run.simulate import simulate
from fem_impact.run.strikes import Followed
from fem_impact.scene.shipped import load, replace_all

FLOOR = {"impact.slope": "0 deg", "impact.until": "rest"}
ELASTIC = ["vibration", "barrier-elastic", "gravity"]


@pytest.fixture(scope="module")
def rattle():
    return simulate(replace_all(load("quick"), FLOOR), "modal")


def test_the_first_strike_is_the_first_impact(rattle):
    first = rattle.strikes.each[0]
    assert first.fidelity == "modal"
    assert first.Omega == pytest.approx(rattle.motion.Omega, rel=1e-12)
    assert first.friction == pytest.approx(rattle.energy.friction * rattle.energy.E_0, rel=1e-12)
    assert first.force == rattle.contact.peak_force


@pytest.mark.parametrize("length", ["400 mm", "1.2 m"])
def test_the_slap_of_a_slender_bar_is_a_strike_of_its_own(length):
    """It counted as part of the first, so that the other end came .49 times as fast, finite elements 1.79."""
    bar = {"projectile.length": length, "projectile.diameter": "10 mm", "projectile.tip_radius": "1 mm"}
    fall = {"impact.angle": "82 deg", "impact.height": "1 m", "impact.slope": "0 deg"}
    each = {**bar, **fall, "impact.until": "2 strikes", "strikes": {}}
    found = simulate(replace_all(load("t5b"), each), "modal")
    first, second, *_ = found.strikes.each
    assert (first.part, second.part) == ("tip", "tail")
    assert first.after == pytest.approx(found.energy.rigid * found.energy.E_0, rel=1e-4)
    assert 1.5 < found.strikes.other_end < 2.1


def test_hard_strikes_are_those_of_modes(rattle):
    s = rattle.strikes
    assert [one.fidelity for one in s.each] == ["modal"] * len(s.each)
    assert "finer than modes" in s.time_factor.reason
    assert len(s.each) > 3
    assert s.end == "rests"
    assert s.each[s.hardest_force - 1].force == max(one.force for one in s.each)
    assert s.force_agree == 64  # the first strike is by far the hardest, of heat another one is near
    assert s.heat_agree > 32
    first = s.each[0]
    slow, fast = (replace(s.each[1], force=None, approach=times * first.approach) for times in (0.9, 1.1))
    assert hardest_force([first, slow]) == 1
    assert "strike 2, which is faster" in hardest_force([first, fast]).reason
    swapped = [s.each[1], s.each[0], *s.each[2:]]
    assert _agree(s.each, [s.each, swapped, s.each], lambda one: one.friction) == 2


def test_numbers_that_look_wrong_are_explained(rattle):
    s, first, *others = rattle.strikes, *rattle.strikes.each
    plain = " ".join(told(replace(s, each=(first,), left=1e-32)))
    assert "e below 0 or above 1" not in plain and "keeps 0 J" in plain
    assert "Hardest by friction heat" in plain
    smooth = replace(first, friction=0.0)
    assert "Hardest by friction heat" not in " ".join(told(replace(s, each=(smooth,), hardest_heat=1)))
    given = replace(s, each=(first, replace(others[0], e=1.5), replace(others[1], e=-0.2)), hardest_agree=0)
    words = " ".join(told(given))
    assert "e below 0 or above 1 in strikes 2, 3:" in words
    assert "in 0 of 64" not in words and "in none of the 64 sequences" in words
    assert "not certain; strike" in words


def test_more_strikes_than_modes_compute_are_those_of_a_rigid_body(monkeypatch):
    monkeypatch.setattr("fem_impact.run.modal_strikes.MOST", 3)
    each = simulate(replace_all(load("quick"), FLOOR), "modal").strikes.each
    assert [one.fidelity for one in each[:4]] == ["modal", "modal", "modal", "rigid"]
    assert each[3].force is None


@pytest.mark.long
def test_stages_that_a_scene_states_follow_each_other_and_the_change_is_told():
    stated = FLOOR | {"strikes.fidelity": "modal for the first 3, then rigid"}
    outcome = simulate(replace_all(load("quick"), stated), "modal")
    s = outcome.strikes
    assert [one.fidelity for one in s.each[:4]] == ["modal", "modal", "modal", "rigid"]
    assert abs(s.residual) < 1e-10
    assert "no force" in s.force_agree.reason
    told = next(text for text in texts(outcome.validity.limitations, "model") if "after the first 3" in text)
    assert f"the modal model gave {s.each[2].e:.3g}" in told
    alone = simulate(replace_all(load("quick"), stated), "rigid").strikes
    assert {one.fidelity for one in alone.each} == {"rigid"}


@pytest.mark.long
def test_the_books_of_the_rattle_close(rattle):
    """And so do those of each strike: gravity acts in it as in the flights, and nothing else is left."""
    s = rattle.strikes
    assert abs(s.residual) < 1e-10
    others = [one.other / (one.before + one.taken) for one in s.each]
    assert others[:-2] == pytest.approx([0.0] * (len(s.each) - 2), abs=1e-4)
    assert -1e-4 < min(others[-2:]) and max(others[-2:]) < 0.01  # its side lands level and sends waves
    for one in simulate(replace_all(load("quick"), FLOOR), "rigid").strikes.each:
        spent = one.friction + one.plastic + one.damping + one.other
        assert one.lost == pytest.approx(spent, abs=1e-12 * one.before)
    told = " ".join(texts(rattle.validity.limitations, "model"))
    assert "strikes are computed with modes" in told


@pytest.mark.long
@pytest.mark.parametrize("angle", [60, 75])
def test_without_losses_motion_and_vibration_keep_the_energy(angle):
    changes = FLOOR | {"effects": ELASTIC, "impact.until": "4 strikes", "impact.angle": f"{angle} deg"}
    scene = replace_all(load("quick"), changes | {"impact.v_n": "-1 m/s", "impact.v_t": "0 m/s"})
    assert modal_loss(Case.of(scene, "modal")) == 0.0
    s = simulate(scene, "modal").strikes
    E_0 = s.each[0].before
    assert [one.fidelity for one in s.each] == ["modal"] * 4
    assert s.friction == s.plastic == 0.0
    assert abs(s.damping) < 1e-12 * E_0
    assert abs(E_0 + s.gravity - s.left) < 1e-9 * E_0
    assert max(one.taken for one in s.each) > 1e-3 * E_0  # a strike meets the vibration of the one before


@pytest.mark.long
def test_a_strike_may_take_vibration_back_into_motion():
    gained = []
    for angle in range(50, 80, 5):
        changes = FLOOR | {"effects": ELASTIC, "impact.until": "4 strikes", "impact.angle": f"{angle} deg"}
        scene = replace_all(load("quick"), changes | {"impact.v_n": "-1 m/s", "impact.v_t": "0 m/s"})
        each = simulate(scene, "modal").strikes.each
        gained += [one.taken - one.vibration for one in each]
    assert max(gained) > 0.0


def test_another_phase_of_what_vibrates_changes_a_strike_and_widens_its_half_widths():
    changes = FLOOR | {"impact.until": "2 strikes", "impact.angle": "85 deg", "impact.v_t": "0 m/s"}
    first, second = (whole := simulate(replace_all(load("quick"), changes), "modal").strikes).each
    assert (first.e_phase, first.force_phase) == (0.0, 0.0)  # nothing vibrates before it
    assert second.taken > 0.01 * second.before
    assert second.e_phase > 0.05
    assert whole.half_width(2, "e") > second.e_phase
    assert whole.half_width(2, "Omega_rad_per_s") > 2.0 * whole.half_width(1, "Omega_rad_per_s")


def test_modes_in_flight_are_damped_oscillators():
    scene = replace_all(load("quick"), FLOOR)
    case = Case.of(scene, "modal")
    course = ModalCourse.at_first(case, Followed.of(case))
    omega, eta, dt = course.rod.omega, course.loss, 3e-4
    q, rate = course._swung(dt)
    for k in (0, len(omega) - 1):
        exact = solve_ivp(
            lambda t, y, w=omega[k]: [y[1], -eta * w * y[1] - w**2 * y[0]],
            (0.0, dt),
            [course.q[k], course.rate[k]],
            rtol=1e-11,
            atol=1e-20,
        ).y[:, -1]
        size = math.hypot(course.q[k], course.rate[k] / omega[k])
        assert q[k] == pytest.approx(exact[0], abs=1e-7 * size)
        assert rate[k] == pytest.approx(exact[1], abs=1e-7 * size * omega[k])


def test_a_vibrating_rod_touches_where_its_lowest_place_meets_the_barrier():
    changes = FLOOR | {"impact.angle": "60 deg"}
    case = Case.of(replace_all(load("t4"), changes), "modal")
    course = ModalCourse.at_first(case, Followed.of(case))
    state = course._touch()
    dt = state.time - course.state.time
    assert course._gap(dt) == pytest.approx(0.0, abs=1e-10)
    # and not before: looked at ten times as closely
    look = np.arange(dt - 1e-4, dt - 1e-8, 2e-8)
    assert min(course._gap(float(t)) for t in look) > -1e-9


@pytest.mark.long
@pytest.mark.parametrize("effects", [["auto", "-vibration"], ["auto", "-friction"], ["auto", "-gravity"]])
def test_effects_that_are_left_out_leave_a_sequence(effects):
    s = simulate(replace_all(load("quick"), FLOOR | {"effects": effects}), "modal").strikes
    assert (len(s.each) > 1) == ("-gravity" not in effects)
    assert abs(s.residual) < 1e-10
    assert s.end == (
        "leaves" if "-gravity" in effects else "slides on" if "-friction" in effects else "rests"
    )


@pytest.mark.long
def test_a_low_rattle_down_a_slope_is_followed_at_once():
    """A rod that hardly leaves the barrier is not looked for over its whole flight."""
    changes = {
        "impact.until": "rest",
        "impact.slope": "60 deg",
        "impact.v_n": "-3 m/s",
        "impact.v_t": "0 m/s",
    }
    s = simulate(replace_all(load("quick"), changes), "modal").strikes
    assert s.end in ("slides on", "tumbles on")
