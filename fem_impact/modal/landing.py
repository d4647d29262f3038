"""Whether a straight part of the rod lands flat as one of its ends touches, and the law that it then gets."""

from math import atan2, cos, dist, pi, sin, sqrt

import numpy as np

from fem_impact.case.case import Case
from fem_impact.modal.flat import CELLS, LAW
from fem_impact.modal.motion import AT, SITE, ModalState, Touched
from fem_impact.modal.rod import ModalRod
from fem_impact.modal.sites import on_arc, skin
from fem_impact.modal.touch import LAID
from fem_impact.physics.contact import FLAT, ON_SIDE, ContactPair, impedance
from fem_impact.physics.contact_law import FULLY_PLASTIC, REPRESENTATIVE, FlowLaw, flow_law
from rigid import Faceted

NEAR = 0.5  # radii of gyration, beyond which a flank presses too far from its end to act there
LEANS = 0.25  # rise over length beyond which a straight part that touches with an end does not land flat
FINE = 11  # places in each cell at which the width of a flat side is looked at
OFF_PLANE = 0.01  # slope of a straight part that crosses the axis, up to which it is a face
RIGID = 1e-9  # share of the contact's give that a barrier which gives nothing is taken to have


def lay_flat(
    case: Case, rod: ModalRod, now: ModalState, held: Touched, s: int, pair: ContactPair, longest: float
) -> tuple[tuple[int, int], float] | None:
    """Lay a straight part with an end at a site along the barrier, if its other end is as near.

    It is where its middle lies within `FLAT` depths of the contact of its end (``pair``), over a surface that
    neither end has touched, and it rises by less than `LEANS` of its length; of two parts that meet there the
    one that leans less. A flank not ``longest``, m, and near its end presses into the groove of that; one
    that lies within the round contact beside it is part of that. Returns both sites and the stiffness of the
    whole, N/m; None where nothing is.
    """
    sites, free = rod.sites, held.flats.law[:, LAW.known] == 0.0
    count, depth, low = len(sites.along_t), pair.estimate.depth, height_of(rod, now, s)

    def part(side: int, other: int) -> tuple[float, float, list[tuple[float, float]]]:
        """Return how far the part between two rounds rises over its length, its far end's height, its ends.

        It begins where the round that touches ends, which is not where a wide nose touches.
        """
        if side:
            a, b, ends, begins = sites.begin[s + 1] - 1, sites.begin[other], sites.high, sites.low
        else:
            a, b, ends, begins = sites.begin[s], sites.begin[other + 1] - 1, sites.low, sites.high
        near, far = on_arc(sites, a, ends[a]), on_arc(sites, b, begins[b])
        heights = [raised(rod, now, k, place) for k, place in ((s, near), (other, far))]
        length = max(dist(near, far), 1e-12)  # of rounds that meet in a corner
        return (heights[1] - heights[0]) / length, heights[1], [in_body(case, *near), in_body(case, *far)]

    beside = [(side, other) for side, other in enumerate(((s - 1) % count, (s + 1) % count)) if other != s]
    for (lean, height, ends), other in sorted((part(*one), one[1]) for one in beside):
        if held.site[s, SITE.known] or held.site[other, SITE.known] or not free.any():
            continue
        gap = height - low
        within = max(min(longest, NEAR * sqrt(rod.k2)), sqrt(2 * _roundness(rod, s) * depth))
        short = not _is_face(ends) and dist(*ends) <= within
        if not short and lean < LEANS and gap <= 2 * FLAT * depth and _is_straight(case, ends, depth):
            f = int(np.argmax(free))
            held.flats.ends[f] = s, other
            flow = flow_law(pair, case.slots.rod_law, case.slots.barrier_law)
            if isinstance(case.bodies.body, Faceted):
                _set_facet(case, held, f, ends, pair, flow)
            elif _is_face(ends):
                _set_face(case, held, f, ends, pair, flow, _roundness(rod, s))
            else:
                _set_side(case, held, f, ends, pair, flow)
            for k in (s, other):
                row = held.site[k]
                row[SITE.known], row[SITE.awake], row[SITE.wake] = LAID, 0.0, 0.0
            law = held.flats.law[f]
            return (s, other), CELLS / float(1 / law[LAW.rod] + 1 / law[LAW.barrier])
    return None


