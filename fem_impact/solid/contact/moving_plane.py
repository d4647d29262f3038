"""Contact of the rod's nodes with the rigid plane of a barrier that is free to move."""

from dataclasses import dataclass, field
from typing import ClassVar

from fem_impact.arrays import Array, Ints
from fem_impact.solid.contact.book import MOVING, Booked, ContactBook
from fem_impact.solid.contact.points import Points, PointState, over_plane, over_turning_plane, settle
from fem_impact.solid.ground import Ground
from fem_impact.solid.state import State


@dataclass(slots=True)
class MovingPlane(Booked):
    """Unilateral contact with Coulomb friction on a plane that is a free barrier's foundation.

    Every impulse changes the velocity of the plane, so the nodes are solved together.

    Attributes
    ----------
    nodes : (k, 3) unknowns of the rod's nodes; f : (k,) their Coulomb coefficients
    ground : the motion of the plane; points : room for all nodes
    """

    moving: ClassVar[tuple[str, ...]] = ("points.memory", *MOVING)
    nodes: Ints
    ground: Ground
    inverse_mass: Array
    f: Array
    points: Points
    book: ContactBook = field(default_factory=ContactBook)

    def resolve(self, state: State) -> None:
        """Apply this step's impulses and book the work."""
        motion = PointState(state.x, state.v, state.force, self.inverse_mass, state.kick, state.dt_next)
        c = self.points
        if self.ground.turns:
            turning = self.ground.foundation, self.ground.turn[0], self.ground.centre
            count = over_turning_plane(self.nodes, self.f, *turning, motion, c)
        else:
            count = over_plane(self.nodes, self.f, self.ground.foundation, motion, c)
        settle(count, motion, c, self.book, state.time)

    def clearance(self, x: Array) -> float:
        """Return the smallest height, m, of the nodes over the plane at positions ``x``."""
        heights = self.ground.levelled(x[self.nodes[:, 0]], x[self.nodes[:, 2]], x)
        return float(heights.min() - self.ground.risen(x))
