"""The end of a run: free flight, stop rule, step guard, the camera replayed, and the reduction."""

import re
from dataclasses import replace
from math import cos, pi, sin
from types import SimpleNamespace

import numpy as np
import pytest
import solid_scenes as scenes

import rigid
from fem_impact.case.case import Case
from fem_impact.errors import RunError
from fem_impact.fem.flight import RigidMotion
from fem_impact.fem.stable import SAFETY, gradient_squares
from fem_impact.outcome.keys import Unknown
from fem_impact.run.markers import WINDOW, lever_of, replay
from fem_impact.run.simulate import simulate
from fem_impact.run.solid import reduce
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import START_GAP, build
from fem_impact.solid.contact.book import StepRecord
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.run import solve
from fem_impact.solid.separation import Separation, flight_heights, flown
from fem_impact.solid.stepguard import StepGuard

TOUCH = StepRecord(1.0, 1.0, 1.0, 1.0, 1.0, active=1)
PLANE = ("vibration", "barrier-rigid", "large-rotation")
SHORT = {"length": 0.08, "v_n": -1.0, "v_t": -1.0}


@pytest.fixture(scope="module")
def result():
    return scenes.run("vibration", "friction", "barrier-rigid", "large-rotation", **SHORT)


def _moving(result, V_n=0.0, V_t=0.0, Omega=0.0, shake=0.0):
    motion = replace(result.motion, V_n=V_n, V_t=V_t, Omega=Omega)
    ahead = replace(result.flight, a=shake * result.flight.a, b=shake * result.flight.b)
    return replace(result, motion=motion, flight=ahead)


def test_heights_of_a_turning_body():
    motion = RigidMotion(1.0, 1.0, np.array([1.0, 0.0, 5.0]), V_n=2.0, V_t=9.0, Omega=0.5)
    x = np.array([[1.0, 0.0, 4.0], [3.0, 0.0, 5.0]])
    still = SimpleNamespace(displacement=lambda rows, t: np.zeros((len(rows), len(t))))
    t = np.array([0.0, 0.2])
    found = flight_heights(x, np.arange(2), motion, still, t)
    # n turns towards t: a point on the +t side goes down
    exact = [[4.0, 5 + 0.4 - cos(0.1)], [5.0, 5 + 0.4 - 2 * sin(0.1)]]
    assert found == pytest.approx(np.array(exact))
    shaken = SimpleNamespace(displacement=lambda rows, t: np.array([[7.0 + s for s in t]] * 2))
    assert flight_heights(x, np.arange(2), motion, shaken, t) - found == pytest.approx(np.tile(t, (2, 1)))


class Stop:
    """A stop rule over the model of a finished run, with a made-up state and flight."""

    def __init__(self, height, V_n, Omega=0.0, swing=0.0, touched=1e-4, time=1.5e-4):
        model = scenes.model(*PLANE, **SHORT)
        self.state = model.initial_state()
        tip = model.layout.rod[:, 2]
        self.state.x[tip] += height - self.state.x[tip].min()
        self.state.time = time
        if touched is not None:
            model.book.close_step(TOUCH, touched)
            model.book.step = StepRecord()
        places = model.layout.rod[~model.geometry.rod.mesh.is_hanging]
        low = model.layout.rod[np.argsort(model.geometry.rod_points[:, 2])[:20]]
        motion = RigidMotion(1.0, 1.0, self.state.x[places].mean(axis=0), V_n, 0.0, Omega)

        def displacement(rows, t):
            return np.tile(swing * (np.cos(2 * pi * 1e4 * t) - 1), (len(rows), 1))

        view = SimpleNamespace(
            rim=low, rigid=lambda s: motion, flight=lambda s, m: SimpleNamespace(displacement=displacement)
        )
        self.rule = Separation(model, view, limit=1e-3, horizon=4e-3)

    def over(self):
        return self.rule.observe(self.state)


def test_the_impact_is_over_when_the_rod_flies_off():
    stop = Stop(1e-5, V_n=0.5)
    assert stop.over() and stop.rule.finished
    assert "does not touch again" in stop.rule.reason


