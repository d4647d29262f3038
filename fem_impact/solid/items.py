"""What the time loop knows: items that push, items that act on velocities, and their accounts.

The loop holds two lists of these, and observers, and nothing else. An effect that is off has no item.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar, Protocol

from fem_impact.solid.state import State

Accounts = dict[str, float]
Part = Callable[[State], None]


class Account(Protocol):
    """Anything that holds energy or has taken energy away.

    ``moving`` names what a checkpoint must keep, see :mod:`~fem_impact.solid.moving`.
    """

    moving: ClassVar[tuple[str, ...]]

    def accounts(self, state: State) -> Accounts:
        """Return half-model energies by ledger name, J."""
        ...


class Force(Account, Protocol):
    """An item that adds forces at the present positions; ``body`` is rod or barrier.

    Its work is done in parts that write nothing but what is their own, so that threads may share them.
    """

    @property
    def body(self) -> str:
        """Return the body it acts on."""
        ...

    @property
    def parts(self) -> Sequence[Part]:
        """Return the parts of the work, the same at every call."""
        ...

    def collect(self, state: State) -> None:
        """Add to ``state.force`` what the parts have found."""
        ...


def add_force(item: Force, state: State) -> None:
    """Do all the work of one item."""
    for part in item.parts:
        part(state)
    item.collect(state)


class Impulse(Account, Protocol):
    """An item that changes the kicked velocities: contact, dashpots."""

    def resolve(self, state: State) -> None:
        """Change ``state.v`` and book the work done with the mean of old and new velocity."""
        ...
