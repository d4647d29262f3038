"""Thin rows of cells under the skin of a part of a mesh."""

from dataclasses import replace

import numpy as np

from meshes.block import drawn_depths
from meshes.common import BoolArray, FloatArray, IntArray
from meshes.hexmesh import CORNERS, FACES, NEIGHBOURS, SKIN, HexMesh, face_keys, owners
from meshes.quality import scaled_jacobians

DEEPEST = 8  # rows from the skin, over which those below a few thin ones are stretched
# cells along the skin over which rows become thin: two, and two more for each row beyond so many, which
# would lean too far
FADE, STEEP = 2, 3
WORST, TRIES = 0.2, 8  # least scaled Jacobian of a cell that is drawn; how often its move is halved for that


def with_thin_rows(mesh: HexMesh, part: BoolArray, cell: float, rows: int) -> HexMesh:
    """Draw rows of a part of a mesh to its skin, each half as high as that below.

    Nodes move along the lines of the mesh that lead inwards; those of the skin stay on it, those of all
    other cells where they are. Rows under the thin ones are stretched evenly, up to the end of the part.

    Parameters
    ----------
    mesh : HexMesh
    part : (m,) bool
        Cells of one level.
    cell : float, m
        Their edge. Rows that are lower already are drawn less.
    rows : int
        How many are drawn, at most half of those that are there: the first is left with 2^-rows of ``cell``.

    Returns
    -------
    HexMesh
        The same cells. Where they would become too skewed they move less.
    """
    fixed = mesh.is_hanging
    fixed[mesh.cells[~part]] = True
    skin = (mesh.face_tag == SKIN) & part[owners(mesh)]
    lines = _lines(mesh, part, skin, fixed, max(DEEPEST, 2 * rows))
    count = (lines >= 0).sum(axis=1) - 1
    height = np.linalg.norm(mesh.points[lines[:, 1]] - mesh.points[lines[:, 0]], axis=1)
    thin = np.clip(rows + np.rint(np.log2(height / cell)), 0, np.minimum(rows, count // 2))
    share = _shares(mesh.faces[skin], lines[:, 0], len(mesh.points), FADE + 2 * max(rows - STEEP, 0))
    move = np.zeros_like(mesh.points)
    for there, drawn in np.unique(np.stack([count, thin.astype(np.int64)], axis=1), axis=0).tolist():
        nodes = lines[(count == there) & (thin == drawn), : there + 1]
        now, place = mesh.points[nodes], drawn_rows(there, drawn)
        low = np.minimum(place.astype(np.int64), there - 1)
        beyond = (place - low)[:, None]
        new = (1.0 - beyond) * now[:, low] + beyond * now[:, low + 1]
        np.add.at(move, nodes, share[nodes[:, 0], None, None] * (new - now))
    least = np.minimum(WORST, scaled_jacobians(mesh).min(axis=1))
    for _ in range(TRIES):
        moved = replace(mesh, points=np.asarray(mesh.tie @ (mesh.points + move)))
        skewed = scaled_jacobians(moved).min(axis=1) < least
        if not skewed.any():
            return moved
        move[mesh.cells[skewed]] *= 0.5
    return mesh


def drawn_rows(count: int, thin: int) -> FloatArray:
    """Return where the ends of rows lie, in rows, once so many of them are drawn to the first.

    Examples
    --------
    >>> drawn_rows(5, 2)
    array([0.        , 0.25      , 0.75      , 2.16666667, 3.58333333,
           5.        ])
    """
    top = drawn_depths(np.arange(thin + 1.0), 1.0, thin)
    return np.concatenate([top[:-1], np.linspace(top[-1], count, count - thin + 1)])


def _lines(mesh: HexMesh, part: BoolArray, skin: BoolArray, fixed: BoolArray, deepest: int) -> IntArray:
    """(k, deepest + 1) nodes of each line of edges from the skin inwards up to one that is fixed, then -1."""
    next_to = _neighbours(mesh.cells, part)
    front, cell = mesh.faces[skin], owners(mesh)[skin]
    path = np.full((*front.shape, deepest + 1), -1, dtype=np.int64)
    path[:, :, 0], row = front, np.arange(len(front))
    for step in range(1, deepest + 1):
        corner = (mesh.cells[cell][:, None, :] == front[:, :, None]).argmax(axis=2)
        side = CORNERS[corner]
        axis = (np.ptp(side, axis=1) == 0).argmax(axis=1)
        front = mesh.cells[cell[:, None], NEIGHBOURS[corner, axis[:, None]]]
        path[row, :, step] = front
        behind = next_to[cell, 2 * axis + 1 - side[np.arange(len(axis)), 0, axis]]
        row, front, cell = row[behind >= 0], front[behind >= 0], behind[behind >= 0]
    path = path.reshape(-1, deepest + 1)
    stop = (path < 0) | fixed[path]
    stop[:, -1] = True
    last = stop[:, 1:].argmax(axis=1) + 1
    last -= path[np.arange(len(path)), last] < 0  # the end of the mesh is one, too
    path[np.arange(deepest + 1) > last[:, None]] = -1
    path = path[(last > 1) & ~fixed[path[:, 0]]]
    return np.asarray(path[np.unique(path[:, :2], axis=0, return_index=True)[1]])


def _neighbours(cells: IntArray, part: BoolArray) -> IntArray:
    """(m, 6) cell of the part across each face of its cells, -1 where there is none."""
    chosen = np.flatnonzero(part)
    keys = face_keys(cells[chosen][:, FACES].reshape(-1, 4))
    order = np.argsort(keys)
    pairs = np.flatnonzero(np.diff(keys[order]) == 0)
    one, other = order[pairs], order[pairs + 1]
    across = np.full((len(cells), 6), -1, dtype=np.int64)
    across[chosen[one // 6], one % 6] = chosen[other // 6]
    across[chosen[other // 6], other % 6] = chosen[one // 6]
    return across


def _shares(quads: IntArray, starts: IntArray, count: int, fade: int) -> FloatArray:
    """(count,) by how much lines that start at nodes of the skin are drawn: less beside nodes without one."""
    away = np.zeros(count)
    away[starts] = fade
    for _ in range(fade):
        np.minimum.at(away, quads, away[quads].min(axis=1)[:, None] + 1.0)
    return away / fade