@pytest.mark.parametrize(
    "case",
    [
        {"height": 1e-5, "V_n": -0.01},  # comes back
        {"height": 1e-5, "V_n": 0.5, "swing": 0.1e-3},  # swings back: 50 us later it is 25 um up, 200 um down
        {"height": 1e-5, "V_n": 0.1, "Omega": 100.0, "swing": 0.0},  # turns its tip down
        {"height": -1e-6, "V_n": 0.5},  # still in the crater
        {"height": 1e-5, "V_n": 0.5, "touched": None},  # has not touched yet
        {"height": 1e-5, "V_n": 0.5, "touched": 1.49e-4},  # touched a microsecond ago
    ],
    ids=["falls", "swings", "turns", "crater", "early", "just now"],
)
def test_the_impact_is_not_over(case):
    if "Omega" in case:
        case = case | {"Omega": -100.0}
    stop = Stop(**case)
    assert not stop.over()
    assert not stop.rule.finished


def test_time_is_up():
    stop = Stop(1e-5, V_n=-1.0, time=1e-3)
    assert stop.over() and not stop.rule.finished
    assert "max_time = 1 ms" in stop.rule.reason


def test_step_follows_a_squeezed_element_and_folded_ones_stop_the_run():
    model = scenes.model("vibration", "rod-plasticity", "barrier-rigid", length=0.08)
    state, guard = model.initial_state(), StepGuard(model)
    assert guard.observe(state) is False
    assert state.dt_next == model.step
    element = guard.places[int(np.argmax(guard.square))]
    base = state.x[element].copy()
    middle = base.mean(axis=0)
    state.x[element] = middle + 0.5 * (base - middle)
    guard.observe(state)
    assert state.dt_next <= 0.51 * model.step
    assert guard.smallest == state.dt_next
    state.x[element] = base
    guard.observe(state)
    assert state.dt_next == model.step
    state.x[element] = middle - 0.1 * (base - middle)
    assert guard.observe(state) is True
    assert told(guard.reason, "An element folded", middle)
    state.x[element] = middle + 0.005 * (base - middle)
    assert guard.observe(state) is True
    assert told(guard.reason, "An element was crushed to under 0.02 of its step", middle)
    state.v[model.layout.rod[7, 0]] = np.nan
    with pytest.raises(RunError) as stop:
        guard.observe(state)
    assert told(str(stop.value), "The motion is not finite", model.start[0][model.layout.rod[7]])
    assert "What was computed before is kept." in str(stop.value)


def told(words, cause, place):
    """Say whether the words hold cause, time, step, place and remedy."""
    t, b, n = place * 1e3
    when = f"{cause} at 0.00 us, step 0, near t, b, n = {t:.2f}, {b:.2f}, {n:.2f} mm."
    return words.startswith(when) and words.endswith("Use a coarser accuracy.tip_size or a lower speed.")


@pytest.mark.long
def test_a_run_that_makes_energy_stops_and_keeps_its_answer():
    """At 1.1 times the stable step the highest mode of the rod grows: it is seen and stopped."""
    planned = Case.of(scenes.scene("vibration", "barrier-rigid", length=0.08))
    model = scenes.model("vibration", "barrier-rigid", length=0.08)
    result = solve(planned, model=replace(model, steps={"rod": 1.1 / SAFETY * model.step}))
    assert not result.finished
    assert result.steps < 400
    assert result.reason.startswith("The energy has grown by ")
    assert "the steps are too long" in result.reason
    assert reduce(result).validity.finished is False


def test_gradients_of_a_cube():
    corners = np.array(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float
    )
    places = np.arange(24).reshape(1, 8, 3)
    one, half = (gradient_squares(x.ravel(), places)[0] for x in (corners, corners / 2))
    assert half == pytest.approx(4 * one)
    g = 1 / np.sqrt(3)
    exact = 3 * sum((1 + s * g) ** 2 * (1 + t * g) ** 2 / 16 for s in (-1, 1) for t in (-1, 1)) * 2
    assert one == pytest.approx(exact)
    assert np.isnan(gradient_squares(corners.ravel(), places[:, [1, 0, 3, 2, 5, 4, 7, 6]]))[0]


