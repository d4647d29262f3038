"""One section operator for a body of identical slices, applied as a banded stencil along the rod.

A slice couples its lower and upper section nodes through A = [[A11, A12], [A21, A22]]. Every interior
layer therefore has A21 to the layer below, A11 + A22 on itself and A12 to the layer above. These three blocks
are the same for all layers and stored once.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array, Ints
from fem_impact.fem.kernels import inlined, kernel
from meshes import RodMesh


@dataclass(frozen=True, slots=True)
class SliceOperator:
    """Stiffness of the slices, N/m, in compressed rows over (component, section node).

    ``below``, ``own`` and ``above`` (entries,) couple an inner layer to the layer below, to itself and to the
    layer above. The end layers have ``lower`` (first) or ``upper`` (last) instead of their sum ``own``.
    """

    start: Ints
    columns: Ints
    below: Array
    lower: Array
    upper: Array
    above: Array
    own: Array

    def apply(self, d: Array, y: Array) -> None:
        """Set ``y``, N, to the product with ``d``, m, both (rows, layers)."""
        ends = self.lower, self.upper
        apply_slices(self.start, self.columns, self.below, self.own, self.above, ends, d, y)

    @classmethod
    def none(cls) -> "SliceOperator":
        """Return the operator of a body without slices."""
        empty = np.zeros(0)
        start, columns = np.zeros(1, np.int64), np.zeros(0, np.int64)
        return cls(start, columns, empty, empty, empty, empty, empty)

    @classmethod
    def of_rod(cls, rod: RodMesh, K: Array) -> "SliceOperator":
        """Build from a rod's mesh with slices and the element matrices (m, 24, 24) of its first slice."""
        section = np.full(len(rod.mesh.points), -1)
        section[rod.body_nodes[:, :2].T] = np.arange(len(rod.body_nodes))
        first = rod.mesh.cells[rod.body_cells[:, 0]]
        return cls.of(K, section[first[:, :4]], section[first[:, 4:]])

    @classmethod
    def of(cls, K: Array, lower_nodes: Ints, upper_nodes: Ints) -> "SliceOperator":
        """Build from the element matrices (m, 24, 24) of one slice.

        ``lower_nodes`` and ``upper_nodes`` are (m, 4): section numbers of each cell's two quads, so
        that the element's nodes are the lower four, then the upper four, in VTK order.
        """
        n = int(lower_nodes.max()) + 1
        low_place, up_place = _places(lower_nodes, n), _places(upper_nodes, n)
        # element unknowns node-major -> component-major, split into the two layers
        order = np.arange(24).reshape(8, 3).T
        low, up = order[:, :4].ravel(), order[:, 4:].ravel()
        parts = {
            "lower": _gather(K, low, low, low_place, low_place, 3 * n),
            "upper": _gather(K, up, up, up_place, up_place, 3 * n),
            "above": _gather(K, low, up, low_place, up_place, 3 * n),
            "below": _gather(K, up, low, up_place, low_place, 3 * n),
        }
        rows, columns = sum(abs(sp.csr_matrix(p)) for p in parts.values()).nonzero()
        start, rows, columns = _in_threes(rows, columns, 3 * n)
        values = {k: np.asarray(p[rows, columns]).ravel() for k, p in parts.items()}
        return cls(start, columns, **values, own=values["lower"] + values["upper"])


def _in_threes(rows: Ints, columns: Ints, size: int) -> tuple[Ints, Ints, Ints]:
    """Return starts, rows and columns of the pattern with each row's length padded to a multiple of three.

    The added entries are at columns that the row does not have; their values are zero.
    """
    full = [columns[rows == i] for i in range(size)]
    padding = [np.setdiff1d(np.arange(size), row)[: -len(row) % 3] for row in full]
    full = [np.sort(np.concatenate(pair)) for pair in zip(full, padding, strict=True)]
    counts = [len(row) for row in full]
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    return start, np.repeat(np.arange(size), counts), np.concatenate(full).astype(np.int64)


def _places(nodes: Ints, n: int) -> Ints:
    """Return the component-major unknowns (m, 12) of quads ``nodes`` (m, 4) of a section with ``n`` nodes."""
    return np.concatenate([nodes + component * n for component in range(3)], axis=1)


def _gather(K: Array, rows: Ints, cols: Ints, row_place: Ints, col_place: Ints, size: int) -> sp.csr_matrix:
    """Return the sum (size, size) of the element blocks K[:, rows, cols] at the given places."""
    block = K[:, rows][:, :, cols]
    i = np.repeat(row_place, len(cols), axis=1).ravel()
    j = np.tile(col_place, (1, len(rows))).ravel()
    return sp.csr_matrix((block.ravel(), (i, j)), shape=(size, size))


@inlined
def _add_inner(out, p, own, above, below, a, b, c):  # type: ignore[no-untyped-def]
    """Add three entries' contributions to all inner layers: one pass over the sums instead of three."""
    own_a, own_b, own_c = own[p], own[p + 1], own[p + 2]
    above_a, above_b, above_c = above[p], above[p + 1], above[p + 2]
    below_a, below_b, below_c = below[p], below[p + 1], below[p + 2]
    for k in range(1, len(out) - 1):
        first = own_a * a[k] + above_a * a[k + 1] + below_a * a[k - 1]
        second = own_b * b[k] + above_b * b[k + 1] + below_b * b[k - 1]
        third = own_c * c[k] + above_c * c[k + 1] + below_c * c[k - 1]
        out[k] += first + second + third


@kernel
def apply_slices(start, columns, below, own, above, ends, d, y):  # type: ignore[no-untyped-def]
    """Set y (rows, layers), N, to the slice operator times d, m; the end layers belong to one slice only."""
    last = d.shape[1] - 1
    lower, upper = ends
    for i in range(len(start) - 1):
        out = y[i]
        out[:] = 0.0
        for p in range(start[i], start[i + 1], 3):
            _add_inner(out, p, own, above, below, d[columns[p]], d[columns[p + 1]], d[columns[p + 2]])
        for p in range(start[i], start[i + 1]):
            row = d[columns[p]]
            out[0] += lower[p] * row[0] + above[p] * row[1]
            out[last] += upper[p] * row[last] + below[p] * row[last - 1]
