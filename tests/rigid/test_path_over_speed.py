"""Friction over sliding speed in rigid theory: constant friction, a closed form, and the energy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid import path_over_speed, sliding_path

ROD = {"d_c": 0.02, "d_d": 0.035, "k2": 5.6e-4}
speeds = st.floats(0.3, 5.0)


@given(speeds, st.floats(-4.0, 4.0), st.floats(0.0, 1.0), st.floats(0.0, 1.2), st.floats(-0.03, 0.03))
def test_one_friction_at_all_speeds_gives_the_closed_path(fall, v_t, e, f, d_c):
    case = {**ROD, "d_c": d_c, "e": e, "f": f}
    closed = sliding_path(-fall, v_t, **case)
    stepped = path_over_speed(-fall, v_t, over=((0.0, 1.0), (1.0, 1.0)), **case)
    np.testing.assert_allclose(stepped.motion, closed.motion, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(sum(stepped.tangential_work), sum(closed.tangential_work), atol=1e-8)


@given(speeds, st.floats(-4.0, 4.0), st.floats(0.0, 1.0), st.floats(0.0, 1.2))
def test_works_are_the_change_of_the_energy(fall, v_t, e, f):
    path = path_over_speed(-fall, v_t, e=e, f=f, over=((0.0, 1.0, 3.0), (1.0, 0.4, 0.7)), **ROD)
    V_n, V_t, Omega = path.motion
    lost = 0.5 * (fall**2 + v_t**2 - V_n**2 - V_t**2 - ROD["k2"] * Omega**2)
    assert path.loss == pytest.approx(lost, abs=1e-12 * (fall**2 + v_t**2))  # what sums of squares round off
    assert sum(path.tangential_work) <= 1e-15


def test_linear_friction_on_a_central_blow_decays_by_an_exponential():
    """Without an arm d_c the normal motion is free of friction: dw/dp = f (1 + d_d^2/k^2) (1 - w/c)."""
    w, f, c, e = 3.0, 0.1, 8.0, 0.5
    path = path_over_speed(-1.0, w, e=e, f=f, over=((0.0, c), (1.0, 0.0)), **{**ROD, "d_c": 0.0})
    grows = 1 + ROD["d_d"] ** 2 / ROD["k2"]
    exact = c + (w - c) * np.exp(grows * f * (1 + e) / c)
    assert path.motion.V_t - ROD["d_d"] * path.motion.Omega == pytest.approx(exact, rel=1e-7)


ONE = ((0.0, 1.0), (1.0, 1.0))


def assert_same_path(v_n, v_t, **case):
    closed, stepped = sliding_path(v_n, v_t, **case), path_over_speed(v_n, v_t, over=ONE, **case)
    swings = np.array([1.0, 1.0, np.sqrt(case["k2"])])
    np.testing.assert_allclose(swings * stepped.motion, swings * closed.motion, rtol=1e-9, atol=1e-9)
    assert stepped.end == closed.end
    assert float(stepped.mu) == pytest.approx(float(closed.mu), abs=1e-9)
    assert float(stepped.e_energetic) == pytest.approx(float(closed.e_energetic), abs=1e-9)
    assert stepped.loss == pytest.approx(closed.loss, rel=1e-9)


@pytest.mark.parametrize(
    ("v_n", "v_t", "case"),
    [
        (-4.1336, 0.0, {"e": 0.0, "f": 1.93, "d_c": 0.0487, "d_d": 0.0792, "k2": 3.28e-5}),
        (-1.0, -1.0, {"e": 0.5, "f": 2.0, "d_c": -0.02, "d_d": -0.035, "k2": 1e-12}),
        (-1e-4, -5.0, {"e": 0.5, "f": 1.5, **ROD}),
    ],
    ids=["from the first touch", "after a slide", "after a fast slide that drives it in"],
)
def test_what_sticks_far_out_on_its_arms_sticks_to_the_end(v_n, v_t, case):
    assert_same_path(v_n, v_t, **case)


@pytest.mark.parametrize("seed", range(4))
def test_one_friction_at_all_speeds_gives_the_closed_path_of_any_body(seed):
    """Arms within the radius of gyration and far beyond it, with spin, from no rebound to a full one."""
    rng, met = np.random.default_rng(seed), 0
    while met < 60:
        arms = {"d_c": 0.05 * rng.normal(), "d_d": rng.uniform(1e-3, 0.1), "k2": 10 ** rng.uniform(-5, -2.3)}
        v_n, v_t = -rng.uniform(0.1, 5.0), 3.0 * rng.normal() * (rng.random() > 0.2)
        omega = 30.0 * rng.normal() * (rng.random() > 0.5)
        e, f = rng.choice([0.0, rng.random(), 1.0]), rng.choice([0.0, 2.0 * rng.random()])
        if v_n + arms["d_c"] * omega < -0.05:
            assert_same_path(v_n, v_t, e=e, f=f, omega=omega, **arms)
            met += 1
