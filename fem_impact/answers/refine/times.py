"""How long runs took, side by side or in turn, and how long further ones will take."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TypeVar

from fem_impact.case.case import Case
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.scene.types import Scene

Work = TypeVar("Work")

# Largest ratio of what a mesh took to its forecast by `pace` on the mesh before it, of 26 pairs of meshes of
# the 13 measured sets (.75 to 1.54, root mean square factor 1.21); a budget that is advised holds as much.
LONGER = 1.55


def in_lanes(work: Sequence[Work], workers: int) -> list[Sequence[Work]]:
    """Return which work each process does: every second piece another one's, where there are two."""
    return [work[0::2], work[1::2]] if workers > 1 and len(work) > 1 else [work]


def longest_s(times: Sequence[float], workers: int) -> float:
    """Return the time, s, of the process that is busy longest."""
    return max(map(sum, in_lanes(times, workers)))


def wall_seconds(run: Outcome) -> float:
    """Return the wall time of a run with that of its set-up, s."""
    return run.cost.wall + (or_none(run.cost.setup_wall) or 0.0)


def cpu_seconds(run: Outcome) -> float:
    """Return the processor time of a run with that of its set-up, s."""
    return run.cost.cpu + (or_none(run.cost.setup_cpu) or 0.0)


def planned_s(scenes: Iterable[Scene], workers: int) -> float:
    """Return the wall time, s, that runs side by side take by the plan, where none of them has run."""
    return longest_s([Case.of(one).size.time for one in scenes], workers)


def pace(scenes: Sequence[Scene], runs: Sequence[Outcome], workers: int) -> float:
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
    return longest_s([wall_seconds(run) for run in runs], workers) / planned_s(reached, workers)


def about_s(time: float) -> str:
    """Return a time as text in whole seconds, at least one, two digits of them: 4 s, 17 s, 170 s."""
    return f"{max(float(f'{time:.2g}'), 1.0):.0f} s"
