"""Linear bodies: the rod in its frame, and the barrier block on its springs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.frame import FixedFrame, TurningFrame
from fem_impact.solid.layout import Layout
from fem_impact.solid.masspoints import MassPoints
from fem_impact.solid.slices import SliceOperator
from fem_impact.solid.sparse import NodeProduct
from fem_impact.solid.state import State

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(slots=True)
class ElasticRod:
    """Slices by stencil, the linear part of the nose by sparse rows, both in one frame."""

    body: ClassVar[str] = "rod"
    effect: ClassVar[str] = "vibration"
    accounts: ClassVar[tuple[str, ...]] = ("strain_rod",)
    moving: ClassVar[tuple[str, ...]] = ("frame.work",)  # its angle
    slices: SliceOperator
    drawn: MassPoints
    nose: NodeProduct
    frame: FixedFrame | TurningFrame
    layout: Layout
    d: Array
    y: Array

    def add(self, state: State) -> None:
        """Add the elastic forces."""
        n = len(self.d)
        self.frame.localise(state.x[:n], self.d)
        self.y[:] = 0.0
        d, y = self.layout.slices_of(self.d), self.layout.slices_of(self.y)
        self.drawn.spread(d)
        self.slices.apply(d, y)
        self.nose.multiply(self.d)
        self.nose.add_to(self.y)
        self.drawn.draw_in(d)
        self.drawn.gather(y)
        self.frame.add_force(self.d, self.y, state.force[:n])

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the strain energy at the last force evaluation."""
        return (0.5 * float(self.d @ self.y),)


@dataclass(slots=True)
class ElasticBlock:
    """The barrier's linear part at ``place`` of the flat vector; ``effect`` is the barrier's."""

    body: ClassVar[str] = "barrier"
    accounts: ClassVar[tuple[str, ...]] = ("strain_barrier",)
    moving: ClassVar[tuple[str, ...]] = ()
    stiffness: NodeProduct
    place: slice
    effect: str = "barrier-elastic"

    def add(self, state: State) -> None:
        """Add the elastic forces of block and boundary springs."""
        self.stiffness.multiply(state.x[self.place])
        self.stiffness.add_to(state.force[self.place], -1.0)

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the strain energy at the last force evaluation."""
        return (self.stiffness.energy,)


@dataclass(slots=True)
class Dashpots:
    """Viscous boundary: takes radiated waves out, implicitly, so that it never limits the step."""

    effect: ClassVar[str] = "radiation"
    accounts: ClassVar[tuple[str, ...]] = ("radiated",)
    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ("radiated",)
    places: Ints
    damping: Array
    inverse_mass: Array
    radiated: float = 0.0

    def resolve(self, state: State) -> None:
        """Damp the boundary velocities; the dashpot force uses the mean velocity of the step."""
        kicked = state.v[self.places]
        old = kicked - state.kick * self.inverse_mass * state.force[self.places]
        share = 0.5 * state.kick * self.inverse_mass * self.damping
        new = (kicked - share * old) / (1 + share)
        mean = 0.5 * (old + new)
        self.radiated += state.kick * float(self.damping @ (mean * mean))
        state.v[self.places] = new

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the energy radiated so far."""
        return (self.radiated,)


@dataclass(slots=True)
class Weight:
    """Gravity on the rod.

    ``weight`` is m g per unknown, N (zero where there is none).
    """

    body: ClassVar[str] = "rod"
    effect: ClassVar[str] = "gravity"
    accounts: ClassVar[tuple[str, ...]] = ("gravity",)
    moving: ClassVar[tuple[str, ...]] = ()
    weight: Array
    reference: Array

    def add(self, state: State) -> None:
        """Add the weight."""
        state.force[: len(self.weight)] += self.weight

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the potential energy since the start."""
        return (-float(self.weight @ (state.x[: len(self.weight)] - self.reference)),)
