"""A second thread that waits for work; handing it over costs a few microseconds, a pool's some ten."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from functools import partial
from queue import SimpleQueue
from threading import Thread
from types import TracebackType

from fem_impact.solid.items import Part
from fem_impact.solid.state import State

__all__ = ["Helper", "share"]


class Helper:
    """Takes one order at a time, from entering its context to leaving it."""

    def __init__(self) -> None:
        self._orders: SimpleQueue[partial[None] | None] = SimpleQueue()
        self._reports: SimpleQueue[BaseException | None] = SimpleQueue()
        self._thread = Thread(target=self._serve, daemon=True)

    def __enter__(self) -> Helper:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._orders.put(None)
        self._thread.join()

    def begin(self, order: partial[None]) -> None:
        """Hand over an order."""
        self._orders.put(order)

    def finish(self) -> None:
        """Wait until the order is done; raise what it has raised."""
        error = self._reports.get()
        if error is not None:
            raise error

    def _serve(self) -> None:
        while (order := self._orders.get()) is not None:
            try:
                order()
            except BaseException as error:  # reported to the thread that gave the order
                self._reports.put(error)
            else:
                self._reports.put(None)


def share(parts: Sequence[Part], state: State, helper: Helper | None) -> None:
    """Do all parts, from the first on; a helper does them from the last on until they meet.

    So each thread does nearly the same parts in every step, and their data stay in its caches.
    """
    waiting = deque(parts)
    if helper is not None:
        helper.begin(partial(_work, waiting.pop, state))
    _work(waiting.popleft, state)
    if helper is not None:
        helper.finish()


def _work(take: Callable[[], Part], state: State) -> None:
    while True:
        try:
            part = take()
        except IndexError:  # none is left; to ask before would not be safe, for the other thread takes too
            return
        part(state)