# ---------------------------------------------------------------- leaving a crater


def _in_crater(V_n, V_t, swing=0.0, barrier="barrier-elastic"):
    """Rod 40 um deep in a dent of the barrier, 50 um deep and steep-walled, with a made-up flight."""
    model = scenes.model("vibration", "friction", barrier, length=0.08)
    state, contact = model.initial_state(), model.contact
    heights = contact.barrier.places[:, 2]
    radius = np.hypot(state.x[contact.barrier.places[:, 0]], state.x[contact.barrier.places[:, 1]])
    state.x[heights[radius < 2.2e-3]] -= 50e-6
    state.x[model.layout.rod[:, 2]] -= 40e-6 + START_GAP
    state.time = 1.5e-4
    model.book.close_step(TOUCH, 1e-4)
    model.book.step = StepRecord()
    motion = RigidMotion(1.0, 1.0, np.array([0.0, 0.0, 0.04]), V_n, V_t, 0.0)

    def displacement(rows, t):
        up = (rows % 3 == contact.rod.places[0, 2] % 3)[:, None]
        return np.where(up, swing * (np.cos(2 * pi * 1e4 * t) - 1), 0.0)

    ahead = SimpleNamespace(displacement=displacement)
    tip = contact.rod.places[np.argsort(state.x[contact.rod.places[:, 2]])[:20]]
    view = SimpleNamespace(rim=tip, rigid=lambda s: motion, flight=lambda s, m: ahead)
    return model, state, Separation(model, view, limit=1e-3, horizon=4e-3)


