"""Simulate to a wanted error: by a setting measured on a near scene, or on meshes from coarse to fine."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from itertools import chain, islice
from typing import Any

from fem_impact.answers.cost.stored import ChosenSetting, NotMeasured, choose_setting
from fem_impact.answers.refine.budget import (
    LONGER,
    Budget,
    about_s,
    below,
    longest_s,
    side_by_side,
)
from fem_impact.answers.refine.chain import BUDGET as LEVELS_BUDGET
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.extrapolate import ALONE, ONE_RUN, MeshRuns, mesh_limits, target_limits
from fem_impact.answers.refine.levels import FEW_OFFSETS, at_offsets
from fem_impact.answers.refine.loop import Level, RefinementLoop, Stop, levels_at_offsets
from fem_impact.answers.refine.quantities import TARGETED
from fem_impact.case.case import Case
from fem_impact.files.lock import directory_lock
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.limitation import limitations
from fem_impact.outcome.record import Outcome
from fem_impact.run import simulate as run
from fem_impact.scene.types import Scene
from fem_impact.tables.text import plain

BUDGET = 120.0  # s of wall time, unless stated, for a scene whose like was not measured
NOT_MEASURED = Unknown("no setting measured on a near scene meets the wanted error in this time")
OVER = "The runs for the wanted error took {:.3g} s, more than the budget of {:.3g} s."


def achieved_errors(meshes: Sequence[MeshRuns], scatter: float = 1.0) -> dict[str, float]:
    """Return the relative uncertainty of each quantity that a target is about; a rigid rod has no E_vib.

    ``scatter`` is the share of the scatter over the grid offsets that counts.
    """
    limits = target_limits(meshes)
    rigid = isinstance(meshes[0].runs[0].energy.vibration, Unknown)
    return {
        name: (limits[name].uncertainty - (1 - scatter) * limits[name].scatter) / limits[name].scale
        for name in TARGETED
        if not (rigid and name == "E_vib")
    }


def achieved_error(meshes: Sequence[MeshRuns], scatter: float = 1.0) -> float:
    """Return the largest of `achieved_errors`."""
    return max(achieved_errors(meshes, scatter).values())


@dataclass(frozen=True, slots=True)
class ErrorJudge:
    """Decides where the finest two meshes reach a relative error, ``target``."""

    target: float

    def failure(self, done: MeshRuns) -> str:
        """Return why a run is no impact with a known e, empty where all are."""
        for outcome in done.runs:
            e, scene = outcome.restitution.edge.e, outcome.provenance.scene_id
            if not outcome.validity.finished:
                return f"{scene}: {outcome.validity.stopped_because}"
            if isinstance(e, Unknown):
                return f"{scene}: e is not known: {e.reason}"
        return ""

    def decided(self, done: Sequence[MeshRuns], scatter: float = 1.0) -> bool:
        """Say whether the finest two meshes reach the target, with a share of their scatter."""
        return len(done) > 1 and achieved_error(done[-2:], scatter) <= self.target


@dataclass(frozen=True, slots=True)
class RefinementPlan:
    """Meshes from coarse to fine until the wanted error is reached or the next would take too long.

    Each mesh runs at two grid offsets, and at its other ones where they alone bring the target; or at one
    where two meshes at two offsets do not fit the budget. Where two meshes do not fit at all, the one run
    tells no error.

    Attributes
    ----------
    target : relative error; budget_s : wall time, s
    reason : why no stored setting is taken
    levels : what may run on each mesh, from coarse to fine
    least_s, pair_s : planned wall times, s, of what runs in any case, and of two meshes at one offset each
    """

    target: float
    budget_s: float
    reason: str
    levels: tuple[Level, ...]
    least_s: float
    pair_s: float

    @classmethod
    def of(cls, scene: Scene, budget_s: float, workers: int, reason: str) -> RefinementPlan:
        """Return the plan with all meshes that can be made for a scene."""
        levels, budget = levels_at_offsets(scene), Budget(budget_s, workers)
        least_s, pair_s = (budget.forecast_s(*(level.scenes[:1] for level in levels[:n])) for n in (1, 2))
        return cls(scene.accuracy.target or 0.0, budget_s, reason, levels, least_s, pair_s)

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
        """Return the outcome of the finest mesh at its first offset, with the limits of the finest two.

        Its ``validity`` says what was reached; its files come up from those of the further runs.

        Raises
        ------
        RunError, SceneError
            A run on the coarsest mesh failed.
        """
        loop = RefinementLoop(self.levels, Budget(self.budget_s, workers), options)
        stop = loop.run(ErrorJudge(self.target))
        if stop.error and not loop.done:
            raise stop.error
        outcome = self._stated(loop, stop)
        if options.out is not None:
            finest = below(options, loop.finest_run).out
            for file in finest.glob("*") if finest else ():
                file.replace(options.out / file.name)
            outcome.write(options.out / "outcome.json")
        return outcome

    def _stated(self, loop: RefinementLoop, stop: Stop) -> Outcome:
        """Return the outcome of a loop with what was reached, and with what more would cost."""
        meshes, wall_s = loop.done, loop.budget.spent_s
        finest, size = meshes[-1].runs[0], meshes[-1].runs[0].cost.tip_size
        edge = "" if isinstance(size, Unknown) else f"{size * 1e3:.3g} mm"
        over = OVER.format(wall_s, self.budget_s) if wall_s > self.budget_s else ""
        missed = f"The wanted {100 * self.target:.3g} % is not reached: {_reached(meshes)}. "
        advice = "" if stop.because == "decided" else missed + _advice(loop, stop)
        return with_limits(
            finest,
            meshes[-2:],
            accuracy_target=self.target,
            limitations=(*finest.validity.limitations, *limitations("run", over, advice)),
            accuracy_setting=f"{len(meshes)} mesh{'es' * (len(meshes) > 1)} of its own, the finest {edge}",
            expected_error=NOT_MEASURED,
            expected_wall=max(self.budget_s, self.least_s),
            achieved_wall=wall_s,
        )


def with_limits(outcome: Outcome, meshes: Sequence[MeshRuns], **stated: Any) -> Outcome:
    """Return an outcome with limits, bands and error of meshes in its validity, and what else is stated."""
    limits, bands = mesh_limits(meshes)
    error = achieved_error(meshes) if len(meshes) > 1 else ALONE
    validity = replace(outcome.validity, achieved_error=error, mesh_limit=limits, mesh_band=bands, **stated)
    return replace(outcome, validity=validity)


def _reached(meshes: Sequence[MeshRuns]) -> str:
    """Return the error of the finest two meshes as text."""
    if len(meshes) == 1:
        return ALONE.reason
    errors = achieved_errors(meshes[-2:])
    return " and ".join(f"{name} is known to {plain(100 * error, 2)} %" for name, error in errors.items())


def _advice(loop: RefinementLoop, stop: Stop) -> str:
    """Say why no other mesh ran, what more would cost, and the budget that holds it."""
    if stop.error:
        return f"Further runs gave no result: {stop.error}"
    ran, budget = len(loop.done), loop.budget
    if ran > 1 and not loop.at_few:
        time = budget.forecast_s(*(level.scenes[:FEW_OFFSETS] for level in loop.levels[: ran + 1]))
        return (
            f"Each mesh ran at one place of the barrier's grid, which makes the band {ONE_RUN:g} times "
            f"as wide. These meshes{' and one finer' * bool(loop.finer)} at two places take about "
            f'{about_s(time)}: for that give --budget "{about_s(LONGER * time)}".'
        )
    if not loop.finer:
        return "No finer mesh of this family can be made."
    time = budget.forecast_s(loop.finer[0].scenes[: FEW_OFFSETS if ran > 1 else 1])
    return (
        f"One mesh finer takes about {about_s(time)} more: for that give --budget "
        f'"{about_s(budget.spent_s + LONGER * time)}".'
    )


def settle(
    scene: Scene, fidelity: str | None = None, workers: int = 1, budget_s: float | None = None
) -> ChosenSetting | RefinementPlan:
    """Return the stored setting that meets the scene's target, or meshes of its own where there is none.

    A stored setting that takes longer than a stated ``budget_s``, s of wall time, gives way to such meshes.

    Raises
    ------
    SceneError
        The fidelity that is asked for does not know the quantities of a target.
    """
    try:
        chosen = choose_setting(scene, fidelity, workers)
        if budget_s is None or chosen.expected_wall_s <= budget_s:
            return chosen
        took = plain(chosen.expected_wall_s, 2)
        reason = f"{chosen.setting.name}, measured on {chosen.like}, takes about {took} s."
    except NotMeasured as missing:
        if fidelity not in (None, "solid"):
            raise
        reason = missing.problem
    return RefinementPlan.of(scene, BUDGET if budget_s is None else budget_s, workers, reason)


def compiled(scene: Scene, fidelity: str) -> Case:
    """Return the case of a scene that gives a mesh, after all that can be refused before any work.

    Raises
    ------
    UsageError, SceneError
        As `Case.of`, of levels that of the first one.
    """
    if not _on_levels(scene, fidelity):
        return Case.of(scene, fidelity)
    case = Case(scene)
    LevelChain(case).pilot()
    if scene.accuracy.tip_size is not None:
        case.require_memory()  # of the last level, whose cells are stated
    return case


def _on_levels(scene: Scene, fidelity: str) -> bool:
    return fidelity == "solid" and scene.accuracy.levels > 1


def simulate(
    scene: Scene,
    fidelity: str | None = None,
    options: RunOptions = RunOptions(),
    workers: int = 1,
    budget_s: float | None = None,
    chosen: ChosenSetting | RefinementPlan | None = None,
    case: Case | None = None,
) -> Outcome:
    """Compute an impact: on the mesh that its scene gives, or as measured costs choose for a stated error.

    A chosen setting runs each mesh at its offsets of the barrier's grid. The result is the outcome of the
    finest mesh at the first offset, with the limits of several meshes, or the means of one, in its
    ``validity``. Files of the other runs stand below ``options.out``. With two or more ``workers`` a second
    process does half of the runs. Where no stored setting serves, meshes of the scene's own are run for about
    ``budget_s``, s (`BUDGET` unless stated), and the outcome says what they reached. ``chosen`` is what
    `settle` returned for this scene, ``case`` that of a scene that gives a mesh, where the caller has them.

    Raises
    ------
    UsageError, SceneError, OutputPathError, ResultError, RunError
        As `fem_impact.run.simulate.simulate` and `settle`.
    """
    if scene.accuracy.target is None:
        if _on_levels(scene, fidelity or "solid"):
            return LevelChain(
                case or Case(scene), options, LEVELS_BUDGET if budget_s is None else budget_s
            ).run()
        return run.simulate(scene, fidelity or "solid", options, case)
    chosen = chosen or settle(scene, fidelity, workers, budget_s)
    with nullcontext() if options.out is None else directory_lock(options.out):
        if isinstance(chosen, RefinementPlan):
            return chosen.simulate(options, workers)
        outcome = _simulate_chosen(scene, chosen, options, workers)
        if options.out is not None:
            outcome.write(options.out / "outcome.json")  # once more: it states its accuracy now
    return outcome


def _simulate_chosen(scene: Scene, chosen: ChosenSetting, options: RunOptions, workers: int) -> Outcome:
    """Return the first outcome of a chosen setting with expected and achieved error and time in its validity.

    The first run writes to ``options.out`` itself and reports its progress.
    """
    alone = [replace(scene, accuracy=replace(scene.accuracy, target=None))]  # a reduced model has no mesh
    groups = [at_offsets(scene, mesh, chosen.setting.places) for mesh in chosen.meshes] or [alone]
    scenes = list(chain.from_iterable(groups))
    of_each = [options, *(below(options, at) for at in range(1, len(scenes)))]
    done = side_by_side(scenes, chosen.setting.fidelity, of_each, workers)
    runs = iter(done)
    return with_limits(
        done[0],
        [MeshRuns.of(islice(runs, len(group))) for group in groups],
        accuracy_target=chosen.target,
        accuracy_setting=chosen.setting.name,
        expected_error=chosen.expected_error,
        expected_wall=chosen.expected_wall_s,
        achieved_wall=longest_s([outcome.cost.whole_wall for outcome in done], workers),
    )
