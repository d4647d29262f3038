"""Simulate to a stated error where no near scene was measured: meshes of the scene's own, within a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import perf_counter

from fem_impact.cost.lanes import below, side_by_side
from fem_impact.cost.limits import Placed, mesh_limits, mesh_means, truths
from fem_impact.cost.quantities import TARGETED
from fem_impact.cost.settings import family, placed
from fem_impact.errors import RunError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.plan.plan import plan
from fem_impact.scene.types import Scene

ALONE = Unknown("one mesh alone cannot estimate its own error")
NOT_MEASURED = Unknown("no scene near this one was measured")


@dataclass(frozen=True, slots=True)
class OwnLadder:
    """Meshes from coarse to fine until the target error is reached or the next would take too long.

    Attributes
    ----------
    target : relative error; budget_s : wall time, s
    reason : why no stored setting is taken
    """

    target: float
    budget_s: float
    reason: str

    @property
    def sentence(self) -> str:
        """Say what is done and why."""
        return (
            f"accuracy {100 * self.target:.3g} %: {self.reason} The scene is run on meshes of its own, from "
            f"coarse to fine, until their band is as narrow or {self.budget_s:.3g} s are used up."
        )

    def simulate(self, scene: Scene, options: RunOptions, workers: int) -> Outcome:
        """Return the outcome of the finest mesh at its first place, with the limits of all meshes.

        Raises
        ------
        RunError
            A run of the coarsest mesh did not finish.
        """
        meshes: list[Placed] = []
        begun, pace = perf_counter(), 0.0  # wall time of the last mesh over the processor time expected of it
        for mesh in family(scene):
            scenes, start = placed(scene, mesh), perf_counter()
            expected = sum(plan(one).size.time for one in scenes)
            if start - begun + pace * expected > self.budget_s:
                break
            count = sum(map(len, meshes))
            own = [below(options, count + at) for at in range(len(scenes))]
            runs, _ = side_by_side(scenes, "solid", own, workers)
            unfinished = [run.validity.stopped_because for run in runs if not run.validity.finished]
            if unfinished and not meshes:
                raise RunError(f"{scene.id}: {unfinished[0]}")
            if unfinished:
                break
            meshes.append(runs)
            pace = (perf_counter() - start) / expected
            if len(meshes) > 1 and achieved_error(meshes) <= self.target:
                break
        return self._stated(meshes, perf_counter() - begun, options)

    def _stated(self, meshes: list[Placed], wall_s: float, options: RunOptions) -> Outcome:
        """Return the outcome with what was reached in its validity; its files come up from below."""
        finest, pair = meshes[-1][0], len(meshes) > 1
        limits, bands = mesh_limits(meshes[-1], meshes[0]) if pair else (mesh_means(meshes[0]), ALONE)
        stated = replace(
            finest.validity,
            accuracy_target=self.target,
            accuracy_setting=f"{len(meshes)} meshes of its own, the finest {_edge(finest)}",
            expected_error=NOT_MEASURED,
            expected_wall=self.budget_s,
            achieved_wall=wall_s,
            achieved_error=achieved_error(meshes) if pair else ALONE,
            mesh_limit=limits,
            mesh_band=bands,
        )
        outcome = replace(finest, validity=stated)
        if options.out is not None:
            kept = below(options, sum(len(runs) for runs in meshes[:-1])).out
            for file in kept.glob("*") if kept else ():
                file.replace(options.out / file.name)
            outcome.write(options.out / "outcome.json")
        return outcome


def achieved_error(meshes: Sequence[Placed]) -> float:
    """Return the largest relative uncertainty of the quantities that a target is about."""
    truth = truths(meshes)
    return max(truth[name].uncertainty / truth[name].scale for name in TARGETED)


def _edge(outcome: Outcome) -> str:
    size = outcome.cost.tip_size
    return "" if isinstance(size, Unknown) else f"{size * 1e3:.3g} mm"
