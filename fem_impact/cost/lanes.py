"""Runs side by side in two processes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import zip_longest

from fem_impact.cost.times import in_lanes
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.options import RunOptions
from fem_impact.outcome.record import Outcome
from fem_impact.run import simulate as run
from fem_impact.scene.types import Scene


def side_by_side(
    scenes: Sequence[Scene], fidelity: str, options: Sequence[RunOptions], workers: int
) -> list[Outcome]:
    """Return the outcomes of scenes in their order.

    With two ``workers`` every second run is done in another process.
    """
    work = [partial(run.simulate, one, fidelity, own) for one, own in zip(scenes, options, strict=True)]
    lanes = in_lanes(work, workers)
    with LocalProcesses(1) as process:
        later = [process.submit(_in_turn, lane) for lane in lanes[1:]]
        done = [_in_turn(lanes[0]), *(lane.result() for lane in later)]
    return [run for turn in zip_longest(*done) for run in turn if run]


def below(options: RunOptions, number: int) -> RunOptions:
    """Return the options of a further run: files below those of the first, no progress."""
    out = options.out and options.out / f"run-{number}"
    return replace(options, out=out, progress=None)


def _in_turn(work: Sequence[Callable[[], Outcome]]) -> list[Outcome]:
    """Do runs one after the other; a function of the module, since it is sent to another process."""
    return [run() for run in work]
