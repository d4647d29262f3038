"""Quick estimate of an impact (milliseconds): the change by leaving an effect out is a difference of two.

A rod of beam modes strikes at one point. The place of the contact on the rod and the directions are fixed.
The contact is Hertz' until its peak pressure is p; beyond, the force grows by p over the added area 2 pi R d
of each depth increment, and it unloads like a Hertzian contact of the same area.
p is 2.8 times the flow stress, the softer body's ultimate stress with its gain by the rate. The tangential
force is Mindlin's spring up to Coulomb's limit; where the surface yields it is smaller:

    F_t <= F_n |v_t| / (3 |v_n|)      while it is pressed in: Levy-Mises flow of a layer between the bodies
    F_t <= F_max / (1 + pi/2)         a surface dragged at its shear strength k holds p = (1 + pi/2) k, as its
                                      slip lines turn by pi/4 from the free surface on (Hencky)

and a shear stress takes from the pressure, p / sqrt(1 + 3 (F_t/F_n)^2) (von Mises).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import cos, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from fem_impact.physics.beam import Beam, BeamFlight, Rigid, beam
from fem_impact.physics.contact import (
    LIMIT_PRESSURE,
    ContactBodies,
    approach,
    arms,
    contact_estimate,
    projectile,
    start_energy,
)
from fem_impact.physics.contact_law import ContactLaw, contact_law
from fem_impact.physics.hardening import rate_gain, strain_rate
from rigid import GRAVITY

STEPS = 150  # time steps over the estimated contact time
MOST_STEPS = 6000  # impulses and flights together
LAYER = 3.0  # factor of the squared shear stress beside the squared normal one (von Mises)
DRAGGED = 1 / (1 + pi / 2)  # shear strength over pressure of a surface that is dragged (Hencky)
SLOWEST = 1e-6  # m/s, least approach that the rebound is divided by


class BeamImpact(NamedTuple):
    """Restitution of the contact point's rigid motion, vibration over E_0, spin after, rad/s."""

    e: float
    E_vib: float
    Omega: float


@dataclass(slots=True)
class Touch:
    """The contact: its law, largest depth, m, the force there, N, and the tangential force now, N."""

    law: ContactLaw
    peak: float = 0.0
    most: float = 0.0
    side: float = 0.0

    def press(self, depth: float, approach: float, sliding: float, dt: float) -> tuple[float, float]:
        """Return normal and tangential force, N, at a depth, m, with the point's speeds, m/s."""
        if depth <= 0:
            self.side = 0.0
            return 0.0, 0.0
        force = self._normal(depth)
        limit = self._most_side(force, depth, approach, sliding)
        spring = self.side - self.law.shear * sqrt(self.law.R * depth) * sliding * dt
        self.side = max(-limit, min(limit, spring))
        return force, self.side

    def _most_side(self, force: float, depth: float, approach: float, sliding: float) -> float:
        limit = self.law.friction * force
        if not self._yielded():
            return limit
        if depth >= self.peak and approach > 0:
            limit = min(limit, force * abs(sliding) / (LAYER * approach))
        return min(limit, DRAGGED * self.most)

    @property
    def crater(self) -> float:
        """Permanent depth, m; the force is zero above it."""
        return self.peak - self._back()

    def _normal(self, depth: float) -> float:
        if depth >= self.peak:
            self.most, self.peak = self._first(depth), depth
            return self.most
        back = self._back()
        return float(self.most * (max(depth - self.peak + back, 0.0) / back) ** 1.5)

    def _back(self) -> float:
        """Return the elastic recovery of the largest depth, m; it gives back no more than it took."""
        if not self._yielded():
            return self.peak
        law = self.law
        area = law.R * (2 * self.peak - law.yield_depth)  # over pi
        work = 0.4 * law.yield_force * law.yield_depth
        work += 0.5 * (law.yield_force + self.most) * (self.peak - law.yield_depth)
        return min(0.75 * self.most / (law.E_star * sqrt(area)), work / (0.4 * self.most))

    def _first(self, depth: float) -> float:
        law, ratio = self.law, self.side / self.most if self.most else 0.0
        if depth <= law.yield_depth:
            return float(law.stiffness * depth**1.5)
        return law.yield_force + law.slope * (depth - law.yield_depth) / sqrt(1 + LAYER * ratio**2)

    def _yielded(self) -> bool:
        return self.peak > self.law.yield_depth


