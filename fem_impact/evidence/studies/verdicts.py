"""Verdicts: how often ``assess`` decides within its budget, and is right by finer meshes, over drawn scenes.

The scenes are those of the study of coverage, as many of each family as of every other. A scene that was
decided runs again with a twin that cannot vibrate, on two levels of meshes more than the verdict had.
"""

import hashlib
import json
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from itertools import chain, pairwise, zip_longest
from pathlib import Path

import pandas

from fem_impact.answers.refine.forecast import MIDDLE
from fem_impact.answers.refine.level import LevelRun
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.answers.verdict.assess import BUDGET, TOLERANCE, assess
from fem_impact.answers.verdict.levels import by_levels, next_step
from fem_impact.answers.verdict.vibration import Answer, VibrationEffect, solid_effect, twins, untargeted
from fem_impact.errors import FemImpactError, ResultError
from fem_impact.evidence.studies.coverage.families import FAMILIES
from fem_impact.evidence.studies.coverage.scenes import DrawnScene, drawn
from fem_impact.jobs.job import Failure, JobKind
from fem_impact.run.program import source_digest
from fem_impact.scene.types import Scene
from fem_impact.tables.table import Cell, Table

OWN_SEED = 20261601
COUNT, QUICK_COUNT = 50, 3
GROUPS = len(FAMILIES) + 2  # with the twelve bodies and the scenes that hardly yield
FINER = 2  # levels more than those of the verdict; one by the reduced model alone counts as of one level
MOST_S = 180.0  # of a finer run: its budget, and the forecast up to which it is begun


@dataclass(frozen=True, slots=True)
class VerdictResult:
    """A verdict, or what finer meshes say.

    Attributes
    ----------
    answer : yes, no or undecided; empty where there is none, for the reason ``why``
    value, band : change of e by vibration and its half-width
    fidelity : modal or solid
    levels_s : processor time, s, of each level of finite elements
    steps, notes, missing, next : as of `fem_impact.answers.verdict.assess.Verdict`, and what to type next
    cpu_s, wall_s : processor and wall time of all of it, s
    """

    answer: str = ""
    value: float = 0.0
    band: float = 0.0
    fidelity: str = "solid"
    levels_s: tuple[float, ...] = ()
    steps: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    missing: str = ""
    next: str = ""
    why: str = ""
    cpu_s: float = 0.0
    wall_s: float = 0.0

    @property
    def decided(self) -> bool:
        """Whether the answer is yes or no."""
        return self.answer in ("yes", "no")

    @property
    def levels(self) -> int:
        """Levels of the run that judges the verdict; 0 where none does."""
        level_s = self.levels_s[-1] if self.levels_s else 0.0
        dear = level_s * sum(MIDDLE**more for more in range(1, FINER + 1)) > MOST_S
        return max(len(self.levels_s), 1) + FINER if self.decided and not dear else 0


@dataclass
class _Clock:
    """Keeps the processor time at which each level of finite elements ended."""

    at: list[float] = field(default_factory=lambda: [time.process_time()])

    def __call__(self, said: str) -> None:
        if said.startswith("finite elements, level"):
            self.at.append(time.process_time())
        elif len(self.at) == 1:  # what comes before the first level
            self.at[0] = time.process_time()


@dataclass(frozen=True, slots=True)
class _Fine:
    """A change by finite elements, and whether the levels are as many as were asked for."""

    effect: VibrationEffect
    enough: bool

    def answer(self, limit: float) -> Answer:
        """Say undecided until the levels are enough."""
        return "yes" if self.enough else "undecided"


