"""Contact between the rod's skin and the deformed surface of a meshed barrier.

Where the barrier stays elastic under some of the contact, in two passes, so that neither surface enters the
other: barrier nodes under rod quads, rod nodes over barrier quads. The contact, often narrower than a cell,
then is that of the flat quad of the rod that it lies in the middle of.

A barrier that flows takes the rod's form. Its nodes, which lie closer than the rod's, are held against quads
bent to the rod's round surface. Were the rod's nodes held against it as well, each body would be held by the
other's facets, and both would flow too soon; they count only where they are deeper than the play between the
barrier's nodes, as a sharp edge between two rows of them may be.

Impulses on a bent quad act along its own normal, which turns as its surface does: then they do no work but
friction's. Flat quads have edges, and every edge is a small step that acts like extra friction: over them the
averaged normals of the deformed barrier count, which turn smoothly as a node slides.
"""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.solid.contact.book import MOVING, Booked, ContactBook
from fem_impact.solid.contact.patch import Patch, lowest_gap, nearest_quads, vertex_normals
from fem_impact.solid.contact.points import (
    Points,
    PointState,
    barrier_under_rod,
    make_points,
    rod_over_barrier,
    settle,
)
from fem_impact.solid.state import State


@dataclass(slots=True)
class SurfaceContact(Booked):
    """Coulomb contact between two patches.

    Attributes
    ----------
    f : (rod nodes,) Coulomb coefficients
    play : how deep a node of the rod may lie under the barrier's quads before it is held, m
    rod_normals : of a rod with bent quads
    band : gap within which a pressed node stays a contact, m: facets and averaged normals differ by
        about h^2 curvature / 8 while a node slides across a quad
    last : (rod nodes + barrier nodes,) last quad found for each node
    """

    moving: ClassVar[tuple[str, ...]] = ("last", "points.memory", *MOVING)
    rod: Patch
    barrier: Patch
    inverse_mass: Array
    f: Array
    play: float
    band: float
    last: Ints
    points: Points
    rod_normals: Array
    normals: Array
    book: ContactBook = field(default_factory=ContactBook)

    @classmethod
    def of(
        cls,
        rod: Patch,
        barrier: Patch,
        inverse_mass: Array,
        f: Array,
        over_speed: Array,
        play: float,
        band: float,
        x: Array,
    ) -> "SurfaceContact":
        """Build and find each node's first quad at positions ``x``; see `speed_table` for ``over_speed``."""
        last = np.concatenate([nearest_quads(x, rod, barrier), nearest_quads(x, barrier, rod)])
        return cls(
            rod,
            barrier,
            inverse_mass,
            f,
            play,
            band,
            last,
            make_points(len(last), over_speed),
            np.zeros((len(rod.places), 3)),
            np.zeros((len(barrier.places), 3)),
        )

    def resolve(self, state: State) -> None:
        """Find this step's contacts, solve their impulses, book the work."""
        motion = PointState(state.x, state.v, state.force, self.inverse_mass, state.kick, state.dt_next)
        c, rod, barrier = self.points, self.rod, self.barrier
        self._turn_normals(state.x)
        last, normals, band = self.last, self.normals, self.band
        under = barrier_under_rod(rod, self.f, self.rod_normals, barrier, normals, last, band, motion, c)
        count, outside = rod_over_barrier(
            under, rod, self.f, barrier, normals, last, self.play, band, motion, c
        )
        settle(count, motion, c, self.book, state.time, outside)

    def clearance(self, x: Array) -> float:
        """Return the smallest height, m, of one patch over the other at positions ``x`` (inf: none is)."""
        rod, barrier, first = self.rod, self.barrier, len(self.rod.places)
        self._turn_normals(x)
        over = lowest_gap(x, rod.places, barrier, self.normals, self.last[:first].copy(), 1.0)
        under = lowest_gap(x, barrier.places, rod, self.rod_normals, self.last[first:].copy(), -1.0)
        return float(min(over + self.play, under))

    def _turn_normals(self, x: Array) -> None:
        rod, barrier = self.rod, self.barrier
        vertex_normals(x, barrier.places, barrier.quads, barrier.mirrored, self.normals)
        if rod.bend.any():  # not by the sag: that of a flat face may be exactly 0
            vertex_normals(x, rod.places, rod.quads, rod.mirrored, self.rod_normals)
