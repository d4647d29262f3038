"""The convex outline of a body about its mass centre: arcs and corners, joined by straight lines."""

import math
from dataclasses import dataclass
from functools import lru_cache

from ..faceted import Faceted
from ..projectile import Projectile
from ..rounds import TURN, Round
from ..turned import Turned

LEVEL_ANGLE = 1e-10
"""Inclination, rad, from that of a straight line of the outline within which both its ends touch."""


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """Rounds in the order in which a body that turns from n towards t rolls over them.

    The last corner ends a full turn after the first begins. Where one ends and the next begins, the body
    touches with the straight line between them, or rolls from arc to arc.
    """

    corners: tuple[Round, ...]

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
    """Return the outline of a body.

    Examples
    --------
    >>> rod = outline(Projectile(0.24, 0.019, "plain", 0.0, 7850.0))
    >>> [round(math.degrees(one.low)) for one in rod.corners]
    [-180, -90, 0, 90]
    """
    return Outline(tuple(one._replace(x=one.x - body.x_c, z=one.z - body.z_c) for one in body.rounds()))


def _least(one: Round) -> float:
    """Return the smallest height, m, of the mass centre over a corner that touches."""
    away = math.hypot(one.x, one.z)
    above = (-math.atan2(one.x, one.z) - one.low) % TURN < one.high - one.low  # its centre, at some time
    return min(one.arms(one.low)[1], one.arms(one.high)[1], one.radius - away if above else math.inf)
