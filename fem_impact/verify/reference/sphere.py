"""Oblique impact of an elastic sphere with friction: Maw, Barber & Fawcett (1976)."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from fem_impact.verify.reference.hertz import hertz
from fem_impact.verify.reference.tangential import SpringRow, tangential_ratio

__all__ = ["SphereRebound", "oblique_sphere", "reversal"]

STEPS = 4000
INERTIA = 0.4  # K^2 of a solid sphere


@dataclass(frozen=True, slots=True)
class SphereRebound:
    """Motion after the impact: velocities of centre and contact point, m/s; spin R Omega, m/s; ratio mu."""

    centre_t: float
    contact_t: float
    spin: float
    ratio: float


def oblique_sphere(
    E_star: float, nu: float, radius: float, mass: float, f: float, v_n: float, v_t: float
) -> SphereRebound:
    """Return the rebound of a sphere without spin; v_n, v_t > 0 are approach and slip speeds, m/s."""
    impact = hertz(E_star, radius, mass, v_n)
    row = SpringRow(E_star, tangential_ratio(nu) * E_star, radius, f, 1.001 * impact.radius)
    dt, depth, rate, slip, pushed = impact.duration / STEPS, 0.0, v_n, v_t, 0.0
    impulse = 0.0
    while True:
        depth += dt * rate
        if depth <= 0.0:
            break
        F, T = row.normal(depth), row.slide(depth, dt * slip)
        rate -= dt * F / mass
        slip -= dt * T / mass * (1 + 1 / INERTIA)
        impulse += dt * F
        pushed += dt * T
    return SphereRebound(v_t - pushed / mass, slip, pushed / mass / INERTIA, pushed / impulse)


def reversal(psi: float, nu: float, f: float = 0.1) -> float:
    """Return psi_2 after the impact for psi_1 before: psi = 2 (1 - nu) V_t / (f (2 - nu) V_n).

    Examples
    --------
    >>> [round(reversal(p, 0.29), 2) for p in (2.0, 3.5)]
    [-0.82, -1.48]
    """
    scale = 2 * (1 - nu) / (f * (2 - nu))
    R, rho, E_star = 9.5e-3, 7850.0, 115e9
    found = oblique_sphere(E_star, nu, R, 4 / 3 * pi * R**3 * rho, f, 1.0, psi / scale)
    return scale * found.contact_t
