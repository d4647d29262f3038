"""The yielding contact: a row of cells across the groove that a round tip presses and ploughs into a surface.

Cell x of the surface carries a normal force q and a tangential force T a metre of the row. It is an elastic
spring (Popov & Hess 2015, doi:10.1007/978-3-642-53876-6) on a bed that flows. With the tip at depth d and
place X it is pressed by D = d - c (x - X)^2 / (2 R1), g of it for good. Beside an elastic contact the surface
sinks, beside a flowing one it does not: c = 2 d / (d + g) of the deepest, so that the contact of a round tip
has the radius sqrt(R d) of Hertz at first and sqrt(2 R d) in the end (Johnson 1985, Contact Mechanics, 6.3);
what rises as c falls is flow. Along a straight flank it sinks by s x / 2, too: Abel's transform of the
outline (Popov & Hess) has .57 s x far from the round part. The tip is met at its slope s over the surface
that sinks, c (x - X) / R1 where it is round, so that

    F_n = sum (q - T s) dx,    F_t = -sum (T + q s) dx.

Flow starts where the slip lines under an inclined load say (Green 1954, doi:10.1016/0022-5096(54)90025-3),

    q / 2 b H = 1 - (theta + 1 - cos(theta)) / (2 + pi),    T / 2 b K = sin(theta),

with theta from 0 to pi/2, where q may be less; it follows the normal. b = sqrt(R2 (D + g)) is half the width
of the contact at the cell and H the hardness: Hertz' contact begins to flow at p0 = 4/pi H, and in the end
all of it bears H. K is at first that of a contact which sticks; as the tip slides, it falls to the shear
yield stress k: normal force falls as tangential force rises (Tabor 1959, doi:10.1098/rspa.1959.0114). T is
at most f q and 2 b k. What the tip ploughs up raises the surface ahead of
the contact, over as much as the contact is long: so far the slip lines of a punch reach (Prandtl 1920).
"""

from math import asin, atan, cos, exp, inf, log, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.kernels import allocating_kernel, inlined
from fem_impact.modal.tip import ROUND, Tip, half_length, lean, outline
from fem_impact.physics.contact_law import FULLY_PLASTIC, REPRESENTATIVE, RUN_IN, STUCK, FlowLaw

# Jackson and Green (2005, doi:10.1115/1.1866166), finite elements of a ball: depth over that of the first
# yield up to which it is Hertz', and mean pressure of one that flows over its yield stress
ELASTIC, FULL = 1.9, 2.84
# of H, that this row of cells bears under a ball at 1.5 to 20 times the first yield's E* a / R sigma
MEAN = 0.93
CELLS = 512  # of the ring that follows the tip
ACROSS = 40  # cells over the largest half length of the contact
LONGEST = CELLS // 4  # cells of a contact on either side of what is lowest


class StateIndex(NamedTuple):
    """Where each number stands in ``Groove.state`` (11,).

    The first and last cell visited; the tip's last place and depth, its deepest, the way slid, the ridge's
    height under the tip and the highest ever, the deepest cell, m; how far the surface sinks beside the
    contact, 1 of an elastic one, 0 of one that flows, and how much less what flowed last pays for.
    """

    first: int = 0
    last: int = 1
    place: int = 2
    depth: int = 3
    deepest: int = 4
    slid: int = 5
    ridge: int = 6
    top: int = 7
    dent: int = 8
    sinks: int = 9
    pays: int = 10


class WorkIndex(NamedTuple):
    """Where each work, J, stands in ``Groove.works`` (3,): normal flow, shear flow, friction."""

    flow: int = 0
    shear: int = 1
    friction: int = 2


AT, WORK = StateIndex(), WorkIndex()


class Strength(NamedTuple):
    """What a contact bears that is pushed to one side, Pa.

    Its hardness H where metal flows to that side, and K; its hardness where it flows to the other one, which
    the push hampers, and the tangential force over 2 b up to which it does, 0 if the other side bears more.
    """

    H: float
    K: float
    away: float
    most: float


