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

    def finding(
        self, state: State, times: NDArray[np.float64], touched: NDArray[np.bool_]
    ) -> tuple[list[Call], list[Call]]:
        """Return calls for a share in `find`: those that need no ``touched`` unknown (size,), and the others.

        The first of two ``times`` will be the step that led to ``x``, s.
        """
        ...

    def collecting(self, state: State) -> Call:
        """Return the call for `collect`."""
        ...


def add_force(item: Force, state: State) -> None:
    """Do all the work of one item."""
    item.find(state)
    item.collect(state)


class Impulse(Account, Protocol):
    """An item that changes the kicked velocities, of unknowns at its ``places``: contact, dashpots."""

    @property
    def places(self) -> NDArray[np.int64]:
        """Return what it may change, an array of any shape."""
        ...

    def resolve(self, state: State) -> None:
        """Change ``state.v`` and book the work done with the mean of old and new velocity."""
        ...
