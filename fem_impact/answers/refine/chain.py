"""Levels of a finite-element run: a coarse pilot finds the contact, finer meshes follow its record.

The pilot takes what may touch from the shapes alone and holds room ready around it. Each finer level holds
ready where its coarser one touched and flowed, and a cell more. How fine the last one is follows from the
width of the contact that was found. A level whose contact or flow left its zones is repeated with twice the
room where it is the last, or where it could not end.

On each level but the pilot several runs may share a mesh: those at other places of the barrier's grid, or a
twin of the scene. What they found together makes the mesh of the next level.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing, nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path

from fem_impact.answers.refine import extrapolate, forecast, needed
from fem_impact.answers.refine.level import LevelRun, simulate_level, with_half_step
from fem_impact.answers.refine.level_meshes import LevelMeshes, steps_between
from fem_impact.answers.refine.quantities import TARGETED
from fem_impact.case.case import Case
from fem_impact.case.cells import contact_edge
from fem_impact.case.record import together
from fem_impact.errors import ResultError, RunError, SceneError
from fem_impact.files.atomic import directory_lock, read_text, write_digests
from fem_impact.files.run_directory import BESIDE, STAMP, is_resumable, stands_also_at
from fem_impact.options import RunOptions
from fem_impact.outcome.groups import limitations
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.strikes import levels_told
from fem_impact.progress import Notice
from fem_impact.run.simulate import begin
from fem_impact.scene.impact import FIRST
from fem_impact.scene.types import Scene, digest, to_toml
from fem_impact.tables.text import plain

# shifts of a meshed barrier's grid along t, in cells at the contact, at which a level runs: one or both
GRID_OFFSETS = (0.0, 0.5)
MOST_REPEATS = 2  # of a level, each with twice the room
BUDGET = 600.0  # s of wall time for all levels, unless stated
LATE = 1.2  # of the budget, beyond which a level is given up: set-up looks at no clock, and all ends by 1.3
LEAST_BUDGET = 5.0  # s: a smaller budget still gives a quick scene its first level
MOST_FINER = 3  # splits beyond a resolved contact, where a band decides, or levels more until it is resolved
Decides = Callable[[Sequence[LevelRun]], bool]
"""Says whether levels from coarse to fine are enough for an answer."""


@dataclass
class LevelChain:
    """The levels of a scene from coarse to fine.

    Attributes
    ----------
    case : of the scene as stated
    options : of all its runs: the files of each level lie in a directory of its own until the last has run
    budget_s : wall time, s, that all levels may take
    workers : runs at a time, 1 or 2
    decides : levels go on until it is content; without it, until the contact is resolved or, where the scene
        states a wanted error, until that is reached
    twin : a scene that runs on the meshes of this one; it states no place of the grid
    read_s : wall time, s, that reading the scene took of the budget
    done : levels so far
    refused, lost_s : what ended the level after them, None where none failed, and its wall time, s
    """

    case: Case
    options: RunOptions = field(default_factory=RunOptions)
    budget_s: float = BUDGET
    workers: int = 1
    decides: Decides | None = None
    twin: Scene | None = None
    read_s: float = 0.0
    done: list[LevelRun] = field(default_factory=list)
    refused: SceneError | RunError | None = None
    lost_s: float = 0.0

    def run(self) -> Outcome:
        """Run levels from coarse to fine until the contact is resolved; return the last one's outcome.

        Where that fails or is cut off, the outcome is that of the finest level that came to its end, and says
        why. It has the limits and bands of its levels, if it resolves the contact. Its files stand in
        ``options.out``, those of all levels below it.

        Raises
        ------
        SceneError, RunError
            As of `fem_impact.run.simulate.simulate`, of the first level; OverBudgetError where the budget
            does not hold that.
        ResultError, OutputPathError
            As there, of any level.
        """
        out = self.options.out
        with nullcontext() if out is None else directory_lock(out):
            if out is not None and not (self.options.resume and is_resumable(out)):
                begin(self.scene, out)
            elif out is not None and read_text(out / "scene.toml") != to_toml(self.scene):
                raise ResultError(
                    f"{out / 'scene.toml'}: is another scene than the one that is to go on. Go on with that "
                    "one, or do not resume: the older run is kept beside the new one."
                )
            self.refine()
            outcome = self._stated()
            if out is not None:
                for file in self._place(self.counted, self.done[self.counted - 1].repeats).iterdir():
                    if file.is_file() and file.name not in ("scene.toml", "outcome.json", STAMP):
                        stands_also_at(file, out / file.name)  # the level keeps them, to be gone on from
                outcome.write(out / "outcome.json")
                write_digests(out, BESIDE)
        return outcome

    def refine(self) -> None:
        """Run levels, finer than those that have run, until one is enough or the budget is used up.

        It raises what `run` does.
        """
        if not self.done:
            forecast.require_pilot(self.meshes.pilot, self.limit_s, self.budget_s, self.options.progress)
        splits = self._next if self.done else self.meshes.first
        with closing(forecast.Turns()) as turns:
            while splits is not None:
                begun = forecast.now()
                try:
                    self._run_level(splits, turns)
                except (SceneError, RunError) as error:  # a mesh that folds is found when it is made
                    if not self.done:
                        raise
                    self.refused, self.lost_s = error, forecast.now() - begun
                    return
                splits = self._next

    @cached_property
    def meshes(self) -> LevelMeshes:
        """The meshes of the levels."""
        return LevelMeshes.of(self.case)

    @property
    def limit_s(self) -> float:
        """Wall time, s, after which the next level is given up."""
        return LATE * max(self.budget_s, LEAST_BUDGET) - self.spent_s

    @property
    def finest(self) -> int:
        """Splits of the last level, as far as the levels so far tell."""
        return self.meshes.last(self.done[-1].record if self.done else None)

    @property
    def following(self) -> int | None:
        """Splits of the level after those that have run, whatever the budget; None where none is wanted."""
        ran, finest, record = self.done[-1].splits, self.finest, self.done[-1].record
        if record.crushed:  # smaller cells are crushed sooner
            return None
        one_more = not self.meshes.is_sized and self._asked < self.scene.accuracy.levels
        if self.decides or self.scene.accuracy.target:
            cut = 1 < len(self.done) > self.counted
            if self._decided or cut or (ran >= finest + MOST_FINER and not one_more):
                return None
            one_more = True
        if one_more:
            finest = max(finest, ran + 1)
        return next(iter(steps_between(ran, finest, self.scene.accuracy.levels - len(self.done))), None)

    @property
    def _asked(self) -> int:
        """How many levels ran, less those that more than stated may until one resolves the contact."""
        return len(self.done) - (0 if self.done[-1].record.resolved else MOST_FINER)

    @property
    def _decided(self) -> bool:
        """Whether the levels so far are enough for an answer."""
        if self.decides:
            return self.decides(self.done) and len(self.done) > 1
        # two levels may agree by chance: t2 told e to 0.06 %, 1.8 % off
        return len(self.done) > 2 and self._reached(self._errors)

    @property
    def _errors(self) -> dict[str, float]:
        """Half-widths over their scales of what a wanted error is about, by name; of what has a band."""
        limits = extrapolate.quantity_limits([level.runs for level in self.done[: self.counted]])
        of = self.scene.accuracy.target_of
        return {name: limits[name].error for name in ((of,) if of else TARGETED) if name in limits}

    def _reached(self, errors: Mapping[str, float]) -> bool:
        """Say whether relative errors, by quantity, are what the scene asks for; those of none are not."""
        return bool(errors) and max(errors.values()) <= (self.scene.accuracy.target or 0.0)

    @property
    def _next(self) -> int | None:
        """Splits of the next level, fewer where the budget holds those alone, or None."""
        then = self.following
        if then is None:
            return None
        for splits, share in {then: forecast.LONGER, self.done[-1].splits + 1: forecast.SHORTER}.items():
            if self.spent_s + share * self.forecast_s(splits) <= self.budget_s:
                return splits
        if self.options.progress is not None:
            self.options.progress(Notice(f"The run ends with level {len(self.done)}. {self._not_begun}"))
        return None

    @property
    def _not_begun(self) -> str:
        """Say that the budget does not hold the next level, and which does; empty where none is wanted."""
        if self.refused or self.following is None:
            return ""
        used, budget = map(forecast.about_s, (self.spent_s, self.budget_s))
        return f"{used} of the budget of {budget} are used up. {self.advice()[0]}"

    @property
    def counted(self) -> int:
        """The number, from 1, of the level that counts: the finest that saw the bodies part, or the last."""
        parted = [n for n, level in enumerate(self.done, 1) if not level.cut_off]
        return parted[-1] if parted else len(self.done)

    @property
    def scene(self) -> Scene:
        """The scene as stated."""
        return self.case.scene

    @property
    def spent_s(self) -> float:
        """Wall time, s, of the budget that is used up so far."""
        return self.read_s + self.lost_s + sum(level.wall_s for level in self.done)

    @property
    def _offsets(self) -> tuple[float, ...]:
        """Places of the barrier's grid at which the next level runs; a rigid barrier has none."""
        pilot = not self.done or self.twin is not None or not self.case.bodies.contact.compliant
        accuracy = self.scene.accuracy
        return GRID_OFFSETS[: 1 if pilot else accuracy.offsets or 1 + bool(accuracy.target)]

    @property
    def _turns(self) -> int:
        """Runs of the next level one after the other."""
        return forecast.turns(2 if self.twin else len(self._offsets), self.workers)

    def forecast_s(self, splits: int) -> float:
        """Return about the wall time, s, of a level whose mesh is not made yet, from that of the last one."""
        last = self.done[-1]
        took_s = forecast.longest_s([run.cost.whole_wall for run in last.outcomes], self.workers)
        run_s = took_s / forecast.turns(len(last.outcomes), self.workers)
        finer = splits - last.splits, last.cases[0], self.meshes.at(splits), last.found
        longer = forecast.growth(run_s, *finer)
        return float(run_s * longer * self._turns)

    def _run_level(self, splits: int, turns: forecast.Turns) -> None:
        """Run a level, again where it needs more room or shorter steps, and add it to what is done."""
        last = bool(self.done) and splits >= self.finest
        scene = self.meshes.at(splits)
        before = known = self.done[-1].found if self.done else self.meshes.expected(splits)
        if last:
            scene = replace(scene, save=self.scene.save)
        accuracy, still = scene.accuracy, replace(scene.save, frames=0, strain_samples=0)
        shifts = [(accuracy.grid_shift + offset) % 1.0 for offset in self._offsets]
        places = [replace(scene, accuracy=replace(accuracy, grid_shift=shift)) for shift in shifts]
        # a film is made of the first alone: storing frames takes a tenth of a quick run
        scenes = [*places[:1], *(replace(one, save=still) for one in places[1:])]
        scenes += [replace(self.twin, accuracy=accuracy)] if self.twin else []
        begun, room, took_s, earlier = forecast.now(), 1.0, 0.0, [0.0] * len(scenes)
        kept: LevelRun | None = None  # what ended in smaller zones or with longer steps: better than nothing
        for repeats in range(MOST_REPEATS + 1):
            planned = [] if self.done or repeats else [self.meshes.pilot]
            cases = planned + [Case.of(one, "solid", before) for one in scenes[len(planned) :]]
            workers = forecast.at_once(cases, self.workers)
            work = [
                partial(simulate_level, case, self._options(splits, repeats, number, begun))
                for number, case in enumerate(cases)
            ]
            try:
                runs = turns(work, workers)
            except (SceneError, RunError) as late:
                if kept is None:
                    raise
                level = replace(kept, wall_s=forecast.now() - begun, late=str(late))
                break
            outcomes, record = tuple(one for one, _ in runs), together([recorded for _, recorded in runs])
            ended = all(outcome.validity.finished for outcome in outcomes)
            size = contact_edge(cases[0].bodies)  # as it came out, which is not always as asked for
            # without a first compilation of the kernels, and with what ran before an interruption
            took_s += forecast.longest_s([one.cost.whole_wall for one in outcomes], workers)
            level = LevelRun(splits, size, tuple(cases), outcomes, record, took_s, repeats, tuple(earlier))
            earlier = [t + one.cost.whole_cpu for t, one in zip(earlier, outcomes, strict=True)]
            zones = cases[0].zones
            if record.crushed and zones.skin_rows + zones.rod_rows and repeats < MOST_REPEATS:
                before = replace(before, crushed=True)  # again, without thin rows and columns
                continue
            if level.loses and cases[0].scene.accuracy.step == accuracy.step and repeats < MOST_REPEATS:
                scenes, kept = [*map(with_half_step, scenes)], level  # a miss falls with the step's square
                continue
            if not record.left or record.crushed or (ended and not last) or repeats == MOST_REPEATS:
                break
            # of a run that stopped what touched so far, and skin that came down outside its zones
            known, kept = (record, level) if ended else (together([known, record]), kept)
            known, room = replace(known, crushed=before.crushed), 2.0 * room
            before = known.wider(room)  # a record has the room of a first run
        self.done.append(replace(level, wall_s=max(level.wall_s, forecast.now() - begun)))

    def _place(self, number: int, repeats: int, run: int = 0) -> Path:
        """Return the directory of a run of a level, both counted, which ran so often before."""
        assert self.options.out is not None, "files are wanted"
        name = f"level-{number}" + f"-again-{repeats}" * bool(repeats) + f"-run-{run + 1}" * bool(run)
        return self.options.out / name

    def _options(self, splits: int, repeats: int, run: int, begun: float) -> RunOptions:
        """Return the options of a run of the next level, which ``begun`` at that `now`.

        Its progress gives the level up where it takes so long that the budget cannot be kept; that of the
        first run names the level and knows about later ones. Another process may do the others.
        """
        number, show = len(self.done) + 1, None if run else self.options.progress
        out = self.options.out and self._place(number, repeats, run)
        ends = self.finest, self.meshes.likely(self.done[-1].record if self.done else None)
        left = self.scene.accuracy.levels - number
        plans = dict.fromkeys(tuple(steps_between(splits, end, left)) for end in ends)  # one or two
        whole = " to ".join(dict.fromkeys(f"{number + len(of)}" for of in plans))
        name = f"{self.scene.id}, level {number}{f' of {whole}' * bool(self.done)}{', again' * bool(repeats)}"
        progress = forecast.LevelProgress(show, name, used_s=self.spent_s, limit_s=self.limit_s, begun=begun)
        if self.done:
            progress.after(self.done[-1].outcome.cost, self._turns)
            planned = [forecast.planned_s(self.done[-1], self.meshes, of) for of in plans if show]
            progress.later_s = (planned[0], planned[-1]) if planned else None
        return replace(self.options, out=out, progress=progress)

    def _stated(self) -> Outcome:
        """Return the outcome of the level that counts, of the scene as stated, with limits and bands."""
        upto = self.done[: self.counted]
        counted, beyond = upto[-1], self.done[self.counted :]
        found = extrapolate.level_limits([level.runs for level in upto])
        limits, bands, lost = needed.told_heat(found, counted.outcome, counted.runs.across, self.scene)
        why = bands if isinstance(bands, Unknown) else extrapolate.UNRESOLVED
        if bands is why:
            limits = bands = Unknown(f"{why.reason}; {self._finer}")
        short = self.meshes.lacking(counted.splits, counted.record, self.finest)
        short, narrow = (one and f"{one}: {self._finer}." for one in (short, counted.narrow))
        cut = beyond[0].stopped if beyond else str(self.refused or "")
        ended = f"The numbers are those of level {len(upto)}: level {len(upto) + 1} was cut off. {cut}"
        outcome = counted.outcome if self.scene.accuracy.unresolved == "report" else counted.withheld
        notes = counted.shorter_steps(self.scene), levels_told([one.outcome.strikes for one in upto])
        said, missed = outcome.validity, self._not_begun
        if self.scene.accuracy.target:
            errors = self._errors
            reached = [f"{name} is known to {plain(100 * error, 2)} %" for name, error in errors.items()]
            known_to, wanted = " and ".join(reached) or why.reason, 100 * self.scene.accuracy.target
            missed = f"The wanted {wanted:.3g} % is not reached: {known_to}. {self.advice()[0]}"
            missed = "" if self._reached(errors) else missed
            said = replace(
                said,
                accuracy_target=self.scene.accuracy.target,
                achieved_error=max(errors.values()) if errors else why,
                achieved_wall=self.spent_s,
            )
        validity = replace(
            said,
            mesh_limit=limits,
            mesh_band=bands,
            limitations=(
                *outcome.validity.limitations,
                *limitations("run", ended if cut else "", counted.lost, missed),
                *limitations("resolution", counted.left, narrow if len(upto) > 1 else "", short),
                *limitations("resolution", counted.without_thin, *notes),
            ),
        )
        strikes = outcome.strikes
        if len(upto) > 1 and self.scene.impact.until != FIRST:
            from fem_impact.answers.refine.strikes import open_by_levels
            from fem_impact.run.certain import with_spread

            strikes = with_spread(counted.cases[0], strikes, open_by_levels(upto))
        return replace(
            outcome,
            validity=validity,
            strikes=strikes,
            heat=needed.known_heat(outcome, lost, upto[-2].outcome if len(upto) > 1 else None),
            provenance=replace(outcome.provenance, scene_digest=digest(self.scene)),
        )

    @property
    def _finer(self) -> str:
        """Say what adds a finer level than those that have run, or why nothing does."""
        if self.done[-1].record.crushed:
            return "cells were crushed, and finer ones would be sooner: fidelity rigid or modal has none"
        if self.refused or self.following is not None:
            return "a finer level gave no result" if self.refused else "a larger budget adds a finer level"
        return self.meshes.remedy(self._asked, forecast.about_s(self.forecast_s(self.done[-1].splits + 1)))

    def advice(self, before_s: float = 0.0, halvings: int = 1) -> tuple[str, int | None]:
        """Return what finer levels would take, or why none is made; the budget for them, s, or None.

        ``before_s`` of the budget, s, went by before this chain; the errors are to be halved so often.
        """
        number = len(self.done) + 1
        if self.refused:
            reason = f"Level {number}, finer, gave no result: {self.refused}"
            return reason, forecast.budget_of(self.refused, before_s)
        then = self.following
        if then is None:
            return f"No finer level is tried: {self._finer}.", None
        last = max(then, min(self.done[-1].splits + halvings, self.finest + MOST_FINER))
        each_s = [self.forecast_s(splits) for splits in range(then, last + 1)]
        return forecast.advice(number, before_s + self.spent_s, each_s)
