import tracemalloc

import numpy as np
import pytest
from scipy.special import stdtrit

from rigid import DataError, Errors, bootstrap, closure_defect, coefficients, first_order, losses
from rigid.experiments import measured_set, measured_sets
from rigid.uncertainty import sensitivities

MEASURED = [s.id for s in measured_sets() if not s.reconstructed]


def body(s):
    return {"d_c": s.arms.d_c, "d_d": s.arms.d_d, "k2": s.k2}


def test_sensitivities_against_the_derivatives_of_eq_16():
    at = {k: np.array(v) for k, v in {"v_n": -2.0, "V_n": 0.3, "Omega": 9.0, "d_c": 0.02}.items()}
    formula = lambda v_n, V_n, Omega, d_c: {"e": -(V_n + d_c * Omega) / v_n}  # noqa: E731
    slope = sensitivities(formula, at)["e"]
    expected = {"v_n": 0.48 / 4.0, "V_n": 0.5, "Omega": 0.01, "d_c": 4.5}
    for name, value in expected.items():
        assert slope[name] == pytest.approx(value, rel=1e-8)


def test_scatter_alone_is_students_interval_of_the_mean():
    """With the same impact speed in every test e is linear in the velocities, so first order is exact."""
    rng = np.random.default_rng(1)
    motion = {"v_n": -2.0, "v_t": -2.0, "V_n": rng.normal(0.3, 0.1, 9), "V_t": -0.5, "Omega": 10.0}
    found = first_order(motion, d_c=0.02, d_d=0.03, k2=5e-4, errors=Errors(0.0, 0.0))["e"]
    sd = np.std(motion["V_n"], ddof=1) / 2.0 / 3.0
    assert found.sd == pytest.approx(sd, rel=1e-7) and found.parts["contact"] == 0
    assert found.high - found.value == pytest.approx(stdtrit(8, 0.975) * sd, rel=1e-7)


def test_contact_point_alone_in_closed_form():
    motion = {"v_n": [-2.0, -2.0], "v_t": -2.0, "V_n": 0.3, "V_t": -0.5, "Omega": 10.0}
    found = first_order(motion, d_c=0.02, d_d=0.03, k2=5e-4, errors=Errors(0.6e-3, 0.0))["e"]
    assert found.sd == pytest.approx(10.0 / 2.0 * 0.6e-3 / np.sqrt(3), rel=1e-7)


def test_tracking_alone_in_closed_form():
    """The ratio of two differences of independent velocities."""
    motion = {"v_n": [-2.0, -2.0], "v_t": -1.0, "V_n": 0.0, "V_t": -0.4, "Omega": 0.0}
    found = first_order(motion, d_c=0.02, d_d=0.03, k2=5e-4, errors=Errors(0.0, 0.02))["mu"]
    terms = np.array([0.3, 0.5, 0.2]) * 0.02 / np.sqrt(3)  # v_n d/dv_n, v_t d/dv_t, V_t d/dV_t
    assert found.value == pytest.approx(0.3) and found.sd == pytest.approx(np.linalg.norm(terms), rel=1e-7)


@pytest.mark.parametrize("id", ["t2", "t5d", "t6-60"])
@pytest.mark.parametrize("name", ["e", "mu"])
def test_bootstrap_and_first_order_agree_where_the_formula_is_nearly_linear(id, name):
    s = measured_set(id)
    linear, drawn = first_order(s.motion, **body(s))[name], bootstrap(s.motion, **body(s))[name]
    assert drawn.value == linear.value
    assert drawn.sd == pytest.approx(linear.sd, rel=0.12)


@pytest.mark.parametrize("id", MEASURED)
def test_no_set_contradicts_a_point_impulse(id):
    """The trend of e_m with angle lies within its uncertainty: every interval holds -1."""
    s = measured_set(id)
    drawn = bootstrap(s.motion, **body(s))["e_m"]
    assert drawn.low <= -1.0 <= drawn.high


def test_a_millimetre_rules_e_m_where_the_moment_arm_vanishes():
    """At 37 degrees the contact point matters most; the long rod hardly feels it."""
    sharp, blunt = (first_order(s.motion, **body(s))["e_m"] for s in map(measured_set, ("t2", "t6-37")))
    assert blunt.parts["contact"] > 10 * sharp.parts["contact"]
    assert sharp.sd < 0.05 < 0.5 < blunt.sd


