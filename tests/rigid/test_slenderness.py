import numpy as np
import pytest

from rigid import LIMIT, LIMIT_MM, ShapeError, behaves_rigidly, in_millimetres, slenderness


def test_the_three_rods():
    gamma = slenderness([0.24, 0.12, 0.08], 0.019)
    np.testing.assert_allclose(gamma, [57.3, 28.6, 19.1], atol=0.05)
    assert behaves_rigidly(gamma).tolist() == [False, False, True]


def test_millimetres_and_metres_agree():
    assert in_millimetres(slenderness(0.12, 0.019)) == pytest.approx(120 / 19**1.3815, rel=1e-13)
    assert in_millimetres(LIMIT) == pytest.approx(LIMIT_MM, rel=1e-14)


def test_lengths_must_be_positive():
    with pytest.raises(ShapeError, match="positive"):
        slenderness(0.1, 0.0)