class Groove(NamedTuple):
    """The groove that a tip leaves, cell by cell along its way.

    Attributes
    ----------
    depth, normal, shift : (CELLS,) depth, m, normal force, N/m, and shift of the tangential spring, m
    state : (11,) what stands once, see `StateIndex`
    works : (3,) J, see `WorkIndex`
    size : of a cell, m
    """

    depth: Array
    normal: Array
    shift: Array
    state: Array
    works: Array
    tip: Tip
    size: float


@allocating_kernel
def smooth(reach: float, radius: float) -> Groove:
    """Return a surface without a groove for contacts of a round tip of at most a half length ``reach``, m."""
    state, cells = np.zeros(len(AT)), (np.zeros(CELLS), np.zeros(CELLS), np.zeros(CELLS))
    state[AT.last], state[AT.sinks] = -1.0, 1.0
    return Groove(*cells, state, np.zeros(3), Tip(radius, ROUND, ROUND), reach / ACROSS)


@inlined
def sunk_beside(deepest: float, dent: float) -> float:
    """Return how far the surface sinks beside a tip at its deepest, m, with a deepest cell of a depth, m."""
    return 1.0 - 2.0 * dent / (deepest + dent)


@inlined
def widest(state: Array, law: FlowLaw) -> float:
    """Return the largest contact radius, m (squared R d elastic, 2 R d plastic)."""
    return sqrt(law.R * (state[AT.deepest] + state[AT.dent]))


@inlined
def borne(radius: float, stress: float, slope: float, exponent: float, ball: float, law: FlowLaw) -> float:
    """Return a plane body's hardness, Pa: from the first yield to Tabor's contact, at the strain .2 a/R.

    It is that of Johnson's cavity or, of the part ``ball`` of the contact that is round, what a ball has by
    Jackson and Green if more, up to some hundred times the depth of its first yield. Theirs is a mean
    pressure by that ratio w: Hertz' up to w = `ELASTIC`, beyond F / pi a^2 with a^2 = R d (w / 1.9)^B. Of H
    cells bear `MEAN`, as those at the rim do not flow.
    """
    if stress == inf:  # it does not yield
        return inf
    stress *= (1.0 + slope * REPRESENTATIVE * radius / law.R) ** exponent
    strained = law.E_star * radius / (law.R * stress)
    cavity = 2 / 3 * (2 + log((strained + 4 * (1 - 2 * law.nu)) / (6 * (1 - law.nu))))
    first = 0.5 * pi * 1.295 * exp(0.736 * law.nu)  # the same at the first yield
    least = 0.5 * first * sqrt(ELASTIC)  # of the chord through the middle of Hertz' contact
    B = 0.14 * exp(23 * stress / law.E_star)
    w = max((strained / first) ** 2 * ELASTIC**B, ELASTIC ** (1.0 + B)) ** (1.0 / (1.0 + B))
    flows = 2.0 * pi * FULL / first * (1.0 - exp(-(w ** (5 / 9)) / 25))
    force = exp(-0.25 * w ** (5 / 12)) * w**1.5 + flows * w
    mean = 4 / (3 * pi) * first**3 * force / max(strained, 2.0 * least) ** 2
    more = max(max(least, mean / MEAN) - cavity, 0.0)
    return float(stress * min(FULLY_PLASTIC, cavity + ball * more))


