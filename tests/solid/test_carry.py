"""What a rod keeps from one strike to the next: stresses and modes that turn with it."""

import numpy as np
import pytest

from fem_impact.fem.hexmodes import LANES
from fem_impact.solid.carry import turned, turned_at, turned_stress


def test_stresses_turn_as_tensors_do():
    rng = np.random.default_rng(1)
    stress = rng.normal(size=(2, 8, 6 * LANES))
    angle = 0.7
    R = turned(np.eye(3), angle).T
    found = turned_stress(stress, angle).reshape(2, 8, 6, LANES)
    for block, point, lane in ((0, 0, 0), (1, 5, LANES - 1)):
        tt, bb, nn, tb, bn, nt = stress.reshape(2, 8, 6, LANES)[block, point, :, lane]
        S = R @ np.array([[tt, tb, nt], [tb, bb, bn], [nt, bn, nn]]) @ R.T
        wanted = S[0, 0], S[1, 1], S[2, 2], S[0, 1], S[1, 2], S[0, 2]
        assert found[block, point, :, lane] == pytest.approx(wanted, abs=1e-12)


def test_a_quarter_turn_brings_n_to_t():
    assert turned(np.array([[0.0, 0.0, 1.0]]), np.pi / 2) == pytest.approx(np.array([[1.0, 0.0, 0.0]]))
    vector, places = np.arange(7.0), np.array([[4, 5, 6]])
    assert turned_at(vector, places, np.pi / 2) == pytest.approx([0, 1, 2, 3, 6, 5, -4])
