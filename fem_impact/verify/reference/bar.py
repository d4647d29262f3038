"""An elastic bar without lateral strain striking a rigid wall: the one-dimensional wave solution."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

__all__ = ["Strike", "bar_speed", "strike"]


@dataclass(frozen=True, slots=True)
class Strike:
    """Plateau of the wall force, N; duration, s; restitution and vibration share, exact."""

    force: float
    duration: float
    restitution: float = 1.0
    vibration: float = 0.0


def bar_speed(E: float, rho: float) -> float:
    """Return c0 = sqrt(E / rho), m/s."""
    return sqrt(E / rho)


def strike(E: float, rho: float, area: float, length: float, speed: float) -> Strike:
    """Return the force rho c0 A v during 2 L / c0; the bar then leaves without stress.

    Examples
    --------
    >>> from math import pi
    >>> found = strike(219e9, 7850.0, pi * 0.0095**2, 0.24, 2.0)
    >>> round(found.force), round(found.duration * 1e6, 2)
    (23512, 90.88)
    """
    c0 = bar_speed(E, rho)
    return Strike(rho * c0 * area * speed, 2 * length / c0)
