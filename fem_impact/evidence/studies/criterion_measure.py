"""Restitution of a rod over the angles, error of rigid theory, group T1/tau, and where it passes a level."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import groupby, pairwise
from math import pi, sqrt
from operator import attrgetter

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.evidence.references.hertz import SPAN
from fem_impact.evidence.references.oblique import ObliqueRod, oblique_rod
from fem_impact.evidence.studies.point_mass import contact_time, spring_drop
from fem_impact.evidence.studies.rods import BODY, Drop, length_of
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.physics.contact_law import contact_law
from fem_impact.physics.flow_law import flow_law
from rigid import LIMIT

LEVELS = (0.02, 0.05, 0.10)
"""Errors of e beyond which a rod does not count as rigid."""


@dataclass(frozen=True, slots=True)
class Rod:
    """One rod on one contact over the angles.

    Attributes
    ----------
    drop : Drop
        The rod's drop at the first of the angles.
    angles : (n,)
        Inclinations, degrees.
    e, e_rigid : (n,)
        Restitution with vibration, and of the rod that cannot vibrate on the same contact.
    groups : (n,)
        T1/tau: first bending period over the contact time of the rod that cannot vibrate.
    whole : float
        T1 over the contact time of the rod's whole mass, falling at full speed onto the contact of 45
        degrees. The effective mass of an inclined contact is less: m* = m / (1 + d_c^2/k^2).
    bands : (n,)
        Half-widths of e - e_rigid by the mesh; 0 without a mesh.
    """

    drop: Drop
    angles: Array
    e: Array
    e_rigid: Array
    groups: Array
    whole: float
    bands: Array

    @property
    def error(self) -> float:
        """Largest change of e by vibration over the angles."""
        return float(np.abs(self.e - self.e_rigid).max())

    @property
    def error_low(self) -> float:
        """Largest change of e that the bands leave sure."""
        return float((np.abs(self.e - self.e_rigid) - self.bands).max())

    @property
    def error_high(self) -> float:
        """Largest change of e that the bands allow."""
        return float((np.abs(self.e - self.e_rigid) + self.bands).max())

    @property
    def spread(self) -> float:
        """Largest less smallest e over the angles: the published meaning of the criterion."""
        return float(np.ptp(self.e))

    @property
    def group(self) -> float:
        """T1/tau at the angle of the largest error."""
        return float(self.groups[int(np.abs(self.e - self.e_rigid).argmax())])


Rods = list[Rod]
Measure = Callable[[Rod], float]
error_of, spread_of = attrgetter("error"), attrgetter("spread")
error_low, error_high = attrgetter("error_low"), attrgetter("error_high")
gamma_of, group_of = attrgetter("drop.gamma"), attrgetter("group")


def rods_of(drops: Iterable[Drop], results: JobResults) -> Rods:
    """Return the rods of a family, drops sorted by rod; angles whose runs failed are left out."""
    rods = []
    for _, same in groupby(drops, lambda drop: (drop.diameter, drop.length)):
        pairs = [(drop, results[drop.name], results[replace(drop, vibrates=False).name]) for drop in same]
        done = [
            (
                drop,
                known(run.restitution.edge.e),
                known(stiff.restitution.edge.e),
                known(stiff.contact.intervals),
            )
            for drop, run, stiff in pairs
            if isinstance(run, Outcome) and isinstance(stiff, Outcome)
        ]
        if done:
            drop = done[0][0]
            angles, e, e_rigid, groups = np.array(
                [
                    (d.angle, e, e_rigid, d.first_period / touches[0].duration)
                    for d, e, e_rigid, touches in done
                ]
            ).T
            rods.append(Rod(drop, angles, e, e_rigid, groups, whole_ratio(drop), np.zeros(len(e))))
    return rods


def whole_ratio(drop: Drop) -> float:
    """Return T1/tau with tau of the rod's whole mass on the contact of 45 degrees (`Rod.whole`)."""
    level = replace(drop, angle=45.0).scene()
    planned, mass = Case.of(level, "modal"), level.projectile.rigid_body.mass
    flow = flow_law(planned.contact, planned.slots.rod_law, planned.slots.barrier_law)
    return drop.first_period / contact_time(contact_law(planned.contact), flow, mass, drop.speed)


