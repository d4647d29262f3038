"""The one forecast of time: how long runs took, further ones will take, and whether a budget affords them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import zip_longest
from time import perf_counter
from typing import TypeVar

from fem_impact.case.case import Case
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.run import simulate as run
from fem_impact.scene.types import Scene

Work = TypeVar("Work")

# Largest ratio of what a mesh took to its forecast by the calibration factor of the mesh before it, of 26
# pairs of meshes of the 13 measured sets (.75 to 1.54, root mean square factor 1.21); a budget that is
# advised holds as much.
LONGER = 1.55


@dataclass(slots=True)
class Budget:
    """The wall time that runs may take, what they took, and what further ones will take.

    Attributes
    ----------
    limit_s : wall time of all runs together, s
    workers : runs at a time, 1 or 2
    spent_s : wall time of the runs so far, s
    factor : `calibration_factor` of the last ones
    """

    limit_s: float
    workers: int
    spent_s: float = 0.0
    factor: float = 1.0

    def forecast_s(self, *batches: Sequence[Scene]) -> float:
        """Return the wall time, s, that batches of runs will take one after the other."""
        return self.factor * sum(planned_s(scenes, self.workers) for scenes in batches)

    def affords(self, *batches: Sequence[Scene]) -> bool:
        """Say whether they fit into what is left of it."""
        return self.spent_s + self.forecast_s(*batches) <= self.limit_s

    def run(self, scenes: Sequence[Scene], options: Sequence[RunOptions]) -> list[Outcome]:
        """Return the outcomes of finite-element runs in their order."""
        begun = perf_counter()
        runs = side_by_side(scenes, "solid", options, self.workers)
        self.spent_s += perf_counter() - begun
        self.factor = calibration_factor(scenes, runs, self.workers)
        return runs


def side_by_side(
    scenes: Sequence[Scene], fidelity: str, options: Sequence[RunOptions], workers: int
) -> list[Outcome]:
    """Return the outcomes of scenes in their order.

    With two ``workers`` every second run is done in another process.
    """
    pairs = zip(scenes, options, strict=True)
    work = [partial(run.simulate, scene, fidelity, of_scene) for scene, of_scene in pairs]
    shares = by_worker(work, workers)
    with LocalProcesses(1) as process:
        later = [process.submit(_in_turn, share) for share in shares[1:]]
        done = [_in_turn(shares[0]), *(share.result() for share in later)]
    return [run for turn in zip_longest(*done) for run in turn if run]


def _in_turn(work: Sequence[Callable[[], Outcome]]) -> list[Outcome]:
    """Do runs one after the other; a function of the module, since it is sent to another process."""
    return [run() for run in work]


def below(options: RunOptions, number: int) -> RunOptions:
    """Return the options of a further run: files below those of the first, no progress."""
    out = options.out and options.out / f"run-{number}"
    return replace(options, out=out, progress=None)


def by_worker(work: Sequence[Work], workers: int) -> list[Sequence[Work]]:
    """Return which work each process does: every second piece another one's, where there are two."""
    return [work[0::2], work[1::2]] if workers > 1 and len(work) > 1 else [work]


def longest_s(times: Sequence[float], workers: int) -> float:
    """Return the time, s, of the process that is busy longest."""
    return max(map(sum, by_worker(times, workers)))


def planned_s(scenes: Iterable[Scene], workers: int) -> float:
    """Return the wall time, s, that runs side by side take by the plan, where none of them has run."""
    return longest_s([Case.of(scene).size.time for scene in scenes], workers)


def calibration_factor(scenes: Sequence[Scene], runs: Sequence[Outcome], workers: int) -> float:
    """Return the wall time of runs over the planned one: times `planned_s` it forecasts a finer mesh.

    It holds what the plan cannot know: when the rod leaves, and how quick this machine is. The planned time
    is that with the mass scaling that was reached: a coarse rod may not make up for all that is asked for, a
    finer one does.
    """
    reached = [
        replace(scene, accuracy=replace(scene.accuracy, mass_scaling=scaling))
        if (scaling := or_none(run.cost.mass_scaling))
        else scene
        for scene, run in zip(scenes, runs, strict=True)
    ]
    return longest_s([run.cost.whole_wall for run in runs], workers) / planned_s(reached, workers)


def about_s(time: float) -> str:
    """Return a time as text in whole seconds, at least one, two digits of them: 4 s, 17 s, 170 s."""
    return f"{max(float(f'{time:.2g}'), 1.0):.0f} s"
