"""Work of several runs on one process or two, and the time that it takes."""

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from itertools import zip_longest
from typing import TypeVar

from fem_impact.jobs.executors import LocalProcesses

Work = TypeVar("Work")
Result = TypeVar("Result")

# Largest ratio of what a mesh took to its forecast from the mesh before it, of 26 pairs of meshes of the 13
# measured sets (.75 to 1.54, root mean square factor 1.21); a budget that is advised holds as much.
LONGER = 1.55


def in_turns(work: Sequence[Callable[[], Result]], workers: int) -> list[Result]:
    """Return the results of pieces of work in their order; of two workers the second is another process."""
    shares = by_worker(work, workers)
    with LocalProcesses(1) if len(shares) > 1 else nullcontext() as process:
        later = [process.submit(_done, share) for share in shares[1:]] if process else []
        done = [_done(shares[0]), *(share.result() for share in later)]
    return [result for turn in zip_longest(*done) for result in turn if result is not None]


def _done(work: Sequence[Callable[[], Result]]) -> list[Result]:
    """Do work piece after piece; a function of the module, since it is sent to another process."""
    return [piece() for piece in work]


def by_worker(work: Sequence[Work], workers: int) -> list[Sequence[Work]]:
    """Return which work each process does: every second piece another one's, where there are two."""
    return [work[0::2], work[1::2]] if workers > 1 and len(work) > 1 else [work]


def turns(runs: int, workers: int) -> int:
    """Return how many of so many runs the busiest process does."""
    return max(map(len, by_worker(range(runs), workers)))


def longest_s(times: Sequence[float], workers: int) -> float:
    """Return the time, s, of the process that is busy longest."""
    return max(map(sum, by_worker(times, workers)))


def about_s(time: float) -> str:
    """Return a time as text in whole seconds, at least one, two digits of them: 4 s, 17 s, 170 s."""
    return f"{max(float(f'{time:.2g}'), 1.0):.0f} s"
