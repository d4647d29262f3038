import numpy as np
import pytest

from rigid import DataError, ImpactError, critical_ratio, predicted_losses, sliding_path, worst_case
from rigid.experiments import angle_sets, at_angle, critical_ratio_against_angle, loss_against_angle

ROD = {"d_c": 0.0226, "d_d": 0.035, "k2": 5.56e-4}


def test_nothing_below_the_critical_ratio_loses_more():
    worst = worst_case(-1.5, -1.5, e=0.33, mass=0.175, **ROD)
    mu = np.random.default_rng(0).uniform(0, worst.mu_c, 5000)
    lost = predicted_losses(-1.5, -1.5, e=0.33, mu=mu, mass=0.175, **ROD)
    assert (lost.E_ln + lost.E_lt).max() == pytest.approx(worst.total, rel=2e-5)
    assert lost.E_lt.max() == pytest.approx(worst.tangential, rel=2e-5)
    at = predicted_losses(-1.5, -1.5, e=0.33, mu=worst.mu_tangential, mass=0.175, **ROD)
    assert at.E_lt == pytest.approx(worst.tangential, rel=1e-12)
    assert worst.mu_c == critical_ratio(-1.5, -1.5, e=0.33, **ROD)


def test_at_the_critical_ratio_the_total_loss_is_close_to_its_maximum():
    """The paper's statement about its Fig 6, at all five angles."""
    for s in angle_sets():
        v, e = (-np.cos(s.alpha), -np.sin(s.alpha)), at_angle(s.alpha).e
        arms = {"d_c": s.arms.d_c, "d_d": s.arms.d_d, "k2": s.k2}
        worst = worst_case(*v, e=e, mass=2.0, **arms)
        there = sum(predicted_losses(*v, e=e, mu=worst.mu_c, mass=2.0, **arms))
        assert 0.9 * worst.total < there <= worst.total * (1 + 1e-12)


def test_friction_heat_stays_below_the_tangential_bound():
    """Whatever Coulomb friction does on the resolved path, while e is the kinematic one."""
    bound = worst_case(-1.5, -1.5, e=0.33, mass=1.0, **ROD).tangential
    path = sliding_path(-1.5, -1.5, e=0.33, f=np.linspace(0, 0.6, 40), law="kinematic", **ROD)
    assert np.all(-sum(path.tangential_work) <= bound * (1 + 2e-5))


def test_arrays():
    worst = worst_case(np.array([-1.5, -3.0]), [[-1.5], [-2.0]], e=0.33, mass=0.175, **ROD)
    assert all(x.shape == (2, 2) for x in worst)


def test_a_tip_sliding_up_the_slope_is_refused():
    with pytest.raises(ImpactError, match="up the slope"):
        worst_case(-1.5, 3.0, e=0.3, mass=1.0, **ROD)


def test_published_angles_of_the_largest_losses():
    """The total is largest near 45 degrees, the tangential loss near 50."""
    degrees = np.linspace(17, 60, 431)
    lost = loss_against_angle(np.radians(degrees))
    assert degrees[(lost.E_ln + lost.E_lt).argmax()] == pytest.approx(45, abs=4)
    assert degrees[lost.E_lt.argmax()] == pytest.approx(50, abs=2)


def test_curves_pass_through_the_measured_means():
    for s in angle_sets():
        mean, lost = s.statistics(), loss_against_angle(s.alpha)
        assert lost.E_ln == pytest.approx(mean["E_ln_over_E_0"].mean, abs=0.02)
        assert lost.E_lt == pytest.approx(mean["E_lt_over_E_0"].mean, abs=0.02)


def test_interpolation_between_two_sets():
    middle = at_angle(np.radians(21.0))
    ends = [at_angle(np.radians(a)) for a in (17.0, 25.0)]
    np.testing.assert_allclose(middle, np.mean(ends, axis=0), rtol=1e-12)
    assert ends[0].d_c == 0.0050


def test_low_angles_reach_the_critical_ratio_and_steep_ones_do_not():
    mu_c, mu = critical_ratio_against_angle()
    assert np.all(mu[:3] > 0.99 * mu_c[:3]) and np.all(mu[3:] < 0.9 * mu_c[3:])
    mu_c_own, _ = critical_ratio_against_angle(e_m=None)
    np.testing.assert_allclose(mu_c_own, mu_c, rtol=0.02)  # e_m hardly matters
    assert np.any(mu_c_own != mu_c)


@pytest.mark.parametrize("degrees", [16.0, 61.0])
def test_angles_that_were_not_measured_are_refused(degrees):
    with pytest.raises(DataError, match="17 to 60"):
        at_angle(np.radians(degrees))
