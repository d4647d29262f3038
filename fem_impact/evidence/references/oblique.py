"""Oblique drop of an elastic rod: rigid motion, free modes, Hertz contact, Coulomb friction.

The contact point lies at -d_c t - d_d n from the mass centre. Its velocity is that of the rigid motion
plus the modes': bending (Timoshenko) moves it by w across the rod and by -rho theta along the axis,
stretching (Love) by u along the axis. The contact forces push each mode by the same amounts. What the modes
leave out of the rod's static flexibility (`rod_edge`) lies in series with the contact's springs.

The rod turns meanwhile, and its rounded edge rolls: the force acts under the edge's centre of curvature.
"""

from dataclasses import dataclass, field
from math import cos, pi, sin, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.evidence.references.free_modes import bending_modes
from fem_impact.evidence.references.hertz import SpringRow, hertz

MODES = 12, 8  # bending, stretching
STEPS = 1000  # over the contact time of the whole mass: half as many move e by 1e-4
FAINT = 1e-3  # of the impulse, and of the largest force: less is no contact
MERGE = 10e-6  # s: shorter releases do not end a contact
STILL, TRIES = 1e-15, 20  # m: how exactly the springs of friction are put in series, and in how many tries


@dataclass(frozen=True, slots=True)
class ObliqueRod:
    """What strikes: mass, kg; k2, m2; arms d_c, d_d, m; its modes.

    Attributes
    ----------
    omega : (k,) rad/s, first the ``bending`` ones
    along_n, along_t : (k,) kg^-1/2, displacement of the contact point by each mode
    edge : radius of the arc that touches, m; 0 for a corner
    give : (2, 2) displacement along n and t for a force along each that no mode has, m/N
    """

    mass: float
    k2: float
    d_c: float
    d_d: float
    omega: Array
    along_n: Array
    along_t: Array
    bending: int
    edge: float = 0.0
    give: Array = field(default_factory=lambda: np.zeros((2, 2)))

    def static(self) -> Array:
        """Return the modes' displacement (2, 2) along n and t for a steady force along each, m/N."""
        at = np.stack([self.along_n, self.along_t]) / self.omega
        return np.asarray(at @ at.T)


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
    """Rigid motion and modes; ``height`` and ``way`` are those of the mass centre, m, ``turn`` is in rad."""

    rod: ObliqueRod
    turning: bool
    V_n: float
    V_t: float
    q: Array
    rate: Array
    Omega: float = 0.0
    height: float = 0.0
    way: float = 0.0
    turn: float = 0.0
    largest: float = 0.0
    touches: list[list[float]] = field(default_factory=list)

    def turned(self) -> tuple[float, float, Array, Array]:
        """Return the arms and the modes' displacements of the contact point in the present attitude."""
        rod, turn = self.rod, self.turn if self.turning else 0.0
        c, s = cos(turn), sin(turn)
        d_c, d_d = rod.d_c, rod.d_d - rod.edge  # of the edge's centre
        arms = c * d_c + s * d_d, c * d_d - s * d_c + rod.edge
        return *arms, c * rod.along_n - s * rod.along_t, c * rod.along_t + s * rod.along_n

    def place(self) -> tuple[float, float]:
        """Return how far the contact point has moved along n and t, m, the edge's rolling taken out."""
        rod = self.rod
        d_c, d_d, along_n, along_t = self.turned()
        if self.turning:
            risen, moved = rod.d_d - d_d, rod.d_c - d_c - rod.edge * self.turn
        else:
            risen, moved = rod.d_c * self.turn, -rod.d_d * self.turn
        return self.height + risen + float(along_n @ self.q), self.way + moved + float(along_t @ self.q)

    def push(self, p_n: float, p_t: float) -> None:
        rod = self.rod
        d_c, d_d, along_n, along_t = self.turned()
        self.V_n += p_n / rod.mass
        self.V_t += p_t / rod.mass
        self.Omega += (d_c * p_n - d_d * p_t) / (rod.mass * rod.k2)
        self.rate += along_n * p_n + along_t * p_t

    def fly(self, dt: float) -> None:
        """Move on without force; the modes swing exactly."""
        self.height += dt * self.V_n
        self.way += dt * self.V_t
        self.turn += dt * self.Omega
        omega, q = self.rod.omega, self.q
        c, s = np.cos(omega * dt), np.sin(omega * dt)
        self.q, self.rate = c * q + s * self.rate / omega, c * self.rate - omega * s * q

    def book(self, time: float, impulse: float) -> None:
        self.largest = max(self.largest, impulse)
        if impulse < FAINT * self.largest:
            return
        if not self.touches or time - self.touches[-1][1] > MERGE:
            self.touches.append([time, time, 0.0])
        self.touches[-1][1] = time
        self.touches[-1][2] += impulse


