"""How long a mass without arms stays in contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_impact.arrays import Array
from fem_impact.modal.impact import reach
from fem_impact.modal.march import ALONE, MOST_CONTACTS, RIGID, Bounds, Start, drop
from fem_impact.physics.contact_law import ContactLaw
from fem_impact.reference.oblique import ObliqueRod

STEP, FREE = 2e-8, 1e-6  # s
LATEST = 1.0  # s


def contact_time(law: ContactLaw, mass: float, speed: float) -> float:
    """Return the contact time, s, of a rigid mass, kg, that falls along the normal with a speed, m/s."""
    start = Start(mass, 1.0, 0.0, 0.0, 0.0, 0.0, -speed, 0.0, 0.0, 0.0)
    bounds = Bounds(STEP, FREE, LATEST, reach(law, 0.5 * mass * speed**2))
    contacts = np.zeros((MOST_CONTACTS, 4))
    drop(start, law, RIGID, ALONE, bounds, contacts)
    return float(contacts[0, 1] - contacts[0, 0])


HORIZON = 8e-3  # s: the longest flight to a further touch
SAMPLES = 24  # over the shortest period
MOST = 40  # contacts


@dataclass(frozen=True, slots=True)
class SpringDrop:
    """Kinematic restitution of the contact point, vibration over E_0, number of contacts."""

    restitution: float
    vibration: float
    contacts: int


def spring_drop(rod: ObliqueRod, stiffness: float) -> SpringDrop:
    """Return the rebound of a rod that falls along n; it does not depend on the speed.

    Parameters
    ----------
    stiffness : of the contact, N/m
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
    """Return the time, s, after which the rigid drift has outrun the sum of all modal amplitudes."""
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
        square, shape = np.linalg.eigh(K)
        return cls(np.sqrt(np.maximum(square, 0.0)), shape, c)

    def at(self, x: Array, v: Array, t: Array) -> tuple[Array, Array]:
        """Return x and v, (k, n), at times t (n,)."""
        q, rate = self.shape.T @ x, self.shape.T @ v
        phase = np.outer(self.omega, t)
        # sin(w t) / w, which is t for a rigid motion
        swing = t * np.sinc(phase / np.pi)
        cosine = np.cos(phase)
        x_t = q[:, None] * cosine + rate[:, None] * swing
        v_t = rate[:, None] * cosine - (self.omega**2 * q)[:, None] * swing
        return self.shape @ x_t, self.shape @ v_t

    def gap(self, x: Array, v: Array, t: float) -> float:
        """Return the contact point's normal displacement at a time."""
        return float(self.c @ self.at(x, v, np.array([t]))[0][:, 0])

    def until(self, x: Array, v: Array, rising: bool, horizon: float) -> tuple[Array, Array, bool]:
        """Return the state at which the gap next rises (or falls) through zero, and whether it does."""
        dt = 2 * np.pi / float(self.omega.max()) / SAMPLES
        t: Array = dt * np.arange(1.0, max(horizon // dt, 2.0))
        past = (self.c @ self.at(x, v, t)[0] >= 0.0) == rising
        first = int(past.argmax())
        touched = bool(past[first])
        end = self._refine(x, v, float(t[first]) - dt, float(t[first])) if touched else float(t[-1])
        state = self.at(x, v, np.array([end]))
        return state[0][:, 0], state[1][:, 0], touched

    def _refine(self, x: Array, v: Array, low: float, high: float) -> float:
        """Return where the gap changes sign between two times, by bisection; the later end of the bracket."""
        at_end = self.gap(x, v, high) >= 0.0
        for _ in range(40):
            middle = 0.5 * (low + high)
            same = (self.gap(x, v, middle) >= 0.0) == at_end
            low, high = (low, middle) if same else (middle, high)
        return high
