"""Guided waves of an infinite round bar: the Pochhammer-Chree frequency equation.

With p^2 = w^2/c_d^2 - k^2 and q^2 = w^2/c_s^2 - k^2 of radius a, displacements are made of a scalar
potential and the two parts of a solenoidal field, each a Bessel function times cos or sin of n theta
(Achenbach, Wave Propagation in Elastic Solids, 1973, section 6.10). Lengths are in units of a, speeds
in units of c0.
"""

from collections.abc import Callable
from functools import cache
from math import pi, sqrt

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import beta, ive, jv

from fem_impact.evidence.references.hertz import SPAN, HertzImpact

SCAN = 400


def _speeds(nu: float) -> tuple[float, float]:
    """Return c_d, c_s over c0."""
    return sqrt((1 - nu) / ((1 + nu) * (1 - 2 * nu))), sqrt(1 / (2 * (1 + nu)))


def _even(square: float) -> tuple[float, float]:
    """Return J0(x) and J1(x) / x for x^2 of either sign, scaled by exp(-|x|) below zero."""
    x = sqrt(abs(square))
    if square < 0:
        return float(ive(0, x)), float(ive(1, x)) / x
    return float(jv(0, x)), float(jv(1, x)) / x if x > 0 else 0.5


def _longitudinal(c: float, k: float, nu: float) -> float:
    """Return the axisymmetric frequency equation, divided by what vanishes with p and q."""
    c_d, c_s = _speeds(nu)
    p2, q2 = k**2 * (c**2 / c_d**2 - 1), k**2 * (c**2 / c_s**2 - 1)
    (J0p, J1p), (J0q, J1q) = _even(p2), _even(q2)
    return 2 * p2 * (q2 + k**2) * J1p * J1q - (q2 - k**2) ** 2 * J0p * J1q - 4 * k**2 * p2 * J1p * J0q


def _radial(square: float) -> tuple[float, float, float]:
    """Return f, f', f'' at 1 of I_1(x r), x^2 = -square, scaled by exp(-x)."""
    x = sqrt(-square)
    f = float(ive(1, x))
    slope = x * float(ive(0, x)) - f
    return f, slope, -slope - (square - 1) * f


def _flexural(c: float, k: float, nu: float) -> float:
    """Return the determinant of the three stresses of the skin at n = 1, for c below c_s."""
    c_d, c_s = _speeds(nu)
    ratio = (c_d / c_s) ** 2 - 2
    p2, q2 = k**2 * (c**2 / c_d**2 - 1), k**2 * (c**2 / c_s**2 - 1)
    f, f1, f2 = _radial(p2)
    g, g1, g2 = _radial(q2)
    rows = [
        [2 * f2 - ratio * (p2 + k**2) * f, 2 * (g1 - g), 2 * k * g2],
        [2 * (f - f1), g1 - g - g2, 2 * k * (g - g1)],
        [2 * k * f1, k * g, (k**2 - q2) * g1],
    ]
    return float(np.linalg.det(np.array(rows)))


def _first_root(
    equation: Callable[[float, float, float], float], low: float, high: float, k: float, nu: float
) -> float:
    grid = np.linspace(low, high, SCAN)
    values = [equation(c, k, nu) for c in grid]
    change = np.flatnonzero(np.sign(values[:-1]) != np.sign(values[1:]))
    if not len(change):
        raise ValueError(f"No guided wave found between {low:g} and {high:g} c0 at k a = {k:g}.")
    i = int(change[0])
    return float(brentq(equation, grid[i], grid[i + 1], args=(k, nu), xtol=1e-12))


def longitudinal_speed(ratio: float, nu: float) -> float:
    """Return phase speed / c0 of the first longitudinal mode at radius / wavelength ``ratio``.

    Examples
    --------
    >>> [round(longitudinal_speed(r, 0.29), 5) for r in (0.1, 0.2, 0.3, 0.5)]
    [0.99113, 0.95645, 0.87299, 0.68927]
    """
    return _first_root(_longitudinal, 0.3, 1.02, 2 * pi * ratio, nu)


