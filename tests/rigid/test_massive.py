import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid import (
    ImpactError,
    coefficients,
    critical_ratio,
    drop_velocities,
    losses,
    phi,
    predicted_losses,
    solve,
)


@st.composite
def impacts(draw, e_m=(-1.0, -1.0)):
    """A rod of any size at any angle, dropped without spin, away from dynamic jam."""
    length, slim, a = draw(st.floats(0.03, 0.5)), draw(st.floats(2.0, 20.0)), draw(st.floats(0.1, 1.4))
    half, r = length / 2, length / slim / 2
    body = {
        "d_c": half * np.sin(a) - r * np.cos(a),
        "d_d": half * np.cos(a) + r * np.sin(a),
        "k2": length**2 / 12 + r**2 / 4,
    }
    speed = draw(st.floats(0.1, 10.0))
    found = {"e": draw(st.floats(0.0, 1.0)), "mu": draw(st.floats(0.0, 1.2)), "e_m": draw(st.floats(*e_m))}
    return -speed * np.cos(a), -speed * np.sin(a), body, found


def regular(body, found):
    return 1 + phi(mu=found["mu"], e_m=found["e_m"], **body) > 0.05


@given(impacts(e_m=(-1.5, -0.1)))
def test_coefficients_invert_the_solution(case):
    v_n, v_t, body, found = case
    if regular(body, found):
        after = solve(v_n, v_t, **found, **body)
        moment = body["d_c"] * (after.V_n - v_n) - body["d_d"] * (after.V_t - v_t)
        back = coefficients(v_n, v_t, *after, **body)
        assert back.e == pytest.approx(found["e"], abs=1e-10)
        assert back.mu == pytest.approx(found["mu"], abs=1e-10)
        if abs(moment) > 1e-4 * body["d_c"] * (after.V_n - v_n):
            assert back.e_m == pytest.approx(found["e_m"], rel=1e-8)


@given(impacts(e_m=(-1.5, -0.1)))
def test_published_closed_forms_are_the_work_of_the_impulses(case):
    v_n, v_t, body, found = case
    if regular(body, found):
        after = solve(v_n, v_t, **found, **body)
        worked = losses(v_n, v_t, *after, **body, mass=0.3)
        closed = predicted_losses(v_n, v_t, **found, **body, mass=0.3)
        np.testing.assert_allclose(closed, worked[:2], rtol=1e-9, atol=1e-9 * worked.E_0)


@given(impacts())
def test_losses_are_never_negative_while_sliding_goes_one_way(case):
    v_n, v_t, body, found = case
    limit = critical_ratio(v_n, v_t, e=found["e"], **body)
    if regular(body, found) and found["mu"] <= limit:
        lost = predicted_losses(v_n, v_t, **found, **body, mass=1.0)
        assert lost.E_ln >= 0 and lost.E_lt >= -1e-12 * (v_n**2 + v_t**2)


@given(impacts())
def test_mirror_symmetry(case):
    v_n, v_t, body, found = case
    if regular(body, found):
        here = solve(v_n, v_t, **found, **body)
        there = solve(v_n, -v_t, **{**found, "mu": -found["mu"]}, **{**body, "d_c": -body["d_c"]})
        np.testing.assert_allclose(there, (here.V_n, -here.V_t, -here.Omega), rtol=1e-12, atol=1e-12)


@given(impacts(), st.floats(0.1, 10.0), st.floats(0.1, 10.0))
def test_losses_scale_with_mass_and_speed_squared(case, mass, factor):
    v_n, v_t, body, found = case
    if regular(body, found):
        base = predicted_losses(v_n, v_t, **found, **body, mass=1.0)
        more = predicted_losses(factor * v_n, factor * v_t, **found, **body, mass=mass)
        np.testing.assert_allclose(more, np.multiply(base, mass * factor**2), rtol=1e-9, atol=1e-12)


@given(impacts())
def test_contact_point_stands_still_at_the_critical_ratio(case):
    v_n, v_t, body, found = case
    found["mu"] = critical_ratio(v_n, v_t, e=found["e"], **body)
    if regular(body, found):
        after = solve(v_n, v_t, **found, **body)
        assert after.V_t - body["d_d"] * after.Omega == pytest.approx(0.0, abs=1e-9 * (abs(v_n) + abs(v_t)))


@given(impacts(e_m=(-1.5, -0.1)), st.floats(-0.9, 0.9))
def test_a_spin_before_the_impact_moves_the_critical_ratio(case, share):
    """``share`` of the approach that the spin makes up for at the contact point."""
    v_n, v_t, body, found = case
    if abs(body["d_c"]) > 1e-3:
        omega = -share * v_n / body["d_c"]
        found["mu"] = critical_ratio(v_n, v_t, e=found["e"], e_m=found["e_m"], omega=omega, **body)
        if regular(body, found):
            after = solve(v_n, v_t, **found, omega=omega, **body)
            slip = after.V_t - body["d_d"] * after.Omega
            size = abs(v_n) + abs(v_t) + body["d_d"] * abs(omega)
            assert slip == pytest.approx(0.0, abs=1e-7 * size)


