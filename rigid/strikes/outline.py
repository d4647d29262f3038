"""The convex outline of a body in its plane of motion: arcs and edges, joined by straight lines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..arrays import Floats
from ..chord import both_sides
from ..faceted import LEVEL as OF_MESH
from ..faceted import Faceted, hull
from ..projectile import Projectile
from ..touch import LEVEL
from ..turned import CORNER, Turned

TURN = 2.0 * math.pi
LEVEL_ANGLE = 1e-10
"""Inclination, rad, from that of a straight line of the outline within which both its ends touch."""
SAME = 1e-8
"""Share of the length within which neighbouring arcs of a stated curve are one circle."""


class Corner(NamedTuple):
    """An arc of the outline, or an edge of radius 0, which is lowest from one inclination to another.

    Attributes
    ----------
    x, z : its centre from the mass centre, m
    radius : m
    low, high : inclinations between which the body touches with it, rad, low < high
    """

    x: float
    z: float
    radius: float
    low: float
    high: float

    def arms(self, alpha: float) -> tuple[float, float]:
        """Return d_c and d_d, m, of its lowest point at an inclination, rad."""
        sin, cos = math.sin(alpha), math.cos(alpha)
        return -self.x * cos - self.z * sin, self.radius + self.x * sin - self.z * cos

    def place(self, alpha: float) -> tuple[float, float]:
        """Return its lowest point (x, z) from the mass centre, m, at an inclination, rad."""
        return self.x + self.radius * math.sin(alpha), self.z - self.radius * math.cos(alpha)


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """Corners in the order in which a body that turns from n towards t rolls over them.

    The last corner ends a full turn after the first begins. Where one ends and the next begins, the body
    touches with the straight line between them, or rolls from arc to arc.
    """

    corners: tuple[Corner, ...]

    @property
    def widest(self) -> float:
        """Largest height, m, of the mass centre over a barrier that the body touches."""
        return max(math.hypot(one.x, one.z) + one.radius for one in self.corners)

    @property
    def least(self) -> float:
        """Smallest height, m, of the mass centre over a barrier that the body touches."""
        return min(_least(one) for one in self.corners)

    def lowest(self, alpha: float, spin: float = 0.0) -> int:
        """Return the number of the corner that is lowest at an inclination, rad.

        Of two that are equally low it is the one that a ``spin``, rad/s, brings down.
        """
        first = self.corners[0].low
        ahead = math.copysign(LEVEL_ANGLE, spin) if spin else 0.0
        turned = first + (alpha + ahead - first) % TURN
        return next((k for k, one in enumerate(self.corners) if turned < one.high), len(self.corners) - 1)

    def beside(self, number: int, step: int) -> int:
        """Return the number of the corner next to one, behind (1) or before it (-1)."""
        return (number + step) % len(self.corners)

    def flat(self, number: int, step: int) -> float:
        """Return the length, m, of the straight line from a corner to the one behind (1) or before (-1)."""
        one, other = self.corners[number], self.corners[self.beside(number, step)]
        if one is other:
            return 0.0
        at = one.high if step > 0 else one.low
        return abs(one.arms(at)[0] - other.arms(at)[0])


@lru_cache(maxsize=128)
def outline(body: Projectile | Turned | Faceted) -> Outline:
    """Return the outline of a body, with its published arcs exact and stated curves by their circles.

    Examples
    --------
    >>> rod = outline(Projectile(0.24, 0.019, "plain", 0.0, 7850.0))
    >>> [round(math.degrees(one.low)) for one in rod.corners]
    [-180, -90, 0, 90]
    """
    if isinstance(body, Projectile):
        own = (Corner(x, z - body.z_c, r, low, high) for x, z, r, low, high, _ in body.rounds())
        return Outline(tuple(own))
    if isinstance(body, Faceted):
        line = hull(body.points[:, [0, 2]], OF_MESH * body.length)
        return Outline(_of_vertices(line - [body.x_c, body.z_c], smooth=False))
    line = hull(both_sides(body.outline), LEVEL * body.length)
    return Outline(_of_vertices(line - [0.0, body.z_c], smooth=True))


def _least(one: Corner) -> float:
    """Return the smallest height, m, of the mass centre over a corner that touches."""
    away = math.hypot(one.x, one.z)
    above = (-math.atan2(one.x, one.z) - one.low) % TURN < one.high - one.low  # its centre, at some time
    return min(one.arms(one.low)[1], one.arms(one.high)[1], one.radius - away if above else math.inf)


def _of_vertices(line: Floats, smooth: bool) -> tuple[Corner, ...]:
    """Return the corners of a convex polygon (k, 2), (x, z), m, counterclockwise from x to z.

    Where a ``smooth`` line turns by little, its corner is the arc that touches both sides, the shorter one in
    its middle, so that a body rolls on without a jump.
    """
    step = np.roll(line, -1, axis=0) - line
    normal = np.arctan2(step[:, 1], step[:, 0])  # inclination at which this side lies on the barrier
    length = np.hypot(*step.T)
    found = []
    for k, (x, z) in enumerate(line.tolist()):
        low = float(normal[k - 1])
        turn = (float(normal[k]) - low) % TURN
        is_smooth = smooth and 0.0 < turn < CORNER
        r = 0.5 * float(min(length[k - 1], length[k])) / math.tan(0.5 * turn) if is_smooth else 0.0
        middle, inside = low + 0.5 * turn, r / math.cos(0.5 * turn)
        centre = x - inside * math.sin(middle), z + inside * math.cos(middle)
        found.append(Corner(*centre, r, low, low + turn))
    first = min(range(len(found)), key=lambda k: found[k].low)
    ordered, end = [], found[first].low
    for one in found[first:] + found[:first]:
        ordered.append(one._replace(low=end, high=end + one.high - one.low))
        end = ordered[-1].high
    return _merged(ordered, SAME * float(np.ptp(line, axis=0).max()))


def _merged(corners: list[Corner], same: float) -> tuple[Corner, ...]:
    """Return corners of which neighbours on one circle, within ``same``, m, are one arc."""
    groups: list[list[Corner]] = []
    for one in corners:
        first = groups[-1][0] if groups else None
        circle = first is not None and first.radius > 0.0 and one.radius > 0.0
        if first and circle and math.dist(first[:3], one[:3]) < same:
            groups[-1].append(one)
        else:
            groups.append([one])
    return tuple(_circle(group) for group in groups)


def _circle(group: list[Corner]) -> Corner:
    """Return the arc of neighbours on one circle; one that goes all round passes through its vertices."""
    x, z, radius = (float(np.mean([one[k] for one in group])) for k in range(3))
    low, high = group[0].low, group[-1].high
    if high - low > TURN - LEVEL_ANGLE:
        radius /= math.cos(0.5 * TURN / len(group))
    return Corner(x, z, radius, low, high)
