"""Simulate to a stated error where no near scene was measured: meshes of the scene's own, within a time."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from time import perf_counter

from fem_impact.cost.lanes import below, in_lanes, side_by_side
from fem_impact.cost.limits import Placed, mesh_limits, truths
from fem_impact.cost.quantities import TARGETED
from fem_impact.cost.settings import placed, rungs
from fem_impact.errors import RunError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.plan.plan import plan
from fem_impact.scene.types import Scene

ALONE = Unknown("one mesh alone cannot estimate its own error")
NOT_MEASURED = Unknown("no scene near this one was measured")
OVER = "The runs for the wanted error took {:.3g} s, more than the budget of {:.3g} s."


@dataclass(frozen=True, slots=True)
class OwnLadder:
    """Meshes from coarse to fine until the target error is reached or the next would take too long.

    Each runs at its places of the barrier's grid, or at one where two meshes at all places do not fit the
    budget. Where two meshes do not fit at all, the coarsest runs once: that tells no error.

    Attributes
    ----------
    target : relative error; budget_s : wall time, s
    reason : why no stored setting is taken
    meshes : scenes of each mesh, from coarse to fine, at its places
    least_s, pair_s : expected wall times, s, of what runs in any case, and of two meshes at one place each
    """

    target: float
    budget_s: float
    reason: str
    meshes: tuple[tuple[Scene, ...], ...]
    least_s: float
    pair_s: float

    @classmethod
    def of(cls, scene: Scene, budget_s: float, workers: int, reason: str) -> OwnLadder:
        """Return the ladder whose first two meshes fit the budget, or one run on the coarsest mesh."""
        whole = [tuple(placed(scene, mesh)) for mesh in rungs(scene)]
        single = [scenes[:1] for scenes in whole]
        of_pair = [expected_s(chain.from_iterable(each[:2]), workers) for each in (whole, single)]
        fitting = [each for each, time in zip((whole, single), of_pair, strict=True) if time <= budget_s]
        meshes = fitting[0] if fitting else single[:1]
        least_s = expected_s(chain.from_iterable(meshes[:2]), workers)
        return cls(scene.accuracy.target or 0.0, budget_s, reason, tuple(meshes), least_s, of_pair[1])

    @property
    def sentence(self) -> str:
        """Say what is done and why, and about what it takes."""
        begin = f"accuracy {100 * self.target:.3g} %: {self.reason}"
        if self.pair_s <= self.budget_s:
            return (
                f"{begin} The scene is run on meshes of its own, from coarse to fine, until their band is as "
                f"narrow or {self.budget_s:.3g} s are used up: about {_whole(self.least_s)} or more."
            )
        over = self.least_s > self.budget_s
        return (
            f"{begin} Two meshes of its own would take about {_whole(self.pair_s)}, more than the budget of "
            f"{self.budget_s:.3g} s: the coarsest runs once, about {_whole(self.least_s)}"
            f"{', which exceeds the budget' if over else ''}, and the error stays unknown. For an error give "
            f'--budget "{_whole(2 * self.pair_s)}".'
        )

    def simulate(self, options: RunOptions, workers: int) -> Outcome:
        """Return the outcome of the finest mesh at its first place, with the limits of the finest two.

        Raises
        ------
        RunError
            A run of the coarsest mesh did not finish.
        """
        meshes: list[Placed] = []
        begun, pace = perf_counter(), 0.0  # wall time of the last mesh over that expected of it
        for scenes in self.meshes:
            start, expected = perf_counter(), expected_s(scenes, workers)
            if meshes and start - begun + pace * expected > self.budget_s:
                break
            count = sum(map(len, meshes))
            own = [below(options, count + at) for at in range(len(scenes))]
            runs, _ = side_by_side(scenes, "solid", own, workers)
            unfinished = [run.validity.stopped_because for run in runs if not run.validity.finished]
            if unfinished and not meshes:
                raise RunError(f"{scenes[0].id}: {unfinished[0]}")
            if unfinished:
                break
            meshes.append(runs)
            pace = (perf_counter() - start) / expected
            if len(meshes) > 1 and achieved_error(meshes[-2:]) <= self.target:
                break
        return self._stated(meshes, perf_counter() - begun, options)

    def _stated(self, meshes: list[Placed], wall_s: float, options: RunOptions) -> Outcome:
        """Return the outcome with what was reached in its validity; its files come up from below."""
        finest, pair = meshes[-1][0], len(meshes) > 1
        limits, bands = mesh_limits(meshes[-2:]) if pair else (ALONE, ALONE)
        warnings = [OVER.format(wall_s, self.budget_s)] if wall_s > self.budget_s else []
        stated = replace(
            finest.validity,
            accuracy_target=self.target,
            warnings=(*finest.validity.warnings, *warnings),
            accuracy_setting=f"{len(meshes)} mesh{'es' * pair} of its own, the finest {_edge(finest)}",
            expected_error=NOT_MEASURED,
            expected_wall=max(self.budget_s, self.least_s),
            achieved_wall=wall_s,
            achieved_error=achieved_error(meshes[-2:]) if pair else ALONE,
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


def expected_s(scenes: Iterable[Scene], workers: int) -> float:
    """Return the wall time, s, that runs side by side are expected to take."""
    times = [plan(one).size.time for one in scenes]
    return max(map(sum, in_lanes(times, workers)))


def _whole(time: float) -> str:
    return f"{max(float(f'{time:.2g}'), 1.0):.0f} s"


def _edge(outcome: Outcome) -> str:
    size = outcome.cost.tip_size
    return "" if isinstance(size, Unknown) else f"{size * 1e3:.3g} mm"
