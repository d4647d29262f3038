"""Runs side by side in two processes, within a wall time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import zip_longest
from time import perf_counter

from fem_impact.answers.refine.times import in_lanes, pace, planned_s
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


@dataclass(slots=True)
class Budget:
    """The wall time that runs may take, what they took, and what further ones will take.

    Attributes
    ----------
    limit_s : wall time of all runs together, s
    workers : runs at a time, 1 or 2
    spent_s : wall time of the runs so far, s
    pace : wall time of the last ones over the planned one, see `fem_impact.answers.refine.times.pace`
    """

    limit_s: float
    workers: int
    spent_s: float = 0.0
    pace: float = 1.0

    def forecast_s(self, *batches: Sequence[Scene]) -> float:
        """Return the wall time, s, that batches of runs will take one after the other."""
        return self.pace * sum(planned_s(scenes, self.workers) for scenes in batches)

    def affords(self, *batches: Sequence[Scene]) -> bool:
        """Say whether they fit into what is left of it."""
        return self.spent_s + self.forecast_s(*batches) <= self.limit_s

    def run(self, scenes: Sequence[Scene], options: Sequence[RunOptions]) -> list[Outcome]:
        """Return the outcomes of finite-element runs in their order."""
        begun = perf_counter()
        runs = side_by_side(scenes, "solid", options, self.workers)
        self.spent_s += perf_counter() - begun
        self.pace = pace(scenes, runs, self.workers)
        return runs


def below(options: RunOptions, number: int) -> RunOptions:
    """Return the options of a further run: files below those of the first, no progress."""
    out = options.out and options.out / f"run-{number}"
    return replace(options, out=out, progress=None)


def _in_turn(work: Sequence[Callable[[], Outcome]]) -> list[Outcome]:
    """Do runs one after the other; a function of the module, since it is sent to another process."""
    return [run() for run in work]
