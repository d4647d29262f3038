"""Oblique drop of an elastic rod: rigid motion, free modes, Hertz contact, Coulomb friction.

The contact point lies at -d_c t - d_d n from the mass centre. Its velocity is that of the rigid motion
plus the modes': bending (Timoshenko) moves it by w across the rod and by -rho theta along the axis,
stretching (Love) by u along the axis. The contact forces push each mode by the same amounts.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, pi, sin, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.reference.free_modes import bending_modes
from fem_impact.reference.hertz import SpringRow

MODES = 12, 8  # bending, stretching
FASTEST = 0.3  # step times the largest circular frequency of the modes
LONGEST = 2e-7  # s
FAINT = 1e-3  # of the impulse: a touch below it is no contact
MERGE = 10e-6  # s: shorter releases do not end a contact


@dataclass(frozen=True, slots=True)
class ObliqueRod:
    """What strikes: mass, kg; k2, m2; arms d_c, d_d, m; its modes.

    Attributes
    ----------
    omega : (k,) rad/s, first the ``bending`` ones
    along_n, along_t : (k,) kg^-1/2, displacement of the contact point by each mode
    """

    mass: float
    k2: float
    d_c: float
    d_d: float
    omega: Array
    along_n: Array
    along_t: Array
    bending: int


def oblique_rod(
    E: float,
    nu: float,
    rho: float,
    length: float,
    radius: float,
    angle: float,
    body: tuple[float, float],
    arms: tuple[float, float],
    touch: tuple[float, float],
    modes: tuple[int, int] = MODES,
) -> ObliqueRod:
    """Return the rod from its material, size and angle.

    ``body`` is (mass, k2), ``arms`` (d_c, d_d), ``touch`` the contact point's distance from the axis and
    from the struck end, ``modes`` how many bend and how many stretch it.
    """
    beam = bending_modes(E, nu, rho, length, radius, modes[0])
    w, theta = beam.at(2 * touch[1] / length - 1)
    number = np.arange(1, modes[1] + 1)
    wave = number * pi / length
    stretch = sqrt(E / rho) * wave / np.sqrt(1 + (nu * wave * radius) ** 2 / 2)
    u = sqrt(2 / body[0]) * np.cos(wave * touch[1])
    across, along = np.concatenate([w, 0 * u]), np.concatenate([-touch[0] * theta, u])
    return ObliqueRod(
        *body,
        *arms,
        np.concatenate([beam.omega, stretch]),
        along * cos(angle) - across * sin(angle),
        along * sin(angle) + across * cos(angle),
        modes[0],
    )


@dataclass(frozen=True, slots=True)
class ObliqueRebound:
    """Motion after the last contact.

    ``bending`` and ``stretching`` are energies, J; ``contacts`` are (start, end, impulse).
    """

    V_n: float
    V_t: float
    Omega: float
    restitution: float
    ratio: float
    bending: float
    stretching: float
    E_0: float
    contacts: list[tuple[float, float, float]]


@dataclass(slots=True)
class _Motion:
    rod: ObliqueRod
    V_n: float
    V_t: float
    q: Array
    rate: Array
    Omega: float = 0.0
    depth: float = 0.0
    touches: list[list[float]] = field(default_factory=list)

    def contact_velocity(self) -> tuple[float, float]:
        rod = self.rod
        v_n = self.V_n + self.Omega * rod.d_c + float(rod.along_n @ self.rate)
        return v_n, self.V_t - self.Omega * rod.d_d + float(rod.along_t @ self.rate)

    def push(self, p_n: float, p_t: float) -> None:
        rod = self.rod
        self.V_n += p_n / rod.mass
        self.V_t += p_t / rod.mass
        self.Omega += (rod.d_c * p_n - rod.d_d * p_t) / (rod.mass * rod.k2)
        self.rate += rod.along_n * p_n + rod.along_t * p_t

    def book(self, time: float, impulse: float) -> None:
        if not self.touches or time - self.touches[-1][1] > MERGE:
            self.touches.append([time, time, 0.0])
        self.touches[-1][1] = time
        self.touches[-1][2] += impulse


def oblique_drop(
    rod: ObliqueRod, row: SpringRow, v_n: float, v_t: float, horizon: float = 2e-3
) -> ObliqueRebound:
    """Return the rebound from velocities v_n, v_t < 0, m/s, followed for ``horizon`` s (leapfrog)."""
    k = len(rod.omega)
    motion = _Motion(rod, v_n, v_t, np.zeros(k), np.zeros(k))
    square, dt = rod.omega**2, min(FASTEST / float(rod.omega.max()), LONGEST)
    for step in range(int(horizon / dt)):
        motion.rate -= dt * square * motion.q
        across = motion.contact_velocity()[1]
        F, T = row.normal(motion.depth), row.slide(motion.depth, dt * across)
        if F > 0:
            motion.push(dt * F, -dt * T)
            motion.book(step * dt, dt * F)
        motion.q += dt * motion.rate
        motion.depth -= dt * motion.contact_velocity()[0]
    return _rebound(motion, v_n, v_t)


def _rebound(motion: _Motion, v_n: float, v_t: float) -> ObliqueRebound:
    rod = motion.rod
    energy = 0.5 * (motion.rate**2 + rod.omega**2 * motion.q**2)
    total = sum(touch[2] for touch in motion.touches)
    return ObliqueRebound(
        motion.V_n,
        motion.V_t,
        motion.Omega,
        -(motion.V_n + rod.d_c * motion.Omega) / v_n,
        (motion.V_t - v_t) / (motion.V_n - v_n),
        float(energy[: rod.bending].sum()),
        float(energy[rod.bending :].sum()),
        0.5 * rod.mass * (v_n**2 + v_t**2),
        [(a, b, p) for a, b, p in motion.touches if p > FAINT * total],
    )
