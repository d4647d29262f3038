"""The rod's stiffness over its mass points, which do not lie at the nodes, and its elastic eigenmodes."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack
from scipy.sparse.csgraph import reverse_cuthill_mckee
from scipy.sparse.linalg import LinearOperator, cg, eigsh, splu

from fem_impact.arrays import Array, Bools
from fem_impact.errors import RunError


@dataclass(frozen=True, slots=True)
class MassStiffness:
    """The stiffness P^T K P, N/m, over the mass points, stored as its factors.

    The product would fill the slices' blocks and take twice the memory.

    Attributes
    ----------
    parts : (n, n) each, terms of K over the nodes; they are not added up, which would take more memory
    spread : (n, n) P, displacements of the nodes from those of the mass points
    """

    parts: tuple[sp.csr_matrix, ...]
    spread: sp.csr_matrix

    @property
    def shape(self) -> tuple[int, int]:
        """Return the number of rows and of columns."""
        return int(self.spread.shape[0]), int(self.spread.shape[1])

    def __matmul__(self, w: Array) -> Array:
        """Return the forces, N, on mass points displaced by ``w``, m, (n,) or (n, k)."""
        u = self.spread @ w
        return np.asarray(self.spread.T @ sum(part @ u for part in self.parts))

    def scaled(self, root: Array) -> sp.csc_matrix:
        """Return the float32 matrix with rows and columns times ``root``, without those where it is 0."""
        P = (self.spread[:, np.flatnonzero(root)] @ sp.diags(root[root != 0])).astype(np.float32)
        return sp.csc_matrix(sum(P.T @ (part.astype(np.float32) @ P) for part in self.parts))


Product = Callable[[Array], Array]

DEFAULT_COUNT = 40
RIGID = 3  # two translations and one turn in the symmetry plane
SHIFT = 1e-5  # of the largest diagonal entry: closer to zero, float32 would keep too few digits of the factor
ROUGH = 1e-6  # relative tolerance of the eigenvalues: the float32 inverse has no more digits
CORRECTIONS = 2  # two bring frequencies to 1e-11 and residual forces to 1e-6, one to 1e-8 and 1e-4
# a rod of 300 diameters needs three, one of 470 fifteen: its bending is nearer to rigid motion than the shift
MOST_CORRECTIONS = 25
RIGID_SQUARE = 1e-3  # of the lowest elastic square of a frequency, below which a motion counts as rigid
# unknowns from which a banded factor may stand in place of a sparse one, and its width over their square root
# up to which it takes neither more memory nor more time: of a bar of 52 000 unknowns .9 s in place of 4.7 s
MANY, BAND = 10_000, 10.0
RELEASED, MOST = 1e-5, 300  # relative residual and most steps of `RodModes.released` (20 are common)


@dataclass(frozen=True, slots=True)
class RodModes:
    """Elastic modes that are symmetric about the plane b = 0.

    Attributes
    ----------
    omega : (k,) circular frequencies, rad/s, ascending
    shape : (n, k) over the rod's free unknowns, half-model mass-normalised: shape.T M shape = 1
    mass : (n,) lumped masses of the half rod, kg
    released : maps internal forces (n,), N, of a free rod to the strain energy, J, that the whole rod
        releases until they vanish, without the part that is rigid acceleration. It counts all shapes of the
        mesh, not these modes only; None where the iteration does not converge
    """

    omega: Array
    shape: Array
    mass: Array
    released: Callable[[Array], float | None]

    @property
    def frequency(self) -> Array:
        """Return natural frequencies (k,), Hz."""
        return self.omega / (2 * np.pi)


def no_modes(mass: Array) -> RodModes:
    """Return the modes of a body that cannot vibrate: none."""
    return RodModes(np.zeros(0), np.zeros((len(mass), 0)), mass, lambda force: 0.0)


_LAST: dict[str, RodModes] = {}
"""Cache of the last modes computed in this process: the run and its material damping use the same modes, and
so do runs that differ in their barrier only."""


def rod_modes(
    stiffness: MassStiffness,
    mass: Array,
    fixed: Bools,
    count: int = DEFAULT_COUNT,
    step: Callable[[], None] = lambda: None,
) -> RodModes:
    """Return the lowest elastic modes; the last ones computed are cached.

    Parameters
    ----------
    stiffness : over the masses, N/m; mass : (n,), kg
    fixed : (n,) unknowns held by symmetry
    count : number of elastic modes wanted
    step : called at each of some hundred steps of the solver; what it raises ends it

    Raises
    ------
    RunError
        If the number of rigid motions is not three: the body is not free, or so slender that its bending is
        not told from them; or if the factor of its stiffness is too large.
    """
    matrices = (stiffness.spread, *stiffness.parts)
    arrays = [array for A in matrices for array in (A.indptr, A.indices, A.data)]
    digest = hashlib.sha256(str(count).encode())
    for array in [*arrays, mass, fixed]:
        digest.update(np.ascontiguousarray(array).data)
    mark = digest.hexdigest()
    if mark not in _LAST:
        _LAST.clear()
        _LAST[mark] = _solve(stiffness, mass, fixed, count, step)
    return _LAST[mark]


def _solve(
    stiffness: MassStiffness, mass: Array, fixed: Bools, count: int, step: Callable[[], None]
) -> RodModes:
    """Solve the eigenvalue problem of `rod_modes`, without the cache."""
    root = np.where(fixed, 0.0, 1 / np.sqrt(mass))
    approximate_inverse, shift = _approximate_inverse(stiffness, root)
    scale = sp.diags(root)

    def times(x: Array) -> Array:
        return np.asarray(scale @ (stiffness @ (scale @ x)))

    def told(x: Array) -> Array:
        step()
        return approximate_inverse(x)

    inverse = _operator(approximate_inverse, mass)
    start = approximate_inverse(np.random.default_rng(0).normal(size=len(mass)))
    # with OPinv given, eigsh uses only the shape of its first argument
    vector = eigsh(inverse, count + RIGID, sigma=shift, v0=start, OPinv=_operator(told, mass), tol=ROUGH)[1]
    for made in range(1, MOST_CORRECTIONS + 1):
        vector = np.linalg.qr(vector)[0]
        # Rayleigh-Ritz: the lowest squares are small beside the shift and have lost digits
        value, rotation = np.linalg.eigh(vector.T @ times(vector))
        vector = vector @ rotation
        change = approximate_inverse(times(vector) - vector * value)  # corrects the highest frequencies
        vector -= change - vector @ (vector.T @ change)
        if made >= CORRECTIONS and abs(value[RIGID - 1]) < RIGID_SQUARE * value[RIGID]:
            break
    else:
        raise RunError(
            "A free rod has three rigid motions in its symmetry plane; the lowest squares of its frequencies "
            f"are {value[:4]} 1/s2. The bending of a rod that is too slender is not told from them: give a "
            "smaller accuracy.across."
        )
    released = partial(_released, _operator(times, mass), inverse, root, vector[:, :RIGID])
    return RodModes(np.sqrt(value[RIGID:]), scale @ vector[:, RIGID:], mass, released)


def _released(
    stiffness: LinearOperator, inverse: LinearOperator, root: Array, rigid: Array, force: Array
) -> float | None:
    """Return `RodModes.released` by conjugate gradients, preconditioned by the approximate inverse."""
    pull = root * force
    least = RELEASED**2 * float(np.linalg.norm(pull))  # round-off of a force that is all rigid acceleration
    pull -= rigid @ (rigid.T @ pull)
    displacement, failed = cg(stiffness, pull, rtol=RELEASED, atol=least, maxiter=MOST, M=inverse)
    return None if failed else float(pull @ displacement)


def _operator(product: Product, vector: Array) -> LinearOperator:
    return LinearOperator((len(vector), len(vector)), product, dtype=np.float64)


def _approximate_inverse(stiffness: MassStiffness, root: Array) -> tuple[Product, float]:
    """Return the inverse of M^-1/2 K M^-1/2 - shift to a few digits, and the shift, 1/s2.

    ``root`` (n,) is 1 / sqrt(mass), 0 where fixed. The factor is by far the largest array of a run; float32
    halves it.
    """
    free, shifted = np.flatnonzero(root), stiffness.scaled(root)
    # a shift below zero keeps the factor definite although rigid motions have no stiffness
    shift = -SHIFT * float(shifted.diagonal().max())
    shifted.setdiag(shifted.diagonal() - np.float32(shift))
    # minimum degree on the symmetric pattern and no pivoting: a quarter of the fill of the default, and up to
    # another quarter less where it starts from a narrow band
    order = reverse_cuthill_mckee(shifted.tocsr(), symmetric_mode=True)
    free, shifted = free[order], shifted[order][:, order].tocsc()
    inverse = _banded(shifted) or _sparse(shifted)

    def solve(b: Array) -> Array:
        x = np.zeros_like(b)
        x[free] = inverse(b[free].astype(np.float32))
        return x

    return solve, shift


def _banded(matrix: sp.csc_matrix) -> Product | None:
    """Return the inverse by a banded Cholesky factor; None where a sparse one takes less, see `BAND`."""
    low = sp.tril(matrix, format="coo")
    away = low.row - low.col
    if matrix.shape[0] < MANY or away.max() > BAND * np.sqrt(matrix.shape[0]):
        return None
    band = np.zeros((away.max() + 1, matrix.shape[0]), np.float32, order="F")
    band[away, low.col] = low.data
    factor, failed = lapack.spbtrf(band, lower=1, overwrite_ab=1)
    return None if failed else lambda b: np.asarray(lapack.spbtrs(factor, b, lower=1)[0])


def _sparse(matrix: sp.csc_matrix) -> Product:
    """Return the inverse by a sparse factor (RunError: it is too large)."""
    try:
        factor = splu(matrix, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except MemoryError:  # SuperLU's numbers have 32 bits: it fails with memory left
        raise RunError(
            f"The modes of the rod need a factor of its stiffness over {matrix.shape[0]} unknowns, which is "
            "too large. Give a smaller accuracy.across."
        ) from None
    return lambda b: np.asarray(factor.solve(b))
