"""The contact laws of a site, made when it touches: from the attitude of the rod and its speed there."""

from dataclasses import replace
from math import atan, cos, inf, pi, sin, sqrt, tan

import numpy as np

from fem_impact.case.case import Case
from fem_impact.modal.groove import ACROSS, LONGEST
from fem_impact.modal.groove import AT as IN_GROOVE
from fem_impact.modal.hertz import springs_over
from fem_impact.modal.landing import height_of, in_body, lay_flat
from fem_impact.modal.motion import AT, SITE, ModalState, Sites, Start, Touched
from fem_impact.modal.rod import ModalRod
from fem_impact.modal.sites import lowest, settle, skin
from fem_impact.modal.tip import ROUND, Flank, half_length
from fem_impact.modal.touch import LAID
from fem_impact.physics.contact import ContactPair
from fem_impact.physics.contact_law import ContactLaw, FlowLaw, contact_law, flow_law

BESIDE = 1e-4  # rad, that a law is at least away from the ends of its site's range of normals
STEADIER = 30.0  # times as many steps where a whole row of cells touches and leaves at once
FLATTEST, UPRIGHT = 1e-4, 1.5  # rad, least and most lean of a straight part beside a site
BEYOND = 0.25 * pi  # rad, by which its far end leans more: cells leave a loaded end over a way, not at once
SLOWEST = 0.25  # of the first approach, at which a site that touches later counts as coming at least
DEEPER = 30.0  # times the energy of its approach that vibration and ploughing may press into a contact


def pair_at(case: Case, rod: ModalRod, now: ModalState, s: int, slowest: float) -> ContactPair:
    """Return rod and barrier as a site touches: as the first contact of a rod that comes so.

    Of a site behind the mass centre it is the rod with its tail as its tip. The site may touch with hardly
    any speed and be pressed in by the turning rod later: it counts as coming at ``slowest``, m/s, at least.
    """
    first, rigid = case.contact, now.rigid
    turn, _ = lowest(rod.sites, s, rigid[AT.turn])
    begin, end = rod.sites.begin[s], rod.sites.begin[s + 1] - 1
    low, high = rod.sites.low[begin] + BESIDE, rod.sites.high[end] - BESIDE
    angle = first.angle + min(max(turn, low), high)
    angle -= 2 * pi * np.floor((angle + pi) / (2 * pi))
    body = case.bodies.body
    if abs(angle) > 0.5 * pi:
        body, angle = body.reversed(), angle - pi if angle > 0 else angle + pi
    c, sn = cos(rigid[AT.turn]), sin(rigid[AT.turn])
    along = c * rod.sites.along_n[s] - sn * rod.sites.along_t[s]
    v_n = float(rigid[AT.V_n] - rigid[AT.V_bn] + along @ now.rate)
    t, n = skin(rod.sites, s, rigid[AT.turn])
    offset = -float(rigid[AT.away_t] + c * t + sn * n)
    metal, yields = case.bodies.metal_at(in_body(case, t, n)[1])
    pair = replace(
        first,
        body=body,
        rod=metal,
        rod_yields=yields,
        angle=angle,
        v_n=v_n,
        v_t=float(rigid[AT.V_t] - rigid[AT.V_bt]),
        omega=float(rigid[AT.Omega]),
        centre_offset=offset,
    )
    slow = slowest - pair.approach
    return replace(pair, v_n=v_n - slow) if slow > 0 else pair


def give_law(
    case: Case,
    rod: ModalRod,
    now: ModalState,
    held: Touched,
    s: int,
    energy: float,
    approach: float,
    begins: bool = False,
) -> float:
    """Give a site its law as it touches, and return how fast it may swing, rad/s, see `contact_rate`.

    A straight part that lands flat gets one law with the site at its other end. ``energy``, J, is the most
    that a contact can take up; ``approach``, m/s, is that of the first touch; ``begins`` says whether the
    impact of the scene begins.
    """
    rigid, row = now.rigid, held.site[s]
    begun = s == rod.first and begins
    pair = case.contact if begun else pair_at(case, rod, now, s, SLOWEST * approach)
    # it is found touching up to a step late: the surface under it is lowered by so much
    row[SITE.sunk_n] -= max(0.0, row[SITE.sunk_n] - rigid[AT.height] - height_of(rod, now, s))
    law = contact_law(pair, case.slots.contact_loss)
    flow = flow_law(pair, case.slots.rod_law, case.slots.barrier_law)
    # of a rod that grazes little presses its tip in: cells as wide as for all its energy miss the contact
    energy = min(energy, DEEPER * pair.energy)
    widest = reach(law, flow, energy)
    longest = widest * LONGEST / ACROSS if flow.yields and flow.ploughs else 0.0
    laid = lay_flat(case, rod, now, held, s, pair, longest)
    if laid:
        ends, stiffness = laid
        start = start_of(case, rod)
        return STEADIER * max(contact_rate(start, rod.sites, now, end, stiffness) for end in ends)
    if not begun:
        settle(rod.sites, s, float(now.rigid[AT.turn]), pair.principal_radii[0])
    set_law(held, s, law, flow, energy)
    shape(rod.sites, held, s, float(rigid[AT.turn]), longest)
    return contact_rate(start_of(case, rod), rod.sites, now, s, contact_stiffness(law, flow, widest))


def set_law(held: Touched, s: int, law: ContactLaw, flow: FlowLaw, energy: float) -> None:
    """Enter the laws of a site that meets a smooth surface; its contact takes up an energy, J, at most."""
    widest, row = reach(law, flow, energy), held.site[s]
    row[SITE.known], row[SITE.awake], row[SITE.wake] = 1.0, 0.0, 0.0
    held.law[s], held.flow[s] = law, flow
    held.place[s], held.width[s], held.shift[s] = springs_over(widest)
    held.state[s, IN_GROOVE.last], held.state[s, IN_GROOVE.sinks] = -1.0, 1.0
    held.size[s] = widest / ACROSS
    held.tip[s, 0], held.tip[s, 1:] = flow.R1, inf


