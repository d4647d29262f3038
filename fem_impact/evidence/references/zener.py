"""Elastic impact on an infinite thin plate: Zener's equation, integrated.

With the approach s over v T, time over T and T = (m / (k sqrt(v)))^(2/5),

    s'' + (1 + lambda d/dt) s^1.5 = 0,    s(0) = 0,  s'(0) = 1,

where lambda = m / (Z T) and Z = 8 sqrt(D rho h) is the impedance of the plate (Zener 1941,
doi:10.1103/PhysRev.59.669, form from memory and derived anew; an open derivation: Mathematics 2021, 9, 2222).
The equation is integrated as that of the striker, u' = -s^1.5, whose point on the plate moves at
lambda s^1.5, so s' = u - lambda s^1.5; e is -u when s = 0 again.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from fem_impact.arrays import Array


@dataclass(frozen=True, slots=True)
class PlateImpact:
    """Restitution of the striker, contact time over T, largest force over k (v T)^1.5."""

    restitution: float
    duration: float
    peak: float


def zener_impact(inelasticity: float) -> PlateImpact:
    """Return the impact for Zener's lambda.

    Examples
    --------
    >>> hit = zener_impact(0.2)
    >>> f"{hit.restitution:.4f} {hit.duration:.3f} {hit.peak:.3f}"
    '0.7140 3.349 0.946'
    """

    def rates(t: float, y: Array) -> Array:
        s, u = y  # u: velocity of the striker towards the plate
        force = max(s, 0.0) ** 1.5
        return np.array([u - inelasticity * force, -force])

    def left(t: float, y: Array) -> float:
        return float(y[0]) if t > 0.1 else 1.0

    left.terminal, left.direction = True, -1.0  # type: ignore[attr-defined]
    solved = solve_ivp(rates, (0.0, 1e3), [0.0, 1.0], events=left, rtol=1e-10, atol=1e-13, max_step=0.01)
    return PlateImpact(-float(solved.y[1, -1]), float(solved.t[-1]), float(solved.y[0].max()) ** 1.5)
