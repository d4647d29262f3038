"""Limit and order of convergence of a quantity on three meshes or more."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fem_impact.errors import RunError
from fem_impact.evidence.studies.convergence import limit

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
