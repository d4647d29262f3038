"""The largest stable step of an assembled body, and how it shrinks with a deforming element."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, eigsh

from fem_impact.modes import MassStiffness
from fem_impact.solid.hexmodes import CORNERS, reference_gradients
from fem_impact.solid.kernels import allocating_kernel

Array = NDArray[np.float64]

SAFETY = 0.9  # of the stable step
ACCURACY = 1e-3  # of the largest eigenvalue; it lies far inside the safety factor
REFERENCE = np.ascontiguousarray(reference_gradients(CORNERS))


def stable_step(K: sp.csr_matrix | MassStiffness, inverse_mass: Array, share: float = SAFETY) -> float:
    """Return a share of the step, s, at which leapfrog becomes unstable: 2 over the largest frequency.

    Parameters
    ----------
    K : (n, n) stiffness, N/m
    inverse_mass : (n,), 1/kg, 0 where nothing moves

    Notes
    -----
    The largest frequency is that of the assembly (Lanczos). The bound of the single elements is up to
    1.5 times higher here, because its modes do not fit together in neighbouring elements.
    """
    root = np.sqrt(inverse_mass)
    scaled = LinearOperator(K.shape, matvec=lambda u: root * (K @ (root * u)), dtype=np.float64)
    start = np.random.default_rng(0).normal(size=K.shape[0]) * root
    largest = eigsh(scaled, k=1, which="LA", v0=start, tol=ACCURACY, return_eigenvectors=False)[0]
    return float(share * 2.0 / np.sqrt(largest))


def gradient_squares(x: Array, places: NDArray[np.int64]) -> Array:
    """Return max over Gauss points of sum |grad N|^2 (m,), 1/m2, of elements (m, 8, 3); nan if folded.

    An element's largest frequency grows like the square root of this number.
    """
    squares = np.empty(len(places))
    _gradient_squares(x, places, REFERENCE, squares)
    return squares


@allocating_kernel
def _gradient_squares(x, places, reference, squares):  # type: ignore[no-untyped-def]
    J, C = np.empty((3, 3)), np.empty((3, 3))
    for e in range(len(places)):
        squares[e] = 0.0
        for q in range(8):
            J[:] = 0.0
            for a in range(8):
                for i in range(3):
                    value = x[places[e, a, i]]
                    for j in range(3):
                        J[i, j] += value * reference[q, a, j]
            for i in range(3):
                m, n = (i + 1) % 3, (i + 2) % 3
                for j in range(3):
                    k, l = (j + 1) % 3, (j + 2) % 3
                    C[i, j] = J[m, k] * J[n, l] - J[m, l] * J[n, k]
            det = J[0, 0] * C[0, 0] + J[0, 1] * C[0, 1] + J[0, 2] * C[0, 2]
            total = 0.0
            for a in range(8):
                for i in range(3):
                    g = C[i, 0] * reference[q, a, 0] + C[i, 1] * reference[q, a, 1]
                    g += C[i, 2] * reference[q, a, 2]
                    total += g * g
            squares[e] = max(squares[e], total / (det * det)) if det > 0.0 else np.nan
            if not det > 0.0:
                break
