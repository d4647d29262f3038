"""Record of the contact of a run: work, impulses and contact intervals."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fem_impact.arrays import Array
from fem_impact.physics.contact_law import FAINT, MERGE_GAP

# places in the step record that the kernels fill (half model)
IMPULSE_T, IMPULSE_N, ARM, FRICTION, CLOSING, ACTIVE, OUTSIDE, SWEEPS = range(8)
RECORD = 8


# what a checkpoint keeps of a contact
MOVING = tuple(
    f"book.{name}"
    for name in (
        "step",
        "friction",
        "closing",
        "impulse",
        "largest",
        "last_touch",
        "outside",
        "table",
    )
)


@dataclass(slots=True)
class Interval:
    """One contact: start and end, s, and its impulse on the whole rod, N s."""

    start: float
    end: float
    impulse_n: float = 0.0
    impulse_t: float = 0.0


@dataclass(slots=True)
class ContactBook:
    """Running sums of one run; energies and impulses of the half model.

    Attributes
    ----------
    step : (RECORD,) what the last step did
    friction, closing : energy taken by friction and by stopping lumped nodes, J
    impulse : (3,) sums of p_t, p_n and of the moment x_t p_n - x_n p_t about the origin
    """

    step: Array = field(default_factory=lambda: np.zeros(RECORD))
    friction: float = 0.0
    closing: float = 0.0
    impulse: Array = field(default_factory=lambda: np.zeros(3))
    intervals: list[Interval] = field(default_factory=list)
    largest: float = 0.0
    last_touch: float = -np.inf
    outside: int = 0

    @property
    def table(self) -> Array:
        """Return the intervals as rows (k, 4): start, end, impulses."""
        rows = [(i.start, i.end, i.impulse_n, i.impulse_t) for i in self.intervals]
        return np.array(rows, dtype=np.float64).reshape(-1, 4)

    @table.setter
    def table(self, rows: Array) -> None:
        self.intervals = [Interval(*map(float, row)) for row in rows]

    @property
    def touching(self) -> bool:
        """Return whether the last step had a compressed node."""
        return bool(self.step[ACTIVE] > 0)

    def close_step(self, time: float) -> None:
        """Add the step's record to the sums."""
        self.friction += float(self.step[FRICTION])
        self.closing += float(self.step[CLOSING])
        self.outside = max(self.outside, int(self.step[OUTSIDE]))
        if self.touching:
            self._touch(time)

    def _touch(self, time: float) -> None:
        self.last_touch = time
        self.impulse += self.step[[IMPULSE_T, IMPULSE_N, ARM]]
        self.largest = max(self.largest, float(self.step[IMPULSE_N]))
        if self.step[IMPULSE_N] > FAINT * self.largest:
            self._prolong(time)

    def _prolong(self, time: float) -> None:
        if not self.intervals or time - self.intervals[-1].end > MERGE_GAP:
            self.intervals.append(Interval(time, time))
        now = self.intervals[-1]
        now.end = time
        now.impulse_n += 2 * float(self.step[IMPULSE_N])
        now.impulse_t += 2 * float(self.step[IMPULSE_T])
