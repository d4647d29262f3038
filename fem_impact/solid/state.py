"""The state of a run, and the interfaces of the items that act on it.

The time loop knows two lists of items, those that add forces and those that change velocities, and observers.
An effect that is off has no item.
"""

from dataclasses import dataclass
from typing import ClassVar, Protocol

from fem_impact.arrays import Array


@dataclass(slots=True)
class State:
    """State of a run; all vectors are flat and numbered by :class:`~fem_impact.fem.layout.DofLayout`.

    Attributes
    ----------
    x, v, force : (size,) float64, m, m/s (half a step behind x), N
    time : s
    step : number of steps done
    dt : step that led to ``x`` (s); 0 before the first
    dt_next : step to take, s
    kick : time over which the present forces act on the velocities, s
    """

    moving: ClassVar[tuple[str, ...]] = ("x", "v", "force", "time", "step", "dt", "dt_next", "kick")
    x: Array
    v: Array
    force: Array
    time: float = 0.0
    step: int = 0
    dt: float = 0.0
    dt_next: float = 0.0
    kick: float = 0.0


class Item(Protocol):
    """A part of the model that may store or dissipate energy.

    ``moving`` names the attributes that a checkpoint stores, see :mod:`~fem_impact.solid.checkpoint`.
    """

    moving: ClassVar[tuple[str, ...]]

    @property
    def effect(self) -> str:
        """Return the effect that its run time counts to, or ``nose`` or ``contact``, which are no effects."""
        ...

    @property
    def accounts(self) -> tuple[str, ...]:
        """Return the names of the ledger's accounts that it adds to; a new name makes a new account."""
        ...

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the half model's energy in each of its ``accounts``, J."""
        ...


class Force(Item, Protocol):
    """An item that adds forces at the present positions; ``body`` is rod or barrier."""

    @property
    def body(self) -> str:
        """Return the body it acts on."""
        ...

    def add(self, state: State) -> None:
        """Add the forces at ``state.x`` to ``state.force``, N."""
        ...


class Impulse(Item, Protocol):
    """An item that changes the kicked velocities: contact, dashpots."""

    @property
    def every(self) -> int:
        """Return the number of steps between two applications."""
        ...

    def resolve(self, state: State) -> None:
        """Change ``state.v`` and record the work done, from the mean of old and new velocity."""
        ...
