"""Run a scene as accurately as it asks, and state what was expected and what was achieved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice, zip_longest
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cost.judge import wall_seconds
from fem_impact.cost.limits import Placed, mesh_limits, mesh_means, truths
from fem_impact.cost.quantities import TARGETED
from fem_impact.cost.settings import placed
from fem_impact.cost.stored import Plan, plan
from fem_impact.outcome import Outcome, Unknown
from fem_impact.scale import LocalProcesses
from fem_impact.simulate import simulate
from fem_impact.solid.checkpoint import INTERVAL

if TYPE_CHECKING:
    from fem_impact.progress import Progress
    from fem_impact.scene import Scene

__all__ = ["simulate_to_target"]

Run = Callable[[], Outcome]
Report = Callable[["Progress"], None]

ALONE = Unknown("one mesh alone cannot estimate its own error")


def simulate_to_target(
    scene: Scene,
    fidelity: str | None = None,
    out: Path | None = None,
    progress: Report | None = None,
    resume: bool = False,
    checkpoint_s: float = INTERVAL,
    workers: int = 1,
) -> Outcome:
    """Run the setting that the measured costs choose.

    Every mesh is run at its places of the barrier's grid. What comes back is the finer mesh's outcome at the
    first, with the limits of two meshes, or the means of one, in its ``validity``. The other runs are
    kept below ``out``; with two ``workers`` or more a process beside takes every other run.

    Raises
    ------
    SceneError
        As `plan`.
    """
    chosen = plan(scene, fidelity, workers)
    if not chosen.meshes:
        alone = simulate(_plain(scene), chosen.setting.fidelity, out, progress, resume, checkpoint_s)
        return _kept(_stated(alone, chosen, wall_seconds(alone)), out)
    jobs = [placed(scene, mesh) for mesh in chosen.meshes]
    work = _work([one for scenes in jobs for one in scenes], out, progress, resume, checkpoint_s)
    lanes = [work[0::2], work[1::2]] if workers > 1 else [work]
    done = _side_by_side(lanes)
    runs = iter([run for turn in zip_longest(*done) for run in turn if run])
    meshes = [list(islice(runs, len(scenes))) for scenes in jobs]
    wall_s = max(sum(wall_seconds(run) for run in lane) for lane in done)
    return _kept(_stated(meshes[0][0], chosen, wall_s, meshes), out)


def _work(
    scenes: list[Scene], out: Path | None, progress: Report | None, resume: bool, checkpoint_s: float
) -> list[Run]:
    """Return the runs; the first of all writes to ``out`` itself."""
    folders = [out and (out / f"run-{at}" if at else out) for at in range(len(scenes))]
    return [
        partial(simulate, scene, "solid", folder, None if at else progress, resume, checkpoint_s)
        for at, (scene, folder) in enumerate(zip(scenes, folders, strict=True))
    ]


def _in_turn(work: list[Run]) -> list[Outcome]:
    return [run() for run in work]


def _side_by_side(lanes: list[list[Run]]) -> list[list[Outcome]]:
    """Do the first lane here and the others in a process beside."""
    with LocalProcesses(1) as beside:
        later = [beside.submit(_in_turn, runs) for runs in lanes[1:]]
        return [_in_turn(lanes[0]), *(runs.result() for runs in later)]


def _kept(outcome: Outcome, out: Path | None) -> Outcome:
    """Write the outcome again, now that it states its accuracy."""
    if out is not None:
        outcome.write(out / "outcome.json")
    return outcome


def _plain(scene: Scene) -> Scene:
    """Return the scene without its target; a reduced model meshes nothing."""
    return replace(scene, accuracy=replace(scene.accuracy, target=None))


def _stated(outcome: Outcome, chosen: Plan, wall_s: float, meshes: Sequence[Placed] = ()) -> Outcome:
    """Return the outcome with what was asked, expected and achieved."""
    limits, bands = mesh_limits(*meshes) if len(meshes) == 2 else (None, None)
    means = mesh_means(meshes[0]) if meshes else ALONE
    stated = replace(
        outcome.validity,
        accuracy_target=chosen.target,
        accuracy_setting=chosen.setting.name,
        expected_error=chosen.expected_error,
        expected_wall=chosen.expected_wall_s,
        achieved_wall=wall_s,
        achieved_error=_left_open(meshes) if len(meshes) == 2 else ALONE,
        mesh_limit=limits or means,
        mesh_band=bands or ALONE,
    )
    return replace(outcome, validity=stated)


def _left_open(meshes: Sequence[Placed]) -> float:
    found = truths(meshes)
    return max(found[name].uncertainty / found[name].scale for name in TARGETED)
