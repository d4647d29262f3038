from dataclasses import replace

import numpy as np
import pytest

import meshes
from meshes.hexmesh import from_cells
from meshes.quality import edge_lengths, require_positive, scaled_jacobians


def cube(points=None):
    mesh = meshes.block((0.0, 0.0, -1.0), (1.0, 1.0, 0.0), 1.0)
    return mesh if points is None else replace(mesh, points=points(mesh.points.copy()))


def test_sheared_cube_has_the_jacobian_of_its_angle():
    angle = 0.5

    def shear(x):
        x[:, 0] += np.tan(angle) * x[:, 2]
        return x

    mesh = cube(shear)
    assert scaled_jacobians(mesh) == pytest.approx(np.cos(angle))
    assert meshes.volume(mesh) == pytest.approx(1.0)
    assert meshes.quality(mesh).aspect == pytest.approx(1.0 / np.cos(angle))


def test_edges_and_aspect_of_a_box():
    mesh = meshes.block((0.0, 0.0, -3.0), (2.0, 1.0, 0.0), 10.0)
    assert sorted(edge_lengths(mesh)[0]) == pytest.approx([1.0] * 4 + [2.0] * 4 + [3.0] * 4)
    assert meshes.quality(mesh).aspect == pytest.approx(3.0)


def test_folded_cell_is_refused_with_its_number_and_place():
    mesh = meshes.block((0.0, 0.0, -1.0), (3.0, 1.0, 0.0), 1.0)
    points = mesh.points.copy()
    corner = mesh.cells[1, 6]
    points[corner] = points[mesh.cells[1, 0]] - 0.1
    with pytest.raises(meshes.MeshError, match=r"cell 1 about \("):
        require_positive(replace(mesh, points=points))


def test_cells_that_name_missing_nodes_are_refused():
    with pytest.raises(meshes.MeshError, match="name node 8"):
        from_cells(np.zeros((8, 3)), np.arange(1, 9)[None], lambda x: np.zeros(len(x), int))
