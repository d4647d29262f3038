"""What models leave out of a projectile: a shaft that flows, a flattened wall, sharp shoulders, a ridge."""

from itertools import pairwise
from math import cos, pi, sin, sqrt

import numpy as np

from fem_impact.case.bodies import SAME_PLACE, Bodies
from fem_impact.physics.beam import prongs
from fem_impact.physics.contact import section_frequency
from fem_impact.physics.stepped_beam import sections
from meshes.revolved import without_shoulders
from rigid import Faceted, Turned

RIDGE = 0.25  # of the diameter, length of the shortest edge of a mesh that lands along a line
PRONG = 0.5  # of the first bending period: the shortest period of prongs that counts
THIN = 3.0  # middle radius over wall from which on a wall bends as a thin ring


def shaft_flows(bodies: Bodies) -> str:
    """Say that the axial stress of the strike would pass the yield stress of the shaft; empty if it does not.

    The stress is that of a plane wave, rho c0 v along the axis (G. I. Taylor, Proc. R. Soc. A 194 (1948) 289,
    doi:10.1098/rspa.1948.0081), or, where that is less, the estimated force of the contact over the smallest
    section of the first half, one diameter behind the tip. Bending is not in it.
    """
    contact, rod = bodies.contact, bodies.contact.rod
    stress = sqrt(rod.E * rod.rho) * max(contact.approach, 0.0) * cos(contact.angle)
    if not contact.rod_yields or stress < rod.yield_stress:
        return ""
    shaft = sections(bodies.rod)
    behind = (shaft.z[:-1] >= contact.body.diameter) & (shaft.z[1:] <= 0.5 * bodies.rod.length)
    if behind.any():
        stress = min(stress, _axial_force(bodies) * rod.E / float(shaft.EA[behind].min()))
    if stress < rod.yield_stress:
        return ""
    told = f"{stress / 1e6:.3g} MPa over {rod.yield_stress / 1e6:.3g} MPa"
    return f"a shaft that would yield along its length (axial stress, estimated: {told})"


UPRIGHT = 0.3  # sine of the angle up to which a strike stretches more than it bends
BENT = 0.0496
"""Energy of the first free bending mode of a round rod over volume times sigma^2 / E, its highest stress."""


def bends_beyond(bodies: Bodies, energy: float) -> str:
    """Say that a round rod whose bending vibration holds so much energy, J, would yield by it; else empty.

    The highest stress of the first free mode, sigma^2 = U E / (0.0496 V), is that of no other bending mode by
    more than a few per cent. Upright strikes stretch the rod instead.
    """
    rod, contact = bodies.rod, bodies.contact
    round_rod = rod.own_mesh is None and not rod.bore and len(rod.segments) < 2 and not rod.is_short
    if not (round_rod and contact.rod_yields and abs(sin(contact.angle)) > UPRIGHT):
        return ""
    stress = sqrt(energy * contact.rod.E * contact.rod.rho / (BENT * contact.body.mass))
    if stress < contact.rod.yield_stress:
        return ""
    told = f"{stress / 1e6:.3g} MPa over {contact.rod.yield_stress / 1e6:.3g} MPa"
    return f"Left out: the rod would yield by bending away from its contact (estimated stress {told})."


def _axial_force(bodies: Bodies) -> float:
    """Return the estimated force, N, of the contact along the axis."""
    size = bodies.estimate
    return size.pressure * pi * size.a_t * size.a_b * cos(bodies.contact.angle)


def part_flows(bodies: Bodies) -> tuple[int, float]:
    """Return which segment, of those after the first, would yield along its length, and its stress, Pa.

    The stress is that of the plane wave that the segment before passes on, 2 Z Z' / (Z + Z') v with their
    impedances Z = rho c0, or, where that is less, the estimated force of the contact over the smallest
    section of the segment, as of `shaft_flows`. Segments count from 1; 0: none would.
    """
    parts, contact = bodies.rod.segments, bodies.contact
    if len(parts) < 2:
        return 0, 0.0
    shaft, force = sections(bodies.rod), _axial_force(bodies)
    for number, (before, part) in enumerate(pairwise(parts), 2):
        metal = part.material
        own = (shaft.z[:-1] >= before.to - 1e-9) & (shaft.z[1:] <= part.to + 1e-9)
        Z, Z_before = (sqrt(one.material.E * one.material.rho) for one in (part, before))
        wave = 2 * Z * Z_before / (Z + Z_before) * max(contact.approach, 0.0) * cos(contact.angle)
        stress = min(wave, force * metal.E / float(shaft.EA[own].min()))
        if stress > metal.yield_stress:
            return number, stress
    return 0, 0.0