@dataclass(frozen=True, slots=True)
class VerdictRun:
    """A drawn scene assessed as by a user, or on so many ``levels`` of finite elements."""

    drawn: DrawnScene
    levels: int = 0

    @property
    def name(self) -> str:
        """Name of the scene and of what is computed."""
        return f"{self.drawn.name}: {f'{self.levels} levels' if self.levels else 'assess'}"

    @property
    def key(self) -> str:
        """Digest of scene, levels, times and program."""
        stated = json.dumps([asdict(self.drawn), self.levels, BUDGET, MOST_S], sort_keys=True)
        return hashlib.sha256(f"{stated} {source_digest()}".encode()).hexdigest()

    @property
    def fidelity(self) -> str:
        """What is computed, by which times compare."""
        return "levels" if self.levels else "assess"

    @property
    def kind(self) -> JobKind:
        """What is computed; the mesh is the run's own affair."""
        return self.fidelity, 0.0

    @property
    def planned_s(self) -> float:
        """Expected processor time, s."""
        return MOST_S / 2 if self.levels else BUDGET

    def run(self) -> str:
        """Return the `VerdictResult` as JSON; an error of whatever kind is a result."""
        cpu, wall = time.process_time(), time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            try:
                scene = self.drawn.scene(Path(folder))
                result = self._finer(scene) if self.levels else _assessed(scene)
            except FemImpactError as error:
                result = VerdictResult(why=str(error).replace(folder, "."))
        spent = {"cpu_s": time.process_time() - cpu, "wall_s": time.perf_counter() - wall}
        return json.dumps(asdict(result) | spent)

    def read(self, text: str) -> VerdictResult:
        """Return the result from its JSON text; raises ResultError where that is damaged."""
        try:
            kept = json.loads(text)
            return VerdictResult(
                **kept | {name: tuple(kept[name]) for name in ("levels_s", "steps", "notes")}
            )
        except (ValueError, TypeError, KeyError) as error:
            raise ResultError(f"{self.name}: its stored result is damaged ({error}).") from error

    def cpu_s(self, result: VerdictResult) -> float:
        """Return the processor time of a result, s."""
        return result.cpu_s

    def _finer(self, scene: Scene) -> VerdictResult:
        """Return what the levels say, undecided where the budget does not hold all of them."""

        def estimate(levels: Sequence[LevelRun]) -> _Fine | None:
            effect = solid_effect([level.runs for level in levels])
            return effect and _Fine(effect, len(levels) >= self.levels)

        steps, clock, pair = list[str](), _Clock(), twins(untargeted(scene))
        found, notes, _ = by_levels(
            pair, estimate, lambda fine: fine.effect.told, TOLERANCE, (MOST_S, 1), clock, steps
        )
        if found is None:
            return VerdictResult(steps=tuple(steps), notes=tuple(notes), why=" ".join(notes))
        value, ran = found.effect.value, tuple(after - at for at, after in pairwise(clock.at))
        answer = ("yes" if abs(value) <= TOLERANCE else "no") if found.enough else "undecided"
        return VerdictResult(answer, value, found.effect.band, "solid", ran, tuple(steps), tuple(notes))


def _assessed(scene: Scene) -> VerdictResult:
    """Return the verdict within the budget that a user has unless he states one."""
    clock = _Clock()
    v = assess(scene, tell=clock)
    ran = tuple(after - at for at, after in pairwise(clock.at))
    after = next_step("fem-impact assess", v.more) or ""
    told = v.steps, v.notes, v.missing, after
    return VerdictResult(v.answer, v.here.value, v.here.band, v.fidelity, ran, *told)


Results = Mapping[str, VerdictResult | Failure]


