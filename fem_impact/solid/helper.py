"""A second thread that does the barrier's part of the forces, and blocks of all that yields.

It runs in compiled code from beginning to end and waits awake, for to wake it would take as long as what it
does in a step, and to hold the interpreter's lock would stop the first thread.
"""

from __future__ import annotations

from threading import Thread
from types import TracebackType
from typing import cast

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.calls import perform
from fem_impact.solid.items import Handed
from fem_impact.solid.kernels import kernel
from fem_impact.solid.model import Model
from fem_impact.solid.signals import make_signals, tell, wait_for
from fem_impact.solid.state import State
from fem_impact.solid.work import Clearing, Drift, Kick, split, touched

__all__ = ["Helper"]

Array = NDArray[np.float64]

LEAVE, MOVE, AHEAD, FIND, COLLECT = range(5)
FIRST, RING = 1, 8  # where what the last orders are stands beside their number, and how many of them


class Helper:
    """Takes orders, from entering its context to leaving it, and does them one after the other.

    Attributes
    ----------
    left : what is left for the first thread
    """

    def __init__(self, model: Model, state: State) -> None:
        self.left, mine = split(model)
        reached, self._times = touched(model), np.zeros(2)
        found = [cast(Handed, force).finding(state, self._times, reached) for force in mine.finds]
        self._calls = (
            (
                Kick(state.v, self._times, model.inverse_mass, state.force, mine.kicked),
                mine.expanded.expansion(state.v),
                Drift(state.x, self._times, state.v, mine.drifted),
            ),
            tuple(call for ahead, _ in found for call in ahead),
            tuple(call for _, rest in found for call in rest),
            (
                Clearing(state.force, mine.cleared),
                *(cast(Handed, force).collecting(state) for force in mine.collects),
                mine.gathered.gathering(state.force),
            ),
        )
        self._order, self._report = make_signals(2)
        self._report[0] = -1  # until the thread is there
        self._moved, self._is_ahead = 0, False
        self._error: BaseException | None = None
        self._thread = Thread(target=self._serve, daemon=True)

    def __enter__(self) -> Helper:
        self._thread.start()
        self.finish()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        give(self._order, LEAVE)
        self._thread.join()

    def move(self, times: Array) -> None:
        """Begin to move, and to find, what the last impulse cannot touch; ``times`` are step and kick, s."""
        self._times[:] = times
        give(self._order, MOVE)
        self._moved = self._order[0]
        give(self._order, AHEAD)
        self._is_ahead = True

    def find(self, state: State) -> None:
        """Begin to find the forces, or the rest of them."""
        if not self._is_ahead:
            self._times[0] = state.dt
            give(self._order, AHEAD)
        give(self._order, FIND)
        self._is_ahead = False
        self._wait(self._moved)  # the first thread will need what is moved

    def collect(self) -> None:
        """Begin to add up what was found."""
        give(self._order, COLLECT)

    def finish(self) -> None:
        """Wait until all orders are done; raise what the thread has raised."""
        self._wait(self._order[0])

    def _wait(self, number: int) -> None:
        while not wait_for(self._report, number):
            if self._error is not None:
                raise self._error

    def _serve(self) -> None:
        try:
            serve(self._order, self._report, self._calls)
        except BaseException as error:  # told to the thread that gave the order
            self._error = error


@kernel
def give(order, what):  # type: ignore[no-untyped-def]
    """Make one more order known: the number of all, and beside it what the last ones are."""
    number = order[0] + 1
    order[FIRST + number % RING] = what
    tell(order, number)


@kernel
def serve(order, report, calls):  # type: ignore[no-untyped-def]
    """Do orders and report their numbers until one says to leave."""
    move, ahead, find, collect = calls
    done = 0
    while True:
        tell(report, done)
        while not wait_for(order, done + 1):
            pass
        done += 1
        what = order[FIRST + done % RING]
        if what == MOVE:
            perform(move)
        elif what == AHEAD:
            perform(ahead)
        elif what == FIND:
            perform(find)
        elif what == COLLECT:
            perform(collect)
        else:
            return
