"""What the time loop knows: items that push, items that act on velocities, and their accounts.

The loop holds two lists of these, and observers, and nothing else. An effect that is off has no item.
"""

from __future__ import annotations

from typing import ClassVar, Protocol

from fem_impact.solid.state import State


class Item(Protocol):
    """A part of the model that may hold energy or take it away.

    ``moving`` names what a checkpoint must keep, see :mod:`~fem_impact.solid.checkpoint`.
    """

    moving: ClassVar[tuple[str, ...]]

    @property
    def effect(self) -> str:
        """Return the effect whose run time it counts to, or ``nose`` or ``contact``, which are no effects."""
        ...

    @property
    def accounts(self) -> tuple[str, ...]:
        """Return the ledger's accounts that it books in; a name that no other item has is a new account."""
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
        """Return at every how many steps it acts."""
        ...

    def resolve(self, state: State) -> None:
        """Change ``state.v`` and book the work done with the mean of old and new velocity."""
        ...
