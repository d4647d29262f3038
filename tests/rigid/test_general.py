import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rigid import General, ImpactError, coefficients, critical_ratio, kinetic_energy, phi, solve, solve_free
from rigid.general import system

ROD = {"d_c": 0.0226, "d_d": 0.035, "k2": 5.56e-4}


@st.composite
def statements(draw):
    """A rod on a massive barrier with coefficients that lose energy."""
    d_c, d_d = draw(st.floats(-0.01, 0.05)), draw(st.floats(0.01, 0.06))
    body = {"d_c": d_c, "d_d": d_d, "k2": draw(st.floats(2e-4, 2e-3))}
    v_n, v_t, e = -draw(st.floats(0.2, 5.0)), -draw(st.floats(0.0, 5.0)), draw(st.floats(0.0, 1.0))
    limit = critical_ratio(v_n, v_t, e=e, **body)
    assume(limit > 0)
    mu = draw(st.floats(0.0, 1.0)) * min(limit, 1.5)
    assume(1 + phi(mu=mu, e_m=-1.0, **body) > 0.05)
    return v_n, v_t, {"e": e, "mu": mu, **body}


@given(statements(), st.floats(0.05, 5.0))
def test_the_general_system_reduces_to_the_massive_barrier(case, mass):
    v_n, v_t, case = case
    np.testing.assert_allclose(
        General(v_n, v_t, mass=mass, **case).solve(), solve(v_n, v_t, **case), rtol=1e-8, atol=1e-9
    )


@given(statements())
def test_a_barrier_of_great_mass_is_the_massive_barrier(case):
    v_n, v_t, case = case
    free = solve_free(v_n, v_t, mass_ratio=1e-9, **case)
    massive = solve(v_n, v_t, **case)
    scale = 1e-6 * (1 + np.abs(massive[2]))
    np.testing.assert_allclose(free[:3], massive, rtol=0, atol=scale)


