"""Sparse operators over the free unknowns: assembly with hanging nodes, and compiled products."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array, Ints
from fem_impact.fem.elements import Kind, element_stiffness
from fem_impact.fem.kernels import Counts, inlined, kernel
from fem_impact.fem.vectors import add_product, load, spread, store, sum_of_three

CHUNK = 500  # elements assembled at once: their entries take a few MB
# differences, over the largest number, below which stiffness blocks and node positions count as equal
ROUNDING, PLACES = 1e-13, 1e-12


def tie_operator(tie: sp.csr_matrix, places: Ints, size: int) -> sp.csr_matrix:
    """Return T (3 n, size): values of all mesh nodes (node * 3 + component) from the flat free vector."""
    coo = tie.tocoo()
    rows = (coo.row[:, None] * 3 + np.arange(3)).ravel()
    columns = places[coo.col].ravel()
    return sp.csr_matrix((np.repeat(coo.data, 3), (rows, columns)), shape=(3 * tie.shape[0], size))


def distinct(rows: Array, rounding: float) -> tuple[Ints, Ints]:
    """Return the number (m,) of each row (m, k) among the distinct rows, and the first index of each.

    Distinct rows are numbered in their order. Rows are equal that differ by less than ``rounding`` times the
    largest number.
    """
    unit = rounding * float(np.abs(rows).max(initial=1e-300))
    rounded = np.ascontiguousarray(np.round(rows / unit)) + 0.0
    # each row as one item of bytes, which sorts far faster
    items = rounded.view(np.dtype((np.void, rounded.itemsize * rounded.shape[1]))).ravel()
    _, first, number = np.unique(items, return_index=True, return_inverse=True)
    order = np.argsort(first)
    return np.argsort(order)[number], first[order]


def element_batches(
    points: Array, cells: Ints, lame: tuple[float, float], kind: Kind
) -> Iterator[tuple[Ints, Array]]:
    """Yield cells (k, 8) and their matrices (k, 24, 24), N/m, as in `element_stiffness`, for all cells.

    The matrix of cells that are translates of each other is computed once.
    """
    corners = points[cells]
    shape, first = distinct((corners - corners[:, :1]).reshape(-1, 24), PLACES)
    for start in range(0, len(first), CHUNK):
        matrices = element_stiffness(points, cells[first[start : start + CHUNK]], lame, kind)
        alike = np.flatnonzero((shape >= start) & (shape < start + CHUNK))
        for some in np.split(alike, range(CHUNK, len(alike), CHUNK)):
            yield cells[some], matrices[shape[some] - start]


def assemble(
    points: Array, cells: Ints, lame: tuple[float, float], kind: Kind, T: sp.csr_matrix
) -> sp.csr_matrix:
    """Return the assembled T^T K T (size, size), N/m, of elements as in `element_stiffness`.

    The element matrices together are far larger than their sum and are never stored all at once.
    """
    total = sp.csr_matrix((T.shape[1], T.shape[1]))
    for some, K in element_batches(points, cells, lame, kind):
        dof = (some[:, :, None] * 3 + np.arange(3)).reshape(len(some), 24).astype(np.int32)
        rows, columns = np.repeat(dof, 24, axis=1).ravel(), np.tile(dof, (1, 24)).ravel()
        part = sp.csr_matrix((K.ravel(), (rows, columns)), shape=(T.shape[0], T.shape[0]))
        total = total + T.T @ part @ T
    return sp.csr_matrix(total)


def assemble_mass(mass: Array, cells: Ints, T: sp.csr_matrix) -> Array:
    """Return the lumped masses (size,) of element nodal masses (m, 8): row sums of T^T M T."""
    nodal = np.bincount(cells.ravel(), weights=mass.ravel(), minlength=T.shape[0] // 3)
    return np.asarray(T.T @ np.repeat(nodal, 3))


@dataclass(slots=True)
class NodeProduct:
    """A symmetric sparse stiffness in 3 x 3 blocks between the nodes it touches, each pair stored once.

    Attributes
    ----------
    places : (k, 3), unknowns of the nodes; unsigned, so that numba does not test for negative indices
    start, columns : (k + 1,), (entries,) compressed rows over nodes, each from its diagonal on
    kinds : (entries,) number of each entry's block; blocks : (kinds + 1, 9), N/m, row-major, the last of
        zeros. Equal cells have equal blocks, so a regular mesh reads few numbers from memory
    origin : (k, 3) positions of the nodes without force, m
    moved, product : (k, 4) displacements, m, and forces, N, of the nodes; the fourth column is padding
    """

    places: Counts
    origin: Array
    start: Ints
    columns: Counts
    kinds: Counts
    blocks: Array
    moved: Array
    product: Array

    @classmethod
    def of(cls, matrix: sp.csr_matrix, places: Ints, origin: Array | None = None) -> "NodeProduct":
        """Build from a stiffness (size, size), N/m, and the unknowns (n, 3) of the free nodes.

        Nodes whose rows are empty are left out. ``origin`` (size,), m: positions without force (default 0).
        """
        filled = np.diff(matrix.indptr) > 0
        used = places[filled[places].any(axis=1)]
        order = used.ravel()
        small = matrix[order][:, order].tobsr((3, 3))
        small.sort_indices()
        rows = np.repeat(np.arange(len(used)), np.diff(small.indptr))
        upper = small.indices >= rows
        blocks = small.data[upper].reshape(-1, 9)
        kinds, first = distinct(blocks, ROUNDING)
        start = np.concatenate([[0], np.cumsum(np.bincount(rows[upper], minlength=len(used)))])
        columns, room = small.indices[upper].astype(np.uint32), np.zeros((2, len(used), 4))
        blocks = np.concatenate([blocks[first], np.zeros((1, 9))])
        zero = np.zeros(used.shape) if origin is None else origin[used]
        numbers = start.astype(np.int64), columns, kinds.astype(np.uint32)
        return cls(used.astype(np.uint32), zero, *numbers, blocks, *room)

    def multiply(self, x: Array) -> None:
        """Set ``product``, N, to the stiffness times (``x`` - origin), m."""
        rows = self.start, self.columns, self.kinds, self.blocks
        multiply_nodes(self.places, self.origin, x, *rows, self.moved, self.product)

    def add_to(self, y: Array, share: float = 1.0) -> None:
        """Add a share of the product to ``y``."""
        add_nodes(self.places, share, self.product, y)

    @property
    def energy(self) -> float:
        """Return the strain energy, J, at the last product."""
        return 0.5 * float((self.moved[:, :3] * self.product[:, :3]).sum())


@inlined
def _add_row(columns, kinds, blocks, d, f, i):  # type: ignore[no-untyped-def]
    """Add the product with row i, given by its entries, and with the transpose of its off-diagonal blocks.

    The rows k, l, m of a block and a node's values are loaded as four numbers; the fourth is padding.
    """
    own, p = load(d, 4 * i), 9 * kinds[0]
    t, b, n = spread(d[i, 0]), spread(d[i, 1]), spread(d[i, 2])
    sum_t, sum_b, sum_n = spread(0.0), spread(0.0), spread(0.0)
    sum_t = add_product(sum_t, load(blocks, p), own)
    sum_b = add_product(sum_b, load(blocks, p + 3), own)
    sum_n = add_product(sum_n, load(blocks, p + 6), own)
    for entry in range(1, len(columns)):
        j, p = 4 * columns[entry], 9 * kinds[entry]
        k, l, m, other = load(blocks, p), load(blocks, p + 3), load(blocks, p + 6), load(d, j)
        sum_t = add_product(sum_t, k, other)
        sum_b = add_product(sum_b, l, other)
        sum_n = add_product(sum_n, m, other)
        store(f, j, add_product(add_product(add_product(load(f, j), k, t), l, b), m, n))
    f[i, 0] += sum_of_three(sum_t)
    f[i, 1] += sum_of_three(sum_b)
    f[i, 2] += sum_of_three(sum_n)


@kernel
def multiply_nodes(places, origin, x, start, columns, kinds, blocks, d, f):  # type: ignore[no-untyped-def]
    """Set d, m, to the node values less their origin and f, N, to the block-sparse product with d."""
    for i in range(len(places)):
        for c in range(3):
            d[i, c] = x[places[i, c]] - origin[i, c]
    f[:] = 0.0
    for i in range(len(d)):
        first, last = start[i], start[i + 1]
        _add_row(columns[first:last], kinds[first:last], blocks, d, f, i)


@kernel
def add_nodes(places, share, f, y):  # type: ignore[no-untyped-def]
    """Add ``share`` times the nodes' values ``f`` (k, 4) to the flat vector ``y``."""
    for i in range(len(places)):
        for c in range(3):
            y[places[i, c]] += share * f[i, c]


