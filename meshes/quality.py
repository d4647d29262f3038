"""Quality of a mesh, and the refusal of one with folded cells."""

from dataclasses import dataclass

import numpy as np

from meshes.common import FloatArray, IntArray, MeshError
from meshes.gauss import jacobians
from meshes.hexmesh import CORNERS, EDGES, NEIGHBOURS, HexMesh


@dataclass(frozen=True, slots=True)
class Quality:
    """Extreme values over all cells of a mesh.

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


# (8,) 1 where the edges from a corner along x, y, z are right-handed, else -1
_SIGN = np.prod(1 - 2 * CORNERS, axis=1)


def scaled_jacobians(mesh: HexMesh) -> FloatArray:
    """(m, 8) volume spanned by the unit edge vectors at each corner: 1 when they are square to each other."""
    return corner_jacobians(mesh.points[mesh.cells])


def corner_jacobians(x: FloatArray) -> FloatArray:
    """(m, 8) scaled Jacobians of cells with corners x (m, 8, 3)."""
    arms = x[:, NEIGHBOURS] - x[:, :, None, :]
    # not a number where two corners are one, which whoever asks refuses
    with np.errstate(invalid="ignore", divide="ignore"):
        arms /= np.linalg.norm(arms, axis=-1, keepdims=True)
        return np.asarray(_SIGN * np.linalg.det(arms))


def edge_lengths(mesh: HexMesh, cells: IntArray | slice = slice(None)) -> FloatArray:
    """(m, 12) edges, m, of every cell, or of those chosen."""
    ends = mesh.points[mesh.cells[cells][:, EDGES]]
    return np.asarray(np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1))


def aspects(mesh: HexMesh) -> FloatArray:
    """(m,) longest over shortest edge."""
    edges = edge_lengths(mesh)
    return np.asarray(edges.max(axis=1) / edges.min(axis=1))


def thicknesses(mesh: HexMesh) -> FloatArray:
    """(m,) least thickness of every cell, m: what a wave has to cross, least over the Gauss points."""
    return np.asarray(2.0 * np.linalg.svd(jacobians(mesh), compute_uv=False)[:, :, -1].min(axis=1))


def volume(mesh: HexMesh) -> float:
    """Volume of the meshed part, m3 (exact for trilinear cells)."""
    return float(np.linalg.det(jacobians(mesh)).sum())


def quality(mesh: HexMesh) -> Quality:
    """Least scaled Jacobian, shortest edge, volume and greatest aspect of a mesh."""
    return Quality(
        float(scaled_jacobians(mesh).min()),
        float(edge_lengths(mesh).min()),
        volume(mesh),
        float(aspects(mesh).max()),
    )


def least_jacobians(mesh: HexMesh) -> FloatArray:
    """(m,) least Jacobian of a cell, at corners (scaled) and Gauss points; not above 0 where it is folded."""
    at_corners, inside = scaled_jacobians(mesh), np.linalg.det(jacobians(mesh))
    return np.asarray(np.minimum(at_corners.min(axis=1), inside.min(axis=1)))


def require_positive(mesh: HexMesh) -> None:
    """Refuse a mesh with a cell that is folded at a corner or a Gauss point.

    Raises
    ------
    MeshError
        Naming the worst cell and its place.
    """
    worst = least_jacobians(mesh)
    cell = int(np.argmin(worst))
    if not worst[cell] > 0.0:
        where = ", ".join(f"{1e3 * x:.3g}" for x in mesh.points[mesh.cells[cell]].mean(axis=0))
        raise MeshError(
            f"cell {cell} about ({where}) mm is folded (Jacobian {worst[cell]:.3g}): "
            "change the size of the cells or the shape"
        )
