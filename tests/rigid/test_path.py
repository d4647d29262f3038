import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rigid import (
    End,
    ImpactError,
    coefficients,
    corner_arms,
    critical_ratio,
    interval_ratio,
    kinetic_energy,
    losses,
    painleve_threshold,
    sliding_path,
    solve,
)

ROD = {"d_c": 0.0226, "d_d": 0.035, "k2": 5.56e-4}
LONG_K2 = 0.24**2 / 12 + 0.019**2 / 16


def long_rod(degrees):
    """Arms of the sharp corner of the 0.24 m rod."""
    return {**corner_arms(0.24, 0.019, np.radians(degrees))._asdict(), "k2": LONG_K2}


@st.composite
def paths(draw, f=(0.0, 4.0)):
    """Any plane rigid body, spinning or not, sliding either way."""
    body = {
        "d_c": draw(st.floats(-0.1, 0.1)),
        "d_d": draw(st.floats(0.005, 0.12)),
        "k2": draw(st.floats(2e-4, 5e-3)),
    }
    v_t, omega = draw(st.floats(-4.0, 4.0)), draw(st.floats(-20.0, 20.0))
    v_n = -draw(st.floats(0.2, 5.0)) - max(0.0, body["d_c"] * omega)
    return v_n, v_t, {"omega": omega, "e": draw(st.floats(0.0, 1.0)), "f": draw(st.floats(*f)), **body}


def stepped(v_n, v_t, *, e, f, d_c, d_d, k2, omega=0.0, steps=40_000):
    """The same physics by brute force: march the normal impulse in small steps (energetic restitution)."""
    u, w = v_n + d_c * omega, v_t - d_d * omega
    nn, nt, tt = 1 + d_c**2 / k2, -d_c * d_d / k2, 1 + d_d**2 / k2
    dp = 4 * abs(u) / (nn - nt**2 / tt) / steps
    p = q = stored = given_back = 0.0
    while u < 0 or given_back < e**2 * stored:
        s = float(np.clip((-w / dp - nt) / tt, -f, f))  # the ratio that would stop it, if friction can
        new_u, new_w = u + (nn + nt * s) * dp, w + (nt + tt * s) * dp
        work = 0.5 * (u + new_u) * dp
        stored, given_back = (stored - work, 0.0) if new_u < 0 else (stored, given_back + work)
        u, w, p, q = new_u, new_w, p + dp, q + s * dp
    return v_n + p, v_t + q, omega + (d_c * p - d_d * q) / k2


@pytest.mark.long
@pytest.mark.parametrize("omega", [0.0, 12.0])
@pytest.mark.parametrize("f", [0.1, 0.57, 3.0])
@pytest.mark.parametrize("d_c", [0.03, 0.0226, 0.004, -0.02])
def test_closed_form_against_brute_force(d_c, f, omega):
    case = {"e": 0.6, "f": f, "omega": omega, **ROD, "d_c": d_c}
    found = sliding_path(-1.6, -1.1, **case).motion
    slow = stepped(-1.6, -1.1, **case)
    np.testing.assert_allclose(found[:2], slow[:2], atol=2e-3)
    np.testing.assert_allclose(found.Omega, slow[2], atol=0.08)


@given(paths())
def test_friction_takes_and_energy_never_grows(case):
    v_n, v_t, case = case
    path = sliding_path(v_n, v_t, **case)
    before = kinetic_energy(v_n, v_t, case["omega"], mass=1.0, k2=case["k2"])
    after = kinetic_energy(*path.motion, mass=1.0, k2=case["k2"])
    assert all(work <= 1e-12 * before for work in path.tangential_work)
    assert path.loss >= -1e-9 * before
    assert before - after == pytest.approx(path.loss, rel=1e-7, abs=1e-9 * before)


@given(paths(f=(0.0, 1.0)))
def test_the_path_is_the_algebraic_solution_while_sliding_never_stops(case):
    v_n, v_t, case = case
    path = sliding_path(v_n, v_t, **case)
    assume(path.end == End.SLIP and path.p_s > 0)
    mu = -case["f"] * np.sign(v_t - case["d_d"] * case["omega"])
    body = {k: case[k] for k in ("omega", "d_c", "d_d", "k2")}
    same = solve(v_n, v_t, e=path.e, mu=mu, **body)
    np.testing.assert_allclose(path.motion, same, rtol=1e-7, atol=1e-7)
    assert path.mu == pytest.approx(mu, abs=1e-12)


