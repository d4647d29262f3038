"""The convex outline of a body in its plane of motion: arcs and corners that may touch.

A plane barrier touches a body where the outward normal of its convex outline is that of the barrier, which at
an inclination `alpha` is (sin alpha, -cos alpha) in (x, z). Each `Round` is what touches over a range of that
angle; rounds of one smooth curve follow each other without a straight part or a corner between them.
"""

import math
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .inputs import Floats

TURN = 2.0 * math.pi
LONG = 2.0
"""Steps of a smooth curve beside it that a straight part is longer than."""
SAME = 1e-8
"""Share of the length within which neighbouring arcs of a stated curve are one circle."""


ROUND_OFF = 1e-12
"""Of angles, rad."""


class Round(NamedTuple):
    """An arc of the outline, or a corner of radius 0, which is lowest from one inclination to another.

    Attributes
    ----------
    x, z : its centre, m
    radius : m
    low, high : inclinations between which the body touches with it, rad, low < high
    curve : number of its smooth curve or corner around the outline
    """

    x: float
    z: float
    radius: float
    low: float
    high: float
    curve: int = 0

    def arms(self, alpha: float) -> tuple[float, float]:
        """Return d_c and d_d, m, of its lowest point at an inclination, rad, if (0, 0) is the mass centre."""
        sin, cos = math.sin(alpha), math.cos(alpha)
        return -self.x * cos - self.z * sin, self.radius + self.x * sin - self.z * cos

    def place(self, alpha: float) -> tuple[float, float]:
        """Return its lowest point (x, z), m, at an inclination, rad."""
        return self.x + self.radius * math.sin(alpha), self.z - self.radius * math.cos(alpha)


def around(side: list[Round]) -> list[Round]:
    """Return the rounds of both sides from those of the side x >= 0, in order from its tip.

    A curve that starts on the axis goes on as its mirror image.
    """
    first = side[0]
    on_axis = first.low < 0.0
    if on_axis:
        side = [first._replace(x=0.0, low=-first.high), *side[1:]]
    mirror = [
        Round(0.0 - one.x, one.z, one.radius, 0.0 - one.high, 0.0 - one.low, -one.curve - int(not on_axis))
        for one in side[:0:-1] + ([] if on_axis else [first])
    ]
    last = mirror[0].curve if mirror else 0
    whole = [*mirror, *side]
    return [one._replace(curve=one.curve - last) for one in whole]


def rounds_of(line: Floats, corner: float = 0.0, edges: NDArray[np.bool_] | None = None) -> list[Round]:
    """Return the rounds of a convex polygon (k, 2), (x, z), m, counterclockwise, over a full turn.

    Turns above ``corner``, rad, and ``edges`` (k,) are corners; vertices that lie closer than straight parts
    are of one curve.
    On a curve a vertex is the arc that touches both sides, the shorter one in its middle, so that a body
    rolls on without a jump; neighbours on one circle are one arc.
    """
    low = np.roll(_directions(line), 1)  # inclination at which the side before it lies on the barrier
    first = int(np.argmin(low))
    line = np.roll(line, -first, axis=0)
    turn, shorter, joined = steps_of(line, corner, None if edges is None else np.roll(edges, -first))
    high = low[first] + np.cumsum(turn)
    bend = np.where(joined | np.roll(joined, 1), 0.5 * shorter / np.tan(0.5 * turn), 0.0)
    middle, inside = high - 0.5 * turn, bend / np.cos(0.5 * turn)
    x, z = line[:, 0] - inside * np.sin(middle), line[:, 1] + inside * np.cos(middle)
    curve = np.append(0, np.cumsum(~joined)[:-1])
    columns = (part.tolist() for part in (x, z, bend, high - turn, high, curve))
    same = SAME * float(np.ptp(line, axis=0).max())
    return _merged([Round(*row) for row in zip(*columns, strict=True)], same)


