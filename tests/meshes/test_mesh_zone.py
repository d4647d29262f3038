import numpy as np
import pytest

import meshes

TURN = np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]])
ZONE = meshes.Zone([1.0, 2.0, 3.0], TURN, [-1.0, -2.0, -3.0], [1.0, 2.0, 0.5])


def test_distance_is_euclidean_and_zero_inside():
    inside = ZONE.centre + np.array([0.9, -1.9, 0.4]) @ TURN
    outside = ZONE.centre + np.array([1.0 + 3.0, 2.0 + 4.0, 0.0]) @ TURN
    assert ZONE.distance(np.array([inside, outside])) == pytest.approx([0.0, 5.0], abs=1e-12)


def test_corners_span_the_box():
    local = ZONE.local(ZONE.corners())
    assert local.min(axis=0) == pytest.approx(ZONE.low)
    assert local.max(axis=0) == pytest.approx(ZONE.high)
    assert len(np.unique(local.round(9), axis=0)) == 8


def test_gap_of_a_cell_that_only_abuts_is_not_zero():
    zone = meshes.Zone(np.zeros(3), np.eye(3), np.zeros(3), np.ones(3))
    cube = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], dtype=float)
    cells = cube + np.array([[1.0, 0.0, 0.0], [0.5, 0.0, 0.0], [3.0, 0.0, 0.0]])[:, None]
    gap = zone.gap(cells, np.full(3, 1e-6))
    assert gap[0] > 0.0
    assert gap[1] == 0.0
    assert gap[2] == pytest.approx(2.0, abs=1e-5)


def test_bad_boxes_are_refused():
    with pytest.raises(meshes.MeshError, match="orthonormal"):
        meshes.Zone(np.zeros(3), np.ones((3, 3)), np.zeros(3), np.ones(3))
    with pytest.raises(meshes.MeshError, match="exceeds high"):
        meshes.Zone(np.zeros(3), np.eye(3), np.ones(3), np.zeros(3))
