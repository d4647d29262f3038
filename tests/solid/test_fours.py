"""Four numbers at once are four numbers."""

import numpy as np
import pytest

from fem_impact.fem.kernels import add_product, kernel, load, spread, store, three


@kernel
def _blend(values, place, share, out):
    store(out, place, add_product(load(values, place), spread(share), load(values, place + 1)))
    return three(load(out, place))


@pytest.mark.parametrize("place", range(4))
@pytest.mark.parametrize("shape", [(8,), (2, 4)])
def test_fours_begin_anywhere_and_leave_the_rest_alone(place, shape):
    values, out = np.random.default_rng(1).normal(size=8), np.full(shape, -7.0)
    total = _blend(values.reshape(shape), place, 0.5, out)
    expected = np.full(8, -7.0)
    expected[place : place + 4] = values[place : place + 4] + 0.5 * values[place + 1 : place + 5]
    assert out.ravel() == pytest.approx(expected, rel=1e-15)
    assert total == pytest.approx(expected[place : place + 3].sum(), rel=1e-14)


def test_a_bad_number_stays_in_its_lane():
    values, out = np.array([1.0, 2.0, 3.0, 4.0, np.nan]), np.zeros(4)
    assert _blend(values, 0, 1.0, out) == 3.0 + 5.0 + 7.0
    assert np.isnan(out[3])