@dataclass(frozen=True, slots=True)
class Hanging:
    """Constraints of hanging nodes: their values from their masters, their forces to their masters.

    Both ways use the same weights, so the tie does no work: (T v) . f = v . (T^T f).

    Attributes
    ----------
    slaves : (k, 3), unknowns of the hanging nodes
    start, masters, weights : (k + 1,), (entries, 3), (entries,) compressed rows over them
    """

    slaves: Counts
    start: Ints
    masters: Counts
    weights: Array

    @classmethod
    def of(cls, parts: list[tuple[sp.csr_matrix, Ints]]) -> "Hanging":
        """Build from the meshes' (tie, unknowns (n, 3) of all nodes)."""
        slaves, counts, masters, weights = [], [], [], []
        for tie, places in parts:
            hanging = np.flatnonzero(tie.diagonal() == 0)
            rows = tie[hanging]
            slaves.append(places[hanging].astype(np.uint32))
            counts.append(np.diff(rows.indptr))
            masters.append(places[rows.indices].astype(np.uint32))
            weights.append(rows.data)
        start = np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int64)
        return cls(np.concatenate(slaves), start, np.concatenate(masters), np.concatenate(weights))

    def expand(self, x: Array) -> None:
        """Set the hanging values of ``x``."""
        expand_ties(self.slaves, self.start, self.masters, self.weights, x)

    def collect(self, force: Array) -> None:
        """Add the forces of hanging nodes to their masters' and set them to zero."""
        gather_ties(self.slaves, self.start, self.masters, self.weights, force)


@kernel
def expand_ties(slaves, start, masters, weights, x):  # type: ignore[no-untyped-def]
    """Set the values of hanging nodes to the weighted sums of their masters'."""
    for i in range(len(slaves)):
        t, b, n = 0.0, 0.0, 0.0
        for p in range(start[i], start[i + 1]):
            t += weights[p] * x[masters[p, 0]]
            b += weights[p] * x[masters[p, 1]]
            n += weights[p] * x[masters[p, 2]]
        x[slaves[i, 0]], x[slaves[i, 1]], x[slaves[i, 2]] = t, b, n


@kernel
def gather_ties(slaves, start, masters, weights, force):  # type: ignore[no-untyped-def]
    """Add the forces of hanging nodes to their masters' and set them to zero."""
    for i in range(len(slaves)):
        t, b, n = force[slaves[i, 0]], force[slaves[i, 1]], force[slaves[i, 2]]
        for p in range(start[i], start[i + 1]):
            force[masters[p, 0]] += weights[p] * t
            force[masters[p, 1]] += weights[p] * b
            force[masters[p, 2]] += weights[p] * n
        force[slaves[i, 0]], force[slaves[i, 1]], force[slaves[i, 2]] = 0.0, 0.0, 0.0
