"""Where the volume of each cell lies: mass, centre, inertia and sections of a meshed body follow from it."""

from typing import NamedTuple

import numpy as np

from meshes.common import FloatArray
from meshes.gauss import gauss_points
from meshes.hexmesh import HexMesh


class CellMoments(NamedTuple):
    """Integrals over cells, (m,) float64 each.

    Attributes
    ----------
    low, high : least and greatest z, m
    volume : m3
    x, z : first moments, m4
    xx, zz : second moments, m5
    """

    low: FloatArray
    high: FloatArray
    volume: FloatArray
    x: FloatArray
    z: FloatArray
    xx: FloatArray
    zz: FloatArray


def cell_moments(mesh: HexMesh) -> CellMoments:
    """Return the integrals over the cells of a mesh by 2 x 2 x 2 Gauss points.

    Volumes are exact, so are all moments of cells with parallel sides.
    """
    weight, place = gauss_points(mesh.points, mesh.cells)
    x, z = place[:, :, 0], place[:, :, 2]
    height = mesh.points[mesh.cells, 2]
    moments = (np.ones_like(x), x, z, x**2, z**2)
    return CellMoments(height.min(axis=1), height.max(axis=1), *((weight * p).sum(axis=1) for p in moments))
