"""Oblique impact of an elastic sphere with friction: Maw, Barber & Fawcett (1976), and of a finite ball."""

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

import numpy as np

from fem_impact.evidence.references.finite_sphere import POINTS, ball_excess, ball_shear, fitted, local_law
from fem_impact.evidence.references.hertz import SpringRow, hertz, tangential_ratio

STEPS = 4000  # time steps over the contact time
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
    return _rebound(row, lambda approach: (approach, 0.0), mass, v_n, v_t, impact.duration)


def oblique_ball(
    E_star: float, E_ball: float, nu: float, radius: float, mass: float, f: float, v_n: float, v_t: float
) -> SphereRebound:
    """Return the rebound of a ball of finite size from a half-space; E_ball = E / (1 - nu^2) of the ball.

    The normal force follows `local_law`; the tangential excess compliance of the ball is in series with the
    springs.

    Examples
    --------
    >>> slow, fast = (oblique_ball(2e11, 4e11, 0.23, 2.5e-3, 2.6e-4, 0.1, v, v / 12) for v in (1e-4, 4.0))
    >>> round(slow.centre_t * 1.2e5, 2), round(fast.centre_t * 3, 2)
    (0.75, 0.73)
    """
    impact = hertz(E_star, radius, mass, v_n)
    a = 1.3 * impact.radius * np.linspace(0.0, 1.0, POINTS)[1:]
    force, approach = local_law(E_star, radius, a, fitted(ball_excess, nu, a / radius) / (E_ball * radius))
    depth = (3 * force / (4 * E_star * sqrt(radius))) ** (2 / 3)
    depth, approach = np.array([0.0, *depth]), np.array([0.0, *approach])
    shear = fitted(ball_shear, nu, np.array([a[0], *a]) / radius) / (E_ball * radius)
    row = SpringRow(E_star, tangential_ratio(nu) * E_star, radius, f, 1.1 * impact.radius)

    def contact(at: float) -> tuple[float, float]:
        return float(np.interp(at, approach, depth)), float(np.interp(at, approach, shear))

    return _rebound(row, contact, mass, v_n, v_t, impact.duration)


def _rebound(
    row: SpringRow,
    contact: Callable[[float], tuple[float, float]],
    mass: float,
    v_n: float,
    v_t: float,
    duration: float,
) -> SphereRebound:
    """March in time; ``contact`` gives approach of the springs, m, and shear compliance, m/N."""
    dt, approach, rate, slip, pushed = duration / STEPS, 0.0, v_n, v_t, 0.0
    impulse, shift, moved, T = 0.0, 0.0, 0.0, 0.0
    while True:
        approach += dt * rate
        if approach <= 0.0:
            break
        depth, shear = contact(approach)
        shift += dt * slip
        shift_of_springs = shift - shear * T
        F, T = row.normal(depth), row.slide(depth, shift_of_springs - moved)
        moved = shift_of_springs
        rate -= dt * F / mass
        slip -= dt * T / mass * (1 + 1 / INERTIA)
        impulse += dt * F
        pushed += dt * T
    return SphereRebound(v_t - pushed / mass, slip, pushed / mass / INERTIA, pushed / impulse)
