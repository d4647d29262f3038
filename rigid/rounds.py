"""The convex outline of a body of revolution in its plane of motion: arcs and corners that may touch.

A plane barrier touches a body where the outward normal of its convex outline is that of the barrier, which at
an inclination `alpha` is (sin alpha, -cos alpha) in (x, z). Each `Round` is what touches over a range of that
angle; rounds of one smooth curve follow each other without a straight part or a corner between them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .arrays import Floats

LONG = 2.0
"""Steps of a smooth curve beside it that a straight part is longer than."""
ALIKE = 1e-4
"""Share of its radius by which the circles of one arc may differ."""


class Round(NamedTuple):
    """An arc of the outline, or a corner of radius 0: its centre (x, z), m, radius, m, and normals, rad.

    ``curve`` numbers the smooth curves and corners around the outline.
    """

    x: float
    z: float
    radius: float
    low: float
    high: float
    curve: int


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


def rounds_of(outline: Floats, corner: float) -> list[Round]:
    """Return the rounds of the side x >= 0 of a turned outline (k, 2), (rho, z), m, from its tip.

    Turns above ``corner``, rad, are corners; vertices that lie closer than straight parts are of one curve.
    On a curve a vertex is an arc of the radius of curvature there; neighbours on one circle are one arc.
    """
    line = _hull_side(outline)
    step = np.diff(line, axis=0)
    slope, length = np.arctan2(step[:, 1], step[:, 0]), np.hypot(*step.T)
    low = np.concatenate([[-slope[0] if line[0, 0] == 0.0 else 0.0], slope])
    high = np.append(slope, np.pi)
    turn = high - low
    if line[-1, 0] == 0.0:
        turn[-1] *= 2.0  # half of it lies on the other side
    shorter = np.minimum(np.append(length[0], length), np.append(length, length[-1]))
    smooth = turn < corner
    steps = np.where(smooth, shorter, 0.0)
    joined = smooth[1:] & smooth[:-1] & (length <= LONG * np.maximum(steps[1:], steps[:-1]))
    curve = np.append(0, np.cumsum(~joined))
    on_curve = np.append(joined, False) | np.append(False, joined)
    bend = np.where(on_curve, shorter / turn, 0.0)
    middle = 0.5 * (low + high)
    middle[0] = 0.0 if line[0, 0] == 0.0 else middle[0]
    middle[-1] = np.pi if line[-1, 0] == 0.0 else middle[-1]
    x, z = line[:, 0] - bend * np.sin(middle), line[:, 1] + bend * np.cos(middle)
    columns = (part.tolist() for part in (x, z, bend, low, high, curve))
    rounds = [Round(*row) for row in zip(*columns, strict=True)]
    found = rounds[:1]
    for one in rounds[1:]:
        last = found[-1]
        away = max(math.hypot(one.x - last.x, one.z - last.z), abs(one.radius - last.radius))
        if one.curve == last.curve and away < ALIKE * one.radius:
            found[-1] = last._replace(high=one.high)
        else:
            found.append(one)
    return found


def _hull_side(outline: Floats) -> Floats:
    """Return the vertices (k, 2) of the convex hull of a turned outline, on one side from tip to tail."""
    first = int(np.flatnonzero(outline[:, 1] <= outline[0, 1])[-1])
    hull: list[tuple[float, float]] = []
    for x, z in outline[first:].tolist():
        while len(hull) > 1 and _left(hull[-2], hull[-1], (x, z)) <= 0.0:
            hull.pop()
        hull.append((x, z))
    return np.array(hull)


def _left(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    """Return how far c lies to the left of the way from a to b, times that way, m2; 0 below round-off."""
    (ux, uz), (vx, vz) = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
    turn = ux * vz - uz * vx
    return turn if turn > 1e-12 * math.hypot(ux, uz) * math.hypot(vx, vz) else 0.0
