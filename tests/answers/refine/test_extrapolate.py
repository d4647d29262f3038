"""Limits and bands of two levels that resolve their contact, floors of vibration, and of one alone none."""

from math import hypot, sqrt

import pytest
from outcome_maker import altered
from study_fakes import outcome

from fem_impact.answers.refine.extrapolate import (
    ALONE,
    EVEN,
    LOWEST,
    ONE_RUN,
    UNRESOLVED,
    MeshRuns,
    level_limits,
    own_limits,
    pair_limit,
    quantity_limits,
)
from fem_impact.outcome.record import KEYS


def limits_of(fine, coarse):
    return own_limits([MeshRuns(runs[0].cost.tip_size, runs) for runs in (coarse, fine)])


@pytest.mark.parametrize("ratio", [2.0, 1.5, 3.0])
@pytest.mark.parametrize("order", [LOWEST, 1.0, 1.5, 2.0, 4.0])
def test_the_band_holds_the_limit_of_every_order_from_the_lowest(ratio, order):
    h = 0.3e-3
    fine, coarse = (
        outcome(tip_size_m=size, mu=0.5 + 0.1 * (size / h) ** order, e_edge=0.3 - 0.02 * (size / h) ** order)
        for size in (h, ratio * h)
    )
    limits, bands = limits_of([fine] * 2, [coarse] * 2)
    for key, true in (("mu", 0.5), ("e_edge", 0.3)):
        assert abs(limits[key] - true) <= bands[key] * (1 + 1e-9)


def test_the_band_reaches_from_the_finer_mesh_to_the_lowest_order():
    fine, coarse = outcome(tip_size_m=3e-4, e_edge=0.30), outcome(tip_size_m=6e-4, e_edge=0.36)
    limits, bands = limits_of([fine] * 2, [coarse] * 2)
    assert limits["e_edge"] + bands["e_edge"] == pytest.approx(0.30)
    assert limits["e_edge"] - bands["e_edge"] == pytest.approx(0.30 - 0.06 / (2**LOWEST - 1))
    assert limits["e_edge"] == pytest.approx(0.256, abs=5e-4)
    assert bands["e_edge"] == pytest.approx(0.044, abs=5e-4)


def test_one_run_on_each_mesh_has_a_wider_band_about_the_same_limit():
    fine, coarse = outcome(tip_size_m=3e-4, e_edge=0.30), outcome(tip_size_m=6e-4, e_edge=0.36)
    (limits, bands), (means, narrow) = (limits_of([fine] * n, [coarse] * n) for n in (1, 2))
    assert limits["e_edge"] == means["e_edge"]
    assert bands["e_edge"] == pytest.approx(ONE_RUN * narrow["e_edge"])
    assert limits_of([fine] * 2, [coarse])[1]["e_edge"] == bands["e_edge"]


def test_what_the_finer_level_does_not_know_has_no_limit():
    limits, bands = limits_of([outcome(e_paper=None)], [outcome(tip_size_m=8e-4)])
    assert "e_paper" not in limits
    assert set(limits) == set(bands) == {key.name for key in KEYS if key.banded} - {"e_paper"}


def test_a_massive_barrier_keeps_its_velocity_without_an_error():
    for mass in (None, 5.0):
        runs = [[outcome(barrier_mass_kg=mass, tip_size_m=size)] for size in (4e-4, 8e-4)]
        assert ("V_bn_m_per_s" in limits_of(*runs)[1]) == (mass is not None)


def test_shares_keep_their_sum_in_the_limit():
    """The rule is linear, so what adds up on both meshes adds up in the limit."""
    fine = outcome(E_r_over_E_0=0.7, W_friction_over_E_0=0.3)
    coarse = outcome(tip_size_m=8e-4, E_r_over_E_0=0.6, W_friction_over_E_0=0.4)
    limits, _ = limits_of([fine], [coarse])
    assert limits["E_r_over_E_0"] + limits["W_friction_over_E_0"] == pytest.approx(1.0)


def test_places_of_the_grid_widen_the_band_by_their_scatter():
    fine = [outcome(mu=mu) for mu in (0.50, 0.52)]
    coarse = [outcome(mu=0.56, tip_size_m=8e-4)] * 2
    limits, bands = limits_of(fine, coarse)
    weight = 0.5 / (2**LOWEST - 1)
    value, half = pair_limit([2.0, 1.0], [[0.56] * 2, [0.51] * 2])
    assert (value, half) == pytest.approx((0.51 - 0.05 * weight, 0.05 * weight))
    assert limits["mu"] == pytest.approx(value)
    assert bands["mu"] == pytest.approx(half + (1 + weight) * EVEN * 0.01)
    both = pair_limit([2.0, 1.0], [[0.5, 0.52], [0.5, 0.52]])
    assert both[1] == pytest.approx(hypot(weight, 1 + weight) * EVEN * 0.02 / sqrt(2) / sqrt(2))


def test_one_level_alone_says_nothing_nor_do_two_whose_last_resolves_nothing():
    fine, coarse = MeshRuns(4e-4, [outcome()]), MeshRuns(8e-4, [outcome(tip_size_m=8e-4)])
    lost = MeshRuns(fine.size, fine.runs, resolved=False)
    assert level_limits([fine]) == level_limits([]) == (ALONE, ALONE)
    assert level_limits([lost]) == level_limits([coarse, lost]) == (UNRESOLVED, UNRESOLVED)
    assert quantity_limits([coarse, lost]) == {}


def test_a_quantity_has_the_sum_of_its_parts_and_their_bands_over_its_scale():
    plastic = {"E_plastic_rod_over_E_0": 0.2, "E_plastic_barrier_over_E_0": 0.3}
    fine = outcome(e_edge=0.02, **plastic)
    coarse = altered(fine, tip_size_m=8e-4, e_edge=0.03, E_plastic_rod_over_E_0=0.1)
    levels = [MeshRuns(8e-4, [coarse] * 2), MeshRuns(4e-4, [fine] * 2)]
    found, (limits, bands) = quantity_limits(levels), level_limits(levels)
    assert found["plastic"].value == pytest.approx(limits["E_plastic_rod_over_E_0"] + 0.3)
    both = bands["E_plastic_rod_over_E_0"] + bands["E_plastic_barrier_over_E_0"]
    assert found["plastic"].band == pytest.approx(both) and both > 0.05
    assert found["e"].error == pytest.approx(bands["e_edge"] / 0.05)  # its least scale


def test_the_band_of_the_vibration_is_no_narrower_than_its_two_counts_on_the_finer_mesh():
    """Two meshes agree by chance; the counts by modes and without them differ on both of them."""
    fine = outcome(E_vib_over_E_0=0.02, E_vib_check_over_E_0=0.0215, E_vib_floor_over_E_0=1e-6)
    coarse = outcome(
        tip_size_m=8e-4, E_vib_over_E_0=0.02, E_vib_check_over_E_0=0.05, E_vib_floor_over_E_0=1e-6
    )
    limits, bands = limits_of([fine] * 2, [coarse] * 2)
    assert limits["E_vib_over_E_0"] == pytest.approx(0.02)
    assert bands["E_vib_over_E_0"] == pytest.approx(0.0015)
    assert bands["mu"] == pytest.approx(0.0, abs=1e-12)
