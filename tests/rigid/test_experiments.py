import numpy as np
import pytest

from rigid import DataError, coefficients
from rigid.experiments import measured_set, measured_sets, printed_statistics, set_ids, statistic, table

IDS = "t2 t3-machined t3-contaminated t3-cleaned t4 t5a t5b t5c t5d t6-17 t6-25 t6-37 t6-60".split()


def test_the_thirteen_sets_and_their_sizes():
    assert list(set_ids()) == IDS
    sizes = [len(s.printed["e"]) for s in measured_sets()]
    assert sizes == [30, 12, 12, 12] + [8] * 9


def test_statistic_against_a_textbook_interval():
    """Student's t for 8 tests is 2.365."""
    s = statistic(measured_set("t5a").printed["e"])
    assert s.n == 8 and s.mean == pytest.approx(0.407, abs=5e-4) and s.sd == pytest.approx(0.048, abs=5e-4)
    assert s.high - s.mean == pytest.approx(2.3646 * s.sd / 8**0.5, rel=1e-4)
    assert s.mean - s.low == pytest.approx(s.high - s.mean)


def test_one_test_has_no_scatter():
    with pytest.raises(DataError, match="two"):
        statistic([1.0])


@pytest.mark.parametrize("id", ["t4", "t5a", "t5b", "t5c", "t5d", "t6-25", "t6-37", "t6-60"])
def test_recomputed_means_are_the_printed_ones(id):
    s = measured_set(id)
    printed, found = printed_statistics(s.table, "mean", s.select), s.statistics()
    for name, tolerance in (("e", 0.006), ("mu", 0.002), ("V_n", 0.001), ("Omega", 0.02)):
        assert found[name].mean == pytest.approx(printed[name][0], abs=tolerance)


@pytest.mark.parametrize("id", ["t2", "t4", "t5a", "t5b", "t5c", "t5d", "t6-25", "t6-37", "t6-60"])
def test_the_stated_masses_arms_and_k2_reproduce_the_energy_columns(id):
    s = measured_set(id)
    energy = 0.5 * s.mass * (s.motion["v_n"] ** 2 + s.motion["v_t"] ** 2)
    for name in ("E_ln", "E_lt", "E_r"):
        found = s.recomputed()[f"{name}_over_E_0"] * energy
        np.testing.assert_allclose(np.median(found / s.printed[name]), 1.0, atol=0.04)


@pytest.mark.parametrize("state", ["machined", "contaminated", "cleaned"])
def test_table_3_is_reconstructed_from_its_coefficients(state):
    s = measured_set(f"t3-{state}")
    assert s.reconstructed and s.surface == state
    back = coefficients(**s.motion, d_c=0.083, d_d=0.086, k2=4.84e-3)
    for name in ("e", "mu", "e_m"):
        np.testing.assert_allclose(getattr(back, name), s.printed[name], rtol=1e-10)
    assert np.all(s.motion["v_n"] == -1.6)


def test_measured_velocities_are_the_printed_ones():
    s = measured_set("t6-60")
    assert not s.reconstructed and s.alpha == pytest.approx(np.pi / 3)
    np.testing.assert_array_equal(s.motion["Omega"], table(6, {"alpha_deg": "60.0"})["Omega"])


def test_shares_of_a_point_impulse_add_up_to_one():
    """E_ln + E_lt + E_r = E_0 where e_m = -1, so nearly so for the machined rod of Table 3."""
    s = measured_set("t3-machined").recomputed()
    total = s["E_ln_over_E_0"] + s["E_lt_over_E_0"] + s["E_r_over_E_0"]
    np.testing.assert_allclose(total, 1.0, atol=0.03)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: measured_set("t7"), "there are t2"),
        (lambda: table(1), "got 1"),
        (lambda: table(5, {"series": "z"}), "no row"),
    ],
)
def test_what_is_not_there_is_refused(call, words):
    with pytest.raises(DataError, match=words):
        call()