def flexural_speed(ratio: float, nu: float) -> float:
    """Return phase speed / c0 of the first flexural mode at radius / wavelength ``ratio``.

    Examples
    --------
    >>> [round(flexural_speed(r, 0.29), 4) for r in (0.1, 0.2, 0.5)]
    [0.27, 0.4138, 0.5448]
    """
    k = 2 * pi * ratio  # a slender beam has k / 2
    return _first_root(_flexural, 0.1 * min(k, 1.0), 0.999 * _speeds(nu)[1], k, nu)


@cache
def _lamb(nu: float, shear: bool) -> float:
    """Return the imaginary part of Lamb's integral, wave number of shear waves 1.

    With a^2 = k^2 - q, b^2 = k^2 - 1, q = (c_s / c_d)^2 and R = (2 k^2 - 1)^2 - 4 k^2 a b the kernel is
    k a / R for a normal force and k b / R for one along the surface (in the plane of a wave). It is complex
    up to k = 1 (body waves) and has Rayleigh's pole beyond.
    """
    q = (1 - 2 * nu) / (2 - 2 * nu)
    p = sqrt(q)

    def both(k: float) -> float:
        a, b = sqrt(max(q - k * k, 0.0)), sqrt(1 - k * k)
        return k * (b if shear else a) / ((2 * k * k - 1) ** 2 + 4 * k * k * a * b)

    def one(k: float) -> float:
        a, b, even = sqrt(max(k * k - q, 0.0)), sqrt(max(1 - k * k, 0.0)), (2 * k * k - 1) ** 2
        cross = 4 * k * k * a * b
        return k * (b * even if shear else a * cross) / (even**2 + cross**2)

    def rayleigh(k: float) -> float:
        return (2 * k * k - 1) ** 2 - 4 * k * k * sqrt((k * k - q) * (k * k - 1))

    pole = brentq(rayleigh, 1 + 1e-9, 2.0, xtol=1e-15)
    step = 1e-6
    slope = (rayleigh(pole + step) - rayleigh(pole - step)) / (2 * step)
    waves = -pi * pole * sqrt(pole**2 - (1 if shear else q)) / slope
    return float(quad(both, 0, p)[0] + quad(one, p, 1)[0] + waves)


def radiation_resistance(E: float, nu: float, rho: float) -> float:
    """Return D, W s^2/N^2, of a normal force: radiated power over the square of the force's rate.

    Examples
    --------
    >>> f"{radiation_resistance(210e9, 0.29, 7850.0):.3e}"
    '5.316e-16'
    """
    G = E / (2 * (1 + nu))
    return _lamb(nu, False) / (2 * pi * G * sqrt(G / rho))


def shear_resistance(E: float, nu: float, rho: float) -> float:
    """Return D, W s^2/N^2, of a force along the surface.

    Half of the directions of a wave number see its plane, half the waves across it, whose kernel k / b has
    the imaginary part 1.

    Examples
    --------
    >>> round(shear_resistance(210e9, 0.29, 7850.0) / radiation_resistance(210e9, 0.29, 7850.0), 3)
    0.904
    """
    G = E / (2 * (1 + nu))
    return (_lamb(nu, True) + 1) / (4 * pi * G * sqrt(G / rho))


def radiated_energy(impact: HertzImpact, E: float, nu: float, rho: float) -> float:
    """Return the energy, J, that a Hertz impact sends into a half-space: D times the integral of F'^2.

    With F = k d^1.5 and d' = v sqrt(1 - x^2.5), x = d / d_max, that integral is
    (9/2) F_max^2 / d_max v int x sqrt(1 - x^2.5) dx.
    """
    share = float(beta(0.8, 1.5)) / 2.5
    speed = SPAN * impact.approach / impact.duration
    return radiation_resistance(E, nu, rho) * 4.5 * impact.force**2 / impact.approach * speed * share
