"""Restitution of an elastic, perfectly plastic sphere: Thornton's law, and a fit.

C. Thornton, Coefficient of restitution for collinear collisions of elastic-perfectly plastic spheres, J.
Appl. Mech. 64(2), 383-386, 1997. Title, pages and year agree in independent reference lists; the paper and
its DOI (10.1115/1.2787319, from memory) were not at hand, so the law is held to its own limits: e = 1 at
first yield, e going as v^(-1/4) far above.

Also the speeds between which a contact is fully plastic and small, where restitution goes as v^(-1/4).
"""

from __future__ import annotations

from math import pi, sqrt

__all__ = ["fitted_restitution", "plastic_radius", "plastic_speeds", "thornton_restitution", "yield_speed"]

# mean pressure of a fully plastic contact over yield stress, the E* a / (Y R) from which it has stopped
# rising (Johnson, Contact Mechanics, 1985, section 6.3), and the a / R up to which the contact is small
MEAN, FULL, SMALL = 2.8, 40.0, 0.2


def plastic_radius(yield_stress: float, radius: float, mass: float, speed: float) -> float:
    """Return the contact radius, m, at which a constant mean pressure of 2.8 Y has stopped a sphere."""
    return float((2 * mass * speed**2 * radius / (pi * MEAN * yield_stress)) ** 0.25)


def plastic_speeds(yield_stress: float, E_star: float, radius: float, mass: float) -> tuple[float, float]:
    """Return the speeds, m/s, from which the contact is fully plastic and up to which it is small.

    Examples
    --------
    >>> from math import pi
    >>> [round(v, 2) for v in plastic_speeds(546e6, 239e9, 9.5e-3, 4 / 3 * pi * 9.5e-3**3 * 7850)]
    [2.26, 10.81]
    """
    unit = plastic_radius(yield_stress, radius, mass, 1.0)  # goes as the root of the speed
    return (FULL * yield_stress * radius / (E_star * unit)) ** 2, (SMALL * radius / unit) ** 2


def yield_speed(limit: float, E_star: float, radius: float, mass: float) -> float:
    """Return the speed, m/s, at which the peak pressure reaches the limiting contact pressure, Pa."""
    return float((pi / (2 * E_star)) ** 2 * sqrt(8 * pi * radius**3 / (15 * mass)) * limit**2.5)


def thornton_restitution(speed: float, yields_at: float) -> float:
    """Return e at a speed, given the speed of first yield; 1 below it.

    Examples
    --------
    >>> round(thornton_restitution(100.0, 1.0) / thornton_restitution(1600.0, 1.0), 2)
    2.0
    """
    if speed <= yields_at:
        return 1.0
    y = yields_at / speed
    losses = (y / (y + 2 * sqrt(6 / 5 - y**2 / 5))) ** 0.25
    return float(sqrt(6 * sqrt(3) / 5) * sqrt(1 - y**2 / 6) * losses)


def fitted_restitution(speed: float, first_yield: float) -> float:
    """Return e of finite-element runs of elastic, perfectly plastic spheres, 2.08 (v_y / v)^(1/4).

    v_y is the speed of first yield, peak pressure 1.6 times the yield stress; the fit holds for contacts that
    are fully plastic and small. From memory it is that of Wu, Li & Thornton (Rebound behaviour of spheres for
    plastic impacts, Int. J. Impact Eng. 28, 929-946, 2003); neither the paper nor a list that cites it was at
    hand, so nothing is judged by it.

    Examples
    --------
    >>> fitted_restitution(81.0, 1.0) / fitted_restitution(1296.0, 1.0)
    2.0
    """
    return float(min(1.0, 2.08 * (first_yield / speed) ** 0.25))
