"""Simulate to a stated error where no near scene was measured: meshes of the scene's own, within a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import inf, sqrt

from fem_impact.answers.refine.budget import Budget, below
from fem_impact.answers.refine.extrapolate import EVEN, ONE_RUN, Placed, stated_limits, truths
from fem_impact.answers.refine.levels import FEW, PLACES, placed, rungs
from fem_impact.answers.refine.quantities import TARGETED
from fem_impact.answers.refine.times import LONGER, about_s, planned_s
from fem_impact.errors import RunError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.scene.types import Scene
from fem_impact.tables.text import plain

ALONE = Unknown("one mesh alone cannot estimate its own error")
NOT_MEASURED = Unknown("no setting measured on a near scene meets the wanted error in this time")
SETTLED = EVEN[len(PLACES)] / EVEN[FEW] * sqrt(FEW / len(PLACES))
"""Share of the scatter at few places that is left at all of them."""
OVER = "The runs for the wanted error took {:.3g} s, more than the budget of {:.3g} s."


@dataclass(frozen=True, slots=True)
class OwnLadder:
    """Meshes from coarse to fine until the target error is reached or the next would take too long.

    The coarsest runs once in any case, and what it took forecasts the others. Each mesh runs at two places of
    the barrier's grid, and at its other places where they alone bring the target; or at one where two meshes
    at two places do not fit the budget. Where two meshes do not fit at all, the one run tells no error.

    Attributes
    ----------
    target : relative error; budget_s : wall time, s
    reason : why no stored setting is taken
    meshes : scenes of each mesh, from coarse to fine, at all of its places
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
        climb = Climb(self.meshes, Budget(self.budget_s, workers), options, self.target)
        climb.begin()
        ended = ""
        while not ended and climb.achieved > self.target:
            ended = climb.up()
        return self._stated(climb, ended)

    def _stated(self, climb: Climb, ended: str) -> Outcome:
        """Return the outcome with what was reached in its validity; its files come up from below.

        ``ended`` says why the target is not reached and what more would cost, empty where it is.
        """
        meshes, wall_s, options = climb.done, climb.budget.spent_s, climb.options
        finest, pair = meshes[-1][0], len(meshes) > 1
        limits, bands = stated_limits(meshes[-2:]) if pair else (ALONE, ALONE)
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
            kept = below(options, climb.first).out
            for file in kept.glob("*") if kept else ():
                file.replace(options.out / file.name)
            outcome.write(options.out / "outcome.json")
        return outcome