def modal_restitution(drop: Drop, results: JobResults) -> float | None:
    """Return e of a drop by modes, None where its run failed."""
    run = results.get(drop.name)
    return known(run.restitution.edge.e) if isinstance(run, Outcome) else None


def linear_rods(drops: Iterable[Drop]) -> Rods:
    """Return rods on one linear spring, as stiff as gives Hertz' contact time at the limit of Eq 29.

    Drops are sorted by rod; the restitution of a rod that cannot vibrate is 1.
    """
    reference = Drop(length_of(LIMIT, BODY))
    k = _effective(slender(reference)) * (pi / _hertz_time(reference)) ** 2
    rods = []
    for _, group in groupby(drops, lambda drop: (drop.diameter, drop.length)):
        same = list(group)
        bodies, T1 = [slender(drop) for drop in same], same[0].first_period
        e = np.array([spring_drop(body, k).restitution for body in bodies])
        groups = np.array([T1 / (pi * sqrt(_effective(body) / k)) for body in bodies])
        angles, whole = np.array([drop.angle for drop in same]), T1 / (pi * sqrt(bodies[0].mass / k))
        rods.append(Rod(same[0], angles, e, np.ones(len(e)), groups, whole, np.zeros(len(e))))
    return rods


def _effective(rod: ObliqueRod) -> float:
    """Return the effective mass of a frictionless contact, kg: m / (1 + d_c^2/k^2)."""
    return rod.mass / (1 + rod.d_c**2 / rod.k2)


def _hertz_time(drop: Drop) -> float:
    """Return Hertz' contact time of a drop, s (Johnson, Contact Mechanics, section 11.4)."""
    scene = drop.scene()
    stiffness, v_n = contact_law(Case.of(scene, "modal").contact).stiffness, -scene.impact.v_n
    depth = (5 * _effective(slender(drop)) * v_n**2 / (4 * stiffness)) ** 0.4
    return float(SPAN * depth / v_n)


@lru_cache(maxsize=4096)
def slender(drop: Drop) -> ObliqueRod:
    """Return the rod's bending (Timoshenko) and stretching (Love) modes at the contact point."""
    scene = drop.scene()
    body, steel, alpha = scene.projectile.rigid_body, scene.projectile.material, scene.impact.angle
    d_c, d_d = (float(arm) for arm in body.arms(alpha))
    rho, z = (float(coordinate) for coordinate in body.contact_point(alpha))
    inertia, radius = (body.mass, body.k2), drop.diameter / 2
    return oblique_rod(
        steel.E, steel.nu, steel.rho, drop.length, radius, alpha, inertia, (d_c, d_d), (rho, z)
    )


def blind_ratio(drop: Drop) -> float:
    """Return mu*, the ratio of tangential to normal force that does not excite the first bending mode."""
    rod = slender(drop)
    return float(-rod.along_n[0] / rod.along_t[0])


def of_body(rods: Rods) -> Rods:
    """Return the rods of 19 mm, in order of slenderness."""
    return sorted((r for r in rods if r.drop.diameter == BODY), key=lambda r: r.drop.gamma)


def gamma_at(rods: Rods, diameter: float, level: float, measure: Measure = error_of) -> float | None:
    """Return the slenderness at which rods of a diameter first pass a level."""
    return place_at([r for r in rods if r.drop.diameter == diameter], level, gamma_of, measure)


def place_at(rods: Rods, level: float, place: Measure, measure: Measure = error_of) -> float | None:
    """Return where, in slenderness or T1/tau, a measure first passes a level, by linear interpolation."""
    same = sorted((place(r), measure(r)) for r in rods)
    for (low, below), (high, above) in pairwise(same):
        if below < level <= above:
            return low + (high - low) * (level - below) / (above - below)
    return None


def exponent(rods: Rods, level: float, measure: Measure = error_of) -> float | None:
    """Return p of l = C d^p along which the measure stays at a level, fitted over the diameters."""
    diameters = sorted({r.drop.diameter for r in rods})
    onsets = [(d, gamma_at(rods, d, level, measure)) for d in diameters]
    lengths = [(d, length_of(g, d)) for d, g in onsets if g is not None]
    if len(lengths) < 2:
        return None
    d, length = np.log(np.array(lengths)).T
    return float(np.polyfit(d, length, 1)[0])
