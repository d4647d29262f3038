"""Simulate to a stated error where no near scene was measured: meshes of the scene's own, within a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import inf
from time import perf_counter

from fem_impact.cost.lanes import below, side_by_side
from fem_impact.cost.limits import ONE_RUN, Placed, mesh_limits, truths
from fem_impact.cost.quantities import TARGETED
from fem_impact.cost.settings import placed, rungs
from fem_impact.cost.times import LONGER, about_s, pace, planned_s
from fem_impact.errors import RunError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.scene.types import Scene
from fem_impact.tables.text import plain

ALONE = Unknown("one mesh alone cannot estimate its own error")
NOT_MEASURED = Unknown("no scene near this one was measured")
OVER = "The runs for the wanted error took {:.3g} s, more than the budget of {:.3g} s."


@dataclass(frozen=True, slots=True)
class OwnLadder:
    """Meshes from coarse to fine until the target error is reached or the next would take too long.

    The coarsest runs once in any case, and what it took forecasts the others (`pace`). Each mesh runs at its
    places of the barrier's grid, or at one where two meshes at all places do not fit the budget. Where two
    meshes do not fit at all, the one run tells no error.

    Attributes
    ----------
    target : relative error; budget_s : wall time, s
    reason : why no stored setting is taken
    meshes : scenes of each mesh, from coarse to fine, at its places
    least_s, pair_s : planned wall times, s, of what runs in any case, and of two meshes at one place each
    """

    target: float
    budget_s: float
    reason: str
    meshes: tuple[tuple[Scene, ...], ...]
    least_s: float
    pair_s: float

    @classmethod
    def of(cls, scene: Scene, budget_s: float, workers: int, reason: str) -> OwnLadder:
        """Return the ladder of all meshes that can be made for a scene."""
        meshes = tuple(tuple(placed(scene, mesh)) for mesh in rungs(scene))
        least_s, pair_s = (sum(planned_s(each[:1], workers) for each in meshes[:n]) for n in (1, 2))
        return cls(scene.accuracy.target or 0.0, budget_s, reason, meshes, least_s, pair_s)

    @property
    def sentence(self) -> str:
        """Say what is done and why, and about what it takes."""
        begin = (
            f"accuracy {100 * self.target:.3g} %: {self.reason} The scene is run on meshes of its own, from "
            f"coarse to fine, until their band is as narrow or {self.budget_s:.3g} s of wall time are used "
            f"up. Two meshes are planned to take {about_s(self.pair_s)}; the first run corrects that."
        )
        if self.pair_s <= self.budget_s:
            return begin
        exceeds = ", which exceeds the budget by itself" if self.least_s > self.budget_s else ""
        return (
            f"{begin} That is more than the budget: the coarsest runs once, about {about_s(self.least_s)}"
            f"{exceeds}; if no second one fits then, the error stays unknown. For an error give --budget "
            f'"{about_s(LONGER * self.pair_s)}".'
        )

    def simulate(self, options: RunOptions, workers: int) -> Outcome:
        """Return the outcome of the finest mesh at its first place, with the limits of the finest two.

        Raises
        ------
        RunError
            A run of the coarsest mesh did not finish.
        """
        climb = Climb(self.meshes, self.budget_s, options, workers, perf_counter())
        climb.begin()
        ended = ""
        while not ended and climb.achieved > self.target:
            ended = climb.up()
        return self._stated(climb, ended)

    def _stated(self, climb: Climb, ended: str) -> Outcome:
        """Return the outcome with what was reached in its validity; its files come up from below.

        ``ended`` says why the target is not reached and what more would cost, empty where it is.
        """
        meshes, wall_s, options = climb.done, climb.spent_s, climb.options
        finest, pair = meshes[-1][0], len(meshes) > 1
        limits, bands = mesh_limits(meshes[-2:]) if pair else (ALONE, ALONE)
        over = [OVER.format(wall_s, self.budget_s)] if wall_s > self.budget_s else []
        missed = [f"The wanted {100 * self.target:.3g} % is not reached: {climb.told}. {ended}"]
        stated = replace(
            finest.validity,
            accuracy_target=self.target,
            warnings=(*finest.validity.warnings, *over, *(missed if ended else [])),
            accuracy_setting=f"{len(meshes)} mesh{'es' * pair} of its own, the finest {_edge(finest)}",
            expected_error=NOT_MEASURED,
            expected_wall=max(self.budget_s, self.least_s),
            achieved_wall=wall_s,
            achieved_error=climb.achieved if pair else ALONE,
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


@dataclass(slots=True)
class Climb:
    """What has run on the meshes of a ladder so far, and what further ones will take.

    Attributes
    ----------
    meshes : scenes of each mesh, from coarse to fine, at its places
    budget_s : wall time, s
    options, workers : of the runs
    begun : clock at the start, s
    done : outcomes on each mesh that ran
    pace : wall time of the last runs over the planned one
    """

    meshes: Sequence[Sequence[Scene]]
    budget_s: float
    options: RunOptions
    workers: int
    begun: float
    done: list[list[Outcome]] = field(default_factory=list)
    pace: float = 1.0

    @property
    def spent_s(self) -> float:
        """Return the wall time since the start, s."""
        return perf_counter() - self.begun

    @property
    def achieved(self) -> float:
        """Return the error of the finest two meshes that ran, infinite of one alone."""
        return achieved_error(self.done[-2:]) if len(self.done) > 1 else inf

    @property
    def told(self) -> str:
        """Return that error as text."""
        if len(self.done) == 1:
            return ALONE.reason
        return f"{' and '.join(TARGETED)} are known to {plain(100 * self.achieved, 2)} %"

    def begin(self) -> None:
        """Run the coarsest mesh once, and at its other places where the next fits at all of its own, too."""
        coarsest, *finer = self.meshes
        self.done.append(self._run(coarsest[:1]))
        rest = coarsest[1:]
        if rest and self._affords(rest, *finer[:1]):
            self.done[0] += self._run(rest)

    def up(self) -> str:
        """Run the next mesh; return an empty string, or why none runs and what would let it."""
        for scenes in filter(self._affords, self._choices()):
            try:
                self.done.append(self._run(scenes))
            except RunError as error:
                return f"The next finer mesh gave no result: {error}"
            return ""
        return self._more()

    @property
    def _whole(self) -> bool:
        """Say whether the coarsest mesh ran at all its places."""
        return len(self.done[0]) == len(self.meshes[0])

    def _choices(self) -> list[Sequence[Scene]]:
        """Return the next mesh at the places at which it may run; a second one also at one alone."""
        following = self.meshes[len(self.done) :][:1]
        single = [scenes[:1] for scenes in following if len(self.done) == 1 or not self._whole]
        return [*(following if self._whole else []), *single]

    def _forecast_s(self, *batches: Sequence[Scene]) -> float:
        """Return the wall time, s, that batches will take one after the other."""
        return self.pace * sum(planned_s(scenes, self.workers) for scenes in batches)

    def _affords(self, *batches: Sequence[Scene]) -> bool:
        return self.spent_s + self._forecast_s(*batches) <= self.budget_s

    def _run(self, scenes: Sequence[Scene]) -> list[Outcome]:
        count = sum(map(len, self.done))
        own = [below(self.options, count + at) for at in range(len(scenes))]
        runs = side_by_side(scenes, "solid", own, self.workers)
        for run in runs:
            if not run.validity.finished:
                raise RunError(f"{scenes[0].id}: {run.validity.stopped_because}")
        self.pace = pace(scenes, runs, self.workers)
        return runs

    def _more(self) -> str:
        """Say what more than these runs would cost, and the budget that holds it."""
        ran, finer = len(self.done), self.meshes[len(self.done) :]
        if ran > 1 and not self._whole:
            time = self._forecast_s(*self.meshes[: ran + 1])
            return (
                f"Each mesh ran at one place of the barrier's grid, which makes the band {ONE_RUN:g} times "
                f"as wide. These meshes{' and one finer' * bool(finer)} at all places take about "
                f'{about_s(time)}: for that give --budget "{about_s(LONGER * time)}".'
            )
        if not finer:
            return "No finer mesh of this family can be made."
        time = self._forecast_s(finer[0] if ran > 1 else finer[0][:1])
        return (
            f"One mesh finer takes about {about_s(time)} more: for that give --budget "
            f'"{about_s(self.spent_s + LONGER * time)}".'
        )


def achieved_error(meshes: Sequence[Placed]) -> float:
    """Return the largest relative uncertainty of the quantities that a target is about."""
    truth = truths(meshes)
    return max(truth[name].uncertainty / truth[name].scale for name in TARGETED)


def _edge(outcome: Outcome) -> str:
    size = outcome.cost.tip_size
    return "" if isinstance(size, Unknown) else f"{size * 1e3:.3g} mm"