def in_body(case: Case, t: float, n: float) -> tuple[float, float]:
    """Return (x, z), m, in the rod of a place (t, n), m, from its mass centre at first contact."""
    angle, body = case.contact.angle, case.bodies.body
    return body.x_c + cos(angle) * t - sin(angle) * n, body.z_c + cos(angle) * n + sin(angle) * t


def height_of(rod: ModalRod, now: ModalState, s: int) -> float:
    """Return the height, m, of what is lowest of a site over the mass centre."""
    return raised(rod, now, s, skin(rod.sites, s, float(now.rigid[AT.turn])))


def raised(rod: ModalRod, now: ModalState, s: int, place: tuple[float, float]) -> float:
    """Return the height, m, over the mass centre of a place (t, n), m, that moves as a site does."""
    turn, (t, n) = float(now.rigid[AT.turn]), place
    t, n = t + rod.sites.along_t[s] @ now.q, n + rod.sites.along_n[s] @ now.q
    return float(cos(turn) * n - sin(turn) * t)


def flexibility(case: Case) -> float:
    """Return (1 - nu^2) / E of the barrier, 1/Pa; 0 of a rigid one."""
    pair = case.contact
    return (1 - pair.barrier.nu**2) / pair.barrier.E if pair.compliant else 0.0


def _roundness(rod: ModalRod, s: int) -> float:
    """Return the radius, m, of the edge at a site; 0 of a corner."""
    begin, end = rod.sites.begin[s], rod.sites.begin[s + 1]
    return float(rod.sites.radius[begin:end].min())


def _is_face(ends: list[tuple[float, float]]) -> bool:
    """Return whether a straight part between two places (x, z) lies across the rod's axis.

    A corner counts as an arc through the place that touched, which is a little off the plane of its face.
    """
    (x, z), (u, w) = ends
    return abs(w - z) < (OFF_PLANE if x * u < 0.0 else 1e-6) * abs(u - x)


def _is_straight(case: Case, ends: list[tuple[float, float]], depth: float) -> bool:
    """Return whether the surface between two places (x, z), m, lies within a depth, m, of their line."""
    body, share = case.bodies.body, (np.arange(CELLS) + 0.5) / CELLS
    (x, z), (u, w) = ends
    if isinstance(body, Faceted):
        # feet at both ends, with or without a gap between
        return bool(body.half_widths(np.array(ends[0]), np.array(ends[1]), share[[0, -1]]).min() > depth)
    if _is_face(ends):
        return True
    if x * u < 0.0:
        return False
    radius = np.asarray(body.radius(z + share * (w - z)))
    return bool((abs(x) + share * (abs(u) - abs(x)) - radius < depth).all())


def _set_face(
    case: Case,
    held: Touched,
    f: int,
    ends: list[tuple[float, float]],
    pair: ContactPair,
    flow: FlowLaw,
    edge: float,
) -> None:
    """Enter the law of a face: it is as wide as its round edge lets it be at its depth."""
    (x, z), _ = ends
    flat, body = abs(x), case.bodies.body
    depth = pair.approach * sqrt(body.mass / (2 * flat * pair.modulus))
    wide = min(flat + sqrt(2 * edge * depth), 0.5 * body.diameter)
    bore = float(body.inner_radius(np.array(z))) if hasattr(body, "inner_radius") else 0.0
    place = wide * (2 * np.arange(CELLS) + 1 - CELLS) / CELLS
    # the round edge beyond an end comes down with it: on a line through both it would begin pressed in
    held.flats.share[f] = np.clip(0.5 * (1.0 - np.sign(x) * place / flat), 0.0, 1.0)
    held.flats.base[f] = wide**2 - place**2
    held.flats.inner[f] = np.sqrt(np.maximum(bore**2 - place**2, 0.0))
    bears = _of_face(flow, _spreads(case, z, flat, edge))
    _set_row(case, held, f, pair, flow, pair.modulus, bears, 2 * wide / CELLS, 0.0)