def test_equations_9_10_and_12_by_hand():
    """Central strike: no arm across the normal, so the impulse is -(1 + e) v_n whatever the friction."""
    after = solve(-2.0, -1.0, e=0.5, mu=0.2, d_c=0.0, d_d=0.04, k2=5e-4)
    np.testing.assert_allclose(after, (1.0, -0.4, 0.04 * -0.2 * 3.0 / 5e-4), rtol=1e-14)


def test_spin_is_positive_from_the_normal_towards_the_slope():
    """A frictionless push left of the mass centre (d_c > 0) turns n towards t."""
    assert solve(-1.0, 0.0, e=1.0, mu=0.0, d_c=0.02, d_d=0.03, k2=5e-4).Omega > 0
    assert solve(-1.0, 0.0, e=1.0, mu=0.5, d_c=0.0, d_d=0.03, k2=5e-4).Omega < 0


def test_elastic_strike_of_a_spinning_rod_keeps_its_energy():
    """An e of 1 without friction loses nothing, spin or no spin."""
    body = {"d_c": 0.02, "d_d": 0.03, "k2": 5e-4}
    after = solve(-1.0, -0.7, e=1.0, mu=0.0, omega=9.0, **body)
    kept = losses(-1.0, -0.7, *after, **body, mass=0.2, omega=9.0)
    assert kept.E_r == pytest.approx(kept.E_0, rel=1e-13)
    back = coefficients(-1.0, -0.7, *after, **body, omega=9.0)
    np.testing.assert_allclose(back, (1.0, 0.0, -1.0), atol=1e-12)


def test_critical_ratio_of_the_short_rod():
    """Figure 5 of the paper, with the rounded-edge arms (values from an independent calculation)."""
    a, r = np.radians([17.0, 25.0, 37.0, 45.0, 60.0]), 0.003
    d_c, d_d = 0.037 * np.sin(a) - 0.0065 * np.cos(a), 0.037 * np.cos(a) + 0.0065 * np.sin(a) + r
    v_n = [-2.131, -2.027, -1.750, -1.502, -1.198]
    v_t = [-0.628, -0.915, -1.312, -1.482, -1.994]
    e = [0.527, 0.466, 0.343, 0.327, 0.373]
    found = critical_ratio(v_n, v_t, e=e, d_c=d_c, d_d=d_d, k2=5.56e-4)
    np.testing.assert_allclose(found, [0.134, 0.263, 0.491, 0.665, 1.10], rtol=0.006)


def test_loss_rises_with_the_impulse_ratio_as_published():
    """From about a half to above nine tenths of E_0 as mu goes from .32 to .72 (Table 3's rod)."""
    arms = {"d_c": 0.083, "d_d": 0.086, "k2": 4.84e-3, "mass": 1.0}
    low = predicted_losses(-1.6, -1.6, e=0.669, mu=0.32, **arms)
    high = predicted_losses(-1.6, -1.6, e=0.556, mu=0.724, **arms)
    assert sum(low) / 2.56 == pytest.approx(0.5, abs=0.02)
    assert sum(high) / 2.56 > 0.9


def test_arrays_broadcast():
    shape = solve(np.full((3, 1), -1.0), -1.0, e=0.5, mu=np.linspace(0, 0.5, 4), d_c=0.02, d_d=0.03, k2=5e-4)
    assert all(v.shape == (3, 4) and v.dtype == np.float64 for v in shape)


def test_drop_velocities():
    v_n, v_t = drop_velocities([0.82, 0.0], np.radians(30.0))
    assert v_n[0] ** 2 + v_t[0] ** 2 == pytest.approx(2 * 9.80665 * 0.82)
    assert v_t[0] / v_n[0] == pytest.approx(np.tan(np.radians(30.0))) and v_n[0] < 0 and v_n[1] == 0


ARMS = {"d_c": 0.0226, "d_d": 0.035, "k2": 5.56e-4}


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: solve([-1.0, 0.5], -1.0, e=0.5, mu=0.3, **ARMS), r"approach.*0\.5 m/s \(impact 1\)"),
        (lambda: solve(float("nan"), -1.0, e=0.5, mu=0.3, **ARMS), "approach"),
        (lambda: solve(-1.0, -1.0, e=0.5, mu=1.5, **ARMS), "friction drives the rod"),
        (lambda: critical_ratio(1.0, -1.0, e=0.5, **ARMS), "approach"),
        (lambda: coefficients(1.0, -1.0, 2.0, 0.0, 0.0, **ARMS), "approach"),
        (lambda: coefficients(-1.0, -1.0, -1.5, -1.0, 0.0, **ARMS), "only push"),
        (lambda: drop_velocities(-0.1, 0.5), "height"),
    ],
)
def test_impossible_impacts_are_refused_in_physical_words(call, words):
    with pytest.raises(ImpactError, match=words):
        call()
