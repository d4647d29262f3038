"""Local refinement of a mesh around zones, 2:1 balanced, with ties at the level changes."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from meshes.common import BoolArray, FloatArray, IntArray, MeshError
from meshes.hexmesh import EDGES, FACES, HexMesh, face_keys
from meshes.split import Forest, Snap, edge_keys
from meshes.zone import Cloud, Zone


def reach(size: FloatArray | float, level: int, finest: int, buffer: int = 2) -> FloatArray:
    """Distance from a zone of level `finest` up to which cells are split into `level`.

    Parameters
    ----------
    size : (m,) float64 or float, m
        Size of the cells to be split.
    level, finest : int
        Level of the cells after the split; level of the cells in the zone.
    buffer : int
        Whole cells kept between two level changes.

    Returns
    -------
    (m,) float64, m
    """
    made = 0.5 * np.asarray(size)
    return np.asarray((buffer + 1) * made * (2.0 - 2.0 ** (level - finest + 1)))


def refine(
    mesh: HexMesh,
    zones: Sequence[Zone | Cloud],
    snap: Snap | None = None,
    *,
    buffer: int = 2,
    frozen: BoolArray | None = None,
) -> HexMesh:
    """Split the cells in and around zones.

    Nodes and unsplit cells keep their numbers and order; new ones follow. A new node of a SKIN face whose
    cells are all split is moved onto the exact surface by `snap`; a hanging node lies on the coarse face
    with the weights of its tie, so that linear fields are continuous across the change of level.

    Parameters
    ----------
    mesh : HexMesh
        Unrefined.
    zones : sequence of Zone
        The first for level 1, the last for the finest: a cell that touches one is split to its level.
    snap : callable, optional
        See `meshes.split.Snap`.
    buffer : int
        Whole cells kept between two level changes.
    frozen : (m,) bool, optional
        Cells that must not be split.

    Raises
    ------
    MeshError
        If the mesh is refined already or a frozen cell would have to be split.
    """
    if mesh.level.any():
        raise MeshError("the mesh is refined already: refine the base mesh once, with all its levels")
    fixed = np.zeros(len(mesh.cells), np.bool_) if frozen is None else frozen
    forest = Forest.plant(mesh, snap, fixed)
    for level in range(1, len(zones) + 1):
        forest.split(_marks(forest, zones, level, buffer))
    hanging = _hanging_births(forest)
    hangs = np.zeros(len(forest.points), np.bool_)
    for nodes, _ in hanging:
        hangs[nodes] = True
    forest.place_all(hangs)
    outer = forest.tags >= 0
    tie = _tie_matrix(hangs, hanging)
    faces, tags = forest.cells[:, FACES][outer], forest.tags[outer]
    region = None if mesh.region is None else mesh.region[forest.root]
    return HexMesh(forest.points, forest.cells, forest.level.astype(np.int8), tie, faces, tags, region)


def _marks(forest: Forest, zones: Sequence[Zone | Cloud], level: int, buffer: int) -> BoolArray:
    """(m,) True for the leaves to split for one level, those for the 2:1 balance included."""
    corners = forest.points[forest.cells]
    diagonals = corners[:, [0, 1, 2, 3]] - corners[:, [6, 7, 4, 5]]
    size = np.linalg.norm(diagonals, axis=2).mean(axis=1) / np.sqrt(3.0)  # edge of a cube of that diagonal, m
    near = np.zeros(len(corners), np.bool_)
    for finest, zone in enumerate(zones[level - 1 :], level):
        near |= zone.gap(corners, 1e-6 * size) <= reach(size, level, finest, buffer)
    marked = _balanced(forest, near & (forest.level == level - 1))
    if np.any(marked & forest.frozen):
        where = corners[marked & forest.frozen].mean(axis=(0, 1))
        raise MeshError(
            f"refinement reaches cells that must stay whole, about {where.tolist()} m: "
            "take fewer levels, a smaller zone or a longer body"
        )
    return marked


def _balanced(forest: Forest, marked: BoolArray) -> BoolArray:
    """Extend the marks until no split leaves a neighbour (face, edge or corner) two levels coarser."""
    extended = np.concatenate([forest.cells, forest.known_mids()], axis=1)
    while True:
        split_level = np.full(len(forest.points) + 1, -1, np.int64)
        np.maximum.at(split_level, forest.cells[marked], forest.level[marked][:, None])
        split_level[-1] = -1
        grown = marked | (split_level[extended].max(axis=1) > forest.level)
        if (grown == marked).all():
            return marked
        marked = grown


def _hanging_births(forest: Forest) -> list[tuple[IntArray, IntArray]]:
    """Nodes that lie on an unsplit edge or face of a leaf, with the corners that they are tied to.

    Returns
    -------
    list of (nodes (k,), corners (k, 2 or 4)), one entry a batch of new nodes.
    """
    edges = np.unique(edge_keys(forest.cells[:, EDGES]))
    quads = np.unique(face_keys(forest.cells[:, FACES].reshape(-1, 4)))
    hanging = []
    for birth in forest.births:
        size = birth.corners.shape[1]
        if size == 8:
            continue
        keys = edge_keys(birth.corners) if size == 2 else face_keys(birth.corners)
        hangs = np.isin(keys, edges if size == 2 else quads)
        hanging.append((birth.nodes[hangs], birth.corners[hangs]))
    return hanging


def _tie_matrix(hangs: BoolArray, hanging: list[tuple[IntArray, IntArray]]) -> sp.csr_matrix:
    """Weights of every node in the free nodes: 1 of itself, or equal shares of the corners it is tied to.

    No corner is tied itself: it would lie on a cell two levels coarser than the finest cells around it,
    which the balance over faces, edges and corners excludes.

    Returns
    -------
    (n, n) csr_matrix, rows summing to 1
    """
    rows = [np.repeat(nodes, corners.shape[1]) for nodes, corners in hanging]
    cols = [corners.ravel() for _, corners in hanging]
    weights = [np.full(corners.size, 1.0 / corners.shape[1]) for _, corners in hanging]
    own = np.flatnonzero(~hangs)
    entries = np.concatenate([np.ones(len(own)), *weights])
    places = (np.concatenate([own, *rows]), np.concatenate([own, *cols]))
    return sp.csr_matrix(sp.coo_matrix((entries, places), shape=(len(hangs), len(hangs))))
