"""Free-free bending modes of a round bar by Timoshenko's theory, in Legendre polynomials.

Deflection w and section angle theta minimise the energy E I theta'^2 + kappa G A (w' - theta)^2 against
rho A w^2 + rho I theta^2; kappa of a round section from Hutchinson (2001), doi:10.1115/1.1349417.
"""

from dataclasses import dataclass
from functools import cache
from itertools import product
from math import cos, pi, sin, sqrt

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import block_diag, eigh

from fem_impact.arrays import Array

RIGID = 2
STATIC = 16  # polynomials of a beam under a force at its end, whose deflection is of order 5


@dataclass(frozen=True, slots=True)
class BarModes:
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


def _legendre_tables(count: int, length: float) -> tuple[Array, Array, Array]:
    """Return values and slopes of ``count`` polynomials at Gauss points, and weights, m."""
    s, weight = legendre.leggauss(count + 2)
    values = legendre.legvander(s, count - 1)
    slopes = np.stack([legendre.legval(s, legendre.legder(row)) for row in np.eye(count)], axis=1)
    return np.asarray(values), np.asarray(slopes * 2 / length), np.asarray(weight * length / 2)


def _ritz(E: float, nu: float, rho: float, length: float, radius: float, n: int) -> tuple[Array, Array]:
    """Return the squares of all circular frequencies (2 n,) and shapes (2 n, 2 n) in ``n`` polynomials."""
    area, second, G = pi * radius**2, pi * radius**4 / 4, E / (2 * (1 + nu))
    kappa = 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)
    P, D, weight = _legendre_tables(n, length)
    shear = np.concatenate([D, -P], axis=1)
    bend = np.concatenate([np.zeros_like(D), D], axis=1)
    K = E * second * bend.T @ (weight[:, None] * bend)
    K += kappa * G * area * shear.T @ (weight[:, None] * shear)
    single = P.T @ (weight[:, None] * P)
    M = rho * np.block([[area * single, 0 * single], [0 * single, second * single]])
    square, shape = eigh(K, M)
    return square, shape


def bending_modes(E: float, nu: float, rho: float, length: float, radius: float, count: int = 8) -> BarModes:
    """Return the lowest elastic bending modes.

    Examples
    --------
    >>> bending_modes(219e9, 0.29, 7850.0, 0.24, 9.5e-3).frequency[:3].round().tolist()
    [1526.0, 4092.0, 7728.0]
    """
    n = 2 * count + 12
    square, shape = _ritz(E, nu, rho, length, radius, n)
    chosen = slice(RIGID, RIGID + count)
    return BarModes(np.sqrt(square[chosen]), shape[:n, chosen].T, shape[n:, chosen].T)


@cache
def bending_period(E: float, nu: float, rho: float, length: float, radius: float) -> float:
    """Return the first bending period of a round bar, s; SI units."""
    return 2 * pi / float(bending_modes(E, nu, rho, length, radius, 1).omega[0])


def free_bar_flexibility(nu: float, length: float, angle: float, touch: tuple[float, float]) -> Array:
    """Return the flexibility (2, 2) in n and t of a free bar under a force at ``touch``, E = radius = 1.

    Its own inertia balances the force: bending by all polynomials that statics need, stretching in closed
    form. ``touch`` is the distance from the axis and from the end, ``angle`` that of the axis to n.

    Examples
    --------
    >>> round(float(free_bar_flexibility(0.29, 8.0, 0.0, (0.0, 0.0))[0, 0]) * 3 * pi / 8, 6)
    1.0
    """
    square, shape = _ritz(1.0, nu, 1.0, length, 1.0, STATIC)
    at = legendre.legvander(np.array([2 * touch[1] / length - 1]), STATIC - 1)[0]
    w, theta = at @ shape[:STATIC, RIGID:], at @ shape[STATIC:, RIGID:]
    x = touch[1] / length
    stretch = length / pi * (1 / 3 - x + x**2)
    axis, across = np.array([cos(angle), sin(angle)]), np.array([-sin(angle), cos(angle)])
    bend = np.outer(axis, -touch[0] * theta) + np.outer(across, w)
    return np.asarray((bend / square[RIGID:]) @ bend.T + stretch * np.outer(axis, axis))


