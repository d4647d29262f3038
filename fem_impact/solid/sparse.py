"""Sparse operators over free unknowns: assembly through ties, and the compiled product."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem_impact.solid.kernels import kernel

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


def tie_operator(tie: sp.csr_matrix, places: Ints, size: int) -> sp.csr_matrix:
    """Return T (3 n, size): values of all mesh nodes (node * 3 + component) from the flat free vector."""
    coo = tie.tocoo()
    rows = (coo.row[:, None] * 3 + np.arange(3)).ravel()
    columns = places[coo.col].ravel()
    return sp.csr_matrix((np.repeat(coo.data, 3), (rows, columns)), shape=(3 * tie.shape[0], size))


def _element_places(cells: Ints) -> Ints:
    return (cells[:, :, None] * 3 + np.arange(3)).reshape(len(cells), 24)


def assemble(K: Array, cells: Ints, T: sp.csr_matrix) -> sp.csr_matrix:
    """Return the assembled T^T K T (size, size) of element matrices (m, 24, 24)."""
    dof = _element_places(cells)
    rows, columns = np.repeat(dof, 24, axis=1).ravel(), np.tile(dof, (1, 24)).ravel()
    full = sp.csr_matrix((K.ravel(), (rows, columns)), shape=(T.shape[0], T.shape[0]))
    return sp.csr_matrix(T.T @ full @ T)


def assemble_mass(mass: Array, cells: Ints, T: sp.csr_matrix) -> Array:
    """Return the lumped masses (size,) of element nodal masses (m, 8): row sums of T^T M T."""
    nodal = np.bincount(cells.ravel(), weights=mass.ravel(), minlength=T.shape[0] // 3)
    return np.asarray(T.T @ np.repeat(nodal, 3))


@dataclass(frozen=True, slots=True)
class RowProduct:
    """The non-empty rows of a sparse matrix, ready for ``y[rows] += A x``."""

    rows: Ints
    start: Ints
    columns: NDArray[np.int32]
    values: Array

    @classmethod
    def of(cls, matrix: sp.csr_matrix) -> RowProduct:
        """Keep the rows that hold anything."""
        matrix.eliminate_zeros()
        rows = np.flatnonzero(np.diff(matrix.indptr)).astype(np.int64)
        start = np.concatenate([matrix.indptr[rows], matrix.indptr[-1:]]).astype(np.int64)
        return cls(rows, start, matrix.indices.astype(np.int32), matrix.data)

    def add_to(self, x: Array, y: Array) -> None:
        """Add the product with ``x`` to ``y``."""
        add_product(self.rows, self.start, self.columns, self.values, x, y)


@kernel
def add_product(rows, start, columns, values, x, y):  # type: ignore[no-untyped-def]
    """Add a sparse product row by row."""
    for i in range(len(rows)):
        total = 0.0
        for p in range(start[i], start[i + 1]):
            total += values[p] * x[columns[p]]
        y[rows[i]] += total


@dataclass(frozen=True, slots=True)
class Hanging:
    """Values of hanging unknowns from their masters, and their forces back to them.

    Both ways use the same weights, so the tie does no work: (T v) . f = v . (T^T f).
    """

    slaves: Ints
    start: Ints
    masters: Ints
    weights: Array

    @classmethod
    def of(cls, parts: list[tuple[sp.csr_matrix, Ints]]) -> Hanging:
        """Collect the ties of meshes given as (tie, places of nodes)."""
        slaves, counts, masters, weights = [], [], [], []
        for tie, places in parts:
            hung = np.flatnonzero(tie.diagonal() == 0)
            for component in range(3):
                rows = tie[hung]
                slaves.append(places[hung, component])
                counts.append(np.diff(rows.indptr))
                masters.append(places[rows.indices, component])
                weights.append(rows.data)
        start = np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int64)
        return cls(np.concatenate(slaves), start, np.concatenate(masters), np.concatenate(weights))

    def expand(self, x: Array) -> None:
        """Set the hanging values of ``x``."""
        _expand(self.slaves, self.start, self.masters, self.weights, x)

    def collect(self, force: Array) -> None:
        """Hand the hanging forces to the masters and clear them."""
        _collect(self.slaves, self.start, self.masters, self.weights, force)


@kernel
def _expand(slaves, start, masters, weights, x):  # type: ignore[no-untyped-def]
    for i in range(len(slaves)):
        value = 0.0
        for p in range(start[i], start[i + 1]):
            value += weights[p] * x[masters[p]]
        x[slaves[i]] = value


@kernel
def _collect(slaves, start, masters, weights, force):  # type: ignore[no-untyped-def]
    for i in range(len(slaves)):
        value = force[slaves[i]]
        for p in range(start[i], start[i + 1]):
            force[masters[p]] += weights[p] * value
        force[slaves[i]] = 0.0
