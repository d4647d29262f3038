"""Runs side by side in two processes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import zip_longest
from typing import TypeVar

from fem_impact.cost.judge import wall_seconds
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.options import RunOptions
from fem_impact.outcome.record import Outcome
from fem_impact.run import simulate as run
from fem_impact.scene.types import Scene

Work = TypeVar("Work")


def side_by_side(
    scenes: Sequence[Scene], fidelity: str, options: Sequence[RunOptions], workers: int
) -> tuple[list[Outcome], float]:
    """Return the outcomes of scenes in their order, and the wall time of all runs, s.

    With two ``workers`` every second run is done in another process.
    """
    work = [partial(run.simulate, one, fidelity, own) for one, own in zip(scenes, options, strict=True)]
    lanes = in_lanes(work, workers)
    with LocalProcesses(1) as process:
        later = [process.submit(_in_turn, lane) for lane in lanes[1:]]
        done = [_in_turn(lanes[0]), *(lane.result() for lane in later)]
    wall_s = max(sum(wall_seconds(run) for run in lane) for lane in done)
    return [run for turn in zip_longest(*done) for run in turn if run], wall_s


def in_lanes(work: Sequence[Work], workers: int) -> list[Sequence[Work]]:
    """Return which work each process does: every second piece another one's, where there are two."""
    return [work[0::2], work[1::2]] if workers > 1 and len(work) > 1 else [work]


def below(options: RunOptions, number: int) -> RunOptions:
    """Return the options of a further run: files below those of the first, no progress."""
    out = options.out and options.out / f"run-{number}"
    return replace(options, out=out, progress=None)


def _in_turn(work: Sequence[Callable[[], Outcome]]) -> list[Outcome]:
    """Do runs one after the other; a function of the module, since it is sent to another process."""
    return [run() for run in work]
