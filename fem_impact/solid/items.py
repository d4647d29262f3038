"""What the time loop knows: items that push, items that act on velocities, and their accounts.

The loop holds two lists of these, and observers, and nothing else. An effect that is off has no item.
"""

from __future__ import annotations

from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.calls import Call
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

    def find(self, state: State) -> None:
        """Do the work; write nothing but what is the item's own."""
        ...

    def collect(self, state: State) -> None:
        """Add to ``state.force`` what was found."""
        ...


class Handed(Force, Protocol):
    """A force whose work a second thread can do, by calls (see :mod:`~fem_impact.solid.calls`)."""

    def finding(self, state: State, dt: NDArray[np.float64]) -> Call:
        """Return the call for a share in `find`; ``dt`` (1,) holds the step that led to ``x``."""
        ...

    def collecting(self, state: State) -> Call:
        """Return the call for `collect`."""
        ...


def add_force(item: Force, state: State) -> None:
    """Do all the work of one item."""
    item.find(state)
    item.collect(state)


class Impulse(Account, Protocol):
    """An item that changes the kicked velocities: contact, dashpots."""

    def resolve(self, state: State) -> None:
        """Change ``state.v`` and book the work done with the mean of old and new velocity."""
        ...
