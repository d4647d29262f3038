"""A contact surface: quadrilaterals, their neighbours, and the nodes they use."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.contact.search import vertex_normals

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


# a node is on an edge, not on a rounding, where a quad leans more than this from the mean of those around
EDGE = np.cos(np.radians(30.0))
STEEP = 0.1  # a normal that rises less is that of a side: no such quad takes part, and no such node is bent


class Patch(NamedTuple):
    """Part of a skin that may touch (a named tuple, so that compiled code reads it by name).

    Attributes
    ----------
    places : (k, 3) int64, unknowns of the patch nodes
    quads : (m, 4) int64, patch node numbers, all turning the same way seen from above the barrier
    neighbours : (m, 4) int64, quad across edge i -> i + 1, or -1 at the border
    mirrored : (k,) bool, nodes on the symmetry plane
    bend : (k,) share of the slope at a node that bends the quads around it: 0 leaves them flat, with 1/2 they
        follow a round surface to third order (Boubekeur and Alexa 2008, ACM Trans. Graph. 27(5), 141)
    sag : how far bent quads may reach beyond their nodes, m
    """

    places: Ints
    quads: Ints
    neighbours: Ints
    mirrored: NDArray[np.bool_]
    bend: Array
    sag: float

    def rounded(self, x: Array) -> Patch:
        """Return the patch with its quads bent to a round surface at positions ``x``, save at edges."""
        around = np.zeros((len(self.places), 3))
        vertex_normals(x, self.places, self.quads, self.mirrored, around)
        corners = x[self.places[self.quads]]
        flat = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        flat /= np.linalg.norm(flat, axis=1)[:, None]
        least = np.ones(len(around))
        np.minimum.at(least, self.quads, np.einsum("qi,qai->qa", flat, around[self.quads]))
        bend = np.where((least > EDGE) & (around[:, 2] > STEEP), 0.5, 0.0)
        return self._replace(bend=bend, sag=_sag(corners, around[self.quads], bend[self.quads]))


def make_patch(quads: Ints, places: Ints, points: Array) -> Patch:
    """Build from skin quads (m, 4) of a mesh with node ``places`` (n, 3) and ``points`` (n, 3)."""
    used, local = np.unique(quads, return_inverse=True)
    numbers = np.ascontiguousarray(local.reshape(-1, 4), dtype=np.int64)
    mirrored, flat = np.abs(points[used, 1]) < 1e-12, np.zeros(len(used))
    return Patch(places[used], numbers, edge_neighbours(numbers), mirrored, flat, 0.0)


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


def _sag(corners: Array, normals: Array, bend: Array) -> float:
    """Return half of what bending adds at other corners, at most: above the rise of an arc over its chord."""
    apart = corners[:, None, :, :] - corners[:, :, None, :]
    share = np.divide(bend, normals[:, :, 2], out=np.zeros_like(bend), where=bend > 0)
    return float(0.5 * np.max(share[:, :, None] * np.abs(np.einsum("qabi,qai->qab", apart, normals))))


def nearest_quads(x: Array, patch: Patch, other: Patch) -> Ints:
    """Return for each node of ``patch`` the quad of ``other`` with the nearest centre in (t, b)."""
    centres = x[other.places[other.quads]][:, :, :2].mean(axis=1)
    nodes = x[patch.places][:, :2]
    return np.array([int(np.argmin(((centres - p) ** 2).sum(axis=1))) for p in nodes], dtype=np.int64)
