"""Limits and bands of two meshes and of more, floors of vibration, and what one mesh alone says."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from study_fakes import outcome

from fem_impact.answers.refine.extrapolate import (
    ALONE,
    LOWEST,
    ONE_RUN,
    MeshRuns,
    limit,
    mesh_limits,
    pair_limit,
)
from fem_impact.errors import RunError
from fem_impact.outcome.record import KEYS


def limits_of(*meshes):
    return mesh_limits([MeshRuns.of(runs) for runs in meshes])


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


def test_what_one_mesh_does_not_know_has_no_limit():
    limits, bands = limits_of([outcome(e_paper=None)], [outcome(tip_size_m=8e-4)])
    assert "e_paper" not in limits
    assert set(limits) == set(bands) == {key.name for key in KEYS if key.banded} - {"e_paper"}


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
    value, half = pair_limit(0.51, 0.56, 2.0, offsets=2)
    assert limits["mu"] == pytest.approx(value)
    assert bands["mu"] > half


def test_one_mesh_alone_has_the_means_over_its_offsets_and_no_band_and_one_run_neither():
    (means, none), alone = limits_of([outcome(mu=mu) for mu in (0.50, 0.52)]), limits_of([outcome()])
    assert means["mu"] == pytest.approx(0.51)
    assert none == ALONE
    assert alone == (ALONE, ALONE)


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


SIZES = np.array([3.0, 2.25, 1.8, 1.5, 1.0])


@pytest.mark.parametrize("order", [0.6, 1.0, 1.5, 2.0])
def test_a_pure_power_gives_its_limit_and_order(order):
    found = limit(SIZES * 1e-4, 0.4 - 0.02 * SIZES**order)
    assert found.value == pytest.approx(0.4, abs=1e-6)
    assert found.order == pytest.approx(order, abs=1e-3)
    assert found.band == pytest.approx(1.25 * 0.02, rel=1e-3)


def test_an_order_beyond_the_method_is_not_believed():
    found = limit(SIZES, 1 + 0.01 * SIZES**3.5)
    assert found.order is None
    assert found.band > 3 * 0.01


def test_values_without_a_trend_have_a_band_of_more_than_their_scatter():
    noise = np.array([0.03, -0.03, 0.03, -0.03, 0.03])
    found = limit(SIZES, 1 + noise)
    assert found.band > 0.06


def test_equal_values_are_their_own_limit():
    found = limit(SIZES, np.full(5, 0.7))
    assert found.value == pytest.approx(0.7)
    assert found.band == pytest.approx(0.0, abs=1e-12)


def test_two_meshes_are_too_few():
    with pytest.raises(RunError, match="three meshes"):
        limit([1.0, 2.0, 2.0], [1.0, 2.0, 2.0])


@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4), st.floats(-5, 5), st.floats(0.1, 10))
def test_the_limit_moves_and_scales_with_the_values(values, shift, scale):
    q = np.array(values)
    plain, moved = limit(SIZES[:4], q), limit(SIZES[:4], shift + scale * q)
    assert moved.value == pytest.approx(shift + scale * plain.value, rel=1e-3, abs=1e-3 * scale)
