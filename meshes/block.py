"""A rectangular block under a flat top, for a barrier."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from meshes.common import FloatArray, IntArray, MeshError
from meshes.hexmesh import CORNERS, OUTER, SKIN, SYMMETRY, HexMesh, from_cells
from meshes.quality import require_positive
from meshes.refine import refine
from meshes.zone import Cloud, Zone

# Columns at the ends of a contact: how many times narrower they are, cells to each side of an end in which
# all are, cells further on in which they widen, and cells beyond the ends over which others are stretched
NARROW, NEAR, WIDENING, AROUND = 2.0, 1.5, 1.0, 8.0


def block(
    low: Sequence[float] | FloatArray,
    high: Sequence[float] | FloatArray,
    size: float,
    zones: Sequence[Zone | Cloud] = (),
    *,
    buffer: int = 2,
) -> HexMesh:
    """Mesh a block with equal box cells, refined around zones.

    Parameters
    ----------
    low, high : (3,) float64, m
        Corners in (t, b, n); low[1] and high[2] are 0: the symmetry plane and the top.
    size : float, m
        Wanted edge of the base cells; the counts are rounded, so edges differ a little from it.
    zones, buffer
        See `refine`.

    Raises
    ------
    MeshError
        If the block is empty or does not end at the two planes.
    """
    lo, hi = np.asarray(low, np.float64), np.asarray(high, np.float64)
    if lo.shape != (3,) or hi.shape != (3,) or np.any(hi <= lo):
        raise MeshError(f"block needs three extents with low < high, not {lo.tolist()} to {hi.tolist()} m")
    if not size > 0.0:
        raise MeshError(f"block size must be positive, not {size} m")
    if lo[1] != 0.0 or hi[2] != 0.0:
        raise MeshError(f"block must start at b = 0 and end at n = 0, not b = {lo[1]} and n = {hi[2]} m")
    counts = np.maximum(1, np.rint((hi - lo) / size)).astype(np.int64)
    axes = [np.linspace(lo[i], hi[i], counts[i] + 1) for i in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    base = from_cells(grid, box_cells(counts), _tag)
    mesh = refine(base, zones, buffer=buffer)
    require_positive(mesh)
    return mesh


def with_thin_skin(mesh: HexMesh, cell: float, rows: int) -> HexMesh:
    """Draw the rows of a block to its top, each half as high as that below; sides and columns stay.

    Parameters
    ----------
    mesh : HexMesh
        As `block` gives it.
    cell : float, m
        Edge of the finest cells.
    rows : int
        How many are drawn: the first is left with 2^-rows of its height, those below with all of it.

    Returns
    -------
    HexMesh
        The bottom of the block rises by `thin_skin_rise` cells.
    """
    return _moved(mesh, 2, -drawn_depths(-mesh.points[:, 2], cell, rows))


def drawn_depths(depths: FloatArray, cell: float, rows: int) -> FloatArray:
    """Return where depths under the top, m, lie after `with_thin_skin`, m."""
    depth = depths / cell
    drawn = np.minimum(depth, rows)
    return np.asarray(cell * (depth - drawn + (2.0**drawn - 1.0) * 0.5**rows))


def with_rows_at(mesh: HexMesh, rows: FloatArray, depths: FloatArray) -> HexMesh:
    """Move rows of whole cells of a block to other depths; between them heights change evenly.

    Parameters
    ----------
    mesh : HexMesh
        As `block` gives it, its top at n = 0.
    rows, depths : (k,) float64, m
        Depths of rows of unsplit cells, growing from 0 at the top to the bottom, and where they are to lie.
    """
    return _moved(mesh, 2, -np.interp(-mesh.points[:, 2], rows, depths))


def with_columns_at(mesh: HexMesh, columns: FloatArray, places: FloatArray) -> HexMesh:
    """Move columns of a block to other places along t; between them widths change evenly.

    Parameters
    ----------
    mesh : HexMesh
        As `block` gives it.
    columns, places : (k,) float64, m
        Growing places along t, and where they are to lie.
    """
    return _moved(mesh, 0, np.interp(mesh.points[:, 0], columns, places))


def _moved(mesh: HexMesh, axis: int, places: FloatArray) -> HexMesh:
    """Return a mesh whose nodes lie at other places (n,), m, on an axis; those that are tied follow."""
    points = mesh.points.copy()
    points[:, axis] = places
    return replace(mesh, points=np.asarray(mesh.tie @ points))


def with_wide_edges(mesh: HexMesh, margin: float, widest: float) -> HexMesh:
    """Widen the columns of a block evenly towards its sides, over a ``margin``, m, inside them.

    At the sides they are ``widest`` times as wide, and the margin is (1 + widest) / 2 times as wide. The side
    b = 0, the plane of symmetry, stays.
    """
    points = mesh.points.copy()
    for axis in (0, 1):
        x = points[:, axis]
        low, high = float(x.min()) + margin if axis == 0 else 0.0, float(x.max()) - margin
        out = np.maximum(x - high, 0.0), np.maximum(low - x, 0.0)
        up, down = (0.5 * (widest - 1.0) * way**2 / margin for way in out)
        points[:, axis] += up - down
    return replace(mesh, points=np.asarray(mesh.tie @ points))


def drawn_to_ends(
    ends: tuple[float, float], cell: float, sides: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """Return places (k,), m, along t before and after columns of cells are drawn to two ends of a contact.

    Columns at the ends become `NARROW` times narrower, the others a little wider; the ``sides`` of the block,
    m, stay. ``cell``, m, is the edge of the cells.
    """
    low, high = max(ends[0] - AROUND * cell, sides[0]), min(ends[1] + AROUND * cell, sides[1])
    after = np.linspace(low, high, 1 + round(20 * (high - low) / cell))
    away = np.abs(after[:, None] - np.array(ends)).min(axis=1) / cell
    density = 1.0 + (NARROW - 1.0) * np.clip(1.0 - (away - NEAR) / WIDENING, 0.0, 1.0)
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    before = low + count / count[-1] * (high - low)
    return np.array([sides[0], *before[1:-1], sides[1]]), np.array([sides[0], *after[1:-1], sides[1]])


def with_free_bottom(mesh: HexMesh) -> HexMesh:
    """Make the bottom of a block a part of its skin: that of a plate, of which the edges alone are cut."""
    bottom = (mesh.points[mesh.faces, 2] == mesh.points[:, 2].min()).all(axis=1)
    return replace(mesh, face_tag=np.where(bottom, SKIN, mesh.face_tag).astype(mesh.face_tag.dtype))


def thin_skin_rise(rows: int) -> float:
    """Return by how many cells the bottom of a block rises where so many rows are drawn together.

    Examples
    --------
    >>> thin_skin_rise(2)
    1.25
    """
    return float(rows - 1 + 0.5**rows)


def box_cells(counts: IntArray) -> IntArray:
    """(m, 8) cells of a box grid whose nodes run fastest in the last direction."""
    starts = np.stack(np.meshgrid(*[np.arange(c) for c in counts], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    stride = np.array([(counts[1] + 1) * (counts[2] + 1), counts[2] + 1, 1])
    return np.asarray((starts + CORNERS[None]) @ stride, dtype=np.int64)


def _tag(corners: FloatArray) -> IntArray:
    """SYMMETRY at b = 0, SKIN at n = 0, OUTER elsewhere."""
    symmetric = (corners[:, :, 1] == 0.0).all(axis=1)
    top = (corners[:, :, 2] == 0.0).all(axis=1)
    return np.where(symmetric, SYMMETRY, np.where(top, SKIN, OUTER))
