"""The stable step of an assembled body, and a measure of how a deforming element lowers it."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigsh

from fem_impact.arrays import Array, Ints
from fem_impact.fem.eigen import MassStiffness
from fem_impact.fem.hexmodes import CORNERS, cofactors, reference_gradients
from fem_impact.fem.kernels import kernel

SAFETY = 0.9  # of the stable step
ACCURACY = 1e-3  # relative, of the largest eigenvalue: much smaller than the safety margin
REFERENCE = np.ascontiguousarray(reference_gradients(CORNERS))
GRAM = np.einsum("qai,qaj->qij", REFERENCE, REFERENCE)


def stable_step(K: sp.csr_matrix | MassStiffness, inverse_mass: Array, share: float = SAFETY) -> float:
    """Return a share of the step, s, at which leapfrog becomes unstable: 2 over the largest frequency.

    Parameters
    ----------
    K : (n, n) stiffness, N/m
    inverse_mass : (n,), 1/kg, 0 where nothing moves

    Notes
    -----
    The largest frequency is that of the assembly (Lanczos). The largest of the single elements is an upper
    bound, here up to 1.5 times higher, because the modes of neighbouring elements do not fit together.
    """
    root = np.sqrt(inverse_mass)
    scaled = LinearOperator(K.shape, matvec=lambda u: root * (K @ (root * u)), dtype=np.float64)
    start = np.random.default_rng(0).normal(size=K.shape[0]) * root
    largest = eigsh(scaled, k=1, which="LA", v0=start, tol=ACCURACY, return_eigenvectors=False)[0]
    return float(share * 2.0 / np.sqrt(largest))


def gradient_squares(x: Array, places: Ints) -> Array:
    """Return the largest sum |grad N|^2 (m,), 1/m2, over an element's Gauss points; nan if it is folded.

    ``x`` (size,), m, are the positions, ``places`` (m, 8, 3) the unknowns of the elements' nodes.

    An element's largest frequency grows like the square root of this number.
    """
    squares = np.empty(len(places))
    _gradient_squares(x, places, REFERENCE, GRAM, squares)
    return squares


@kernel
def _gradient_squares(x, places, reference, gram, squares):  # type: ignore[no-untyped-def]
    for e in range(len(places)):
        p, worst = places[e], 0.0
        for q in range(8):
            j00, j01, j02, j10, j11, j12, j20, j21, j22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for a in range(8):
                X, Y, Z = reference[q, a, 0], reference[q, a, 1], reference[q, a, 2]
                t, b, n = x[p[a, 0]], x[p[a, 1]], x[p[a, 2]]
                j00, j01, j02 = j00 + t * X, j01 + t * Y, j02 + t * Z
                j10, j11, j12 = j10 + b * X, j11 + b * Y, j12 + b * Z
                j20, j21, j22 = j20 + n * X, j21 + n * Y, j22 + n * Z
            c = cofactors(j00, j01, j02, j10, j11, j12, j20, j21, j22)
            det = j00 * c[0] + j01 * c[1] + j02 * c[2]
            total = 0.0
            for i in range(3):
                k, l, m = c[3 * i], c[3 * i + 1], c[3 * i + 2]
                total += gram[q, 0, 0] * k * k + gram[q, 1, 1] * l * l + gram[q, 2, 2] * m * m
                total += 2.0 * (gram[q, 0, 1] * k * l + gram[q, 1, 2] * l * m + gram[q, 2, 0] * m * k)
            worst = max(worst, total / (det * det)) if det > 0.0 else np.nan
            if not det > 0.0:
                break
        squares[e] = worst
