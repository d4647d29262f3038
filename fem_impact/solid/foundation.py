"""What moves the barrier as a whole: springs on a free mass that does not turn, or a plate that bends.

It has the unknowns of one node, the foundation. On a free barrier the springs and dashpots around a meshed
block, which stand for the rest of the barrier, act between block and foundation, and a rigid plane is the
foundation: so the barrier has the momentum that the rod loses. A plate has its inertia in its impedance: its
block or plane stays at rest in a frame that moves with the plate.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.layout import DofLayout
from fem_impact.solid.contact.book import ContactBook
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.state import Impulse, State


@dataclass(slots=True)
class FoundationSprings:
    """What the springs around a block do to its foundation, beside their part in the block's own stiffness.

    Attributes
    ----------
    places : (k,) unknowns of the block with springs; stiffness : (k,) N/m; origin : (k,) positions, m
    ends : (k,) unknowns of the foundation that hold their other ends
    """

    body: ClassVar[str] = "barrier"
    accounts: ClassVar[tuple[str, ...]] = ("strain_barrier",)
    moving: ClassVar[tuple[str, ...]] = ()
    places: Ints
    stiffness: Array
    origin: Array
    ends: Ints
    effect: str = "barrier-elastic"
    energy: float = 0.0

    @classmethod
    def of(cls, springs: Array, layout: DofLayout, x: Array, effect: str) -> "FoundationSprings":
        """Build from the ``springs``, N/m, of all unknowns of a block; those along b move no foundation."""
        first, held = layout.barrier_slice.start, np.flatnonzero(springs)
        held = held[layout.ends(first + held) != layout.foundation[1]]
        places = first + held
        return cls(places, springs[held], x[places].copy(), layout.ends(places), effect)

    def add(self, state: State) -> None:
        """Add the forces by the motion of the foundation, and those on it."""
        moved = state.x[self.ends]
        pulled = self.stiffness * moved
        stretched = self.stiffness * (state.x[self.places] - self.origin) - pulled
        state.force[self.places] += pulled
        np.add.at(state.force, self.ends, stretched)
        # the block's stiffness holds the energy of springs whose other ends stand still
        self.energy = -0.5 * float(moved @ (stretched + stretched + pulled))

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the strain energy beyond that of the block's stiffness."""
        return (self.energy,)


@dataclass(slots=True)
class BendingPlate:
    """A plate that gives way along n at the normal force over its impedance; it acts after the contact.

    The force of a step moves the plate in the next one.

    Attributes
    ----------
    place : unknown of the foundation along n; rows : (k,) those of the rod's nodes that may touch
    impedance : of the half model, N s/m; book : of the contact
    speed, later : velocity in this step and in the next, m/s
    taken : energy of the half model that bending waves carry away so far, J
    """

    effect: ClassVar[str] = "plate-bending"
    accounts: ClassVar[tuple[str, ...]] = ("plate",)
    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ("speed", "later", "taken")
    place: int
    rows: Ints
    impedance: float
    book: ContactBook
    speed: float = 0.0
    later: float = 0.0
    taken: float = 0.0

    def resolve(self, state: State) -> None:
        """Bring the rod back from the plate's frame and book the work of the contact on the plate."""
        state.x[self.rows] += state.x[self.place]
        state.v[self.rows] += self.speed
        impulse = self.book.step.impulse_n
        self.taken -= impulse * self.speed
        self.later = -impulse / (self.impedance * state.kick)

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the energy carried away so far."""
        return (self.taken,)


@dataclass(slots=True)
class PlateFrame:
    """The step into the frame of a plate that bends; it acts before the contact."""

    effect: ClassVar[str] = "plate-bending"
    accounts: ClassVar[tuple[str, ...]] = ()
    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ()
    plate: BendingPlate

    def resolve(self, state: State) -> None:
        """Set the plate's velocity and take it from the rod's nodes that may touch."""
        plate = self.plate
        plate.speed = state.v[plate.place] = plate.later
        state.x[plate.rows] -= state.x[plate.place]
        state.v[plate.rows] -= plate.speed

    def energies(self, state: State) -> tuple[float, ...]:
        """Return nothing: a frame holds no energy."""
        return ()


def on_plate(contact: PlaneContact | SurfaceContact, place: int, impedance: float) -> list[Impulse]:
    """Return a contact within the frame of a plate of ``impedance``, N s/m, of the whole model."""
    nodes = contact.rod.places if isinstance(contact, SurfaceContact) else contact.nodes
    plate = BendingPlate(place, nodes[:, 2].copy(), 0.5 * impedance, contact.book)
    return [PlateFrame(plate), contact, plate]