SECTION_DEGREE = 5
AXIAL_DEGREE = 15


@dataclass(frozen=True, slots=True)
class Frequencies:
    """Lowest natural frequencies, Hz, ascending (k,)."""

    bending: Array
    longitudinal: Array
    torsion: Array


def _power(x: Array, a: int) -> tuple[Array, Array]:
    return x**a, a * x ** (a - 1) if a else np.zeros_like(x)


def _section(parities: tuple[int, int], radius: float) -> tuple[list[tuple[Array, int]], Array]:
    """Return a component's value and three slopes over a disc, with the axial factor's order, and weights.

    Values and slopes (points, terms) are those of all x^a y^b of the parities up to `SECTION_DEGREE`, the
    third slope being along the axis.
    """
    s, w = legendre.leggauss(8)
    r, w_r = 0.5 * (s + 1), 0.5 * w
    turn = 2 * pi * np.arange(16) / 16
    x, y = np.outer(r, np.cos(turn)).ravel(), np.outer(r, np.sin(turn)).ravel()
    weight = np.repeat(w_r * r * 2 * pi / 16, 16)
    powers = product(*(range(parity, SECTION_DEGREE + 1, 2) for parity in parities))
    rows = [(*_power(x, a), *_power(y, b)) for a, b in powers if a + b <= SECTION_DEGREE]
    value = np.stack([X * Y for X, _, Y, _ in rows], axis=1)
    along_x = np.stack([X1 * Y for _, X1, Y, _ in rows], axis=1)
    along_y = np.stack([X * Y1 for X, _, _, Y1 in rows], axis=1)
    return [(value, 0), (along_x / radius, 0), (along_y / radius, 0), (value, 1)], weight * radius**2


def _class_frequencies(
    parities: list[tuple[int, int]], E: float, nu: float, rho: float, length: float, radius: float
) -> Array:
    """Return all frequencies of one symmetry class, the rigid ones as zeros, Hz."""
    tables = [_section(p, radius) for p in parities]
    weight, axial = tables[0][1], _legendre_tables(AXIAL_DEGREE + 1, length)
    G = E / (2 * (1 + nu))
    lame = 2 * G * nu / (1 - 2 * nu)

    def integrals(i: int, p: int, j: int, q: int) -> Array:
        """Return the integrals of derivative p of component i times derivative q of component j."""
        (A, a), (B, b) = tables[i][0][p], tables[j][0][q]
        along = axial[a].T @ (axial[2][:, None] * axial[b])
        return np.asarray(np.kron(A.T @ (weight[:, None] * B), along))

    def stiffness(i: int, j: int) -> Array:
        block = lame * integrals(i, i + 1, j, j + 1) + G * integrals(i, j + 1, j, i + 1)
        if i == j:
            block += G * (integrals(i, 1, i, 1) + integrals(i, 2, i, 2) + integrals(i, 3, i, 3))
        return block

    K = np.block([[stiffness(i, j) for j in range(3)] for i in range(3)])
    M = block_diag(*(rho * integrals(i, 0, i, 0) for i in range(3)))
    return np.asarray(np.sqrt(np.maximum(eigh(K, M, eigvals_only=True), 0.0)) / (2 * pi))


def cylinder_frequencies(E: float, nu: float, rho: float, length: float, radius: float) -> Frequencies:
    """Return the three lowest bending, longitudinal and torsional frequencies.

    Examples
    --------
    >>> found = cylinder_frequencies(219e9, 0.29, 7850.0, 0.24, 9.5e-3)
    >>> found.bending.round(1).tolist(), found.longitudinal[:2].round(1).tolist()
    ([1526.3, 4092.1, 7728.6], [11000.3, 21978.8])
    """
    size = (E, nu, rho, length, radius)
    bending = _class_frequencies([(0, 0), (1, 1), (1, 0)], *size)
    stretching = _class_frequencies([(1, 0), (0, 1), (0, 0)], *size)
    c_s = sqrt(E / (2 * (1 + nu)) / rho)
    torsion = np.asarray(c_s / (2 * length) * np.arange(1, 4), dtype=np.float64)
    return Frequencies(bending[2:5], stretching[1:4], torsion)
