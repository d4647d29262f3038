"""Record of the contact of a run: work, impulses and contact intervals."""

from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.physics.contact_law import FAINT, MERGE_GAP
from fem_impact.solid.state import State

# what a checkpoint keeps of a contact
MOVING = tuple(
    f"book.{name}"
    for name in ("last_step", "friction", "closing", "impulse", "largest", "last_touch", "outside", "table")
)


class StepRecord(NamedTuple):
    """What a contact did to the rod in one step, half model (a named tuple, so that kernels can return it).

    Attributes
    ----------
    impulse_t, impulse_n : sums p_t and p_n of the impulses on the rod, N s
    moment : sum of x_t p_n - x_n p_t, about the origin, N m s
    friction, closing : energy taken by friction and by stopping lumped nodes, J
    rubbed : sum of the sizes of the impulses along the surface, N s
    active : number of pressed nodes
    outside : number of rod nodes below the barrier's surface that lie beside its patch
    """

    impulse_t: float = 0.0
    impulse_n: float = 0.0
    moment: float = 0.0
    friction: float = 0.0
    closing: float = 0.0
    rubbed: float = 0.0
    active: int = 0
    outside: int = 0


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
    step : what the last step did
    friction, closing : energy taken by friction and by stopping lumped nodes, J
    impulse : (3,) sums of p_t, p_n and of the moment x_t p_n - x_n p_t about the origin
    gap : longest time, s, without touching within one contact
    """

    step: StepRecord = StepRecord()  # noqa: RUF009
    friction: float = 0.0
    closing: float = 0.0
    impulse: Array = field(default_factory=lambda: np.zeros(3))
    intervals: list[Interval] = field(default_factory=list)
    largest: float = 0.0
    last_touch: float = -np.inf
    outside: int = 0
    gap: float = MERGE_GAP

    @property
    def table(self) -> Array:
        """Return the intervals as rows (k, 4): start, end, impulses."""
        rows = [(i.start, i.end, i.impulse_n, i.impulse_t) for i in self.intervals]
        return np.array(rows, dtype=np.float64).reshape(-1, 4)

    @table.setter
    def table(self, rows: Array) -> None:
        self.intervals = [Interval(*map(float, row)) for row in rows]

    @property
    def last_step(self) -> Array:
        """Return ``step`` as an array, for a checkpoint."""
        return np.array(self.step, dtype=np.float64)

    @last_step.setter
    def last_step(self, values: Array) -> None:
        self.step = StepRecord(*values[:6].tolist(), *values[6:].astype(int).tolist())

    @property
    def touching(self) -> bool:
        """Return whether the last step had a compressed node."""
        return self.step.active > 0

    def close_step(self, step: StepRecord, time: float) -> None:
        """Add the record of the step that ends at ``time``, s, to the sums."""
        self.step = step
        self.friction += step.friction
        self.closing += step.closing
        self.outside = max(self.outside, step.outside)
        if not self.touching:
            return
        self.last_touch = time
        self.impulse += (step.impulse_t, step.impulse_n, step.moment)
        self.largest = max(self.largest, step.impulse_n)
        if step.impulse_n > FAINT * self.largest:
            if not self.intervals or time - self.intervals[-1].end > self.gap:
                self.intervals.append(Interval(time, time))
            now = self.intervals[-1]
            now.end = time
            now.impulse_n += 2 * self.step.impulse_n
            now.impulse_t += 2 * self.step.impulse_t


class Booked:
    """A contact of any kind, as the ledger sees it: its energies are those in its book."""

    __slots__ = ()
    effect: ClassVar[str] = "contact"
    accounts: ClassVar[tuple[str, ...]] = ("friction", "contact_dissipation")
    every: ClassVar[int] = 1
    book: ContactBook

    def energies(self, state: State) -> tuple[float, ...]:
        """Return friction heat and closing loss."""
        return self.book.friction, self.book.closing