@given(paths())
def test_equation_22_gives_the_ratio_of_the_whole_and_of_each_part(case):
    v_n, v_t, case = case
    path = sliding_path(v_n, v_t, **case)
    d_c, d_d, k2, omega = (case[k] for k in ("d_c", "d_d", "k2", "omega"))
    V_n, V_t, Omega = path.motion
    changes = V_n + d_c * Omega - v_n - d_c * omega, V_t - d_d * Omega - v_t + d_d * omega
    assert interval_ratio(*changes, d_c=d_c, d_d=d_d, k2=k2) == pytest.approx(path.mu, rel=1e-6, abs=1e-7)


@given(paths())
def test_restitutions_of_the_outcome_reproduce_it(case):
    v_n, v_t, case = case
    path = sliding_path(v_n, v_t, **case)
    assert path.e_energetic == pytest.approx(case["e"], abs=1e-6)
    rest = {k: v for k, v in case.items() if k != "e"}
    for law, e in (("kinematic", path.e), ("kinetic", path.e_kinetic)):
        again = sliding_path(v_n, v_t, e=np.maximum(e, 0.0), law=law, **rest)
        np.testing.assert_allclose(again.p_f, path.p_f, rtol=1e-7)


@given(paths())
def test_mirror(case):
    v_n, v_t, case = case
    here = sliding_path(v_n, v_t, **case)
    there = sliding_path(v_n, -v_t, **{**case, "omega": -case["omega"], "d_c": -case["d_c"]})
    V_n, V_t, Omega = there.motion
    np.testing.assert_allclose((V_n, -V_t, -Omega), here.motion, rtol=1e-9, atol=1e-9)
    assert here.end == there.end


@given(paths(), st.floats(0.1, 10.0))
def test_velocities_scale(case, factor):
    v_n, v_t, case = case
    here = sliding_path(v_n, v_t, **case)
    there = sliding_path(factor * v_n, factor * v_t, **{**case, "omega": factor * case["omega"]})
    np.testing.assert_allclose(there.motion, np.multiply(here.motion, factor), rtol=1e-7, atol=1e-7)
    assert there.loss == pytest.approx(factor**2 * here.loss, rel=1e-6, abs=1e-7)


def test_kinematic_and_kinetic_agree_while_sliding_goes_one_way():
    for law in ("kinematic", "kinetic", "energetic"):
        path = sliding_path(-1.5, -1.5, e=0.4, f=0.3, law=law, **ROD)
        np.testing.assert_allclose((path.e, path.e_kinetic, path.e_energetic), 0.4, rtol=1e-12)
        assert path.end == End.SLIP and path.mu == pytest.approx(0.3)


def test_long_rod_at_28_degrees():
    """Reference figures of an independent calculation; f of 1.4 and 3 lie above the Painleve threshold."""
    a = np.radians(28.0)
    path = sliding_path(-2 * np.cos(a), -2 * np.sin(a), e=1.0, f=[0.5, 1.4, 3.0], **long_rod(28.0))
    np.testing.assert_allclose(path.e, [1.099, 1.154, 1.161], atol=6e-4)
    np.testing.assert_allclose(path.mu, [0.387, 0.385, 0.385], atol=6e-4)
    np.testing.assert_allclose(path.loss / 2.0, [0.165, 0.080, 0.070], atol=6e-4)
    assert painleve_threshold(**long_rod(28.0)) < 1.4


def test_lowest_painleve_threshold():
    degrees = np.linspace(20.0, 45.0, 2501)
    threshold = painleve_threshold(**long_rod(degrees))
    assert threshold.min() == pytest.approx(1.332, abs=5e-4)
    assert degrees[threshold.argmin()] == pytest.approx(31.1, abs=0.05)
    assert painleve_threshold(**{**ROD, "d_c": -0.01}) == np.inf


