"""Thornton's restitution of an elastic, perfectly plastic sphere (1997), doi:10.1115/1.2787319."""

from __future__ import annotations

from math import pi, sqrt

__all__ = ["thornton_restitution", "yield_speed"]


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
