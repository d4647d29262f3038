"""Run a scene as accurately as it asks, and state what was expected and what was achieved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cost.judge import extrapolated
from fem_impact.cost.quantities import QUANTITIES, TARGETED
from fem_impact.cost.settings import on_mesh
from fem_impact.cost.stored import Plan, plan
from fem_impact.outcome import KEYS, Outcome
from fem_impact.simulate import simulate
from fem_impact.solid.checkpoint import INTERVAL

if TYPE_CHECKING:
    from fem_impact.progress import Progress
    from fem_impact.scene import Scene

__all__ = ["simulate_to_target"]

COARSER = "coarser"
ORDERS = (1.0, 2.0)  # between which two meshes leave the limit open
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
    run is kept below ``out``.

    Raises
    ------
    SceneError
        As `plan`.
    """
    chosen = plan(scene, fidelity)
    meshes = chosen.meshes
    if not meshes:
        alone = simulate(_plain(scene), chosen.setting.fidelity, out, progress, resume, checkpoint_s, threads)
        return _kept(_stated(alone, chosen), out)
    coarse = None
    if len(meshes) > 1:
        place = out and out / COARSER
        coarse = simulate(on_mesh(scene, meshes[1]), "solid", place, progress, resume, checkpoint_s, threads)
    fine = simulate(on_mesh(scene, meshes[0]), "solid", out, progress, resume, checkpoint_s, threads)
    return _kept(_stated(fine, chosen, coarse), out)


def _kept(outcome: Outcome, out: Path | None) -> Outcome:
    """Write the outcome again, now that it states its accuracy."""
    if out is not None:
        outcome.write(out / "outcome.json")
    return outcome


def _plain(scene: Scene) -> Scene:
    """Return the scene without its target; a reduced model meshes nothing."""
    return replace(scene, accuracy=replace(scene.accuracy, target=None))


def _stated(outcome: Outcome, chosen: Plan, coarse: Outcome | None = None) -> Outcome:
    """Return the outcome with what was asked, expected and achieved."""
    limits = _limits(outcome, coarse) if coarse else None
    return outcome.replace(
        reasons={"achieved_error": ALONE, "extrapolated": ALONE},
        accuracy_target=chosen.target,
        accuracy_setting=chosen.setting.name,
        expected_error=chosen.expected_error,
        expected_wall_s=chosen.expected_wall_s,
        achieved_wall_s=outcome["wall_s"] + (coarse["wall_s"] if coarse else 0.0),
        achieved_error=_achieved(outcome, coarse) if coarse else None,
        extrapolated=limits,
    )


def _limits(fine: Outcome, coarse: Outcome) -> dict[str, float]:
    """Return the limits of the quantities of interest, key by key."""
    ratio = coarse["tip_size_m"] / fine["tip_size_m"]
    kinds = {key.name: key.kind for key in KEYS}
    keys = [key for quantity in QUANTITIES for key in quantity.keys if kinds[key] == "number"]
    return {key: extrapolated(fine[key], coarse[key], ratio) for key in keys}


def _achieved(fine: Outcome, coarse: Outcome) -> float:
    """Return how far apart first and second order put the limit, over each quantity's scale."""
    ratio = coarse["tip_size_m"] / fine["tip_size_m"]
    worst = 0.0
    for quantity in (q for q in QUANTITIES if q.name in TARGETED):
        q_1, q_2 = quantity.value(fine), quantity.value(coarse)
        if q_1 is not None and q_2 is not None:
            low, high = (extrapolated(q_1, q_2, ratio, order) for order in ORDERS)
            worst = max(worst, abs(high - low) / quantity.scale(low, fine))
    return worst
