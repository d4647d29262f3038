"""Free-free bending modes of a round bar by Timoshenko's theory, in Legendre polynomials.

Deflection w and section angle theta minimise the energy E I theta'^2 + kappa G A (w' - theta)^2 against
rho A w^2 + rho I theta^2; kappa of a round section from Hutchinson (2001), doi:10.1115/1.1349417.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.linalg import eigh

__all__ = ["BeamModes", "bending_modes"]

Array = NDArray[np.float64]
RIGID = 2


@dataclass(frozen=True, slots=True)
class BeamModes:
    """Bending modes of unit modal mass.

    Attributes
    ----------
    omega : (k,) rad/s
    deflection, angle : (k, n) Legendre coefficients of w, kg^-1/2, and theta, 1/m kg^-1/2, over the bar
        from -1 (struck end) to 1
    """

    omega: Array
    deflection: Array
    angle: Array

    @property
    def frequency(self) -> Array:
        """Return natural frequencies (k,), Hz."""
        return self.omega / (2 * pi)

    def at(self, place: float) -> tuple[Array, Array]:
        """Return w and theta (k,) at a place from -1 to 1."""
        values = legendre.legvander(np.array([place]), self.deflection.shape[1] - 1)[0]
        return self.deflection @ values, self.angle @ values


def shear_factor(nu: float) -> float:
    """Return kappa of a round section."""
    return 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)


def _legendre_tables(count: int, length: float) -> tuple[Array, Array, Array]:
    """Return values and slopes of ``count`` polynomials at Gauss points, and weights, m."""
    s, weight = legendre.leggauss(count + 2)
    values = legendre.legvander(s, count - 1)
    slopes = np.stack([legendre.legval(s, legendre.legder(row)) for row in np.eye(count)], axis=1)
    return np.asarray(values), np.asarray(slopes * 2 / length), np.asarray(weight * length / 2)


def bending_modes(E: float, nu: float, rho: float, length: float, radius: float, count: int = 8) -> BeamModes:
    """Return the lowest elastic bending modes.

    Examples
    --------
    >>> bending_modes(219e9, 0.29, 7850.0, 0.24, 9.5e-3).frequency[:3].round().tolist()
    [1526.0, 4092.0, 7728.0]
    """
    n = 2 * count + 12
    area, second, G = pi * radius**2, pi * radius**4 / 4, E / (2 * (1 + nu))
    P, D, weight = _legendre_tables(n, length)
    shear = np.concatenate([D, -P], axis=1)
    bend = np.concatenate([np.zeros_like(D), D], axis=1)
    K = E * second * bend.T @ (weight[:, None] * bend)
    K += shear_factor(nu) * G * area * shear.T @ (weight[:, None] * shear)
    single = P.T @ (weight[:, None] * P)
    M = rho * np.block([[area * single, 0 * single], [0 * single, second * single]])
    square, shape = eigh(K, M)
    chosen = slice(RIGID, RIGID + count)
    return BeamModes(np.sqrt(square[chosen]), shape[:n, chosen].T, shape[n:, chosen].T)
