"""An existing dask.distributed cluster as an executor."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from fem_impact.errors import MissingLibraryError, UsageError

__all__ = ["on_scheduler"]

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
