"""Zones that are clouds of points."""

import numpy as np
import pytest

import meshes
from meshes import Cloud, MeshError


def test_cells_about_the_points_are_split_and_no_others():
    points = np.array([[0.0, 0.0, 0.0], [6e-3, 0.0, 0.0]])
    cloud = Cloud(points, np.array([1e-3, 2e-3]))
    block = meshes.block(np.array([-8e-3, 0, -8e-3]), np.array([10e-3, 4e-3, 0]), 1e-3, [cloud], buffer=0)
    split = block.points[block.cells[block.level == 1]].mean(axis=1)
    whole = block.points[block.cells[block.level == 0]].mean(axis=1)
    away = [np.linalg.norm(at[:, None] - points, axis=2) - cloud.radii for at in (split, whole)]
    assert len(split) and away[0].min(axis=1).max() < 2e-3
    assert away[1].min() > 0


def test_the_gap_of_a_cell_is_that_to_its_box():
    corners = np.array([[[x, y, z] for x in (2.0, 3.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]])
    cloud = Cloud(np.zeros((1, 3)), np.array([0.5]))
    assert cloud.gap(corners, np.zeros(1)) == pytest.approx([1.5])
    assert cloud.corners().min(axis=0) == pytest.approx([-0.5] * 3)


def test_a_cloud_needs_points_with_a_radius_each():
    with pytest.raises(MeshError, match="needs points"):
        Cloud(np.zeros((0, 3)), np.zeros(0))
    with pytest.raises(MeshError, match="radius"):
        Cloud(np.zeros((2, 3)), np.zeros(1))