@dataclass(slots=True)
class _Contact:
    """The springs of a contact in series with a static flexibility of the rod and a barrier that radiates.

    A barrier that radiates D (dF/dt)^2 lags: it gives way by D dF/dt less than it does statically.

    Attributes
    ----------
    give : (2, 2) m/N; waves : (2,) D, W s2/N2; both along n and t
    normal, shear : forces on the rod along n and t, N
    depth, way : approach and way of the contact point at the last step, m
    """

    row: SpringRow
    give: Array
    waves: tuple[float, float]
    normal: float = 0.0
    shear: float = 0.0
    depth: float = 0.0
    way: float = 0.0
    moved: float = 0.0

    def press(self, depth: float, way: float, dt: float) -> tuple[float, float]:
        """Return the forces on the rod, N, after a step of the contact point to ``depth`` and ``way``."""
        row = self.row
        closer, along, self.depth, self.way = depth - self.depth, way - self.way, depth, way
        ahead = self.waves[0] * row.stiffness(depth) * closer / dt
        approach = self._depth(depth + ahead - self.give[0, 1] * self.shear)
        self.normal = row.normal(approach)
        ahead = self.waves[1] * row.grip(approach) * along / dt
        moved = way + ahead + self.give[0, 1] * self.normal
        self._slide(approach, moved - self.moved)
        self.moved = moved
        return self.normal, self.shear

    def _depth(self, depth: float) -> float:
        """Return the springs' part of an approach, by Newton's rule."""
        approach = depth
        for _ in range(TRIES):
            slope = 1 + self.give[0, 0] * self.row.stiffness(approach)
            change = (approach + self.give[0, 0] * self.row.normal(approach) - depth) / slope
            approach -= change
            if abs(change) < STILL:
                break
        return approach

    def _slide(self, depth: float, step: float) -> None:
        """Move the springs by their part of a step; the force against it is piecewise linear in it."""
        part, shift, start = step, self.row.shift.copy(), self.shear
        for _ in range(TRIES):
            self.row.shift = shift.copy()
            self.shear = -self.row.slide(depth, part)
            # the rod's own part of the step goes with the change of the force on it
            over = part - step - self.give[1, 1] * (self.shear - start)
            part -= over / (1 + self.give[1, 1] * self.row.grip(depth))
            if abs(over) < STILL:
                break


def oblique_drop(
    rod: ObliqueRod,
    row: SpringRow,
    v_n: float,
    v_t: float,
    horizon: float = 2e-3,
    waves: tuple[float, float] = (0.0, 0.0),
    turning: bool = True,
) -> ObliqueRebound:
    """Return the rebound from velocities v_n, v_t < 0, m/s, followed for ``horizon`` s.

    ``waves`` are the barrier's radiation resistances along n and t, W s2/N2; without ``turning`` the contact
    point and the modes stay in their first attitude, as in printed drops.
    """
    k = len(rod.omega)
    motion = _Motion(rod, turning, v_n, v_t, np.zeros(k), np.zeros(k))
    contact = _Contact(row, rod.give, waves)
    dt = hertz(row.E_star, row.radius, rod.mass, -v_n).duration / STEPS
    for step in range(int(horizon / dt)):
        normal, way = motion.place()
        F, T = contact.press(-normal, way, dt)
        if F > 0:
            motion.push(dt * F, dt * T)
            motion.book(step * dt, dt * F)
        motion.fly(dt)
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
