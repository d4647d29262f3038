"""A rod with a rounded end striking a plane along its axis: Sears' delay equation.

The approach d of the end follows d' = v - [F(t) + 2 sum_n F(t - n 2 L / c0)] / (rho c0 A) with the
Hertz force F = (4/3) E* sqrt(R) d^1.5 (Sears 1908, Goldsmith, Impact, 1960, section 3.1), or with another
law of the contact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

__all__ = ["AxialImpact", "sears"]

STEPS = 4000  # per round trip of the wave


@dataclass(frozen=True, slots=True)
class AxialImpact:
    """Largest force, N, and when, s; contact time, s; restitution; vibration share of E_0."""

    force: float
    peak_time: float
    duration: float
    restitution: float
    vibration: float


def _history(
    law: Callable[[float], float], impedance: float, speed: float, dt: float, delay: int
) -> NDArray[np.float64]:
    """Return the contact force at times k dt until the end leaves, by Heun's rule."""
    force, d = [0.0], 0.0
    while True:
        k = len(force)
        past = [sum(force[j - n * delay] for n in range(1, j // delay + 1)) for j in (k - 1, k)]
        first = speed - (force[-1] + 2 * past[0]) / impedance
        guess = law(max(d + dt * first, 0.0))
        second = speed - (guess + 2 * past[1]) / impedance
        d += 0.5 * dt * (first + second)
        if d <= 0.0:
            return np.array([*force, 0.0])
        force.append(law(d))


def rod_impact(
    E: float, rho: float, length: float, radius: float, law: Callable[[float], float], speed: float
) -> AxialImpact:
    """Return the impact of a rod whose end pushes with the force ``law`` (m to N) of its approach."""
    c0, area = sqrt(E / rho), pi * radius**2
    dt = 2 * length / c0 / STEPS
    F = _history(law, rho * c0 * area, speed, dt, STEPS)
    rebound = float(F.sum()) * dt / (rho * area * length) - speed
    e = rebound / speed
    return AxialImpact(float(F.max()), dt * int(F.argmax()), dt * (len(F) - 1), e, 1 - e**2)


def sears(
    E: float, rho: float, length: float, radius: float, E_star: float, tip_radius: float, speed: float
) -> AxialImpact:
    """Return the impact of a rod (length, radius in m) with a tip of ``tip_radius`` by Hertz' law.

    Examples
    --------
    >>> rod = sears(219e9, 7850.0, 0.24, 9.5e-3, 115.9e9, 7e-3, 2.0)
    >>> round(rod.force, -1), round(rod.duration * 1e6), round(rod.vibration, 4)
    (17780.0, 219, 0.0024)
    """
    k = 4 / 3 * E_star * sqrt(tip_radius)
    return rod_impact(E, rho, length, radius, lambda d: k * d**1.5, speed)
