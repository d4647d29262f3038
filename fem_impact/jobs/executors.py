"""Where jobs run: processes on this machine, or the workers of a dask scheduler."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import connection, get_context, parent_process
from multiprocessing.connection import Connection
from traceback import format_exception
from types import ModuleType
from typing import Any, ParamSpec, TypeVar

from fem_impact.errors import FemImpactError, MissingLibraryError, UsageError

P = ParamSpec("P")
T = TypeVar("T")

TRIES = 2  # a process may be killed for memory that others use; a job whose process dies twice fails
GRACE = 3.0  # s from SIGTERM to SIGKILL, in which a process removes its drafts
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
SCHEDULER_PATIENCE = 20  # s to wait for the scheduler and its first worker


def cores() -> int:
    """Return how many processor cores this process may use; one that another process started has one."""
    if parent_process() is not None:
        return 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class LocalProcesses(Executor):
    """An executor of processes, each fed by a thread of this process.

    A process that dies costs its own job only (a pool of the standard library breaks as a whole): a new
    process tries the job once more, and then the job fails. The processes end when this one does, however
    it ends.

    Parameters
    ----------
    workers : int
        Number of processes; as many as there are cores when None.
    reuse : bool
        Whether a process computes one job after another; if not, each job has a new process.
    """

    def __init__(self, workers: int | None = None, *, reuse: bool = True) -> None:
        self._threads = ThreadPoolExecutor(workers or cores(), thread_name_prefix="study")
        self._own, self._workers, self._closed, self._reuse = threading.local(), set[_Worker](), False, reuse

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
        for worker in tuple(self._workers):
            worker.ask_to_end()  # all of them before the first is waited for
        for worker in tuple(self._workers):
            worker.end()

    def _call(self, fn: Callable[..., T], args: Any, kwargs: Any) -> T:
        for _ in range(TRIES):
            if self._closed:
                break
            try:
                if getattr(self._own, "worker", None) is None:
                    self._own.worker = _Worker()
                    self._workers.add(self._own.worker)
                worker: _Worker = self._own.worker
                return worker.call(fn, args, kwargs)
            except _DiedError:
                self._drop()
            finally:
                if not self._reuse:
                    self._drop()
        raise BrokenExecutor("the process that computed it was killed")

    def _drop(self) -> None:
        """End the process of this thread, if it has one."""
        worker, self._own.worker = getattr(self._own, "worker", None), None
        if worker is not None:
            worker.end()
            self._workers.discard(worker)


class _DiedError(Exception):
    """The process at the other end of a pipe has ended."""


class _Worker:
    """One process and the pipe to it."""

    def __init__(self) -> None:
        self._ending = threading.Lock()
        context = get_context("spawn")
        self._pipe, far = context.Pipe()
        self._process = context.Process(target=_serve, args=(far,), daemon=True)
        with _STARTING, _no_script():
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

    def ask_to_end(self) -> None:
        """Send SIGTERM, upon which the process leaves its job and removes its drafts."""
        self._process.terminate()

    def end(self) -> None:
        with self._ending:  # the main thread may end it while its own thread sees it die: a pipe closes once
            self._process.terminate()
            self._process.join(GRACE)
            self._process.kill()
            self._process.join()
            self._pipe.close()


_STARTING = threading.Lock()


@contextmanager
def _no_script() -> Iterator[None]:
    """Hide the script that runs: a process started now does not execute it, as no job is stated there."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


def _leave(*_: object) -> None:
    """End the process by way of its blocks of `finally`, which remove the drafts of files; only once."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise SystemExit(1)


def _serve(pipe: Connection) -> None:
    """Answer calls until the other end is gone or SIGTERM comes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process of the study decides what an interrupt stops
    signal.signal(signal.SIGTERM, _leave)
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))  # before the first call imports numpy
    threading.Thread(target=_end_with_parent, daemon=True).start()
    while True:
        try:
            fn, args, kwargs = pipe.recv()
        except EOFError:
            return
        answer: tuple[object, Exception | None]
        try:
            answer = fn(*args, **kwargs), None
        except Exception as error:  # it is raised in the process of the study
            if not isinstance(error, FemImpactError):  # a fault of the program: its place is known only here
                error.add_note("".join(format_exception(error)))
            answer = None, error
        pipe.send(answer)


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


@contextmanager
def on_scheduler(address: str) -> Iterator[Executor]:
    """Yield an executor on the workers of a dask scheduler, which repeats a job whose worker dies.

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
        problem = "a scheduler needs dask.distributed: pip install 'fem-impact[cluster]'."
        raise MissingLibraryError(problem) from None
    try:
        client = Client(address, timeout=SCHEDULER_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise _refused(address, f"no scheduler answers ({error}).") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=SCHEDULER_PATIENCE)
        except TimeoutError:
            raise _refused(address, "the scheduler has no worker.") from None
        yield client.get_executor(pure=False)


def _refused(address: str, problem: str) -> UsageError:
    remedy = "Start `dask scheduler` and `dask worker ADDRESS --nthreads 1`."
    return UsageError(problem, key="scheduler=", value=address, remedy=remedy)