def wall_is_flattened(bodies: Bodies) -> str:
    """Say that a tube which comes down on its side would be flattened for good; empty if it would not.

    The energy of the strike is held against what its rings bear elastically between two plates up to their
    collapse load, 4 M / R a metre with M = sigma_y t^2 / 4 (DeRuntz and Hodge 1963, J. Appl. Mech. 30, 391);
    R is the middle radius, t the wall, and a thin ring gives way by (pi / 4 - 2 / pi) P R^3 / (E I).
    """
    rod, contact = bodies.rod, bodies.contact
    if not (rod.bore and contact.rod_yields and contact.lands_flat and cos(contact.angle) < 0.5):
        return ""
    _, outer, inner = rod.wall()
    R, t = 0.5 * (outer + inner), outer - inner
    load = contact.rod.yield_stress * t**2 / R
    gives = (pi / 4 - 2 / pi) * load * R**3 / (contact.rod.E * t**3 / 12)
    bears = 0.5 * float((load * gives).mean()) * rod.length
    comes = 0.5 * contact.body.mass * contact.approach**2
    if (R < THIN * t).any() or comes <= bears:
        return ""
    return f"a wall that would be flattened ({comes:.3g} J come down, and it bears {bears:.3g} J elastically)"


def gives_elsewhere(bodies: Bodies) -> str:
    """Say what of a body gives way besides its contact, and in no beam; empty if nothing does."""
    return shaft_flows(bodies) or wall_is_flattened(bodies) or rings_through(bodies) or pronged(bodies)


def pronged(bodies: Bodies) -> str:
    """Say that a body parts into prongs that swing on their own, as a fork does; empty if it does not."""
    found = prongs(bodies.rod)
    if found.period < PRONG * bodies.bending_period:
        return ""
    size = f"{1e3 * found.length:.2g} mm long and {1e3 * found.width:.2g} mm wide"
    return f"prongs {size}, which bend on their own"


def rings_through(bodies: Bodies) -> str:
    """Say that waves through the thickness of a body that lands on its face decide; empty if they do not.

    Such a contact lasts as long as a wave takes through the body and back. The modes of a beam end below the
    first that deforms its section, and a short body has no stretching mode below it.
    """
    contact, period = bodies.contact, bodies.stretching_period
    if not contact.all_may_touch or 2 * pi / period <= section_frequency(contact.rod, contact.body.diameter):
        return ""
    back = f"there and back: {period * 1e6:.3g} us"
    return f"waves through the thickness of a body that lands on its face ({back})"


def coned(bodies: Bodies) -> str:
    """Say where meshes have a cone in place of a shoulder; empty of a body without one."""
    body = bodies.body
    if not isinstance(body, Turned):
        return ""
    bore = np.zeros((0, 2)) if body.bore is None else body.bore
    *_, heights = without_shoulders(body.outline, bore, bodies.scene.across)
    places = " and ".join(f"{z * 1e3:.3g} mm" for z in heights)
    are = ("shoulder {} from the tip is a cone", "shoulders {} from the tip are cones")[len(heights) > 1]
    foot = float(bodies.lowest_point[2])
    on_one = any(abs(z - foot) < SAME_PLACE * body.length for z in heights)
    beside = ", whose edge touches first: finite elements land beside it" * on_one
    return f"in a mesh the {are.format(places)} of 63 degrees or less{beside}" if places else ""


def lands_on_ridge(bodies: Bodies) -> bool:
    """Return whether an edge of a mesh lands flat, no side with a width; facets of round tips are shorter."""
    body, touch, angle = bodies.body, bodies.contact.touch, bodies.contact.angle
    if not isinstance(body, Faceted) or touch.length <= RIDGE * body.diameter:
        return False
    middle, half = np.array(touch[:2]), 0.5 * touch.length * np.array([cos(angle), sin(angle)])
    return not body.half_widths(middle - half, middle + half, np.array([0.02, 0.5, 0.98])).any()