def test_bootstrap_repeats_with_its_seed():
    s = measured_set("t4")
    one, two, other = (bootstrap(s.motion, **body(s), samples=200, seed=k)["e"] for k in (3, 3, 4))
    assert one == two != other


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Errors(contact=-1e-3), "contact"),
        (lambda: Errors(tracking=float("nan")), "tracking"),
        (lambda: first_order({"v_n": [-1.0]}, d_c=0.02, d_d=0.03, k2=5e-4), "lacks v_t"),
        (
            lambda: bootstrap(
                {"v_n": -1.0, "v_t": -1.0, "V_n": 0.1, "V_t": 0.0, "Omega": 1.0}, d_c=0.02, d_d=0.03, k2=5e-4
            ),
            "two tests",
        ),
    ],
)
def test_unusable_data_are_refused(call, words):
    with pytest.raises(DataError, match=words):
        call()


@pytest.mark.parametrize("omega", [0.0, -7.0])
def test_closure_identity_holds_for_any_velocities(omega):
    """Nonsense velocities close too: the identity tests mass, inertia and e_m alone."""
    rng = np.random.default_rng(0)
    v_n, v_t, V_t, Omega = -rng.uniform(1, 5, 500), *rng.uniform(-5, 5, (3, 500))
    V_n = v_n + rng.uniform(0.1, 9, 500)
    arms = {"d_c": 0.02, "d_d": 0.035, "k2": 5e-4, "omega": omega}
    v_n = v_n - 0.02 * abs(omega)
    lost = losses(v_n, v_t, V_n, V_t, Omega, mass=0.17, **arms)
    e_m = coefficients(v_n, v_t, V_n, V_t, Omega, **arms).e_m
    gap = lost.E_ln + lost.E_lt + lost.E_r - lost.E_0
    np.testing.assert_allclose(
        closure_defect(Omega, e_m, mass=0.17, k2=5e-4, omega=omega), gap, rtol=1e-8, atol=1e-11
    )


@pytest.mark.parametrize("id", MEASURED)
def test_closure_identity_on_the_tables(id):
    s = measured_set(id)
    row = s.recomputed()
    share = row["E_ln_over_E_0"] + row["E_lt_over_E_0"] + row["E_r_over_E_0"] - 1
    energy = 0.5 * s.mass * (row["v_n"] ** 2 + row["v_t"] ** 2)
    gap = closure_defect(row["Omega"], row["e_m"], mass=s.mass, k2=s.k2) / energy
    np.testing.assert_allclose(share, gap, rtol=1e-8, atol=1e-13)


@pytest.mark.parametrize("n", [2, 3, 4, 8])
def test_the_interval_of_few_tests_holds_95_per_cent_of_the_true_values(n):
    """Tests drawn anew with replacement held 74 % of three and 89 % of eight."""
    rng, repeats = np.random.default_rng(5), 400
    true = {"v_n": -1.5, "v_t": -1.5, "V_n": 0.33, "V_t": -0.39, "Omega": 4.0}
    scatter, arms = (0.01, 0.01, 0.07, 0.08, 2.0), {"d_c": 0.0217, "d_d": 0.0339, "k2": 5.5e-4}
    known = coefficients(**true, **arms)
    held = np.zeros(2)
    for _ in range(repeats):
        motion = {k: rng.normal(v, sd, n) for (k, v), sd in zip(true.items(), scatter, strict=True)}
        found = bootstrap(motion, **arms, errors=Errors(0.0, 0.0), samples=500)
        held += [found[name].low <= getattr(known, name) <= found[name].high for name in ("e", "mu")]
    assert held / repeats == pytest.approx(0.95, abs=0.04)


def test_the_tests_are_never_drawn_one_by_one():
    """Twenty thousand tests took 3.8 GB when all samples were drawn at once."""
    rng = np.random.default_rng(3)
    motion = {"v_n": rng.normal(-2.0, 0.1, 20_000), "v_t": -2.0, "V_n": 0.3, "V_t": -0.5, "Omega": 10.0}
    arms = {"d_c": 0.02, "d_d": 0.03, "k2": 5e-4, "samples": 100}
    tracemalloc.start()
    bootstrap(motion, **arms)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10e6