def steps_of(
    line: Floats, corner: float, edges: NDArray[np.bool_] | None = None
) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Return what makes a curve of the steps of a closed convex polygon (k, 2), m, counterclockwise.

    These are the turn at each vertex, rad, the length, m, of the shorter side there, and whether the side
    behind it `is_step` of a smooth curve. A turn above ``corner``, rad, is an edge, as is one of ``edges``.
    """
    length, after = np.hypot(*(np.roll(line, -1, axis=0) - line).T), _directions(line)
    turn, shorter = (after - np.roll(after, 1)) % TURN, np.minimum(length, np.roll(length, 1))
    smooth = turn < corner if edges is None else (turn < corner) & ~edges
    steps = np.where(smooth, shorter, 0.0)
    return turn, shorter, is_step(length, steps, np.roll(steps, -1))


def _directions(line: Floats) -> Floats:
    """Return the angle (k,), rad, of the side behind each vertex (k, 2) of a closed line."""
    step = np.roll(line, -1, axis=0) - line
    return np.asarray(np.arctan2(step[:, 1], step[:, 0]))


def is_step(length: Floats, start: Floats, end: Floats) -> NDArray[np.bool_]:
    """Return whether each side of an outline is a step of a smooth curve, no straight part between edges.

    ``length`` (k,), m, of the sides; ``start`` and ``end`` (k,), m, the shorter side at its two vertices, 0
    at one that turns more than a curve may.
    """
    return np.asarray((start > 0.0) & (end > 0.0) & (length <= LONG * np.maximum(start, end)))


def cut(rounds: list[Round], angle: float) -> list[Round]:
    """Return rounds over the full turn that ends at an ``angle``, rad; what is lowest there is cut in two.

    The curve that is cut has two numbers, but a whole circle stays one round.
    """
    start = angle - TURN
    if len(rounds) == 1:
        return [rounds[0]._replace(low=start, high=angle)]
    found = []
    for one in rounds:
        turns = math.floor((one.low - start) / TURN + ROUND_OFF)
        low, high = max(one.low - turns * TURN, start), one.high - turns * TURN
        found.append(one._replace(low=low, high=min(high, angle)))
        if high > angle + ROUND_OFF:
            found.append(one._replace(low=start, high=high - TURN))
    found.sort(key=lambda one: one.low)
    begins = [0, *(int(a.curve != b.curve) for a, b in pairwise(found))]
    return [one._replace(curve=number) for one, number in zip(found, accumulate(begins), strict=True)]


def hull(places: Floats, level: float) -> Floats:
    """Return the vertices (k, 2) of the convex hull of places (x, z), m, counterclockwise.

    Those that lie nearer than `level`, m, to the line between their neighbours are left out.
    """
    ordered = places[np.lexsort((places[:, 1], places[:, 0]))].tolist()
    line = np.array(_chain(ordered)[:-1] + _chain(ordered[::-1])[:-1])
    while len(line) > 3:
        before, after = np.roll(line, 1, axis=0), np.roll(line, -1, axis=0)
        (x, z), (u, w) = (after - before).T, (line - before).T
        away = np.abs(x * w - z * u) / np.hypot(x, z)
        nearest = int(np.argmin(away))
        if away[nearest] >= level:
            break
        line = np.delete(line, nearest, axis=0)
    return line


def _chain(ordered: list[list[float]]) -> list[list[float]]:
    """Return one side of the convex hull of places that are sorted (Andrew 1979): those that turn left."""
    chain: list[list[float]] = []
    for x, z in ordered:
        while len(chain) > 1:
            (x_0, z_0), (x_1, z_1) = chain[-2:]
            if (x_1 - x_0) * (z - z_0) > (z_1 - z_0) * (x - x_0):
                break
            chain.pop()
        chain.append([x, z])
    return chain


def _merged(rounds: list[Round], same: float) -> list[Round]:
    """Return rounds of which neighbours on one circle, within ``same``, m, are one arc."""
    groups: list[list[Round]] = []
    for one in rounds:
        first = groups[-1][0] if groups else None
        if first and first.curve == one.curve and math.dist(first[:3], one[:3]) < same:
            groups[-1].append(one)
        else:
            groups.append([one])
    found = []
    for group in groups:
        x, z, radius = (float(np.mean([one[k] for one in group])) for k in range(3))
        low, high = group[0].low, group[-1].high
        if high - low > TURN - ROUND_OFF:  # one that goes all round passes through its vertices
            radius /= math.cos(0.5 * TURN / len(group))
        found.append(Round(x, z, radius, low, high, group[0].curve))
    return found
