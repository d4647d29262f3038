"""Reference drops of the criterion study: contact time of a point mass, rebound of a rod from a spring.

The point mass uses the contact law of the modal fidelity; the rod on a spring is piecewise linear and solved
exactly by its modes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_impact.arrays import Array
from fem_impact.evidence.references.oblique import ObliqueRod
from fem_impact.modal.impact import reach
from fem_impact.modal.march import drop
from fem_impact.modal.motion import ALONE, MOST_CONTACTS, RIGID, Bounds, Start
from fem_impact.physics.contact_law import ContactLaw
from fem_impact.physics.flow_law import FlowLaw

STEP, FREE = 2e-8, 1e-6  # s: time steps of the point mass in contact and in flight
LATEST = 1.0  # s: end of the point mass's run
HORIZON = 8e-3  # s: longest flight of the spring drop before its next contact
SAMPLES = 24  # of the gap over the shortest period
MOST = 40  # contacts of a spring drop


def contact_time(law: ContactLaw, flow: FlowLaw, mass: float, speed: float) -> float:
    """Return the contact time, s, of a rigid mass, kg, that falls along the normal with a speed, m/s."""
    start = Start(mass, 1.0, 0.0, 0.0, 0.0, 0.0, -speed, 0.0, 0.0, 0.0)
    bounds = Bounds(STEP, FREE, LATEST, reach(law, flow, 0.5 * mass * speed**2))
    contacts = np.zeros((MOST_CONTACTS, 4))
    drop(start, law, flow, RIGID, ALONE, bounds, contacts, np.zeros((0, 15)))
    return float(contacts[0, 1] - contacts[0, 0])


@dataclass(frozen=True, slots=True)
class SpringDrop:
    """Rebound from a linear spring: e of the contact point (kinematic), E_vib/E_0, number of contacts."""

    restitution: float
    vibration: float
    contacts: int


def spring_drop(rod: ObliqueRod, stiffness: float) -> SpringDrop:
    """Return the rebound of a rod that falls along n onto a linear spring; it does not depend on the speed.

    Parameters
    ----------
    rod : inertia, lever arms and modes
    stiffness : of the spring, N/m
    """
    scale = np.sqrt(np.concatenate([[rod.mass, rod.mass * rod.k2], np.ones(len(rod.omega))]))
    # the contact point's normal displacement is c . x for mass-normalised unknowns x
    c = np.concatenate([[1.0, rod.d_c], rod.along_n]) / scale
    free = np.diag(np.concatenate([[0.0, 0.0], rod.omega**2]))
    touching = _System.of(free + stiffness * np.outer(c, c), c)
    flying = _System.of(free, c)
    x, v = np.zeros(len(c)), np.zeros(len(c))
    v[0] = -scale[0]
    count = 0
    touched, span = True, 2 * np.pi * float(np.sqrt(rod.mass / stiffness))
    while touched and count < MOST:
        pressed = True
        while pressed:
            x, v, released = touching.until(x, v, True, span)
            pressed = not released
        count += 1
        x, v, touched = flying.until(x, v, False, _reach(rod, x, v, c))
    V_n, Omega = v[:2] / scale[:2]
    vibration = 0.5 * float((v[2:] ** 2 + (rod.omega * x[2:]) ** 2).sum())
    return SpringDrop(float(V_n + rod.d_c * Omega), vibration / (0.5 * rod.mass), count)


def _reach(rod: ObliqueRod, x: Array, v: Array, c: Array) -> float:
    """Return the time, s, after which the rigid motion exceeds the sum of all modal amplitudes.

    No contact can follow; at most `HORIZON`.
    """
    drift, start = float(c[:2] @ v[:2]), float(c[:2] @ x[:2])
    amplitude = float(np.abs(c[2:]) @ np.hypot(x[2:], v[2:] / rod.omega))
    return min(HORIZON, (amplitude - start) / drift) if drift > 0 else HORIZON


@dataclass(frozen=True, slots=True)
class _System:
    """x'' + K x = 0 by its modes: circular frequencies (k,), shapes (k, k), contact direction (k,)."""

    omega: Array
    shape: Array
    c: Array

    @classmethod
    def of(cls, K: Array, c: Array) -> _System:
        """Return the modes of a mass-normalised stiffness (k, k), 1/s^2; negative round-off is set to 0."""
        omega_squared, shape = np.linalg.eigh(K)
        return cls(np.sqrt(np.maximum(omega_squared, 0.0)), shape, c)

    def at(self, x: Array, v: Array, t: Array) -> tuple[Array, Array]:
        """Return x and v, (k, n), at times t (n,)."""
        q, rate = self.shape.T @ x, self.shape.T @ v
        phase = np.outer(self.omega, t)
        # sin(omega t) / omega, which is t for a rigid motion
        sine = t * np.sinc(phase / np.pi)
        cosine = np.cos(phase)
        x_t = q[:, None] * cosine + rate[:, None] * sine
        v_t = rate[:, None] * cosine - (self.omega**2 * q)[:, None] * sine
        return self.shape @ x_t, self.shape @ v_t

    def until(self, x: Array, v: Array, rising: bool, horizon: float) -> tuple[Array, Array, bool]:
        """Return x, v at the gap's next rise (or fall) through 0, and whether it is in the horizon, s."""
        dt = 2 * np.pi / float(self.omega.max()) / SAMPLES
        t: Array = dt * np.arange(1.0, max(horizon // dt, 2.0))
        passed = (self.c @ self.at(x, v, t)[0] >= 0.0) == rising
        first = int(passed.argmax())
        touched = bool(passed[first])
        low, end = (float(t[first]) - dt, float(t[first])) if touched else (0.0, float(t[-1]))
        for _ in range(40 if touched else 0):  # bisection; the bracket's later end is taken
            middle = 0.5 * (low + end)
            gap = self.c @ self.at(x, v, np.array([middle]))[0][:, 0]
            low, end = (low, middle) if (gap >= 0.0) == rising else (middle, end)
        state = self.at(x, v, np.array([end]))
        return state[0][:, 0], state[1][:, 0], touched