@inlined
def hardness(radius: float, tip: Tip, law: FlowLaw) -> tuple[float, float]:
    """Return H, Pa, of metal that flows to the rear of the tip and to its front: of the body that flows.

    It is at most that of the other one. The tip bears less than a plane body: its flank rises beside the
    contact, and slip lines turn by less. One in its groove cannot flow to one side alone: it leans by the
    mean of both.
    """
    flatter = max(min(tip.behind.slope, tip.ahead.slope), 0.0)  # 0 of a part that has turned beyond flat
    ball = min(tip.radius * flatter / (radius * sqrt(law.R1 / law.R)), 1.0)
    own = borne(radius, law.yield_stress, law.slope, law.exponent, ball, law)
    other = borne(radius, law.other_yield_stress, law.other_slope, law.other_exponent, ball, law)
    if law.ploughs:
        H = min(own, other * (1.0 - atan(radius / sqrt(law.R * law.R1)) / (1.0 + 0.5 * pi)))
        return H, H
    depth = 0.5 * radius**2 / law.R
    behind = own * (1.0 - lean(tip.radius, tip.behind, depth) / (1.0 + 0.5 * pi))
    return min(behind, other), min(own * (1.0 - lean(tip.radius, tip.ahead, depth) / (1.0 + 0.5 * pi)), other)


