"""Run a scene as accurately as it asks, and state what was expected and what was achieved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cost.judge import extrapolated, truths
from fem_impact.cost.quantities import QUANTITIES, TARGETED
from fem_impact.cost.settings import on_mesh
from fem_impact.cost.stored import Plan, plan
from fem_impact.outcome import KEYS, Outcome
from fem_impact.scale import LocalProcesses
from fem_impact.simulate import simulate
from fem_impact.solid.checkpoint import INTERVAL

if TYPE_CHECKING:
    from fem_impact.progress import Progress
    from fem_impact.scene import Scene

__all__ = ["simulate_to_target"]

Run = Callable[[int], Outcome]  # of so many threads

COARSER = "coarser"
ALONE = "one run alone cannot estimate its own error"


def simulate_to_target(
    scene: Scene,
    fidelity: str | None = None,
    out: Path | None = None,
    progress: Callable[[Progress], None] | None = None,
    resume: bool = False,
    checkpoint_s: float = INTERVAL,
    threads: int = 1,
) -> Outcome:
    """Run the setting that the measured costs choose.

    Two meshes give the finer one's outcome with the limits of both under ``extrapolated``; the coarser
    run is kept below ``out``, and has a process beside the finer where there are two threads or more.

    Raises
    ------
    SceneError
        As `plan`.
    """
    chosen = plan(scene, fidelity, threads)
    meshes = chosen.meshes
    if not meshes:
        alone = simulate(_plain(scene), chosen.setting.fidelity, out, progress, resume, checkpoint_s, threads)
        return _kept(_stated(alone, chosen), out)
    place = out and out / COARSER
    fine = partial(simulate, on_mesh(scene, meshes[0]), "solid", out, progress, resume, checkpoint_s)
    if len(meshes) == 1:
        return _kept(_stated(fine(threads), chosen), out)
    coarse = partial(simulate, on_mesh(scene, meshes[1]), "solid", place, None, resume, checkpoint_s)
    both = _side_by_side(fine, coarse, threads - 1) if threads > 1 else (fine(1), coarse(1))
    together = max if threads > 1 else sum
    return _kept(_stated(both[0], chosen, both[1], together(run["wall_s"] for run in both)), out)


def _side_by_side(fine: Run, coarse: Run, threads: int) -> tuple[Outcome, Outcome]:
    with LocalProcesses(1) as beside:
        later = beside.submit(coarse, 1)
        return fine(threads), later.result()


def _kept(outcome: Outcome, out: Path | None) -> Outcome:
    """Write the outcome again, now that it states its accuracy."""
    if out is not None:
        outcome.write(out / "outcome.json")
    return outcome


def _plain(scene: Scene) -> Scene:
    """Return the scene without its target; a reduced model meshes nothing."""
    return replace(scene, accuracy=replace(scene.accuracy, target=None))


def _stated(
    outcome: Outcome, chosen: Plan, coarse: Outcome | None = None, wall_s: float | None = None
) -> Outcome:
    """Return the outcome with what was asked, expected and achieved."""
    return outcome.replace(
        reasons={"achieved_error": ALONE, "extrapolated": ALONE},
        accuracy_target=chosen.target,
        accuracy_setting=chosen.setting.name,
        expected_error=chosen.expected_error,
        expected_wall_s=chosen.expected_wall_s,
        achieved_wall_s=wall_s or outcome["wall_s"],
        achieved_error=_left_open(outcome, coarse) if coarse else None,
        extrapolated=_limits(outcome, coarse) if coarse else None,
    )


def _left_open(fine: Outcome, coarse: Outcome) -> float:
    found = truths([fine, coarse])
    return max(found[name].uncertainty / found[name].scale for name in TARGETED)


def _limits(fine: Outcome, coarse: Outcome) -> dict[str, float]:
    """Return the limits of the quantities of interest, key by key."""
    ratio = coarse["tip_size_m"] / fine["tip_size_m"]
    kinds = {key.name: key.kind for key in KEYS}
    keys = [key for quantity in QUANTITIES for key in quantity.keys if kinds[key] == "number"]
    return {key: extrapolated(fine[key], coarse[key], ratio) for key in keys}