def test_above_the_threshold_the_point_is_pressed_in_before_it_is_thrown_out():
    rod = long_rod(31.1)
    path = sliding_path(-1.7, -1.0, e=0.5, f=2.0, **rod)
    assert path.end == End.STICK and path.p_s < path.p_c
    assert path.normal_work[0] < 0 and path.motion.V_n + rod["d_c"] * path.motion.Omega > 0
    pressed = path.p_s * (1 + rod["d_c"] ** 2 / LONG_K2 - 2.0 * rod["d_c"] * rod["d_d"] / LONG_K2)
    assert pressed < 0


def test_stick_slip_and_reversal():
    """With d_c > 0 a stopped tip sticks; with d_c < 0 and little friction it slides back."""
    assert sliding_path(-2.0, -0.6, e=0.5, f=0.6, d_c=0.005, d_d=0.04, k2=5.56e-4).end == End.STICK
    back = sliding_path(-2.0, -0.05, e=0.5, f=0.1, d_c=-0.02, d_d=0.035, k2=5.56e-4)
    assert back.end == End.REVERSE
    assert back.motion.V_t - 0.035 * back.motion.Omega > 0
    assert abs(back.mu) < 0.1 and back.tangential_work[1] < 0


def test_a_tip_that_friction_holds_does_no_work_to_the_last_bit():
    rng = np.random.default_rng(2)
    d_c, d_d = rng.uniform(0.001, 0.1, 2000), rng.uniform(0.005, 0.12, 2000)
    path = sliding_path(-2.0, -0.01, e=0.5, f=3.0, d_c=d_c, d_d=d_d, k2=1e-3)
    assert set(path.end.tolist()) == {int(End.STICK)}
    assert not path.tangential_work[1].any()


def test_the_ratio_of_a_sticking_tip_is_the_critical_one():
    """If sliding ends just at separation the path gives Eq 11's ratio; sticking leaves v_ct at zero."""
    limit = critical_ratio(-1.5, -1.5, e=0.4, **ROD)
    just = sliding_path(-1.5, -1.5, e=0.4, f=limit, law="kinematic", **ROD)
    assert just.motion.V_t - 0.035 * just.motion.Omega == pytest.approx(0.0, abs=1e-12)
    held = sliding_path(-1.5, -1.5, e=0.4, f=2 * limit, law="kinematic", **ROD)
    assert held.mu == pytest.approx(limit, rel=1e-9) and held.end == End.STICK


def test_works_by_part_are_the_losses_of_equations_20_and_21():
    """While nothing stops; afterwards Eq 21 no longer holds part by part, but the total does."""
    one = sliding_path(-1.5, -1.5, e=0.4, f=0.3, **ROD)
    paper = losses(-1.5, -1.5, *one.motion, **ROD, mass=1.0)
    np.testing.assert_allclose((-one.normal_work[0], -one.tangential_work[0]), paper[:2], rtol=1e-12)
    stopped = sliding_path(-2.1, -0.63, e=0.5, f=0.57, d_c=0.0046, d_d=0.0403, k2=5.56e-4)
    paper = losses(-2.1, -0.63, *stopped.motion, d_c=0.0046, d_d=0.0403, k2=5.56e-4, mass=1.0)
    assert stopped.loss == pytest.approx(paper.E_ln + paper.E_lt, rel=1e-12)
    assert coefficients(
        -2.1, -0.63, *stopped.motion, d_c=0.0046, d_d=0.0403, k2=5.56e-4
    ).e_m == pytest.approx(-1)


def test_a_frictionless_tip_that_does_not_slide_at_first():
    path = sliding_path(-1.0, 0.0, e=1.0, f=0.0, **ROD)
    assert path.mu == 0 and path.loss == pytest.approx(0.0, abs=1e-14) and path.end == End.SLIP


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"e": -0.1}, "restitution must not be negative"),
        ({"f": -0.1}, "friction must not be negative"),
        ({"law": "newton"}, "kinematic, kinetic, energetic"),
        ({"omega": 100.0}, "approach"),
        ({"e": 1.2}, "energy from nothing"),
    ],
)
def test_meaningless_paths_are_refused(change, words):
    with pytest.raises(ImpactError, match=words):
        sliding_path(-1.5, -1.5, **{"e": 0.5, "f": 0.4, **ROD, **change})