def test_clearance_is_the_height_between_the_surfaces():
    model, state, _ = _in_crater(0.5, 0.0)
    assert model.contact.clearance(state.x) == pytest.approx(10e-6, abs=1e-9)
    assert model.contact.clearance(model.start[0]) == pytest.approx(START_GAP, abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("barrier", ["barrier-elastic", "barrier-elastoplastic"])
@pytest.mark.parametrize(
    ("V_n", "V_t", "swing", "over"),
    [(0.5, 0.0, 0.0, True), (0.5, -60.0, 0.0, False), (0.5, 0.0, 50e-6, False), (-0.1, 0.0, 0.0, False)],
    ids=["rises", "runs into the rim", "swings down", "sinks"],
)
def test_a_rod_may_leave_its_crater_in_flight(V_n, V_t, swing, over, barrier):
    _, state, rule = _in_crater(V_n, V_t, swing, barrier)
    assert rule.observe(state) is over


def test_flown_nodes_are_at_the_heights_of_the_flight():
    _, state, rule = _in_crater(0.5, -2.0)
    motion = replace(rule.view.rigid(state), Omega=30.0)
    still = SimpleNamespace(displacement=lambda rows, t: np.full((len(rows), len(t)), 3e-6 * t[0]))
    x, tip, t = state.x, rule.view.rim, 1e-3
    moved = flown(x, tip, motion, still, t)
    heights = flight_heights(x[tip], tip[:, 2], motion, still, np.array([t]))[:, 0]
    assert moved[tip][:, 2] == pytest.approx(heights, abs=1e-8)
    arm = x[tip] - motion.centre
    assert moved[tip][:, 0] == pytest.approx(-2e-3 + cos(0.03) * arm[:, 0] + sin(0.03) * arm[:, 2], abs=1e-8)
    others = np.setdiff1d(np.arange(len(x)), tip)
    assert np.array_equal(moved[others], x[others])


@pytest.mark.long
@pytest.mark.parametrize("effects", [("vibration", "friction", "barrier-elastic"), ("barrier-rigid",)])
def test_a_tail_that_strikes_first_ends_the_run(effects):
    """At 89 degrees the other end comes down within a bending period; no contact of the model holds it."""
    flat = {"impact.angle": "89 deg", "impact.v_n": "-4 m/s", "accuracy.tip_size": "0.8 mm", "save.frames": 0}
    outcome = simulate(replace_all(load("quick"), {**flat, "effects": list(effects)}))
    assert outcome.validity.finished
    told = re.match(r"The rod's other end strikes ([\d.]+) ms later", outcome.validity.stopped_because)
    assert "strikes again" not in outcome.validity.stopped_because  # it is said once
    later = float(told[1]) * 1e-3
    alpha, rod = outcome.motion.alpha, load("quick").projectile
    high = (rod.length - 0.019 * 0.5 * (1 - sin(alpha))) * cos(alpha)  # of the tail above the tip, about
    speed = outcome.motion.V_n - outcome.motion.Omega * rod.length / 2 * sin(alpha)
    came = 0.5 * (4.0 - speed) * outcome.contact.intervals[0].end  # while the tip touched
    assert later == pytest.approx((high - came) / -speed, rel=0.3)


# ---------------------------------------------------------------- markers


def test_camera_reads_a_rigid_flight_exactly(result):
    alpha, arm = result.case.scene.impact.angle, lever_of(0.08)
    # the last two turn the rod by more than a quarter, and by more than a whole turn, in the window
    for V_n, V_t, Omega in ((0.4, -1.2, s) for s in (0.0, 12.0, -30.0, 500.0, -1700.0)):
        seen = replay(_moving(result, V_n, V_t, Omega), V_n, V_t)
        assert (seen.V_n, seen.V_t) == pytest.approx((V_n, V_t))
        assert seen.Omega == pytest.approx(Omega, rel=1e-9, abs=1e-12)
        turned = Omega * WINDOW
        down = -arm * (cos(alpha + turned) - cos(alpha)) / WINDOW
        across = -arm * (sin(alpha + turned) - sin(alpha)) / WINDOW
        assert (seen.V_cn, seen.V_ct) == pytest.approx((V_n + down, V_t + across))


def test_camera_reads_vibration_as_a_difference_over_its_window(result):
    still, shaken = (replay(_moving(result, 0.4, shake=s), 0.4, 0.0) for s in (0.0, 1.0))
    ahead, rim = result.flight, result.view.rim.ravel()
    most = (np.abs(ahead.modes.shape[rim]) @ np.hypot(ahead.a, ahead.b)).max()
    assert 0 < abs(shaken.V_cn - still.V_cn) < 2 * most / WINDOW


def test_levers():
    assert lever_of(0.24) == 0.12
    assert (lever_of(0.12), lever_of(0.08)) == (0.052, 0.032)
    assert lever_of(0.1) == pytest.approx(0.042)


# ---------------------------------------------------------------- reduction


@pytest.fixture(scope="module")
def measured(result):
    """The run as if it repeated a measured set, so that all three sets of arms are filled."""
    return reduce(replace(result, case=Case.of(replace(result.case.scene, measured="t5b"))))


@pytest.mark.parametrize("arms", ["paper", "edge", "impulse"])
def test_closure_with_every_set_of_arms(measured, result, arms):
    """E_ln + E_lt + E_r - E_0 = (I Omega^2 / 2)(1 + 1/e_m)."""
    assert _closure_defect(measured, result.motion.inertia, arms) == pytest.approx(0, abs=1e-7)
    assert getattr(measured.restitution, arms).d_c > 0.02


def _closure_defect(o, inertia, arms):
    found = getattr(o.restitution, arms)
    turning = 0.5 * inertia * o.motion.Omega**2 * (1 + 1 / found.e_m) / o.energy.E_0
    return found.E_ln + found.E_lt + o.energy.rigid - 1 - turning


def test_closure_with_gravity():
    """E_r must belong to the velocities of the record, from which gravity's share is taken out."""
    run = scenes.run("vibration", "friction", "barrier-rigid", "large-rotation", "gravity", **SHORT)
    assert _closure_defect(reduce(run), run.motion.inertia, "edge") == pytest.approx(0, abs=1e-6)


def test_restitution_of_moment_is_minus_one_at_the_centre_of_impulse(measured):
    assert measured.restitution.impulse.e_m == pytest.approx(-1.0, abs=1e-9)
    assert measured.restitution.edge.e_m != pytest.approx(-1.0, abs=1e-9)


def test_coefficients_are_those_of_the_velocities(measured, result):
    m, impact = result.motion, result.case.scene.impact
    d_c = measured.restitution.edge.d_c
    assert measured.restitution.edge.e == pytest.approx(-(m.V_n + d_c * m.Omega) / impact.v_n)
    assert measured.restitution.mu == pytest.approx((m.V_t - impact.v_t) / (m.V_n - impact.v_n))
    book = result.model.book.impulse
    assert measured.restitution.mu == pytest.approx(book[0] / book[1], rel=1e-6)
    assert measured.energy.rigid == pytest.approx(m.kinetic / result.E_0)


def test_sign_of_omega_follows_the_impulse(result):
    """A frictionless push up under the mass centre's down-slope side turns n towards t."""
    free = scenes.run(*PLANE, **SHORT)
    d_c, d_d = (float(d) for d in rigid.Projectile(0.08, 0.019, "B", 0.003, 7850.0).arms(pi / 4))
    impulse = free.model.book.impulse[1] * 2
    assert free.motion.Omega == pytest.approx(impulse * d_c / free.motion.inertia, rel=0.02)
    p_t, p_n, _ = 2 * result.model.book.impulse
    assert result.motion.Omega == pytest.approx((p_n * d_c - p_t * d_d) / result.motion.inertia, rel=0.05)


def test_gravity_is_taken_out(result):
    scene = replace(result.case.scene, effects=(*result.case.scene.effects, "gravity"))
    with_fall = reduce(replace(result, case=Case.of(scene)))
    without = reduce(result)
    later = result.time - result.model.book.table[-1, 1]  # across the barrier a contact bears it
    fell_n, fell_t = 9.80665 * later * cos(pi / 4), 9.80665 * result.time * sin(pi / 4)
    assert with_fall.motion.V_n - without.motion.V_n == pytest.approx(fell_n, rel=1e-4)
    assert with_fall.motion.V_t - without.motion.V_t == pytest.approx(fell_t, rel=1e-4)


def test_unmeasured_scenes_say_why_they_have_no_paper_arms(result):
    found = reduce(result)
    assert isinstance(found.restitution.paper.e, Unknown)
    assert "no measured set" in found.restitution.paper.e.reason
    assert found.validity.mesh_band.reason


def test_an_open_ledger_fails_the_run(result):
    spoiled = reduce(replace(result, worst=2e-4 * result.E_0))
    assert spoiled.validity.finished is False
    assert "ledger misses 2.00e-04" in spoiled.validity.stopped_because
    assert spoiled.validity.stopped_because.endswith("do not use this run. Give half the accuracy.step.")
    assert spoiled.energy.vibration_floor == pytest.approx(2e-4)
    assert reduce(replace(result, worst=0.9e-4 * result.E_0)).validity.finished is True


def test_vibration_below_the_floor_is_marked(result):
    share = result.flight.energy
    assert reduce(replace(result, worst=1.01 * share)).energy.below_floor is True
    assert reduce(replace(result, worst=0.99 * share)).energy.below_floor is False


def test_a_step_changes_momentum_by_the_contact_impulse_alone():
    model = scenes.model("vibration", "friction", "barrier-rigid", **SHORT)
    state, n = model.initial_state(), model.layout.rod_size
    places = model.layout.rod[~model.geometry.rod.mesh.is_hanging]
    while not model.book.intervals:
        evaluate(model, state)
        advance(model, state)
    for _ in range(50):
        evaluate(model, state)
        before = (model.mass[:n] * state.v[:n])[places].sum(axis=0)
        book = model.book.impulse.copy()
        advance(model, state)
        after = (model.mass[:n] * state.v[:n])[places].sum(axis=0)
        assert (after - before)[[0, 2]] == pytest.approx((model.book.impulse - book)[:2], rel=1e-6, abs=1e-12)


def test_a_run_that_ends_before_it_touches_has_no_outcome():
    planned = Case.of(scenes.scene(*PLANE, length=0.08, max_time=1e-6, v_n=-0.1))
    result = solve(planned, model=build(planned, gap=1e-4))
    assert result.model.book.intervals == []
    with pytest.raises(RunError, match=r"There was no contact in .* us, 100 steps. Reached max_time"):
        reduce(result)
