"""Observers of a run: energy ledger, history, field frames, progress and peak force."""

import time as clock
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array
from fem_impact.files.fields_write import FieldWriter
from fem_impact.progress import Progress
from fem_impact.solid.contact.book import ContactBook
from fem_impact.solid.ledger import Ledger
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import FieldSampler, RodState
from fem_impact.solid.state import State
from fem_impact.tables.history import HistoryWriter

QUIET = 20e-6  # s without contact before the free flight is evaluated: waves cross the block a few times
OF_IMPACT = 0.1  # of `Case.one_impact`, the longest such time: in a smaller scene all is sooner
GROWTH = 1e-2  # of E_0, growth of the total energy at which a run stops as unstable

TAKEN = {"friction", "contact_dissipation", "radiated", "damping", "plate"}


def history_column(account: str) -> str:
    """Return the column of history.csv that holds an account or the residual."""
    if account == "residual":
        return "residual_J"
    return f"{'W' if account in TAKEN else 'E'}_{account}_J"


@dataclass(slots=True)
class Watch:
    """Observer that samples the ledger, stores the last accounts and stops a run whose energy grows.

    Energies are computed here only.
    """

    moving: ClassVar[tuple[str, ...]] = ("ledger.start", "ledger.worst", "sampled")
    ledger: Ledger
    every: int
    accounts: dict[str, float] = field(default_factory=dict)
    reason: str = ""

    @property
    def sampled(self) -> Array:
        """Return the last accounts in their order, the residual last, J."""
        return np.array(list(self.accounts.values()))

    @sampled.setter
    def sampled(self, values: Array) -> None:
        self.accounts = dict(zip((*self.ledger.names, "residual"), map(float, values), strict=True))

    def observe(self, state: State) -> bool:
        """Sample the ledger; stop if the energy has grown by more than `GROWTH`."""
        self.accounts = self.ledger.sample(state)
        if self.drift >= -GROWTH:
            return False
        self.reason = (
            f"The energy has grown by {-self.drift:.1e} of E_0 at {state.time * 1e6:.2f} us, step "
            f"{state.step}: the steps are too long. Use a coarser accuracy.tip_size or a lower speed."
        )
        return True

    @property
    def drift(self) -> float:
        """Return the present residual over E_0."""
        return self.accounts["residual"] / self.ledger.start


@dataclass(slots=True)
class History:
    """Observer that writes history.csv; it follows `Watch` and has the same interval."""

    moving: ClassVar[tuple[str, ...]] = ("last_time", "last_impulse", "writer.size")
    model: Model
    view: RodState
    watch: Watch
    writer: HistoryWriter
    every: int
    last_time: float = 0.0
    last_impulse: Array = field(default_factory=lambda: np.zeros(3))

    def observe(self, state: State) -> bool:
        """Append one row."""
        motion = self.view.rigid(state)
        # the mean force on the whole rod since the last row, N
        span, now = state.time - self.last_time, self.model.book.impulse.copy()
        gained = 2 * (now - self.last_impulse) / span if span > 0 else np.zeros(3)
        self.last_time, self.last_impulse = state.time, now
        force_t, force_n = float(gained[0]), float(gained[1])
        row: dict[str, float] = {history_column(k): v for k, v in self.watch.accounts.items()}
        row |= {"time_s": state.time, "force_n_N": force_n, "force_t_N": force_t}
        row |= {"contact_nodes": self.model.book.step.active}
        row |= {"V_n_m_per_s": motion.V_n, "V_t_m_per_s": motion.V_t, "Omega_rad_per_s": motion.Omega}
        self.writer.append(row)
        return False


@dataclass(slots=True)
class Frames:
    """Observer that writes a frame every ``early``, s, until the time ``parted``, then every ``later``, s."""

    moving: ClassVar[tuple[str, ...]] = ("due", "writer.frames")
    fields: FieldSampler
    writer: FieldWriter
    early: float
    later: float
    parted: float
    every: int = 10
    due: float = 0.0

    def observe(self, state: State) -> bool:
        """Append when a frame is due."""
        if state.time >= self.due:
            self.writer.append(state.time, *self.fields.sample(state))
            self.due += self.early if self.due < self.parted else self.later
        return False


