"""Linear items: the elastic rod in its frame, the barrier block, dashpots, weight and modal damping."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.eigen import RodModes
from fem_impact.fem.layout import DofLayout, MassPoints
from fem_impact.fem.slices import SliceOperator
from fem_impact.fem.sparse import NodeProduct
from fem_impact.solid.frame import FixedFrame, TurningFrame, turned_at
from fem_impact.solid.state import State


@dataclass(slots=True)
class ElasticRod:
    """The rod's linear part: slices by stencil and elastic nose cells by sparse rows, both in one frame.

    A nose that ends in a rigid rest has no slices, and the ``effect`` ``nose``.
    """

    body: ClassVar[str] = "rod"
    accounts: ClassVar[tuple[str, ...]] = ("strain_rod",)
    moving: ClassVar[tuple[str, ...]] = ("frame.work",)  # its angle
    slices: SliceOperator
    drawn: MassPoints
    nose: NodeProduct
    frame: FixedFrame | TurningFrame
    layout: DofLayout
    d: Array
    y: Array
    effect: str = "vibration"

    def add(self, state: State) -> None:
        """Add the elastic forces."""
        n = len(self.d)
        self.frame.localise(state.x[:n], self.d)
        self.apply(self.d, self.y)
        self.frame.add_force(self.d, self.y, state.force[:n])

    def apply(self, d: Array, y: Array) -> None:
        """Set ``y`` (n,), N, to the stiffness times displacements ``d`` (n,), m, in the frame."""
        y[:] = 0.0
        drawn, forces = self.layout.slices_of(d), self.layout.slices_of(y)
        self.drawn.expand(drawn)
        self.slices.apply(drawn, forces)
        self.nose.multiply(d)
        self.nose.add_to(y)
        self.drawn.condense(drawn)
        self.drawn.gather(forces)

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the strain energy at the last force evaluation."""
        return (0.5 * float(self.d @ self.y),)


@dataclass(slots=True)
class ElasticBlock:
    """The barrier's linear part, at ``place`` of the flat vectors; ``effect`` is the barrier's."""

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
    """Viscous boundary that absorbs outgoing waves; implicit in time, so it does not limit the step.

    ``places`` (k,) are the damped unknowns, ``damping`` (k,), N s/m, ``inverse_mass`` (k,), 1/kg. On a free
    barrier ``ends`` (k,) are the unknowns of its foundation that hold the other ends, ``foundation_inverse``
    (k,), 1/kg, its inverse masses; both are empty else. Block and foundation are solved for together: a block
    may hold nearly all of its barrier's mass. ``effect`` and ``accounts`` are those of the waves.
    """

    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ("radiated",)
    places: Ints
    damping: Array
    inverse_mass: Array
    ends: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    foundation_inverse: Array = field(default_factory=lambda: np.zeros(0))
    effect: str = "radiation"
    accounts: tuple[str, ...] = ("radiated",)
    radiated: float = 0.0

    def resolve(self, state: State) -> None:
        """Damp the boundary velocities; the dashpot force uses the mean velocity of the step."""
        if len(self.ends):
            self._resolve_free(state)
            return
        kicked = state.v[self.places]
        old = kicked - state.kick * self.inverse_mass * state.force[self.places]
        share = 0.5 * state.kick * self.inverse_mass * self.damping
        new = (kicked - share * old) / (1 + share)
        mean = 0.5 * (old + new)
        self.radiated += state.kick * float(self.damping @ (mean * mean))
        state.v[self.places] = new

    def _resolve_free(self, state: State) -> None:
        """Damp the velocities relative to the foundation, which takes the opposite impulses."""
        seen = state.v[self.places] - state.v[self.ends]
        pushed = state.kick * self.inverse_mass * state.force[self.places]
        dragged = state.kick * self.foundation_inverse * state.force[self.ends]
        old, half = seen - pushed + dragged, 0.5 * state.kick * self.damping
        given = half / (1 + half * self.inverse_mass)  # N s per m/s of the foundation's motion
        alone, at = -given * (old + seen), self.ends - self.ends.min()
        passed = given * self.foundation_inverse
        taken = np.bincount(at, alone) / (1 + np.bincount(at, passed))  # by each of its unknowns
        impulse = alone - passed * taken[at]
        state.v[self.places] += self.inverse_mass * impulse
        np.add.at(state.v, self.ends, -self.foundation_inverse * impulse)
        new = state.v[self.places] - state.v[self.ends]
        self.radiated -= 0.5 * float(impulse @ (old + new))

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the energy radiated so far."""
        return (self.radiated,)


@dataclass(slots=True)
class Weight:
    """Gravity on the rod.

    ``weight`` (n,), N, is the weight along each unknown, ``reference`` (n,), m, the start position.
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


PHASE = 0.3  # rad, largest phase of the highest mode between two applications


@dataclass(slots=True)
class ModalDamping:
    """Damping with a loss factor eta: each modal velocity q' is multiplied by exp(-eta omega t).

    A mode's energy then decays like exp(-eta omega t). Rigid motion is not damped and keeps its momentum.

    Attributes
    ----------
    modes : in the reference position; weighted : (modes, n), their shapes times mass
    frame : of the rod's linear part, for its angle
    places : (k, 3) int64, unknowns of the rod's free nodes
    loss : loss factor eta; every : steps between two applications
    taken : damped energy of the half model so far, J; last : time of the last application, s
    """

    effect: ClassVar[str] = "material-damping"
    accounts: ClassVar[tuple[str, ...]] = ("damping",)
    moving: ClassVar[tuple[str, ...]] = ("taken", "last")
    modes: RodModes
    weighted: Array
    frame: FixedFrame | TurningFrame
    inverse_mass: Array
    places: Ints
    loss: float
    every: int
    taken: float = 0.0
    last: float = 0.0

    @classmethod
    def of(
        cls,
        modes: RodModes,
        frame: FixedFrame | TurningFrame,
        inverse_mass: Array,
        places: Ints,
        loss: float,
        step: float,
    ) -> "ModalDamping":
        """Build with the interval of applications, in steps of ``step`` s, that the highest mode allows."""
        every = max(1, int(PHASE / modes.omega[-1] / step))
        weighted = np.ascontiguousarray(modes.shape.T * modes.mass)
        return cls(modes, weighted, frame, inverse_mass, places, loss, every)

    def resolve(self, state: State) -> None:
        """Damp and add the work done, from the mean of old and new velocity."""
        n, angle = len(self.modes.mass), self.frame.angle
        kicked = turned_at(state.v[:n], self.places, angle)
        pushed = turned_at(self.inverse_mass * state.force[:n], self.places, angle)
        q = self.weighted @ kicked
        old = q - state.kick * (self.weighted @ pushed)
        lost = q * -np.expm1(-self.loss * self.modes.omega * (state.time - self.last))
        self.last = state.time
        self.taken += 0.5 * float(lost @ (old + q - lost))
        state.v[:n] -= turned_at(self.modes.shape @ lost, self.places, -angle)

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the damped energy so far."""
        return (self.taken,)