@given(statements(), st.floats(0.0, 10.0), st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_a_free_barrier_conserves_momentum_and_keeps_the_restitution(case, ratio, v_bn, v_bt):
    v_n, v_t, case = case
    assume(v_n - v_bn < -0.05)
    after = solve_free(v_n, v_t, mass_ratio=ratio, v_bn=v_bn, v_bt=v_bt, **case)
    assert ratio * after.V_n + after.V_bn == pytest.approx(ratio * v_n + v_bn, rel=1e-9, abs=1e-9)
    assert ratio * after.V_t + after.V_bt == pytest.approx(ratio * v_t + v_bt, rel=1e-9, abs=1e-9)
    parting = after.V_n + case["d_c"] * after.Omega - after.V_bn
    assert parting == pytest.approx(-case["e"] * (v_n - v_bn), rel=1e-9, abs=1e-9)


def test_two_equal_masses_swap():
    after = solve_free(-1.0, 0.0, e=1.0, mu=0.0, d_c=0.0, d_d=0.04, k2=5e-4, mass_ratio=1.0)
    np.testing.assert_allclose(after, (0.0, 0.0, 0.0, -1.0, 0.0), atol=1e-15)


FULL = General(
    -1.5, -1.2, 8.0, e=0.4, mu=0.3, e_m=-0.9, mass=0.2, d_c=0.0226, d_d=0.035, k2=5.56e-4,
    D_c=0.0230, D_d=0.0345, J=1.1e-4, v_bn=0.3, P_1n=-0.004, P_1t=0.002, M_1=1e-5,
)  # fmt: skip


def test_the_solution_satisfies_equations_1_to_5_as_printed():
    """Each equation is written out here afresh from the paper."""
    s = FULL
    V_n, V_t, Omega = s.solve()
    I, m = s.mass * s.k2, s.mass
    gamma, delta = (s.d_c + s.e * s.D_c) / (1.4 * I), (s.d_d + s.e * s.D_d) / (1.4 * I)
    assert V_n + s.D_c * Omega - s.v_bn == pytest.approx(-s.e * (s.v_n + s.d_c * s.omega - s.v_bn))
    right = s.mu * s.v_n - s.v_t - (s.P_1t - s.mu * s.P_1n) / m
    assert s.mu * V_n - V_t == pytest.approx(right)
    left = s.e_m * m * gamma * V_n - s.e_m * m * delta * V_t + (1 - s.e_m * (s.J / I - 1)) * Omega
    inner = m * gamma * s.v_n - m * delta * s.v_t - s.omega + gamma * s.P_1n - delta * s.P_1t - s.M_1 / I
    assert left == pytest.approx(s.e_m * inner)


def test_angular_momentum_is_kept_when_the_contact_exerts_no_moment():
    """e_m = -1: J Omega - I omega is the moment of the impulse on the mean arms, plus M_1."""
    s = General(
        -1.5, -1.2, 8.0, e=0.4, mu=0.3, mass=0.2, J=1.1e-4, M_1=1e-5, D_c=0.0230, D_d=0.0345, **ROD
    )  # fmt: skip
    V_n, V_t, Omega = s.solve()
    arm_n, arm_t = (s.d_c + 0.4 * s.D_c) / 1.4, (s.d_d + 0.4 * s.D_d) / 1.4
    moment = s.mass * (arm_n * (V_n - s.v_n) - arm_t * (V_t - s.v_t)) + s.M_1
    assert s.J * Omega - s.mass * s.k2 * s.omega == pytest.approx(moment)


def test_table_1_as_printed_fails():
    """Its right-hand side is the negative of ours: the rod would go on into the barrier."""
    s = General(-1.5, -1.48, e=0.327, mu=0.584, mass=0.175, **ROD)
    A, b = system(s)
    printed = np.array([0.327 * -1.5, -0.584 * -1.5 + -1.48, 0.175 * printed_moment(s)])
    np.testing.assert_allclose(printed, -b)
    V_n, _, Omega = np.linalg.solve(A, printed)
    contact = V_n + s.d_c * Omega
    assert contact == pytest.approx(0.327 * -1.5)  # same sign as before: no rebound
    back = coefficients(s.v_n, s.v_t, *np.linalg.solve(A, printed), **ROD)
    assert abs(back.mu - 0.584) > 1 and abs(back.e_m + 1) > 0.5  # nor do Eq 2 and 3 hold
    right = s.solve()
    assert right.V_n + s.d_c * right.Omega == pytest.approx(0.327 * 1.5)


def printed_moment(s):
    """The bracket of b_34 without external terms, over the mass: Gamma v_n - Delta v_t."""
    return (s.d_c * s.v_n - s.d_d * s.v_t) / (s.mass * s.k2)


def test_restitution_above_one_with_a_positive_loss_is_legitimate():
    """Friction turns tangential energy into rebound (0.24 m rod, sharp corner, 28 degrees)."""
    a = np.radians(28.0)
    arms = {"d_c": 0.04795, "d_d": 0.11041, "k2": 4.8226e-3}
    v = -2 * np.cos(a), -2 * np.sin(a)
    after = General(*v, e=1.099, mu=0.387, mass=0.5, **arms).solve()
    assert kinetic_energy(*after, mass=1.0, k2=4.8226e-3) < 2.0


def test_external_impulse_and_moving_barrier_only_shift_the_frame():
    """Seen from a barrier moving at v_bn the impact is the same."""
    rod = {"e": 0.4, "mu": 0.3, "mass": 0.2, **ROD}
    still, moving = General(-1.5, -1.2, **rod).solve(), General(-1.2, -1.2, v_bn=0.3, **rod).solve()
    np.testing.assert_allclose(moving, np.add(still, (0.3, 0.0, 0.0)), rtol=1e-12)


def test_many_at_once():
    mu = np.linspace(0.0, 0.5, 6)
    together = General(-1.5, -1.48, e=0.3, mu=mu, mass=0.175, **ROD).solve()
    alone = [General(-1.5, -1.48, e=0.3, mu=m, mass=0.175, **ROD).solve() for m in mu]
    np.testing.assert_allclose(np.transpose(together), alone, rtol=1e-13)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"e": -0.1}, "through the barrier"),
        ({"v_bn": -2.0}, "approach"),
        ({"mass": 0.0}, "mass must be positive"),
        ({"J": -1e-4}, "inertia J"),
        ({"e": 1.3, "mu": 0.0}, "from nothing"),
        ({"e": 0.0, "mu": (5.56e-4 + 0.0226**2) / (0.0226 * 0.035)}, "singular"),
        ({"mu": 2.5}, "only push"),
    ],
)
def test_meaningless_statements_are_refused(change, words):
    statement = {"e": 0.3, "mu": 0.3, "mass": 0.175, **ROD, **change}
    with pytest.raises(ImpactError, match=words):
        General(-1.5, -1.48, **statement).solve()


def test_free_barrier_refusals():
    with pytest.raises(ImpactError, match="mass ratio"):
        solve_free(-1.0, 0.0, e=0.5, mu=0.1, mass_ratio=-1.0, **ROD)
    with pytest.raises(ImpactError, match="approach"):
        solve_free(-1.0, 0.0, e=0.5, mu=0.1, mass_ratio=0.1, v_bn=-2.0, **ROD)
    with pytest.raises(ImpactError, match="friction drives"):
        solve_free(-1.0, 0.0, e=0.5, mu=3.0, mass_ratio=0.1, **ROD)
