"""A contact surface: quadrilaterals, their neighbours, and the nodes they use."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


class Patch(NamedTuple):
    """Part of a skin that may touch (a named tuple, so that compiled code reads it by name).

    Attributes
    ----------
    places : (k, 3) int64, unknowns of the patch nodes
    quads : (m, 4) int64, patch node numbers, all turning the same way seen from above the barrier
    neighbours : (m, 4) int64, quad across edge i -> i + 1, or -1 at the border
    mirrored : (k,) bool, nodes on the symmetry plane
    """

    places: Ints
    quads: Ints
    neighbours: Ints
    mirrored: NDArray[np.bool_]


def make_patch(quads: Ints, places: Ints, points: Array) -> Patch:
    """Build from skin quads (m, 4) of a mesh with node ``places`` (n, 3) and ``points`` (n, 3)."""
    used, local = np.unique(quads, return_inverse=True)
    numbers = np.ascontiguousarray(local.reshape(-1, 4), dtype=np.int64)
    return Patch(places[used], numbers, edge_neighbours(numbers), np.abs(points[used, 1]) < 1e-12)


def edge_neighbours(quads: Ints) -> Ints:
    """Return (m, 4) the quad on the other side of each edge, -1 where there is none."""
    edges = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    key = np.sort(edges, axis=1) @ np.array([quads.max() + 1, 1])
    order = np.argsort(key, kind="stable")
    pairs = np.flatnonzero(np.diff(key[order]) == 0)
    result = np.full(len(key), -1, dtype=np.int64)
    first, second = order[pairs], order[pairs + 1]
    result[first], result[second] = second // 4, first // 4
    return result.reshape(-1, 4)


def nearest_quads(x: Array, patch: Patch, other: Patch) -> Ints:
    """Return for each node of ``patch`` the quad of ``other`` with the nearest centre in (t, b)."""
    centres = x[other.places[other.quads]][:, :, :2].mean(axis=1)
    nodes = x[patch.places][:, :2]
    return np.array([int(np.argmin(((centres - p) ** 2).sum(axis=1))) for p in nodes], dtype=np.int64)
