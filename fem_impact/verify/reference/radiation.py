"""Energy that a slow normal force sends as waves into an elastic half-space.

Lamb's problem: a force F(t) on a spot much smaller than the waves radiates the power D (dF/dt)^2, half of it
and more in Rayleigh waves (Miller & Pursey 1955, On the partition of energy between elastic waves in a
semi-infinite solid, Proc. R. Soc. A; for impact Hunter 1957, J. Mech. Phys. Solids 5, 162, after whom it is
1.127 (v / c0)^0.6 of the kinetic energy at nu = 0.29).
"""

from __future__ import annotations

from functools import cache
from math import pi, sqrt

from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import beta

from fem_impact.verify.reference.hertz import SPAN, HertzImpact

__all__ = ["radiated_energy", "radiation_resistance"]


@cache
def _lamb(nu: float) -> float:
    """Return 2 pi G c_s D: the imaginary part of Lamb's integral, wave number of shear waves 1.

    Its kernel k a / ((2 k^2 - 1)^2 - 4 k^2 a b), a^2 = k^2 - q, b^2 = k^2 - 1, q = (c_s / c_d)^2, is complex
    up to k = 1 (body waves) and has Rayleigh's pole beyond.
    """
    q = (1 - 2 * nu) / (2 - 2 * nu)
    p = sqrt(q)

    def both(k: float) -> float:
        a, b = sqrt(max(q - k * k, 0.0)), sqrt(1 - k * k)
        return k * a / ((2 * k * k - 1) ** 2 + 4 * k * k * a * b)

    def shear(k: float) -> float:
        a, b = sqrt(max(k * k - q, 0.0)), sqrt(max(1 - k * k, 0.0))
        return 4 * k**3 * a * a * b / ((2 * k * k - 1) ** 4 + (4 * k * k * a * b) ** 2)

    def rayleigh(k: float) -> float:
        return (2 * k * k - 1) ** 2 - 4 * k * k * sqrt((k * k - q) * (k * k - 1))

    pole = brentq(rayleigh, 1 + 1e-9, 2.0, xtol=1e-15)
    step = 1e-6
    slope = (rayleigh(pole + step) - rayleigh(pole - step)) / (2 * step)
    waves = -pi * pole * sqrt(pole**2 - q) / slope
    return float(quad(both, 0, p)[0] + quad(shear, p, 1)[0] + waves)


def radiation_resistance(E: float, nu: float, rho: float) -> float:
    """Return D, W s^2/N^2: radiated power over the square of the rate of the force.

    Examples
    --------
    >>> f"{radiation_resistance(210e9, 0.29, 7850.0):.3e}"
    '5.316e-16'
    """
    G = E / (2 * (1 + nu))
    return _lamb(nu) / (2 * pi * G * sqrt(G / rho))


def radiated_energy(impact: HertzImpact, E: float, nu: float, rho: float) -> float:
    """Return the energy, J, that a Hertz impact sends into a half-space: D times the integral of F'^2.

    With F = k d^1.5 and d' = v sqrt(1 - x^2.5), x = d / d_max, that integral is
    (9/2) F_max^2 / d_max v int x sqrt(1 - x^2.5) dx.
    """
    share = float(beta(0.8, 1.5)) / 2.5
    speed = SPAN * impact.approach / impact.duration
    return radiation_resistance(E, nu, rho) * 4.5 * impact.force**2 / impact.approach * speed * share
