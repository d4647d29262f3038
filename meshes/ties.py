"""Ties of hanging nodes: exactly the interpolation of the coarse face they lie on."""

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from meshes.hexmesh import face_keys
from meshes.split import Forest, edge_keys
from meshes.topology import EDGES, FACES

__all__ = ["hanging_births", "tie_matrix"]

IntArray = npt.NDArray[np.int64]


def hanging_births(forest: Forest) -> list[tuple[IntArray, IntArray]]:
    """Nodes that lie on a whole edge or face of a leaf, with the corners they follow.

    Returns
    -------
    list of (nodes (k,), corners (k, 2 or 4)), one entry a batch of new nodes.
    """
    edges = np.unique(edge_keys(forest.cells[:, EDGES]))
    quads = np.unique(face_keys(forest.cells[:, FACES].reshape(-1, 4)))
    found = []
    for birth in forest.births:
        size = birth.corners.shape[1]
        if size == 8:
            continue
        keys = edge_keys(birth.corners) if size == 2 else face_keys(birth.corners)
        hangs = np.isin(keys, edges if size == 2 else quads)
        found.append((birth.nodes[hangs], birth.corners[hangs]))
    return found


def tie_matrix(count: int, hanging: list[tuple[IntArray, IntArray]]) -> sp.csr_matrix:
    """Weights of every node in the free nodes.

    There is no tie of a tie: a master that hung itself would lie on a cell two levels coarser than the
    finest cells around it, which the balance over faces, edges and corners excludes.

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