@dataclass(slots=True)
class Climb:
    """What has run on the meshes of a ladder so far, and what further ones will take.

    Attributes
    ----------
    meshes : scenes of each mesh, from coarse to fine, at all of its places
    budget : of all runs
    options : of the runs
    target : relative error
    done : outcomes on each mesh that ran
    first : number of the first run on the finest mesh
    """

    meshes: Sequence[Sequence[Scene]]
    budget: Budget
    options: RunOptions
    target: float
    done: list[list[Outcome]] = field(default_factory=list)
    first: int = 0

    @property
    def achieved(self) -> float:
        """Return the error of the finest two meshes that ran, infinite of one alone."""
        return achieved_error(self.done[-2:]) if len(self.done) > 1 else inf

    @property
    def told(self) -> str:
        """Return that error as text."""
        if len(self.done) == 1:
            return ALONE.reason
        known = achieved_errors(self.done[-2:])
        return " and ".join(f"{name} is known to {plain(100 * error, 2)} %" for name, error in known.items())

    def begin(self) -> None:
        """Run the coarsest mesh once, and at a second place where the next fits at two, too."""
        coarsest, *finer = self.meshes
        self.done.append(self._run(coarsest[:1]))
        second = coarsest[1:FEW]
        if second and self.budget.affords(second, *(scenes[:FEW] for scenes in finer[:1])):
            self.done[0] += self._run(second)

    def up(self) -> str:
        """Run what brings the target nearest; return an empty string, or why nothing runs and what would."""
        try:
            more = self._more_places()
            if more and self.budget.affords(*more):
                for runs, scenes in zip(self.done[-2:], more, strict=True):
                    runs += self._run(scenes)
                return ""
            for scenes in filter(self.budget.affords, self._choices()):
                before = self._ran
                self.done.append(self._run(scenes))
                self.first = before
                return ""
        except RunError as error:
            return f"Further runs gave no result: {error}"
        return self._advice()

    @property
    def _ran(self) -> int:
        """Return the number of runs so far."""
        return sum(map(len, self.done))

    @property
    def _few(self) -> bool:
        """Say whether the coarsest mesh ran at two places or more, or at the one it has."""
        return len(self.done[0]) >= min(FEW, len(self.meshes[0]))

    def _more_places(self) -> list[Sequence[Scene]]:
        """Return the other places of the finest two meshes, where only their scatter is in the way."""
        if len(self.done) == 1 or not self._few:
            return []
        pair = zip(self.meshes[: len(self.done)][-2:], self.done[-2:], strict=True)
        more = [scenes[len(runs) :] for scenes, runs in pair]
        return more if all(more) and achieved_error(self.done[-2:], SETTLED) <= self.target else []

    def _choices(self) -> list[Sequence[Scene]]:
        """Return the next mesh at the places at which it may run; a second one also at one alone."""
        following = [scenes[:FEW] for scenes in self.meshes[len(self.done) :][:1]]
        single = [scenes[:1] for scenes in following if len(self.done) == 1 or not self._few]
        return [*(following if self._few else []), *single]

    def _run(self, scenes: Sequence[Scene]) -> list[Outcome]:
        own = [below(self.options, self._ran + at) for at in range(len(scenes))]
        runs = self.budget.run(scenes, own)
        for run in runs:
            e = run.restitution.edge.e
            if not run.validity.finished:
                raise RunError(f"{scenes[0].id}: {run.validity.stopped_because}")
            if isinstance(e, Unknown):
                raise RunError(f"{scenes[0].id}: e is not known: {e.reason}")
        return runs

    def _advice(self) -> str:
        """Say what more than these runs would cost, and the budget that holds it."""
        ran, finer, spent_s = len(self.done), self.meshes[len(self.done) :], self.budget.spent_s
        if ran > 1 and not self._few:
            time = self.budget.forecast_s(*(scenes[:FEW] for scenes in self.meshes[: ran + 1]))
            return (
                f"Each mesh ran at one place of the barrier's grid, which makes the band {ONE_RUN:g} times "
                f"as wide. These meshes{' and one finer' * bool(finer)} at two places take about "
                f'{about_s(time)}: for that give --budget "{about_s(LONGER * time)}".'
            )
        if not finer:
            return "No finer mesh of this family can be made."
        time = self.budget.forecast_s(finer[0][: FEW if ran > 1 else 1])
        return (
            f"One mesh finer takes about {about_s(time)} more: for that give --budget "
            f'"{about_s(spent_s + LONGER * time)}".'
        )


def achieved_errors(meshes: Sequence[Placed], kept: float = 1.0) -> dict[str, float]:
    """Return the relative uncertainty of each quantity that a target is about; a rigid rod has no E_vib.

    ``kept`` is the share of its scatter that counts.
    """
    truth = truths(meshes)
    rigid = isinstance(meshes[0][0].energy.vibration, Unknown)
    return {
        name: (truth[name].uncertainty - (1 - kept) * truth[name].scatter) / truth[name].scale
        for name in TARGETED
        if not (rigid and name == "E_vib")
    }


def achieved_error(meshes: Sequence[Placed], kept: float = 1.0) -> float:
    """Return the largest of `achieved_errors`."""
    return max(achieved_errors(meshes, kept).values())


def _edge(outcome: Outcome) -> str:
    size = outcome.cost.tip_size
    return "" if isinstance(size, Unknown) else f"{size * 1e3:.3g} mm"
