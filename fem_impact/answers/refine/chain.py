"""Levels of a finite-element run: a coarse pilot finds the contact, finer meshes follow its record.

The pilot takes what may touch from the shapes alone and holds room ready around it. Each finer level holds
ready where its coarser one touched and flowed, and a cell more. How fine the last one is follows from the
width of the contact that was found. A level whose contact or flow left its zones is repeated with twice the
room where it is the last, or where it could not end.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import log2
from pathlib import Path

from fem_impact.answers.refine.budget import about_s
from fem_impact.answers.refine.extrapolate import MeshRuns, level_limits
from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.cells import body_cell, contact_edge, level_size, levels_of, rod_cell
from fem_impact.case.record import ContactRecord, expected_record
from fem_impact.case.recorded import patch_radius
from fem_impact.errors import ResultError, RunError, SceneError
from fem_impact.files.atomic import read_text, write_text
from fem_impact.files.digests import write_digests
from fem_impact.files.lock import directory_lock
from fem_impact.files.run_directory import BESIDE, RECORD, is_resumable
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.limitation import limitations
from fem_impact.outcome.record import Outcome
from fem_impact.progress import Notice, Progress
from fem_impact.run.program import stamp
from fem_impact.run.resolution import NOT_RESOLVED, without
from fem_impact.run.simulate import begin, simulate_recorded
from fem_impact.scene.fields import LEVELS
from fem_impact.scene.types import Scene
from fem_impact.scene.write import digest, to_toml

MOST_REPEATS = 2  # of a level, each with twice the room
# levels beyond those asked for, where the last has not resolved the contact: it would have no numbers
MORE = 1
JUMP = 2  # splits between two levels at most: a record holds the places of cells four times as large
# how much longer a level takes than one with cells twice as large, where only one has run: the most of 24
# pairs of levels of the 13 measured sets, whose median was 1.9
SLOWER = 2.8
BUDGET = 600.0  # s of wall time for all levels, unless stated
SLICES = 1 / 3  # of the diameter: height over the tip at which the slices of a body may begin
STAMP = "level.stamp"
"""File of a level's directory that says what was computed there."""
UNRESOLVED = Unknown("the last level did not resolve the contact; accuracy.levels = 4 adds a finer one")


@dataclass(frozen=True, slots=True)
class LevelRun:
    """A level that has run.

    Attributes
    ----------
    splits : how often the cells at the contact are split there
    size : edge of the cells that resolve the contact, m
    case, outcome, record : of its last run; repeats : how often it ran again with more room
    """

    splits: int
    size: float
    case: Case
    outcome: Outcome
    record: ContactRecord
    repeats: int = 0


