"""Friction over sliding speed in rigid theory: constant friction, a closed form, and the energy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid import ImpactError, path_over_speed, sliding_path

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


def test_sliding_that_never_stops_is_refused():
    with pytest.raises(ImpactError, match="without end"):
        path_over_speed(
            -1.0, -1.0, e=0.5, f=2.0, over=((0.0, 1.0), (1.0, 1.0)), d_c=-0.02, d_d=-0.035, k2=1e-12
        )
