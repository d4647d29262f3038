"""What theory says of dropped rods: point masses, rods on a spring, and rods that bend without vibration.

The point mass and the static rod use the contact law of the modal fidelity; the rod on a spring is piecewise
linear and solved exactly by its modes.
"""

from dataclasses import dataclass
from functools import cache
from math import pi, sqrt

import numpy as np

from fem_impact import Case
from fem_impact.arrays import Array
from fem_impact.evidence.references.hertz import SPAN
from fem_impact.evidence.references.oblique import ObliqueRod, oblique_rod
from fem_impact.evidence.studies.rods import DroppedRod, length_of
from fem_impact.modal.groove import indent
from fem_impact.modal.impact import drop_round
from fem_impact.modal.laws import reach
from fem_impact.modal.motion import Bounds, Start
from fem_impact.modal.rod import modal_rod
from fem_impact.physics.contact_law import ContactLaw, FlowLaw, contact_law, flow_law
from rigid import LIMIT

STEP, FREE = 2e-8, 1e-6  # s: time steps of the point mass in contact and in flight
LATEST = 1.0  # s: end of the point mass's run
HORIZON = 8e-3  # s: longest flight of the spring drop before its next contact
SAMPLES = 24  # of the gap over the shortest period
MOST = 40  # contacts of a spring drop


def contact_time(law: ContactLaw, flow: FlowLaw, mass: float, speed: float) -> float:
    """Return the contact time, s, of a rigid mass, kg, that falls along the normal with a speed, m/s."""
    bounds = Bounds(STEP, FREE, LATEST)
    contacts = drop_round(Start(mass, 1.0), law, flow, (-speed, 0.0, 0.0), bounds, 0.0).contacts
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
    def of(cls, K: Array, c: Array) -> "_System":
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


@cache
def slender(rod: DroppedRod) -> ObliqueRod:
    """Return the rod's bending (Timoshenko) and stretching (Love) modes at the contact point."""
    scene = rod.scene()
    body, steel, alpha = scene.projectile.rigid_body, scene.projectile.material, scene.impact.angle
    d_c, d_d = (float(arm) for arm in body.arms(alpha))
    rho, z = (float(coordinate) for coordinate in body.contact_point(alpha))
    inertia, radius = (body.mass, body.k2), rod.diameter / 2
    return oblique_rod(steel.E, steel.nu, steel.rho, rod.length, radius, alpha, inertia, (d_c, d_d), (rho, z))


def blind_ratio(rod: DroppedRod) -> float:
    """Return mu*, the ratio of tangential to normal force that does not excite the first bending mode."""
    modes = slender(rod)
    return float(-modes.along_n[0] / modes.along_t[0])


def effective_mass(rod: ObliqueRod) -> float:
    """Return the effective mass of a frictionless contact, kg: m / (1 + d_c^2/k^2)."""
    return rod.mass / (1 + rod.d_c**2 / rod.k2)


@cache
def spring_stiffness() -> float:
    """Return the stiffness, N/m, of a linear spring on which rods fall.

    It gives the contact time of Hertz' contact (Johnson, Contact Mechanics, section 11.4) of 19 mm, 45
    degrees and 2.1 m/s at the limit of Eq 29.
    """
    rod = DroppedRod(length_of(LIMIT))
    scene, mass = rod.scene(), effective_mass(slender(rod))
    stiffness, v_n = contact_law(Case.of(scene, "modal").contact).stiffness, -scene.impact.v_n
    depth = (5 * mass * v_n**2 / (4 * stiffness)) ** 0.4
    return mass * (pi / float(SPAN * depth / v_n)) ** 2


def spring_bounce(rod: DroppedRod) -> dict[str, float]:
    """Return columns of a rod on that spring: e with and without vibration, T1/tau by either mass."""
    modes, period, k = slender(rod), rod.first_period, spring_stiffness()
    return {
        "e_edge": spring_drop(modes, k).restitution,
        "e_edge_rigid": 1.0,
        "T1_over_tau": period / (pi * sqrt(effective_mass(modes) / k)),
        "T1_over_tau_whole": period / (pi * sqrt(modes.mass / k)),
    }


@cache
def whole_ratio(rod: DroppedRod) -> float:
    """Return T1/tau with tau of the rod's whole mass, falling at full speed onto its contact.

    The effective mass of an inclined contact is less: m* = m / (1 + d_c^2/k^2).
    """
    case = Case.of(rod.scene(), "modal")
    flow = flow_law(case.contact, case.slots.rod_law, case.slots.barrier_law)
    mass = case.scene.projectile.rigid_body.mass
    return rod.first_period / contact_time(contact_law(case.contact), flow, mass, rod.speed)


def static_restitution(rod: DroppedRod) -> float:
    """Return e of a frictionless rod that deforms elastically but is left without vibration.

    Its modes act as springs without inertia: they take up energy as the contact force rises and return it as
    it falls, so that less is left for plastic flow. Impact energy = plastic and elastic work of the contact +
    F^2/2 times the flexibility of the modes. The groove is pressed in along the normal: that holds for
    upright rods, whose tip slides little meanwhile. All of the contact counts as round: where it reaches the
    straight parts beside the edge, as at 5 degrees, that gives up to .03 more of e.
    """
    case = Case.of(rod.scene(), "modal")
    modes = modal_rod(case.bodies)
    law = flow_law(case.contact, case.slots.rod_law, case.slots.barrier_law)
    mass = modes.mass / (1 + modes.arm[0] ** 2 / modes.k2)
    energy = 0.5 * mass * case.scene.impact.v_n**2
    widest = reach(contact_law(case.contact), law, energy)
    return sqrt(1 - indent(law, widest, modes.flexibility, energy)[2] / energy)
