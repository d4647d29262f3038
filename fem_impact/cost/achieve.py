"""Run a scene as accurately as it asks, and state what was expected and what was achieved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING

from fem_impact.cost.limits import Placed, extrapolated, truths
from fem_impact.cost.quantities import QUANTITIES, TARGETED
from fem_impact.cost.settings import Mesh, placed
from fem_impact.cost.stored import Plan, plan
from fem_impact.outcome import KEYS, Outcome
from fem_impact.scale import LocalProcesses
from fem_impact.simulate import simulate
from fem_impact.solid.checkpoint import INTERVAL

if TYPE_CHECKING:
    from fem_impact.progress import Progress
    from fem_impact.scene import Scene

__all__ = ["simulate_to_target"]

Run = Callable[[], Outcome]
Report = Callable[["Progress"], None]

ALONE = "one mesh alone cannot estimate its own error"


def simulate_to_target(
    scene: Scene,
    fidelity: str | None = None,
    out: Path | None = None,
    progress: Report | None = None,
    resume: bool = False,
    checkpoint_s: float = INTERVAL,
    threads: int = 1,
) -> Outcome:
    """Run the setting that the measured costs choose.

    Every mesh is run at the places of the barrier's grid. What comes back is the finer mesh's outcome at the
    first, with the limits of two meshes, or the means of one, under ``extrapolated``. The other runs are
    kept below ``out``; those at the second place have a process beside where there are two threads or more.

    Raises
    ------
    SceneError
        As `plan`.
    """
    chosen = plan(scene, fidelity, threads)
    if not chosen.meshes:
        alone = simulate(_plain(scene), chosen.setting.fidelity, out, progress, resume, checkpoint_s, threads)
        return _kept(_stated(alone, chosen, alone["wall_s"]), out)
    work = _work(scene, chosen.meshes, out, progress, resume, checkpoint_s)
    places = _side_by_side(work) if threads > 1 else [_in_turn(runs) for runs in work]
    walls = [sum(run["wall_s"] for run in runs) for runs in places]
    meshes = list(zip(*places, strict=True))
    return _kept(_stated(places[0][0], chosen, max(walls) if threads > 1 else sum(walls), meshes), out)


def _work(
    scene: Scene, meshes: list[Mesh], out: Path | None, progress: Report | None, resume: bool, every: float
) -> list[list[Run]]:
    """Return the runs at each place, the finest mesh first; the first of all writes to ``out`` itself."""
    found: list[list[Run]] = []
    for place, scenes in enumerate(zip(*(placed(scene, mesh) for mesh in meshes), strict=True)):
        found.append([])
        for at, one in enumerate(scenes):
            first = at == place == 0
            folder = out and (out if first else out / f"mesh-{at}-{place}")
            told = progress if first else None
            found[-1].append(partial(simulate, one, "solid", folder, told, resume, every))
    return found


def _in_turn(work: list[Run]) -> list[Outcome]:
    return [run() for run in work]


def _side_by_side(work: list[list[Run]]) -> list[list[Outcome]]:
    with LocalProcesses(1) as beside:
        later = [beside.submit(_in_turn, runs) for runs in work[1:]]
        return [_in_turn(work[0]), *(runs.result() for runs in later)]


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
    return outcome.replace(
        reasons={"achieved_error": ALONE, "extrapolated": ALONE},
        accuracy_target=chosen.target,
        accuracy_setting=chosen.setting.name,
        expected_error=chosen.expected_error,
        expected_wall_s=chosen.expected_wall_s,
        achieved_wall_s=wall_s,
        achieved_error=_left_open(meshes) if len(meshes) == 2 else None,
        extrapolated=_limits(meshes) if meshes else None,
    )


def _left_open(meshes: Sequence[Placed]) -> float:
    found = truths(meshes)
    return max(found[name].uncertainty / found[name].scale for name in TARGETED)


def _limits(meshes: Sequence[Placed]) -> dict[str, float]:
    """Return the limits, or the means on one mesh, of the quantities of interest, key by key."""
    kinds = {key.name: key.kind for key in KEYS}
    keys = [key for quantity in QUANTITIES for key in quantity.keys if kinds[key] == "number"]
    means = [{key: fmean(run[key] for run in runs) for key in keys} for runs in meshes]
    if len(means) == 1:
        return means[0]
    fine, coarse = means
    ratio = meshes[1][0]["tip_size_m"] / meshes[0][0]["tip_size_m"]
    return {key: extrapolated(fine[key], coarse[key], ratio) for key in keys}
