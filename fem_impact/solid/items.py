"""What the time loop knows: items that push, items that act on velocities, and their accounts.

The loop holds two lists of these, and observers, and nothing else. An effect that is off has no item.
"""

from __future__ import annotations

from typing import ClassVar, Protocol

from fem_impact.solid.state import State

Accounts = dict[str, float]


class Account(Protocol):
    """Anything that holds energy or has taken energy away.

    ``moving`` names what a checkpoint must keep, see :mod:`~fem_impact.solid.moving`.
    """

    moving: ClassVar[tuple[str, ...]]

    def accounts(self, state: State) -> Accounts:
        """Return half-model energies by ledger name, J."""
        ...


class Force(Account, Protocol):
    """An item that adds forces at the present positions; ``body`` is rod or barrier."""

    @property
    def body(self) -> str:
        """Return the body it acts on."""
        ...

    def add(self, state: State) -> None:
        """Add the forces at ``state.x`` to ``state.force``, N."""
        ...


class Impulse(Account, Protocol):
    """An item that changes the kicked velocities: contact, dashpots."""

    def resolve(self, state: State) -> None:
        """Change ``state.v`` and book the work done with the mean of old and new velocity."""
        ...
