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
    parts : (n, n) each, K over the nodes as a sum that is never made, for it takes more memory than it holds
    spread : (n, n) P, displacements of nodes from those of masses
    """

    parts: tuple[sp.csr_matrix, ...]
    spread: sp.csr_matrix

    @property
    def shape(self) -> tuple[int, int]:
        """Return the number of rows and of columns."""
        return int(self.spread.shape[0]), int(self.spread.shape[1])

    def __matmul__(self, w: Array) -> Array:
        """Return the forces on masses that moved by ``w``, (n,) or (n, k)."""
        u = self.spread @ w
        return np.asarray(self.spread.T @ sum(part @ u for part in self.parts))

    def scaled(self, root: Array) -> sp.csc_matrix:
        """Return the matrix with rows and columns times ``root`` where that is not zero, in float32."""
        P = (self.spread[:, np.flatnonzero(root)] @ sp.diags(root[root != 0])).astype(np.float32)
        return sp.csc_matrix(sum(P.T @ (part.astype(np.float32) @ P) for part in self.parts))
