"""The constant data of a run: numbering, masses, and the items of the time loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.eigen import MassStiffness
from fem_impact.fem.geometry import Geometry
from fem_impact.fem.layout import DofLayout, MassPoints
from fem_impact.fem.sparse import Hanging
from fem_impact.solid.contact.book import ContactBook
from fem_impact.solid.contact.moving_plane import MovingPlane
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.elastic import ElasticRod
from fem_impact.solid.ground import Ground
from fem_impact.solid.ledger import Ledger
from fem_impact.solid.state import Force, Impulse, Item, State

if TYPE_CHECKING:
    from fem_impact.solid.yielding import YieldingZone


@dataclass(frozen=True, slots=True)
class Model:
    """Everything that does not change during a run.

    Attributes
    ----------
    geometry : meshes
    layout : places of the unknowns
    mass, inverse_mass : (size,), kg and 1/kg, of the half model; the inverse is 0 where an unknown is fixed
    added_mass : (size,) the masses less the true ones, kg
    scaling : mass scaling in force
    drawn : mass points of the rod's slices
    forces, impulses : items in the order in which they act
    rod : the rod's linear part, one of the forces
    zones : the yielding zones among the forces
    contact : one of the impulses, or None without contact
    ground : the motion of the barrier as a whole
    hanging : ties of the locally refined meshes
    rod_stiffness : elastic stiffness of the half rod over its mass points, N/m; None for a rod that cannot
        vibrate
    steps : stable step of each body with its safety factor, s
    start : (size,) positions and (size,) velocities at time 0
    uneven : what is told of a mesh that has the body's mass elsewhere, see `fem_impact.fem.uneven`
    """

    geometry: Geometry
    layout: DofLayout
    mass: Array
    inverse_mass: Array
    added_mass: Array
    scaling: float
    drawn: MassPoints
    forces: Sequence[Force]
    impulses: Sequence[Impulse]
    rod: ElasticRod
    zones: Sequence[YieldingZone]
    contact: PlaneContact | MovingPlane | SurfaceContact | None
    ground: Ground
    hanging: Hanging
    rod_stiffness: MassStiffness | None
    steps: Mapping[str, float]
    start: tuple[Array, Array]
    uneven: str = ""

    @property
    def step(self) -> float:
        """Return the smallest stable step of the bodies, s."""
        return min(self.steps.values())

    @property
    def book(self) -> ContactBook:
        """Return the record of the contact, an empty one without contact."""
        return self.contact.book if self.contact else ContactBook()

    @property
    def in_plate_frame(self) -> bool:
        """Return whether the barrier's positions are those seen from a plate that bends."""
        return bool(len(self.layout.foundation)) and not self.mass[self.layout.foundation].any()

    def nodes(self, vector: Array) -> Array:
        """Return displacements or velocities of the nodes from those of the mass points, both (size,)."""
        moved = vector.copy()
        self.drawn.expand(self.layout.slices_of(moved))
        return moved

    def with_ties(self, of_rod: Array) -> Array:
        """Return a flat vector (size,) with values of the rod's unknowns, those of tied nodes included."""
        whole = np.zeros(self.layout.size)
        whole[: len(of_rod)] = of_rod
        self.hanging.expand(whole)
        return whole

    def initial_state(self) -> State:
        """Return the state just before the first contact."""
        x, v = self.start
        state = State(x.copy(), v.copy(), np.zeros_like(x))
        state.dt_next = self.step
        return state

    def coasting(self) -> Model:
        """Return the model of the rod alone, for free flight after the last contact."""
        rod_forces = [f for f in self.forces if f.body == "rod"]
        return replace(self, forces=rod_forces, impulses=())

    def ledger(self) -> Ledger:
        """Return an empty ledger over all items."""
        items: list[Item] = [*self.forces, *self.impulses]
        moved = np.where(self.inverse_mass > 0, self.mass, 0.0)
        return Ledger(moved, slice(0, self.layout.rod_size), items)
