"""Hertz impact of a sphere on a half-space (Johnson, Contact Mechanics, 1985, section 11.4)."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

from scipy.optimize import brentq
from scipy.special import beta, ellipe, ellipk

__all__ = ["HertzImpact", "contact_modulus", "equivalent_radius", "hertz", "radiated_share"]

# t_c = HALF_SPAN d / v with HALF_SPAN = 2 int_0^1 (1 - s^(5/2))^(-1/2) ds
SPAN = 0.8 * float(beta(0.4, 0.5))


@dataclass(frozen=True, slots=True)
class HertzImpact:
    """Largest force, N, approach and contact radius, m; duration, s."""

    force: float
    approach: float
    radius: float
    duration: float


def contact_modulus(E: float, nu: float, E_2: float = float("inf"), nu_2: float = 0.0) -> float:
    """Return E*, Pa: 1 / E* = (1 - nu^2) / E + (1 - nu_2^2) / E_2."""
    return 1 / ((1 - nu**2) / E + (1 - nu_2**2) / E_2)


def equivalent_radius(R_1: float, R_2: float) -> float:
    """Return the radius, m, of the sphere as stiff as a surface of principal radii R_1 and R_2.

    The approach of an elliptical contact is that of the mean radius sqrt(R_1 R_2) times F_2 (Johnson, Contact
    Mechanics, 1985, Eq 4.26 to 4.28), so the force at an approach is that of a radius larger by F_2^-3.

    Examples
    --------
    >>> round(equivalent_radius(6.0, 6.0), 4), round(equivalent_radius(3.0, 12.2) / (3.0 * 12.2) ** 0.5, 3)
    (6.0, 1.083)
    """
    mean, ratio = sqrt(R_1 * R_2), max(R_1, R_2) / min(R_1, R_2)
    if ratio < 1 + 1e-6:
        return mean

    def parts(axes: float) -> tuple[float, float, float]:
        m = 1 - axes**-2
        return axes**2 * float(ellipe(m)) - float(ellipk(m)), float(ellipk(m) - ellipe(m)), m

    axes = float(brentq(lambda a: parts(a)[0] / parts(a)[1] - ratio, 1 + 1e-9, 2 * ratio))
    over, under, m = parts(axes)
    F_1 = (4 / (pi * m) * axes**-1.5 * sqrt(over * under)) ** (1 / 3)
    F_2 = 2 / pi * axes**-0.5 / F_1 * float(ellipk(m))
    return float(mean * F_2**-3)


def hertz(E_star: float, radius: float, mass: float, speed: float) -> HertzImpact:
    """Return the impact of a mass behind a spherical surface.

    Examples
    --------
    >>> from math import pi
    >>> R = 9.5e-3
    >>> steel = hertz(contact_modulus(210e9, .29, 210e9, .29), R, 4 / 3 * pi * R**3 * 7850, 1.0)
    >>> round(steel.force, 1), round(steel.duration * 1e6, 2), round(steel.radius * 1e3, 3)
    (1575.7, 65.82, 0.461)
    """
    stiffness = 4 / 3 * E_star * sqrt(radius)
    approach = (5 * mass * speed**2 / (4 * stiffness)) ** 0.4
    return HertzImpact(stiffness * approach**1.5, approach, sqrt(radius * approach), SPAN * approach / speed)


def radiated_share(speed: float, c0: float) -> float:
    """Return the share of E_0 sent into a half-space at nu = 0.29: 1.127 (v / c0)^0.6 (Hunter 1957).

    Examples
    --------
    >>> round(radiated_share(1.0, 5172.0), 4)
    0.0067
    """
    return float(1.127 * (speed / c0) ** 0.6)
