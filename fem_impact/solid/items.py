"""Interfaces of the model's items: those that add forces, those that change velocities, and their accounts.

The time loop knows two lists of items, and observers. An effect that is off has no item.
"""

from typing import ClassVar, Protocol

from fem_impact.solid.model import State


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
