"""Numbers that say how good a mesh is, and the refusal of one that is inside out."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from meshes.errors import MeshError
from meshes.gauss import jacobians, weighted_volumes
from meshes.hexmesh import HexMesh
from meshes.topology import CORNERS, EDGES

__all__ = ["Quality", "aspects", "edge_lengths", "quality", "require_positive", "scaled_jacobians", "volume"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Quality:
    """Extremes over a mesh.

    Attributes
    ----------
    min_scaled_jacobian : float
        Least over all corners of all cells; 1 for a box, not positive for a folded cell.
    min_edge : float, m
    volume : float, m3
        Of the meshed part (half a body that has a symmetry plane).
    aspect : float
        Greatest ratio of the longest to the shortest edge of a cell.
    """

    min_scaled_jacobian: float
    min_edge: float
    volume: float
    aspect: float


def _corner_neighbours() -> npt.NDArray[np.int64]:
    """(8, 3) corners reached from each corner along x, y, z."""
    step = np.abs(CORNERS[:, None, :] - CORNERS[None, :, :])
    return np.array(
        [[np.flatnonzero((step[c] == np.eye(3)[d]).all(axis=1))[0] for d in range(3)] for c in range(8)]
    )


_NEIGHBOURS = _corner_neighbours()
_SIGN = np.prod(1 - 2 * CORNERS, axis=1)


def scaled_jacobians(mesh: HexMesh) -> FloatArray:
    """(m, 8) volume spanned by the unit edge vectors at each corner: 1 when they are square to each other."""
    x = mesh.points[mesh.cells]
    arms = x[:, _NEIGHBOURS] - x[:, :, None, :]
    arms /= np.linalg.norm(arms, axis=-1, keepdims=True)
    return np.asarray(_SIGN * np.linalg.det(arms))


def edge_lengths(mesh: HexMesh) -> FloatArray:
    """(m, 12) edges of every cell, m."""
    ends = mesh.points[mesh.cells[:, EDGES]]
    return np.asarray(np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1))


def aspects(mesh: HexMesh) -> FloatArray:
    """(m,) longest over shortest edge."""
    edges = edge_lengths(mesh)
    return np.asarray(edges.max(axis=1) / edges.min(axis=1))


def volume(mesh: HexMesh) -> float:
    """Volume of the meshed part, m3 (exact for trilinear cells)."""
    return float(weighted_volumes(mesh).sum())


def quality(mesh: HexMesh) -> Quality:
    """Least scaled Jacobian, shortest edge, volume and greatest aspect of a mesh."""
    return Quality(
        float(scaled_jacobians(mesh).min()),
        float(edge_lengths(mesh).min()),
        volume(mesh),
        float(aspects(mesh).max()),
    )


def require_positive(mesh: HexMesh) -> None:
    """Refuse a mesh with a cell that is folded at a corner or a Gauss point.

    Raises
    ------
    MeshError
        Naming the worst cell and its place.
    """
    worst = np.minimum(scaled_jacobians(mesh).min(axis=1), np.linalg.det(jacobians(mesh)).min(axis=1))
    cell = int(np.argmin(worst))
    if not worst[cell] > 0.0:
        where = mesh.points[mesh.cells[cell]].mean(axis=0).tolist()
        raise MeshError(
            f"cell {cell} about {where} m is folded (Jacobian {worst[cell]:.3g}): "
            "change the size of the cells or the shape"
        )
