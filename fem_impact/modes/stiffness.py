"""The stiffness of the rod over its masses, which do not stand at the nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MassStiffness:
    """P^T K P, N/m. Its factors alone are kept: multiplied out, P fills the slices and doubles the memory.

    Attributes
    ----------
    nodes : (n, n) K over the nodes, N/m
    spread : (n, n) P, displacements of nodes from those of masses
    """

    nodes: sp.csr_matrix
    spread: sp.csr_matrix

    @property
    def shape(self) -> tuple[int, int]:
        """Return the number of rows and of columns."""
        return int(self.nodes.shape[0]), int(self.nodes.shape[1])

    def __matmul__(self, w: Array) -> Array:
        """Return the forces on masses that moved by ``w``, (n,) or (n, k)."""
        return np.asarray(self.spread.T @ (self.nodes @ (self.spread @ w)))

    def scaled(self, root: Array) -> sp.csc_matrix:
        """Return the matrix with rows and columns times ``root`` where that is not zero, in float32."""
        P = (self.spread[:, np.flatnonzero(root)] @ sp.diags(root[root != 0])).astype(np.float32)
        return sp.csc_matrix(P.T @ (self.nodes.astype(np.float32) @ P))