def scenes(request: Request) -> list[DrawnScene]:
    """Return the scenes: the first of each family, the second of each, and so on."""
    count = QUICK_COUNT if request.quick else GROUPS * request.first or COUNT
    rounds = -(-count // GROUPS)
    families = dict[str, list[DrawnScene]]()
    for one in drawn(max(rounds, 2), rounds, request.seed or OWN_SEED):
        families.setdefault(one.family, []).append(one)
    turns = chain.from_iterable(zip_longest(*families.values()))
    return [one for one in turns if one is not None][:count]


def plan(request: Request, results: Results) -> list[VerdictRun]:
    """Return the verdicts, and after them the finer runs that they call for; none where quick."""
    runs = [VerdictRun(scene) for scene in scenes(request)]
    if request.quick:
        return runs
    found = [(run, results.get(run.name)) for run in runs]
    finer = (
        VerdictRun(run.drawn, result.levels) for run, result in found if isinstance(result, VerdictResult)
    )
    return [*runs, *(run for run in finer if run.levels)]


def conclude(request: Request, results: Results) -> StudyReport:
    """Return how many were decided, how many of these finer meshes confirm, and every scene."""
    every = scenes(request)
    rows = [_row(scene, results) for scene in every]
    table = pandas.DataFrame(rows, columns=COLUMNS)
    decided, checked = table["answer"].isin(("yes", "no")), table["judged"].isin(("right", "wrong"))
    right, open_still = table["judged"] == "right", table["clear"] == "no"
    tried = ", ".join(f"{name} {count}" for name, count in table["answer"].value_counts().items())
    sentences = [
        f"Decided within {BUDGET:g} s: {_share(int(decided.sum()), len(table))} ({tried}).",
        f"Right by {FINER} levels more: {_share(int(right.sum()), int(checked.sum()))} of those decided; "
        f"{int((decided & ~checked).sum())} more were decided and not checked, as a finer run takes more than "
        f"{MOST_S:g} s or tells no number. In {int((checked & open_still).sum())} the half-width of the finer "
        "run leaves the answer open, and its value counts.",
    ]
    by = table.groupby(["by", "answer"], sort=True)["judged"].value_counts().unstack(fill_value=0)
    counts = Table.of(
        ("by", "answer", *map(str, by.columns)),
        [(*at, *row) for at, row in zip(by.index, by.to_numpy().tolist(), strict=True)],
        left=(0, 1),
    )
    words = ["scene", "answer", "tried", "missing", "next"]
    lacking = Table.of(words, table.loc[~decided, words].to_numpy().tolist(), left=range(len(words)))
    shown = [name for name in COLUMNS if name not in words[2:]]
    return StudyReport(
        "verdicts",
        "How often assess decides, and is right",
        sentences,
        [],
        [
            Sheet("verdicts", "By what the answer rests on", counts),
            Sheet("undecided", "What was not decided", lacking),
            Sheet("scenes", "Every scene", Table.of(shown, table[shown].to_numpy().tolist(), left=(0, 1, 2))),
        ],
        [
            f"Scenes drawn with seed {request.seed or OWN_SEED}, on which no told error rests. A change of e by "
            f"{TOLERANCE:g} may be neglected; assess has its own budget of {BUDGET:g} s of wall time.",
            "The truth is a finer run of the same program: it knows no error that all meshes share.",
        ],
        conclusions=[("", sentence) for sentence in sentences],
    )


COLUMNS = (
    *("scene", "family", "barrier", "answer", "by", "change", "half-width", "levels", "cpu_s", "wall_s"),
    *("truth", "its half-width", "judged", "clear", "tried", "missing", "next"),
)


def _row(scene: DrawnScene, results: Results) -> tuple[Cell, ...]:
    """Return what became of a scene, by `COLUMNS`."""
    v = _known(results, VerdictRun(scene))
    finer = _known(results, VerdictRun(scene, v.levels)) if v.levels else VerdictResult()
    judged = "" if not v.decided else "not checked"
    if finer.decided:
        judged = "right" if finer.answer == v.answer else "wrong"
    clear = "yes" if abs(abs(finer.value) - TOLERANCE) > finer.band else "no"
    told = (v.value, v.band, len(v.levels_s)) if v.answer else (None, None, None)
    truth = (finer.value, finer.band, judged, clear) if finer.decided else (None, None, judged, "")
    words = "; ".join(v.steps[-1:] + v.notes[-1:]) or v.why, v.missing, v.next
    by = v.fidelity if v.answer else ""
    place = scene.name, scene.family, scene.group
    return *place, v.answer or "none", by, *told, v.cpu_s, v.wall_s, *truth, *words


def _known(results: Results, run: VerdictRun) -> VerdictResult:
    found = results.get(run.name, VerdictResult())
    return VerdictResult(why=found.reason) if isinstance(found, Failure) else found


def _share(count: int, of: int) -> str:
    """Return a count with its share and 95 % Wilson interval."""
    from scipy.stats import binomtest

    if not of:
        return "0 of 0"
    wilson = binomtest(count, of).proportion_ci(method="wilson")
    return f"{count} of {of} ({100 * wilson.low:.0f} to {100 * wilson.high:.0f} %)"
