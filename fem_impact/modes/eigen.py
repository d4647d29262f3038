"""The eigenproblem of the free rod, on the mesh and with the masses of the explicit model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, eigsh, splu

Array = NDArray[np.float64]

DEFAULT_COUNT = 40
RIGID = 3  # two translations and one turn in the symmetry plane


@dataclass(frozen=True, slots=True)
class RodModes:
    """Elastic modes that are symmetric about the plane b = 0.

    Attributes
    ----------
    omega : (k,) circular frequencies, rad/s, ascending
    shape : (n, k) over the rod's free unknowns, half-model mass-normalised: shape.T M shape = 1
    mass : (n,) lumped masses of the half rod, kg
    """

    omega: Array
    shape: Array
    mass: Array

    @property
    def frequency(self) -> Array:
        """Return natural frequencies (k,), Hz."""
        return self.omega / (2 * np.pi)


def no_modes(mass: Array) -> RodModes:
    """Return the modes of a body that cannot vibrate: none."""
    return RodModes(np.zeros(0), np.zeros((len(mass), 0)), mass)


def rod_modes(
    stiffness: sp.csr_matrix, mass: Array, fixed: NDArray[np.bool_], count: int = DEFAULT_COUNT
) -> RodModes:
    """Return the lowest elastic modes.

    Parameters
    ----------
    stiffness : (n, n), N/m; mass : (n,), kg
    fixed : (n,) unknowns held by symmetry
    count : number of elastic modes wanted

    Raises
    ------
    ValueError
        If the body is not free: more or fewer than three rigid motions were found.
    """
    free = np.flatnonzero(~fixed)
    root = sp.diags(1 / np.sqrt(mass[free]))
    shifted = (root @ stiffness[free][:, free] @ root).tocsc()
    # a shift below zero keeps the factor definite although rigid motions have no stiffness
    shift = -1e-6 * float(shifted.diagonal().max())
    shifted.setdiag(shifted.diagonal() - shift)
    # minimum degree on the symmetric pattern and no pivoting: a quarter of the fill of the default
    factor = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inverse = LinearOperator(shifted.shape, factor.solve, dtype=np.float64)
    start = np.random.default_rng(0).normal(size=len(free))
    # with the inverse at hand the solver takes only the shape of its first argument
    value, vector = eigsh(shifted, k=count + RIGID, sigma=shift, which="LM", v0=start, OPinv=inverse)
    order = np.argsort(value)
    value, vector = value[order], vector[:, order]
    if not abs(value[RIGID - 1]) < 1e-3 * value[RIGID]:
        raise ValueError(
            f"A free rod has three rigid motions in its symmetry plane; the lowest squares are {value[:4]}."
        )
    shape = np.zeros((len(mass), count))
    shape[free] = root @ vector[:, RIGID:]
    return RodModes(np.sqrt(value[RIGID:]), shape, mass)