REBOUND = 1.5  # impulse of a contact over that which stops the approach: e mostly lies between 0.2 and 0.8


@dataclass(slots=True)
class ProgressObserver:
    """Observer that reports progress towards the time at which rod and barrier are apart.

    That time follows the normal impulse so far: a contact whose force is half a sine wave in time T has given
    the share sin^2(pi t / 2 T) of its impulse at the time t. The smaller the share, the more counts ``end``,
    s, expected before the run. ``stopping`` is the impulse, N s, that stops the contact point's approach.
    """

    moving: ClassVar[tuple[str, ...]] = ()
    show: Callable[[Progress], None]
    watch: Watch
    model: Model
    end: float
    stopping: float
    note: str
    every: int = 200
    reports: int = 0
    begun: tuple[float, float] = (0.0, 0.0)

    def observe(self, state: State) -> bool:
        """Report the progress."""
        time, end = state.time, self._end(state.time)
        # kernels are loaded in the steps before the second report: they do not count for the pace
        self.reports += 1
        if self.reports == 2:  # a resumed run does not begin at time 0
            self.begun = clock.monotonic(), time
        spent, done = clock.monotonic() - self.begun[0], time - self.begun[1]
        eta = spent * (end - time) / done if self.reports > 2 and time < end else None
        nodes = self.model.book.step.active
        contact = f"{nodes} nodes touch" if nodes else "no contact"
        self.show(Progress(time, max(end, time), state.step, self.watch.drift, contact, eta, self.note))
        return False

    def _end(self, time: float) -> float:
        """Return the time, s, at which the run is expected to end; after a contact it ends soon."""
        book = self.model.book
        if book.intervals and not book.touching:
            return book.last_touch + QUIET
        share = min(2 * float(book.impulse[1]) / (REBOUND * self.stopping), 1.0)
        if share <= 0:
            return self.end
        half_sine = time * 0.5 * np.pi / float(np.arcsin(np.sqrt(share))) + QUIET
        return (1 - share) * self.end + share * half_sine


@dataclass(slots=True)
class AddedMass:
    """Observer of the kinetic energy of the mass that mass scaling added, less that of the mass taken off.

    ``largest`` is its largest amount, J, of the half model; it is a part of the bodies' kinetic energies.
    """

    moving: ClassVar[tuple[str, ...]] = ("largest",)
    mass: Array
    every: int = 50
    largest: float = 0.0

    def observe(self, state: State) -> bool:
        """Compare with the largest so far."""
        self.largest = max(self.largest, abs(0.5 * float(self.mass @ state.v**2)))
        return False


FORCE_WINDOW = 2e-6  # s, of mean forces: nodes close one by one, so the impulse of a single step is noise
OF_CONTACT = 1 / 30  # of the estimated contact, the longest window: half a sine keeps .9995


@dataclass(slots=True)
class PeakForce:
    """Observer of the largest normal force on the whole rod.

    ``largest`` is its largest mean, N, over a ``window``, s, and ``nodes`` how many nodes of the half model
    were pressed at once in that window.
    """

    moving: ClassVar[tuple[str, ...]] = ("largest", "nodes", "_time", "_impulse", "_nodes")
    book: ContactBook
    window: float = FORCE_WINDOW
    every: int = 1
    largest: float = 0.0
    nodes: int = 0
    _time: float = 0.0
    _impulse: float = 0.0
    _nodes: int = 0

    def observe(self, state: State) -> bool:
        """Close a window when it is long enough."""
        span, self._nodes = state.time - self._time, max(self._nodes, self.book.step.active)
        if span >= self.window:
            impulse = float(self.book.impulse[1])
            force = 2 * (impulse - self._impulse) / span
            if force > self.largest:
                self.largest, self.nodes = force, self._nodes
            self._time, self._impulse, self._nodes = state.time, impulse, 0
        return False