@cache
def strike(bodies: ContactBodies, vibrating: bool, rate: bool, gravity: bool) -> BeamImpact:
    """Return the quick estimate of an impact.

    Parameters
    ----------
    vibrating : whether the rod has its beam modes
    rate : whether flow stresses grow with the strain rate
    gravity : whether gravity acts
    """
    modes = beam(bodies.scene)
    resolved = modes.omega * contact_estimate(bodies).duration / STEPS < pi  # half a turn in a step
    modes = Beam(*(part[resolved & vibrating] for part in modes))
    return _march(bodies, modes, Touch(_law(bodies, rate)), gravity)


def _march(bodies: ContactBodies, modes: Beam, touch: Touch, gravity: bool) -> BeamImpact:
    """March in time, impulse of the contact force and exact flight in turn, until the rod has left."""
    scene = bodies.scene
    rod, impact, (d_c, d_d) = projectile(scene), scene.relative, arms(scene)
    inertia = rod.mass * rod.k2
    lightness = 1 / rod.mass + d_c**2 / inertia + float(modes.along_n @ modes.along_n)
    dt = _time_step(bodies, touch.law, lightness)
    g = GRAVITY * dt if gravity else 0.0
    flight = BeamFlight(modes, dt, d_c, (g * cos(impact.angle), g * sin(impact.angle)))
    now, swing = Rigid(impact.v_n, impact.v_t, impact.omega, 0.0), np.zeros(len(modes.omega), dtype=complex)
    steps = last = 0
    for _ in range(MOST_STEPS):
        w_n = now.V_n + d_c * now.spin + float(modes.along_n @ swing.imag)
        w_t = now.V_t - d_d * now.spin + float(modes.along_t @ swing.imag)
        p_n, p_t = (dt * force for force in touch.press(flight.depth(now, swing), -w_n, w_t, dt))
        turned = now.spin + (d_c * p_n - d_d * p_t) / inertia
        now = Rigid(now.V_n + p_n / rod.mass, now.V_t + p_t / rod.mass, turned, now.height)
        swing = swing + 1j * (p_n * modes.along_n + p_t * modes.along_t)
        last = steps if p_n > 0 else last
        if (steps - last) * dt > flight.longest or (p_n == 0 and flight.gone(now, swing, touch.crater)):
            break
        n = 1 if p_n > 0 else flight.free(now, swing, touch.crater)
        (now, swing), steps = flight.fly(now, swing, n), steps + n
    rebound = now.V_n + flight.g[0] * steps + d_c * now.spin
    E_vib = float(np.sum(np.abs(swing) ** 2)) / 2 / start_energy(scene)
    return BeamImpact(rebound / max(approach(scene), SLOWEST), E_vib, now.spin)


def _time_step(bodies: ContactBodies, law: ContactLaw, lightness: float) -> float:
    """Return the time step, s: that of the stiffest unloading of a point of so much speed per impulse, 1/kg.

    A sharp tip has much less mass than the rod. Impulses and flights in turn are stable up to twice this.
    """
    estimate = contact_estimate(bodies)
    stiffness = 2 * law.E_star * sqrt(2 * law.R * estimate.depth)
    return min(estimate.duration / STEPS, 1 / sqrt(stiffness * lightness))


def _law(bodies: ContactBodies, rate: bool) -> ContactLaw:
    """Return the contact law whose limit pressure is that of the flow stress, on the area 2 pi R d."""
    law = contact_law(bodies)
    soft = min(bodies.yielding, key=lambda metal: metal.ultimate_stress, default=None)
    if soft is None:
        return law
    limit = LIMIT_PRESSURE * soft.ultimate_stress * (1 + rate_gain(soft, strain_rate(bodies)) * rate)
    depth = (pi * limit / (2 * law.E_star)) ** 2 * law.R
    force = law.stiffness * depth**1.5
    return law._replace(limit=limit, yield_depth=depth, yield_force=force, slope=2 * pi * limit * law.R)
