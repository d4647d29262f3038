"""The largest contact force of a run, as a mean over a fixed time, so that meshes can be compared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from fem_impact.solid.contact import ContactBook
from fem_impact.solid.state import State

WINDOW = 2e-6  # s: nodes close one by one, and the impulse of a single step is noise


@dataclass(slots=True)
class PeakForce:
    """Follows the normal force on the whole rod.

    ``largest`` is its largest mean over `WINDOW`, N.
    """

    moving: ClassVar[tuple[str, ...]] = ("largest", "_time", "_impulse")
    book: ContactBook
    every: int = 1
    largest: float = 0.0
    _time: float = 0.0
    _impulse: float = 0.0

    def observe(self, state: State) -> bool:
        """Close a window when it is long enough."""
        span = state.time - self._time
        if span >= WINDOW:
            impulse = float(self.book.impulse[1])
            self.largest = max(self.largest, 2 * (impulse - self._impulse) / span)
            self._time, self._impulse = state.time, impulse
        return False
