"""Restitution of an elastic, perfectly plastic sphere: Thornton (1997), doi:10.1115/1.2787319, and a fit."""

from __future__ import annotations

from math import pi, sqrt

__all__ = ["fitted_restitution", "thornton_restitution", "yield_speed"]


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
    are fully plastic and small (Wu, Li & Thornton 2003, doi:10.1016/S0734-743X(03)00014-9).

    Examples
    --------
    >>> fitted_restitution(81.0, 1.0) / fitted_restitution(1296.0, 1.0)
    2.0
    """
    return float(min(1.0, 2.08 * (first_yield / speed) ** 0.25))
