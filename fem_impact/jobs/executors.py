"""How many processor cores there are to use."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import connection, get_context, parent_process
from multiprocessing.connection import Connection
from typing import Any, ParamSpec, TypeVar

from fem_impact.errors import MissingLibraryError, UsageError

__all__ = ["LocalProcesses", "cores", "on_scheduler"]


def cores() -> int:
    """Return how many processor cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


P = ParamSpec("P")
T = TypeVar("T")
TRIES = 2  # a process may be killed for memory that others took; a job that kills two is at fault
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


class LocalProcesses(Executor):
    """An executor of processes, each fed by a thread here.

    Unlike a pool that breaks as a whole, a process that dies costs its own job only: a new process
    tries it once more, and then the job fails. The processes end when this one does, however it ends.

    Parameters
    ----------
    workers : int
        Processes; as many as there are cores when None.
    """

    def __init__(self, workers: int | None = None) -> None:
        workers = workers or cores()
        self._threads = ThreadPoolExecutor(workers, thread_name_prefix="study")
        self._own, self._lanes, self._closed = threading.local(), set[_Lane](), False

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Run ``fn`` in the next free process."""
        return self._threads.submit(self._call, fn, args, kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Finish what was submitted, or with ``cancel_futures`` stop at once, running jobs too."""
        self._closed = cancel_futures
        if cancel_futures:
            self._end()
        self._threads.shutdown(wait, cancel_futures=cancel_futures)
        if wait:
            self._end()

    def __exit__(self, kind: object, *_: object) -> None:
        """Stop at once after an interrupt or a fault."""
        self.shutdown(cancel_futures=kind is not None)

    def _end(self) -> None:
        for lane in tuple(self._lanes):
            lane.end()

    def _call(self, fn: Callable[..., T], args: Any, kwargs: Any) -> T:
        for _ in range(TRIES):
            if self._closed:
                break
            try:
                return self._lane().call(fn, args, kwargs)
            except _DiedError:
                self._drop()
        raise BrokenExecutor("the process that computed it was killed")

    def _lane(self) -> _Lane:
        if getattr(self._own, "lane", None) is None:
            self._own.lane = _Lane()
            self._lanes.add(self._own.lane)
        lane: _Lane = self._own.lane
        return lane

    def _drop(self) -> None:
        self._own.lane.end()
        self._lanes.discard(self._own.lane)
        self._own.lane = None


class _DiedError(Exception):
    """The process at the other end of a pipe is gone."""


class _Lane:
    """One process and the pipe to it."""

    def __init__(self) -> None:
        self._ending = threading.Lock()
        context = get_context("spawn")
        self._pipe, far = context.Pipe()
        self._process = context.Process(target=_serve, args=(far,), daemon=True)
        self._process.start()
        far.close()

    def call(self, fn: Callable[..., T], args: Any, kwargs: Any) -> T:
        try:
            self._pipe.send((fn, args, kwargs))
            value, error = self._pipe.recv()
        except (EOFError, OSError) as end:
            raise _DiedError from end
        if error is not None:
            raise error
        result: T = value
        return result

    def end(self) -> None:
        with self._ending:  # an interrupt ends it here while its own thread sees it die: a pipe closes once
            self._process.kill()
            self._process.join()
            self._pipe.close()


def _serve(pipe: Connection) -> None:
    """Answer calls until the other end is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the study's own process decides what an interrupt stops
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))  # before the first call imports numpy
    threading.Thread(target=_end_with_parent, daemon=True).start()
    while True:
        try:
            fn, args, kwargs = pipe.recv()
        except EOFError:
            return
        pipe.send(_answer(fn, args, kwargs))


def _answer(fn: Callable[..., object], args: Any, kwargs: Any) -> tuple[object, Exception | None]:
    try:
        return fn(*args, **kwargs), None
    except Exception as error:  # it is raised in the study's own process
        return None, error


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


PATIENCE = 20  # s for scheduler and first worker


@contextmanager
def on_scheduler(address: str) -> Iterator[Executor]:
    """Lend the workers of a scheduler; a job whose worker dies is given to another one by the scheduler.

    Workers need this package in the same version and one thread each (``dask worker --nthreads 1``).

    Raises
    ------
    MissingLibraryError
        dask.distributed is not installed.
    UsageError
        No scheduler answers there, or it has no worker.
    """
    try:
        from distributed import Client
    except ImportError:
        words = "--scheduler needs dask.distributed: pip install 'fem-impact[cluster]'."
        raise MissingLibraryError(words) from None
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise _refused(address, f"no scheduler answers ({error}).") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise _refused(address, "the scheduler has no worker.") from None
        yield client.get_executor(pure=False)


def _refused(address: str, problem: str) -> UsageError:
    remedy = "Start `dask scheduler` and `dask worker ADDRESS --nthreads 1`."
    return UsageError(problem, key="--scheduler", value=address, remedy=remedy)