def _set_facet(
    case: Case, held: Touched, f: int, ends: list[tuple[float, float]], pair: ContactPair, flow: FlowLaw
) -> None:
    """Enter the law of a flat side of a mesh, as stiff as a round punch of its area; gaps bear nothing."""
    body, fine = case.bodies.body, (np.arange(FINE * CELLS) + 0.5) / (FINE * CELLS)
    assert isinstance(body, Faceted), "a facet is one of a mesh"
    wide = body.half_widths(np.array(ends[0]), np.array(ends[1]), fine)
    there = np.flatnonzero(wide)
    length = dist(*ends) * len(there) / len(fine)
    at = there[len(there) * (2 * np.arange(CELLS) + 1) // (2 * CELLS)]
    half = wide[at]
    held.flats.share[f], held.flats.base[f] = fine[at], half**2
    stiffness = 2 * pair.modulus * sqrt(2 * float(half.mean()) * length / pi) / length
    _set_row(case, held, f, pair, flow, stiffness, _of_face(flow), length / CELLS, 0.0)


def _spreads(case: Case, z: float, flat: float, edge: float) -> float:
    """Return the angle, over a right one, by which a body widens behind a face of a radius at a place z, m.

    It is that of the first radius behind the face, beyond a round ``edge``, m.
    """
    body = case.bodies.body
    behind = z + flat if z < 0.5 * body.length else z - flat
    wider = float(body.radius(np.array(min(max(behind, 0.0), body.length)))) - flat - edge
    return atan2(max(wider, 0.0), flat) / (0.5 * pi)


def _of_face(flow: FlowLaw, spreads: float = 0.0) -> float:
    """Return what a face bears, Pa: a rod that is pressed over all of it yields as a column.

    One that ``spreads`` behind it, by an angle over a right one, bears more in proportion to that: slip lines
    turn by so much on their way to its flank (truncated wedge, Hill 1950, chapter 9).
    """
    plane, column = flow.yield_stress, flow.other_yield_stress
    if not flow.ploughs:
        plane, column = column, plane
    return min(FULLY_PLASTIC * plane, column * (1.0 + (FULLY_PLASTIC - 1.0) * spreads))


def _set_side(
    case: Case, held: Touched, f: int, ends: list[tuple[float, float]], pair: ContactPair, flow: FlowLaw
) -> None:
    """Enter the law of a side that lies down along its length."""
    (x, z), (u, w) = ends
    length = float(np.hypot(u - x, w - z))
    R = 0.5 * (abs(x) + abs(u)) * length / abs(w - z)
    held.flats.share[f] = (np.arange(CELLS) + 0.5) / CELLS
    hardness = FULLY_PLASTIC * flow.yield_stress
    if np.isfinite(hardness):
        energy = 0.5 * pair.body.mass * pair.approach**2
        depth = (energy / (hardness * length * 4 / 3 * sqrt(2 * R))) ** (2 / 3)
        strain = REPRESENTATIVE * sqrt(2 * depth / R)
        hardness *= (1.0 + flow.slope * strain) ** flow.exponent
    _set_row(case, held, f, pair, flow, ON_SIDE * pair.modulus, hardness, length / CELLS, 2 * R)


def _set_row(
    case: Case,
    held: Touched,
    f: int,
    pair: ContactPair,
    flow: FlowLaw,
    stiffness: float,
    hardness: float,
    size: float,
    widens: float,
) -> None:
    """Enter a row of cells of a stiffness a metre, Pa, a hardness, Pa, and a size, m.

    A barrier with a mass of its own, or a plate that bends, is no half-space that waves leave through. Those
    of a barrier of layers are longer than these are thick: what lies under all of them takes them.
    """
    sheared = 0.5 * pair.shear_stiffness / pair.modulus  # tangential over normal stiffness
    cell, share = stiffness * size, max(flexibility(case) * pair.modulus, RIGID)
    springs = cell / (1 - share), cell / share, sheared * cell
    leaves = pair.compliant and not (case.scene.barrier.mass or case.slots.plate)
    waves = impedance(case.scene.barrier.material) if leaves else 0.0
    held.flats.law[f] = *springs, waves, hardness, flow.skin, flow.friction, size, widens, 1.0