def reach(law: ContactLaw, flow: FlowLaw, energy: float) -> float:
    """Return the half length, m, of a contact that has taken up an energy, J, along t."""
    if not flow.yields:
        return float(np.sqrt(law.R) * (2.5 * energy / law.stiffness) ** 0.2)
    depth = np.sqrt(energy / (np.pi * law.limit * law.R))
    return float(np.sqrt(2 * flow.R1 * depth))


def contact_stiffness(law: ContactLaw, flow: FlowLaw, widest: float) -> float:
    """Return the stiffness, N/m, of a contact of half length ``widest``, m."""
    if flow.yields:
        return 2 * widest * max(flow.normal, flow.shear)
    return widest * max(1.5 * law.stiffness / sqrt(law.R), law.shear)


def contact_rate(start: Start, sites: Sites, now: ModalState, s: int, stiffness: float) -> float:
    """Return a bound, rad/s, of how fast a site swings on a contact of a stiffness, N/m.

    The tip of a thin rod gives way to its many modes as if it were light; on a contact that grows wide under
    the weight of the whole rod it swings faster than any of them.
    """
    t, n = skin(sites, s, float(now.rigid[AT.turn]))
    inverse_mass = 2 * (1 / start.mass + start.inverse_barrier_mass)
    lever_t, lever_n = now.rigid[AT.away_t] + t, now.rigid[AT.away_n] + n
    inverse_mass += start.inverse_barrier_inertia * (lever_t**2 + lever_n**2)
    inverse_mass += (t**2 + n**2) / (start.mass * start.k2)
    inverse_mass += float(np.sum(sites.along_t[s] ** 2 + sites.along_n[s] ** 2))
    return sqrt(stiffness * inverse_mass)


def start_of(case: Case, rod: ModalRod) -> Start:
    """Return the constants of rod and barrier."""
    g, struck, angle = case.slots.gravity or 0.0, case.scene.barrier, case.scene.impact.vertical
    return Start(
        rod.mass,
        rod.k2,
        -g * sin(angle),
        -g * cos(angle),
        1 / struck.mass if struck.mass else 0.0,
        1 / case.slots.plate if case.slots.plate else 0.0,
        1 / struck.inertia if struck.inertia else 0.0,
    )


def shape(sites: Sites, held: Touched, s: int, turn: float, longest: float) -> None:
    """Give a site that touches at a turn, rad, the straight parts beside it, see `Flank`.

    A part belongs to that of its ends which touches first, the other end has what that one left of it. One
    not ``longest``, m, takes the corner at its other end along: both press into one groove. The cells of the
    groove hold the whole of a long part and resolve a corner alone.
    """
    begin, end, (t, n) = int(sites.begin[s]), int(sites.begin[s + 1]), skin(sites, s, turn)
    arcs = [a for a in range(begin, end) if sites.high[a] > sites.low[a]]
    if len(arcs) == 1:
        held.tip[s, 0] = sites.radius[arcs[0]]
    count, deepest = len(sites.begin) - 1, (ACROSS * held.size[s]) ** 2 / (2 * held.flow[s, 0])
    longer = 0.0
    for side, other in enumerate(((s - 1) % count, (s + 1) % count)):
        if other == s or held.site[other, SITE.known] == LAID:
            continue
        u, w = skin(sites, other, turn)
        far = slice(int(sites.begin[other]), int(sites.begin[other + 1]))
        flank = _flank(
            turn - sites.low[begin] if side == 0 else sites.high[end - 1] - turn, u - t, w - n, turn
        )
        if held.site[other, SITE.known]:
            theirs = Flank(*held.tip[other, 4 - 3 * side : 7 - 3 * side].tolist())
            gone = half_length(float(held.tip[other, 0]), theirs, float(held.site[other, SITE.deepest]))
            flank = flank._replace(end=max(flank.end - gone, 0.0))
        elif np.hypot(u - t, w - n) <= longest and not sites.radius[far].any():
            lean = turn - sites.low[far][0] if side == 0 else sites.high[far][-1] - turn
            # a corner that hangs counts as upright: cells would leave it at once, and what they hold be lost
            flank = flank._replace(beyond=min(_slope(lean), tan(UPRIGHT)))
            held.site[other, SITE.known] = LAID
        held.tip[s, 1 + 3 * side : 4 + 3 * side] = flank
        longer = max(longer, half_length(float(held.tip[s, 0]), flank, deepest))
    if longer > 0.0:  # a ball has no straight part
        held.size[s] = min(max(held.size[s], longer / LONGEST), longer / ACROSS)


def _flank(lean: float, t: float, n: float, turn: float) -> Flank:
    """Return a straight part that leans by an angle, rad, to its far end (t, n), m, of a rod at a turn.

    One that hangs over the barrier is none, even where its far end lies right above what touches.
    """
    slope = _slope(lean)
    if slope == inf:
        return ROUND
    along, rise = abs(cos(turn) * t + sin(turn) * n), cos(turn) * n - sin(turn) * t
    # of a steep part, whose slope is bounded, the rise counts
    return Flank(slope, max(along, rise / slope), tan(min(atan(slope) + BEYOND, UPRIGHT)))


def _slope(lean: float) -> float:
    """Return the slope of a straight part that leans by an angle, rad, over the barrier; inf if it hangs."""
    lean = (lean + 0.5 * pi) % (2 * pi) - 0.5 * pi
    return tan(min(max(lean, FLATTEST), UPRIGHT)) if lean < 0.5 * pi else inf
