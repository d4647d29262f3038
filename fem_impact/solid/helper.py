"""A second thread that does the barrier's part of the forces, and blocks of all that yields.

It runs in compiled code from beginning to end and waits awake, for to wake it would take as long as what it
does in a step, and to hold the interpreter's lock would stop the first thread.
"""

from __future__ import annotations

from threading import Thread
from types import TracebackType
from typing import cast

import numpy as np

from fem_impact.solid.calls import perform
from fem_impact.solid.items import Handed
from fem_impact.solid.kernels import kernel
from fem_impact.solid.model import Model
from fem_impact.solid.signals import look, make_signals, tell, wait_for_change
from fem_impact.solid.state import State

__all__ = ["COLLECT", "FIND", "Helper"]

FIND, COLLECT, LEAVE = range(3)


class Helper:
    """Takes one order at a time, `FIND` or `COLLECT`, from entering its context to leaving it.

    Attributes
    ----------
    finds, collects : forces that the first thread finds and collects meanwhile
    """

    def __init__(self, model: Model, state: State) -> None:
        handed = [cast(Handed, force) for force in model.forces if force.body == "barrier"]
        self.collects = [force for force in model.forces if force.body != "barrier"]
        self.finds = [*self.collects, *(zone for zone in model.zones if zone.body == "barrier")]
        shared = [*handed, *(zone for zone in model.zones if zone.body != "barrier")]
        self._dt = np.zeros(1)
        self._finding = tuple(force.finding(state, self._dt) for force in shared)
        self._collecting = tuple(force.collecting(state) for force in handed)
        self._order, self._report = make_signals(2)
        self._report[0] = -1  # until the thread is there
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

    def begin(self, order: int, dt: float) -> None:
        """Hand over an order; ``dt`` is the step that led to the present positions, s."""
        self._dt[0] = dt
        give(self._order, order)

    def finish(self) -> None:
        """Wait until the order is done; raise what the thread has raised."""
        while not wait_for_change(self._report, self._order[0] - 1):
            if self._error is not None:
                raise self._error

    def _serve(self) -> None:
        try:
            serve(self._order, self._report, self._finding, self._collecting)
        except BaseException as error:  # told to the thread that gave the order
            self._error = error


@kernel
def give(order, what):  # type: ignore[no-untyped-def]
    """Make the next order known: its number, and beside it what it is."""
    order[1] = what
    tell(order, order[0] + 1)


@kernel
def serve(order, report, finding, collecting):  # type: ignore[no-untyped-def]
    """Do orders and report their numbers until one says to leave."""
    done = 0
    while True:
        tell(report, done)
        while not wait_for_change(order, done):
            pass
        done = look(order)
        if order[1] == FIND:
            perform(finding)
        elif order[1] == COLLECT:
            perform(collecting)
        else:
            return