@inlined
def window(groove: Groove, depth: float, place: float) -> tuple[int, int]:
    """Return first and last cell that the tip may touch; cells not visited before become smooth."""
    state, tip, size = groove.state, groove.tip, groove.size
    down, most = max(depth + state[AT.top], 0.0), size * LONGEST
    behind = min(half_length(tip.radius, tip.behind, down), most)
    ahead = min(half_length(tip.radius, tip.ahead, down), most)
    # a cell more than may touch on either side: one that is left is set free there
    first, last = int(np.floor((place - behind) / size)) - 1, int(np.floor((place + ahead) / size)) + 1
    if state[AT.last] < state[AT.first]:
        state[AT.first], state[AT.last] = first, first - 1
    for c in range(int(state[AT.last]) + 1, last + CELLS // 4):
        clear(groove, c)
        state[AT.last] = c
    state[AT.first] = max(state[AT.first], state[AT.last] - CELLS + 1)
    for c in range(int(state[AT.first]) - 1, first - CELLS // 4, -1):
        clear(groove, c)
        state[AT.first] = c
    state[AT.last] = min(state[AT.last], state[AT.first] + CELLS - 1)
    return first, last


@inlined
def clear(groove: Groove, cell: int) -> None:
    """Make a cell smooth."""
    at = cell % CELLS
    groove.depth[at], groove.normal[at], groove.shift[at] = 0.0, 0.0, 0.0


@inlined
def flowed(q: float, T: float, Q: float, S: float, law: FlowLaw) -> tuple[float, float]:
    """Return elastic forces q, T brought back along the normal to Green's curve, of at most Q and S."""
    if Q <= 0.0:
        return 0.0, 0.0
    y, P = abs(T), Q / (2.0 + pi)
    low, high = 0.0, asin(min(y / S, 1.0))
    if q <= Q - P * (high + 1.0 - cos(high)):
        return q, min(max(T, -S), S)
    at = high if (q - Q) * P * law.shear < y * S * law.normal else 0.0  # else at the corner, where T is 0
    for _ in range(30 if at > 0.0 else 0):
        u, v, c, sn = q - Q + P * (at + 1.0 - cos(at)), y - S * sin(at), cos(at), 1.0 + sin(at)
        beyond = v * S * c / law.shear - u * P * sn / law.normal
        low, high = (at, high) if beyond > 0.0 else (low, at)
        slope = (P * P * sn * sn + u * P * c) / law.normal + (S * S * c * c + v * S * (sn - 1.0)) / law.shear
        before, at = at, at + beyond / slope
        if not low <= at <= high:
            at = 0.5 * (low + high)
        if abs(at - before) < 1e-10:
            break
    T = S * sin(at) if T > 0.0 else -S * sin(at)
    return Q - P * (at + 1.0 - cos(at)), T


@inlined
def strengths(groove: Groove, law: FlowLaw) -> tuple[Strength, Strength]:
    """Return what the contact bears as it is, if it is pushed on along its way and back."""
    radius = widest(groove.state, law)
    behind, ahead = hardness(radius, groove.tip, law)
    way = exp(-groove.state[AT.slid] / (RUN_IN * radius))
    return strength(behind, ahead, way, law), strength(ahead, behind, way, law)


@inlined
def strength(H: float, away: float, way: float, law: FlowLaw) -> Strength:
    """Return what a contact bears whose metal is pushed to the side of the hardness H, Pa."""
    slid = min(law.skin, STUCK * H)
    K = slid + (STUCK * H - slid) * way
    turns = (2.0 + pi) * (1.0 - away / H) if away < H else 0.0
    at = 0.5 * turns
    for _ in range(8 if turns > 0.0 else 0):
        at -= (at + 1.0 - cos(at) - turns) / (1.0 + sin(at))
    return Strength(H, K, away, K * sin(min(at, 0.5 * pi)))


@inlined
def press_cell(
    groove: Groove, i: int, D: float, moved: float, up: float, bears: tuple[Strength, Strength], law: FlowLaw
) -> tuple[float, float]:
    """Press a cell to D, m, move the tip along it, m, and return its normal and tangential force, N/m.

    ``up`` is how high the ridge stands there, m. Flow, shear and friction are booked.
    """
    g, normal, shift, _, works, _, size = groove
    before, sheared = g[i], law.shear * shift[i]
    trial, b = sheared + law.shear * moved, sqrt(law.R2 * max(D + g[i] + 2 * up, 0.0))
    H, K, away, most = bears[0] if trial > 0.0 else bears[1]
    held = min(max(trial, -2 * b * K), 2 * b * K)  # a long step moves on: no more than that was ever held
    q, stuck = law.normal * (D - g[i]), held
    if q <= 2 * b * away or abs(held) > 2 * b * most:
        q, stuck = flowed(q, held, 2 * b * H, 2 * b * K, law)
    if q > 2 * b * away:  # metal flows to the other side
        q, stuck = 2 * b * away, min(max(stuck, -2 * b * most), 2 * b * most)
    g[i] = max(g[i], D - q / law.normal)
    works[WORK.flow] += 0.5 * (normal[i] + q) * (g[i] - before) * size
    limit = min(law.friction * q, 2 * b * law.skin)
    T = min(max(stuck, -limit), limit)
    mean = 0.5 * (sheared + T) * size / law.shear
    slipped = mean * (trial - held + stuck - T)
    works[WORK.shear] += mean * (held - stuck)
    works[WORK.friction if law.friction * q <= 2 * b * law.skin else WORK.shear] += slipped
    normal[i], shift[i] = q, T / law.shear
    return q, T


@inlined
def release_cell(groove: Groove, i: int, law: FlowLaw) -> None:
    """Free a cell that the tip has left."""
    groove.works[WORK.friction] += 0.5 * law.shear * groove.shift[i] ** 2 * groove.size
    groove.normal[i], groove.shift[i] = 0.0, 0.0


@inlined
def slide(groove: Groove, depth: float, place: float, law: FlowLaw) -> tuple[float, float]:
    """Move the tip to a depth and place, m, and return its normal and tangential force, N."""
    g, state, size = groove.depth, groove.state, groove.size
    sunk, moved = depth - state[AT.depth], place - state[AT.place]
    state[AT.depth], state[AT.place] = depth, place
    middle = place if law.ploughs else 0.0  # a tip that is flattened takes its cells along
    first, last = window(groove, depth, middle)
    state[AT.deepest] = max(state[AT.deepest], depth)
    if state[AT.deepest] <= 0.0:
        return 0.0, 0.0
    # no more rises beside the contact than what flows pays for: flow never gives energy
    rises = min(state[AT.sinks] - sunk_beside(state[AT.deepest], state[AT.dent]), state[AT.pays])
    state[AT.sinks] = sinks = state[AT.sinks] - rises
    flow, lift = groove.works[WORK.flow], 0.0
    bears = strengths(groove, law)
    F_n, F_t, ridge, volume, front, touching = 0.0, 0.0, 0.0, 0.0, 0, 0
    way = 1 if moved > 0.0 else -1
    for step in range(last - first + 1):
        c = first + step if way > 0 else last - step  # from the rear to the front
        i, x = c % CELLS, (c + 0.5) * size - middle
        height, s, rate = outline(groove.tip, x, sinks)
        D = depth - height
        if D <= g[i]:
            release_cell(groove, i, law)
            continue
        s, before, bore = s if law.ploughs else 0.0, g[i], groove.normal[i]
        ahead = s * moved > 0.0
        q, T = press_cell(groove, i, D, moved - s * sunk, state[AT.ridge] if ahead else 0.0, bears, law)
        touching += 1
        lift += 0.5 * (bore + q) * rate * size
        state[AT.dent] = max(state[AT.dent], g[i])
        F_n += (q - T * s) * size
        F_t -= (T + q * s) * size
        if ahead:
            volume += min(max(g[i] - before - max(sunk, 0.0), 0.0), s * moved) * size
            ridge, front = max(ridge, -g[i]), c
    flow = groove.works[WORK.flow] - flow
    groove.works[WORK.flow] -= lift * rises
    state[AT.pays] = max(flow + min(flow - lift * rises, 0.0), 0.0) / lift if lift > 0.0 else 0.0
    state[AT.ridge] = ridge
    state[AT.slid] += abs(moved) if F_n > 0.0 else 0.0
    if volume > 0.0:
        pile_up(groove, front, way, touching, volume)
    return F_n, F_t


@inlined
def pile_up(groove: Groove, front: int, way: int, cells: int, volume: float) -> None:
    """Raise so many cells before the ``front`` one by a volume over its width, m2."""
    g, state = groove.depth, groove.state
    for c in range(front + way, front + way * (cells + 1), way):
        if state[AT.first] <= c <= state[AT.last]:
            g[c % CELLS] -= volume / (cells * groove.size)
            state[AT.top] = max(state[AT.top], -g[c % CELLS])


@inlined
def meets(groove: Groove, depth: float, place: float, law: FlowLaw) -> bool:
    """Return whether a tip at a depth and place, m, touches."""
    if depth + groove.state[AT.top] <= 0.0:
        return False
    middle = place if law.ploughs else 0.0
    first, last = window(groove, depth, middle)
    for c in range(first, last + 1):
        x = (c + 0.5) * groove.size - middle
        if depth - outline(groove.tip, x, groove.state[AT.sinks])[0] > groove.depth[c % CELLS]:
            return True
    return False


@inlined
def move_apart(groove: Groove, depth: float, place: float) -> None:
    """Move the tip without contact."""
    groove.state[AT.depth], groove.state[AT.place] = depth, place
    groove.normal[:] = 0.0
    groove.shift[:] = 0.0


@inlined
def stored_energy(groove: Groove, law: FlowLaw) -> tuple[float, float]:
    """Return the elastic energies, J, of the cells' normal and tangential springs."""
    normal, tangential = 0.0, 0.0
    for i in range(CELLS):
        normal += groove.normal[i] ** 2
        tangential += groove.shift[i] ** 2
    return 0.5 * groove.size * normal / law.normal, 0.5 * groove.size * law.shear * tangential


@allocating_kernel
def indent(law: FlowLaw, reach: float, flexibility: float, energy: float) -> tuple[float, float, float]:
    """Press a tip into a smooth surface until the contact and a spring behind it have taken up an energy, J.

    Parameters
    ----------
    reach : half length of the contact, m, at least of the deepest
    flexibility : of the spring, m/N

    Returns
    -------
    tuple of float
        Depth, m, force, N, and work of the flow, J.
    """
    groove, depth, force, work = smooth(reach, law.R1), 0.0, 0.0, 0.0
    step = 1e-4 * reach**2 / law.R1
    while work + 0.5 * flexibility * force**2 < energy:
        depth += step
        before = force
        force = slide(groove, depth, 0.0, law)[0]
        work += 0.5 * (before + force) * step
    return depth, force, groove.works[WORK.flow]
