"""The stiffness of the rod over its masses, which do not stand at the nodes."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import reverse_cuthill_mckee
from scipy.sparse.linalg import LinearOperator, cg, eigsh, splu

from fem_impact.arrays import Array


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


Product = Callable[[Array], Array]

DEFAULT_COUNT = 40
RIGID = 3  # two translations and one turn in the symmetry plane
SHIFT = 1e-5  # of the largest diagonal entry: closer to zero, float32 would keep too few digits of the factor
ROUGH = 1e-6  # of the eigenvalues of the inverse, which has no more digits
CORRECTIONS = 2  # bring frequencies to 1e-11 and residual forces to 1e-6; one: 1e-8 and 1e-4
RELEASED, MOST = 1e-5, 300  # residual force, of the force that an energy is asked for; steps (20 are common)


@dataclass(frozen=True, slots=True)
class RodModes:
    """Elastic modes that are symmetric about the plane b = 0.

    Attributes
    ----------
    omega : (k,) circular frequencies, rad/s, ascending
    shape : (n, k) over the rod's free unknowns, half-model mass-normalised: shape.T M shape = 1
    mass : (n,) lumped masses of the half rod, kg
    released : from internal forces (n,), N, of a free rod the strain energy, J, that the whole rod releases
        until they are gone, rigid acceleration apart: of all shapes that the mesh has, not of these modes;
        None if it is not found
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
"""The modes that this process found last: material damping asks for them beside the run, and runs that differ
in their barrier alone have them in common."""


def rod_modes(
    stiffness: MassStiffness, mass: Array, fixed: NDArray[np.bool_], count: int = DEFAULT_COUNT
) -> RodModes:
    """Return the lowest elastic modes, the same again to whoever asks for those found last.

    Parameters
    ----------
    stiffness : over the masses, N/m; mass : (n,), kg
    fixed : (n,) unknowns held by symmetry
    count : number of elastic modes wanted

    Raises
    ------
    ValueError
        If the body is not free: more or fewer than three rigid motions were found.
    """
    matrices = (stiffness.spread, *stiffness.parts)
    arrays = [array for A in matrices for array in (A.indptr, A.indices, A.data)]
    mark = _mark([*arrays, mass, fixed], count)
    if mark not in _LAST:
        _LAST.clear()
        _LAST[mark] = _found(stiffness, mass, fixed, count)
    return _LAST[mark]


def _mark(arrays: Iterable[NDArray[Any]], count: int) -> str:
    digest = hashlib.sha256(str(count).encode())
    for array in arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


def _found(stiffness: MassStiffness, mass: Array, fixed: NDArray[np.bool_], count: int) -> RodModes:
    """Search for what `rod_modes` returns."""
    root = np.where(fixed, 0.0, 1 / np.sqrt(mass))
    roughly, shift = _rough_inverse(stiffness, root)
    scale = sp.diags(root)

    def times(x: Array) -> Array:
        return np.asarray(scale @ (stiffness @ (scale @ x)))

    inverse = _operator(roughly, mass)
    start = roughly(np.random.default_rng(0).normal(size=len(mass)))
    # with the inverse at hand the solver takes only the shape of its first argument
    vector = eigsh(inverse, count + RIGID, sigma=shift, v0=start, OPinv=inverse, tol=ROUGH)[1]
    for _ in range(CORRECTIONS):
        vector = np.linalg.qr(vector)[0]
        # beside the shift the lowest squares are small: Rayleigh-Ritz gives their digits back
        value, mix = np.linalg.eigh(vector.T @ times(vector))
        vector = vector @ mix
        rest = roughly(times(vector) - vector * value)  # what few digits left in the highest frequencies
        vector -= rest - vector @ (vector.T @ rest)
    if not abs(value[RIGID - 1]) < 1e-3 * value[RIGID]:
        raise ValueError(
            f"A free rod has three rigid motions in its symmetry plane; the lowest squares are {value[:4]}."
        )
    released = partial(_released, _operator(times, mass), inverse, root, vector[:, :RIGID])
    return RodModes(np.sqrt(value[RIGID:]), scale @ vector[:, RIGID:], mass, released)


def _released(
    stiffness: LinearOperator, inverse: LinearOperator, root: Array, rigid: Array, force: Array
) -> float | None:
    """Return what `RodModes` tells of ``released``, by conjugate gradients with the rough inverse at hand."""
    pull = root * force
    least = RELEASED**2 * float(np.linalg.norm(pull))  # what rounding leaves of a rigid acceleration
    pull -= rigid @ (rigid.T @ pull)
    given, failed = cg(stiffness, pull, rtol=RELEASED, atol=least, maxiter=MOST, M=inverse)
    return None if failed else float(pull @ given)


def _operator(product: Product, vector: Array) -> LinearOperator:
    return LinearOperator((len(vector), len(vector)), product, dtype=np.float64)


def _rough_inverse(stiffness: MassStiffness, root: Array) -> tuple[Product, float]:
    """Return the inverse, good to a few digits, of stiffness over mass less a shift, and the shift, 1/s2.

    ``root`` is 1 / sqrt(mass). The factor is by far the largest thing in memory, and float32 halves it.
    """
    free, shifted = np.flatnonzero(root), stiffness.scaled(root)
    # a shift below zero keeps the factor definite although rigid motions have no stiffness
    shift = -SHIFT * float(shifted.diagonal().max())
    shifted.setdiag(shifted.diagonal() - np.float32(shift))
    # minimum degree on the symmetric pattern and no pivoting: a quarter of the fill of the default, and up to
    # another quarter less where it starts from a narrow band
    order = reverse_cuthill_mckee(shifted.tocsr(), symmetric_mode=True)
    free, shifted = free[order], shifted[order][:, order].tocsc()
    factor = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def solve(b: Array) -> Array:
        x = np.zeros_like(b)
        x[free] = factor.solve(b[free].astype(np.float32))
        return x

    return solve, shift
