"""The 2 x 2 x 2 Gauss points of the trilinear unit cell [-1, 1]^3 (weights 1)."""

import numpy as np

from meshes.common import FloatArray, IntArray
from meshes.hexmesh import CORNERS, HexMesh

_SIGNS = 2.0 * CORNERS - 1.0
_POINTS = _SIGNS / np.sqrt(3.0)
_FACTORS = 1.0 + _POINTS[:, None, :] * _SIGNS[None, :, :]

#: (8, 8, 3) derivative of each shape function with respect to the unit coordinates.
GRADIENTS: FloatArray = np.stack(
    [_SIGNS[:, d] * np.delete(_FACTORS, d, axis=2).prod(axis=2) / 8.0 for d in range(3)], axis=2
)

#: (8, 8) value of each shape function at each Gauss point.
SHAPES: FloatArray = _FACTORS.prod(axis=2) / 8.0


def jacobians(mesh: HexMesh) -> FloatArray:
    """(m, 8, 3, 3) dx_i / dxi_j at the Gauss points, m."""
    return jacobians_of(mesh.points, mesh.cells)


def jacobians_of(points: FloatArray, cells: IntArray) -> FloatArray:
    """(m, 8, 3, 3) dx_i / dxi_j, m, at the Gauss points of cells (m, 8) of nodes (n, 3), m."""
    return np.asarray(np.einsum("qaj,mai->mqij", GRADIENTS, points[cells], optimize=True))


def gauss_points(points: FloatArray, cells: IntArray) -> tuple[FloatArray, FloatArray]:
    """Volumes (m, 8), m3, that the Gauss points of cells stand for, and their places (m, 8, 3), m."""
    return np.linalg.det(jacobians_of(points, cells)), np.einsum("qa,mai->mqi", SHAPES, points[cells])
