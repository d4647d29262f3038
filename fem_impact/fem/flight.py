"""Split of the rod's motion into a rigid and a vibrating part, and its exact free flight."""

from dataclasses import dataclass

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.eigen import RodModes


@dataclass(frozen=True, slots=True)
class RigidMotion:
    """Rigid part of the whole rod's motion, from its momentum and angular momentum.

    Attributes
    ----------
    mass, inertia : kg, kg m2 (about b through the mass centre), whole rod
    centre : (3,), m
    V_n, V_t, Omega : m/s, m/s, rad/s (positive from n to t)
    kinetic : rigid kinetic energy, J
    """

    mass: float
    inertia: float
    centre: Array
    V_n: float
    V_t: float
    Omega: float

    @property
    def kinetic(self) -> float:
        """Return the kinetic energy of the rigid part, J."""
        return 0.5 * (self.mass * (self.V_n**2 + self.V_t**2) + self.inertia * self.Omega**2)

    @property
    def spin(self) -> float:
        """Return the angular momentum about the origin, kg m2/s."""
        orbit = self.mass * (self.centre[2] * self.V_t - self.centre[0] * self.V_n)
        return float(self.inertia * self.Omega + orbit)


def rigid_motion(x: Array, v: Array, mass: Array) -> RigidMotion:
    """Return the rigid motion of nodes at x, m, with velocities v, m/s, both (n, 3) in (t, b, n).

    ``mass`` (n,), kg, is that of the half model.
    """
    half = float(mass.sum())
    centre, V = mass @ x / half, mass @ v / half
    arm, relative = x - centre, v - V
    inertia = float(mass @ (arm[:, 0] ** 2 + arm[:, 2] ** 2))
    spin = float(mass @ (arm[:, 2] * relative[:, 0] - arm[:, 0] * relative[:, 2]))
    return RigidMotion(2 * half, 2 * inertia, centre, float(V[2]), float(V[0]), spin / inertia)


@dataclass(frozen=True, slots=True)
class FreeVibration:
    """Vibration of the rod in free flight: q_i(t) = a_i cos(omega_i t) + b_i sin(omega_i t).

    ``a`` and ``b`` are (k,), sqrt(kg) m, about the rest shape, which may have residual stress.
    """

    modes: RodModes
    a: Array
    b: Array

    @property
    def energies(self) -> Array:
        """Return the energy (k,) of each mode of the whole rod, J."""
        return np.asarray(self.modes.omega**2 * (self.a**2 + self.b**2))

    @property
    def energy(self) -> float:
        """Return the vibration energy of the whole rod, J."""
        return float(self.energies.sum())

    @property
    def strain(self) -> float:
        """Return the strain energy of the vibration at t = 0, whole rod, J."""
        return float((self.modes.omega**2 * self.a**2).sum())

    def displacement(self, rows: Ints, t: Array) -> Array:
        """Return displacements (m, times), m, of unknowns ``rows`` (m,) at times ``t`` from the start, s."""
        phase = np.outer(self.modes.omega, t)
        q = self.a[:, None] * np.cos(phase) + self.b[:, None] * np.sin(phase)
        return np.asarray(self.modes.shape[rows] @ q)


def flight(modes: RodModes, v: Array, force: Array) -> FreeVibration:
    """Return the free vibration from velocities, m/s, and internal forces, N, both (n,), in the rod's frame.

    The displacement amplitudes come from the forces, a = -shape . f / omega^2, not from positions:
    residual stress after yielding is in equilibrium with itself and is no vibration.
    """
    q_rate = modes.shape.T @ (modes.mass * v)
    pull = modes.shape.T @ force
    return FreeVibration(modes, -pull / modes.omega**2, q_rate / modes.omega)
