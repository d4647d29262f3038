"""Progress of a run or a study, and the meters that show it in plain lines or not at all."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol, TextIO, TypeVar


@dataclass(frozen=True, slots=True)
class Progress:
    """The state of a run: times in s, energy drift as a fraction of E_0, contact in words, a note.

    ``eta_s`` is None while it cannot be told, ``eta_range_s`` its least and most; ``note`` names the scene or
    the work when there are several. ``setup_s`` is about what is needed before the first step.
    """

    time_s: float
    end_time_s: float
    step: int
    energy_drift: float
    contact: str
    eta_s: float | None = None
    note: str = ""
    eta_range_s: tuple[float, float] | None = None
    setup_s: float = 0.0


def compiling(end_time_s: float, seconds: int) -> Progress:
    """Return the report of a run that first compiles its kernels, for about so many seconds."""
    return Progress(0.0, end_time_s, 0, 0.0, f"compiling the kernels, once, about {seconds} s")


def standing(end_time_s: float, note: str, eta_s: float | None, setup_s: float) -> Progress:
    """Return the report of a run whose meshes stand before the rod's modes are found."""
    return Progress(0.0, end_time_s, 0, 0.0, "the meshes are made", eta_s, note, setup_s=setup_s)


def setting_up(end_time_s: float, note: str, eta_s: float | None = None, setup_s: float = 0.0) -> Progress:
    """Return the report of a run that makes its mesh and finds the modes of its rod before the first step."""
    doing = "setting up: mesh and modes of the projectile"
    return Progress(0.0, end_time_s, 0, 0.0, doing, eta_s, note, setup_s=setup_s)


@dataclass(frozen=True, slots=True)
class CaseProgress:
    """The state of a study: ``note`` names the case that was just done; ``eta_s`` covers all cases."""

    note: str
    done: int
    total: int
    eta_s: float


@dataclass(frozen=True, slots=True)
class Notice:
    """A sentence that the user must see, whatever the rate of progress lines."""

    text: str


class ProgressMeter(Protocol):
    """Anything that takes progress, and may be closed when the work is over or interrupted."""

    def __call__(self, progress: Progress | CaseProgress | Notice) -> None:
        """Take one report."""

    def close(self) -> None:
        """Finish; called once, also after an error."""


class NullMeter:
    """A meter that shows nothing."""

    def __call__(self, progress: object) -> None:
        """Ignore the report."""

    def close(self) -> None:
        """Do nothing."""


silent = NullMeter()
"""The off-switch: ``progress=silent`` (of `assess`: ``tell=silent``) shows nothing in a notebook either."""


class CellMeter:
    """One line under a cell of a notebook, or in IPython, that is written over and cleared at the end.

    Calls of less than ``first_s`` show nothing.
    """

    def __init__(
        self, stream: TextIO, first_s: float = 1.0, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._stream, self._clock, self._next, self._shown = stream, clock, clock() + first_s, ""

    def __call__(self, progress: Progress | CaseProgress | Notice) -> None:
        """Write over the line, at most five times a second; a notice gets a line of its own."""
        if isinstance(progress, Notice):
            self._over(progress.text)
            self._stream.write("\n")
            self._shown = ""
        elif self._clock() >= self._next:
            self._next = self._clock() + 0.2
            self._over(describe(progress))

    def close(self) -> None:
        """Clear the line."""
        if self._shown:
            self._over("")
            self._over("")

    def _over(self, text: str) -> None:
        self._stream.write(f"\r{text:<{len(self._shown)}}")
        self._stream.flush()
        self._shown = text


Given = TypeVar("Given", bound=Callable[..., None])


@contextmanager
def watched(given: Given | None) -> Iterator[Given | CellMeter | NullMeter]:
    """Yield a meter that was given, which its owner closes; else a line where IPython runs, or silence."""
    if given is not None:
        yield given
        return
    shell = sys.modules.get("IPython")
    meter = CellMeter(sys.stdout) if shell is not None and shell.get_ipython() is not None else silent
    try:
        yield meter
    finally:
        meter.close()


def tell_cell(sentence: str) -> None:
    """Print a sentence where IPython runs."""
    with watched(None) as meter:
        meter(Notice(sentence))


class LineMeter:
    """Plain lines for a log: one at the start of each work, then one every few seconds."""

    def __init__(
        self, stream: TextIO, every_s: float = 5.0, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._stream, self._every, self._clock = stream, every_s, clock
        self._next: dict[str, float] = {}

    def __call__(self, progress: Progress | CaseProgress | Notice) -> None:
        """Write a line when it is due for this work, a notice at once."""
        if isinstance(progress, Notice):
            self._stream.write(f"{progress.text}\n")
            return
        now = self._clock()
        if now < self._next.get(progress.note, now):
            return
        self._next[progress.note] = now + self._every
        self._stream.write(f"{describe(progress)}\n")
        self._stream.flush()

    def close(self) -> None:
        """Do nothing: every line is complete."""


def describe(progress: Progress | CaseProgress) -> str:
    """Return one line: t, time still needed, step, energy drift, contact state; or cases done and that time.

    What matters most stands first, for a narrow terminal cuts the end. Before the first step there is none.
    """
    if isinstance(progress, CaseProgress):
        done = f"{progress.done} of {progress.total} runs done"
        return f"{done}, about {clock_text(progress.eta_s)} left, last {progress.note}"
    parts = (
        progress.note,
        f"t {progress.time_s * 1e6:.0f}/{progress.end_time_s * 1e6:.0f} us",
        left_text(progress),
        f"step {progress.step}  energy drift {progress.energy_drift:+.1e}" if progress.step else "",
        progress.contact,
    )
    return "  ".join(part for part in parts if part)


def left_text(progress: Progress) -> str:
    """Return the time still needed, with its range where that says more; empty where it cannot be told."""
    if progress.eta_s is None:
        return ""
    least, most = progress.eta_range_s or (0.0, 0.0)
    told = f" ({range_text(least, most)})" if round(least) < round(most) else ""
    return f"about {clock_text(progress.eta_s)} left{told}"


def range_text(least_s: float, most_s: float) -> str:
    """Return a range of times in words."""
    least, most = clock_text(least_s), clock_text(most_s)
    return f"{least} to {most}" if round(least_s) else f"up to {most}"


def clock_text(seconds: float) -> str:
    """Return a duration in words."""
    minutes, rest = divmod(round(seconds), 60)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60:02d} min"
    return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"
