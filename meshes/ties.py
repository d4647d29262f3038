"""Ties of hanging nodes: the interpolation of the coarse edge or face on which they lie."""

import numpy as np
import scipy.sparse as sp

from meshes.arrays import IntArray
from meshes.hexmesh import face_keys
from meshes.split import Forest, edge_keys
from meshes.topology import EDGES, FACES

__all__ = ["hanging_births", "tie_matrix"]


def hanging_births(forest: Forest) -> list[tuple[IntArray, IntArray]]:
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


def tie_matrix(count: int, hanging: list[tuple[IntArray, IntArray]]) -> sp.csr_matrix:
    """Weights of every node in the free nodes: 1 of itself, or equal shares of the corners it is tied to.

    No corner is tied itself: it would lie on a cell two levels coarser than the finest cells around it,
    which the balance over faces, edges and corners excludes.

    Returns
    -------
    (count, count) csr_matrix, rows summing to 1
    """
    rows = [np.repeat(nodes, corners.shape[1]) for nodes, corners in hanging]
    cols = [corners.ravel() for _, corners in hanging]
    weights = [np.full(corners.size, 1.0 / corners.shape[1]) for _, corners in hanging]
    free = np.ones(count, np.bool_)
    for nodes, _ in hanging:
        free[nodes] = False
    own = np.flatnonzero(free)
    entries = np.concatenate([np.ones(len(own)), *weights])
    places = (np.concatenate([own, *rows]), np.concatenate([own, *cols]))
    return sp.csr_matrix(sp.coo_matrix((entries, places), shape=(count, count)))