@dataclass
class LevelChain:
    """The levels of a scene from coarse to fine.

    Attributes
    ----------
    case : of the scene as stated
    options : of all its runs: the files of each level lie in a directory of its own until the last has run
    budget_s : wall time, s, that all levels may take
    done : levels so far
    failed : why the level after them has no outcome, empty where none failed
    """

    case: Case
    options: RunOptions = field(default_factory=RunOptions)
    budget_s: float = BUDGET
    done: list[LevelRun] = field(default_factory=list)
    failed: str = ""

    def run(self) -> Outcome:
        """Run levels from coarse to fine until the contact is resolved; return the last one's outcome.

        Where that fails or is cut off, the outcome is that of the finest level that came to its end, and says
        why. It has the limits and bands of its levels, if it resolves the contact. Its files stand in
        ``options.out``, those of the other levels below it.

        Raises
        ------
        SceneError, RunError
            As of `fem_impact.run.simulate.simulate`, of the first level.
        ResultError, OutputPathError
            As there, of any level.
        """
        out = self.options.out
        with nullcontext() if out is None else directory_lock(out):
            if out is not None:
                self._begin(out)
            splits: int | None = self.first
            while splits is not None and self._ran(splits):
                splits = self._next
            outcome = self._stated()
            if out is not None:
                for file in self._place(self.counted, self.done[self.counted - 1].repeats).iterdir():
                    if file.is_file() and file.name not in ("scene.toml", STAMP):
                        file.replace(out / file.name)
                outcome.write(out / "outcome.json")
                write_digests(out, BESIDE)
        return outcome

    def _begin(self, out: Path) -> None:
        """Make the directory ready for a new run, or go on with what an interrupted one left there."""
        if not (self.options.resume and is_resumable(out)):
            begin(self.scene, out)
        elif read_text(out / "scene.toml") != to_toml(self.scene):
            raise ResultError(
                f"{out / 'scene.toml'}: is another scene than the one that is to go on. Go on with that one, "
                "or leave out --resume: the older run is kept beside the new one."
            )

    def pilot(self) -> Case:
        """Return the case of the first level.

        Raises
        ------
        SceneError
            Finite elements cannot compute the scene.
        """
        return Case.of(self._at(self.first), "solid", self._expected(self.first))

    @cached_property
    def first(self) -> int:
        """Splits of the pilot: two fewer than those of a stated size, of two levels one; else none or one."""
        expected, rod = self._expected(0).rod, self._bodies.rod
        # a side that lands is a polygon of slices where its cells are not split, and slices cannot touch
        of_side = rod.own_mesh is None and expected.touched[:, 2].max() > SLICES * rod.diameter
        least = int(of_side and not rod.is_ball)
        if self._is_sized:
            return max(least, self._usual - (JUMP if self.scene.accuracy.levels > JUMP else 1))
        return max(least, min(1, self._wanted(patch_radius(expected)) - 1))

    @property
    def finest(self) -> int:
        """Splits of the last level: as stated, or those that resolve the contact that the levels found.

        As many levels as wanted reach it, or it is not reached: the contact of a sharp edge is narrower on
        each finer mesh.
        """
        levels = self.scene.accuracy.levels
        if self._is_sized or not self.done:
            wanted = self._usual
        else:  # levels that were asked for are run, however well the pilot resolves its contact
            wanted = max(self._wanted(patch_radius(self.done[-1].record.rod)), self.done[0].splits + 1)
        least = self.first + (0 if self._is_sized else min(levels, LEVELS) - 1)
        more = max(levels - LEVELS, 0) if self._is_sized else levels - LEVELS
        return min(max(wanted + more, least), self.first + JUMP * max(levels - 2, 0) + 1)

    @property
    def _next(self) -> int | None:
        """Splits of the next level; None after the last, or where the budget does not hold another."""
        ran, finest, record = self.done[-1].splits, self.finest, self.done[-1].record
        if not (record.resolved or self._is_sized) and len(self.done) < self.scene.accuracy.levels + MORE:
            finest = max(finest, ran + 1)
        if ran >= finest or record.crushed:  # smaller cells are crushed sooner
            return None
        then = finest if finest - ran == 1 else min(ran + JUMP, finest - 1)
        forecast_s, spent_s = self._forecast_s(then), self._spent_s
        if spent_s + forecast_s <= self.budget_s:
            return then
        self._tell(
            f"Level {len(self.done) + 1} would take about {about_s(forecast_s)}; {about_s(spent_s)} of the "
            f"budget of {about_s(self.budget_s)} are used up: the run ends with level {len(self.done)}."
        )
        return None

    @property
    def counted(self) -> int:
        """The number, from 1, of the level whose outcome counts: the finest that saw the bodies part.

        It is the last one where none did.
        """
        parted = [n for n, one in enumerate(self.done, 1) if not isinstance(one.outcome.motion.V_n, Unknown)]
        return parted[-1] if parted else len(self.done)

    @property
    def scene(self) -> Scene:
        """The scene as stated."""
        return self.case.scene

    @property
    def _bodies(self) -> Bodies:
        return self.case.bodies

    @cached_property
    def _cells(self) -> tuple[float, float]:
        """Edges, m, of the unsplit cells of rod and barrier where they touch."""
        return rod_cell(self._bodies), body_cell(self._bodies)

    @cached_property
    def _splits(self) -> tuple[int, int]:
        """Splits of rod and barrier that resolve the contact estimated, or that the stated size asks for."""
        return levels_of(self._bodies)

    @property
    def _usual(self) -> int:
        return self._splits[1] if self._bodies.contact.compliant else self._splits[0]

    @property
    def _is_sized(self) -> bool:
        return self.scene.accuracy.tip_size is not None

    @property
    def _spent_s(self) -> float:
        return sum(level.outcome.cost.whole_wall * (1 + level.repeats) for level in self.done)

    def _forecast_s(self, splits: int) -> float:
        """Return about the wall time, s, of a level, from how much longer each took than that before."""
        times = [level.outcome.cost.whole_wall for level in self.done]
        steps = [level.splits for level in self.done]
        slower = (times[-1] / times[-2]) ** (1 / (steps[-1] - steps[-2])) if len(times) > 1 else SLOWER
        return float(times[-1] * max(slower, 1.0) ** (splits - steps[-1]))

    def _wanted(self, radius: float) -> int:
        """Return the splits with which so many cells as advised lie over a contact's radius, m."""
        base = self._cells[1] if self._bodies.contact.compliant else self._cells[0]
        return max(0, round(log2(base / level_size(self._bodies, radius))))

    def _at(self, splits: int) -> Scene:
        """Return the scene on cells that are split so often; rod and barrier are split alike."""
        sizes = zip(self._cells, self._splits, strict=True)
        rod, barrier = (cell / 2 ** (usual + splits - self._usual) for cell, usual in sizes)
        # a user's cells may be larger than a scene may state: they are left as they are
        accuracy = replace(self.scene.accuracy, tip_size=min(rod, self.scene.projectile.diameter / 4))
        if self._bodies.contact.compliant:
            accuracy = replace(accuracy, barrier_size=barrier)
        return replace(self.scene, accuracy=accuracy)

    def _expected(self, splits: int) -> ContactRecord:
        """Return what may touch on cells that are split so often."""
        more = splits - self._usual
        sizes = zip(self._cells, self._splits, strict=True)
        return expected_record(self._bodies, *(cell / 2 ** max(0, usual + more) for cell, usual in sizes))

    def _ran(self, splits: int) -> bool:
        """Run a level; return whether it has an outcome, which the first must have."""
        try:
            self._run_level(splits)
        except (SceneError, RunError) as error:  # a mesh that folds is found when it is made
            if not self.done:
                raise
            self.failed = str(error)
            return False
        return True

    def _run_level(self, splits: int) -> None:
        """Run a level, again with more room where it needs that, and add it to what is done."""
        last = bool(self.done) and splits >= self.finest
        scene = self._at(splits)
        before = known = self.done[-1].record if self.done else self._expected(splits)
        if not last:  # a coarse level tells all it finds
            accuracy = replace(scene.accuracy, unresolved="report")
            scene = replace(scene, accuracy=accuracy, save=replace(scene.save, frames=0, strain_samples=0))
        for repeats in range(MOST_REPEATS + 1):
            case = Case.of(scene, "solid", before)
            outcome, record = self._simulated(case, before, self._options(splits, repeats))
            ended = outcome.validity.finished
            if not record.left or record.crushed or (ended and not last) or repeats == MOST_REPEATS:
                break
            known = record if ended else known
            before = known.wider(2.0 ** (repeats + 1))  # a record has the room of a first run
        size = contact_edge(case.bodies)  # as it came out, which is not always as asked for
        self.done.append(LevelRun(splits, size, case, outcome, record, repeats))

    def _simulated(
        self, case: Case, before: ContactRecord, options: RunOptions
    ) -> tuple[Outcome, ContactRecord]:
        """Return outcome and record of a level, from its files where it ran before it was resumed."""
        computed = f"{stamp(case.scene)}record {before.digest()}\n"
        out = options.out
        if out is not None and options.resume and (out / STAMP).is_file():
            if read_text(out / STAMP) == computed and (out / "outcome.json").is_file():
                return Outcome.read(out / "outcome.json"), ContactRecord.read(out / RECORD)
            options = replace(options, resume=read_text(out / STAMP) == computed)
        if out is not None:
            out.mkdir(parents=True, exist_ok=True)
            write_text(out / STAMP, computed)
        outcome, record = simulate_recorded(case.scene, "solid", options, case)
        assert record is not None, "finite elements leave a record"
        return outcome, record

    def _place(self, number: int, repeats: int) -> Path:
        """Return the directory of a level, counted from 1, run again so often with more room."""
        assert self.options.out is not None, "files are wanted"
        return self.options.out / (f"level-{number}-wider-{repeats}" if repeats else f"level-{number}")

    def _options(self, splits: int, repeats: int) -> RunOptions:
        """Return the options of the next level, whose progress names it and knows about later ones."""
        number, show = len(self.done) + 1, self.options.progress
        out = self.options.out and self._place(number, repeats)
        if show is None:
            return replace(self.options, out=out)
        later = range(splits + 1, max(self.finest, splits) + 1)
        name = f"{self.scene.id}, level {number}" + f" of {number + len(later)}" * bool(self.done)

        def named(progress: Progress | Notice) -> None:
            if isinstance(progress, Notice):
                return show(progress)
            rest = sum(map(self._forecast_s, later)) if self.done else 0.0
            eta = None if progress.eta_s is None or not self.done else progress.eta_s + rest
            show(replace(progress, note=name, eta_s=eta))

        return replace(self.options, out=out, progress=named)

    def _tell(self, sentence: str) -> None:
        if self.options.progress is not None:
            self.options.progress(Notice(sentence))

    def _stated(self) -> Outcome:
        """Return the outcome of the level that counts, of the scene as stated, with limits and bands."""
        upto = self.done[: self.counted]
        counted, beyond = upto[-1], self.done[self.counted :]
        meshes = [MeshRuns(level.size, [level.outcome]) for level in upto]
        banded = len(meshes) > 1 and counted.record.resolved
        limits, bands = level_limits(meshes, upto[-2].record.resolved) if banded else (UNRESOLVED, UNRESOLVED)
        left = (
            f"Contact or flow left the zones held ready, after {counted.repeats} repeats with more room."
            if counted.record.left
            else ""
        )
        radius = patch_radius(counted.record.rod)
        wanted = self._wanted(radius) - counted.splits
        short = (
            f"The contact, {2e3 * radius:.2g} mm wide, would be resolved as advised by cells halved "
            f"{wanted} times more: give a larger accuracy.levels or --budget."
            if wanted > 0 and (counted.splits < self.finest or not self._is_sized)
            else ""
        )
        cut = beyond[0].outcome.validity.stopped_because if beyond else self.failed
        ended = f"The numbers are those of level {len(upto)}: level {len(upto) + 1} was cut off. {cut}"
        outcome = self._without_unresolved(counted)
        validity = replace(
            outcome.validity,
            mesh_limit=limits,
            mesh_band=bands,
            limitations=(
                *outcome.validity.limitations,
                *limitations("run", ended if cut else ""),
                *limitations("resolution", left, short),
            ),
        )
        return replace(
            outcome,
            validity=validity,
            provenance=replace(outcome.provenance, scene_digest=digest(self.scene)),
        )

    def _without_unresolved(self, counted: LevelRun) -> Outcome:
        """Return a level's outcome without the numbers that a scene withholds where they are not resolved."""
        outcome = counted.outcome
        if counted.record.resolved or self.scene.accuracy.unresolved == "report":
            return outcome
        reasons = [one.text for one in outcome.validity.limitations if one.text.startswith(NOT_RESOLVED)]
        return without(outcome, Unknown(reasons[0])) if reasons else outcome
