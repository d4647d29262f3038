"""Verdicts: how often ``assess`` decides within its budget, and is right by finer meshes, over drawn scenes.

The scenes are those of the study of coverage, as many of each family as of every other. A scene that was
decided, surely or probably, runs again with a twin that cannot vibrate, on two levels of meshes more than the
verdict had.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import chain, zip_longest
from typing import Any

from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.answers.verdict.assess import BUDGET, SURE, TOLERANCE
from fem_impact.answers.verdict.vibration import PROBABLY
from fem_impact.evidence.studies.coverage.families import FAMILIES
from fem_impact.evidence.studies.coverage.run import ASSESS, CHECK, MOST, CoverageResult, CoverageRun
from fem_impact.evidence.studies.coverage.scenes import DrawnScene, drawn
from fem_impact.jobs.job import Failure
from fem_impact.tables.table import Cell, Table

SEED = 20261601
COUNT, QUICK_COUNT = 50, 3
GROUPS = len(FAMILIES) + 2
"""Families, with the twelve bodies and the scenes that hardly yield."""
FINER = 2
"""Levels that a check has more than its verdict; one by the reduced model counts as of one level."""
JUDGED = ("right", "wrong")
BY = ("by", "answer", "judged")
COLUMNS = (
    *("scene", "family", "barrier", "answer", "by", "levels", "change", "half-width", "wall_s", "cpu_s"),
    *("truth", "its half-width", "judged", "clear", "tried", "missing", "next"),
)
LEGEND = (
    "Every scene: change, of e by vibration, as assess told it; by, the model that it rests on, with so many "
    "levels of finite elements tried; truth, the change by two levels more; clear, whether that one alone "
    "decides"
)
Results = Mapping[str, CoverageResult | Failure]


def scenes(request: Request) -> list[DrawnScene]:
    """Return the scenes: the first of each family, the second of each, and so on."""
    count = QUICK_COUNT if request.quick else GROUPS * request.first or COUNT
    rounds, families = -(-count // GROUPS), dict[str, list[DrawnScene]]()
    for one in drawn(max(rounds, 2), rounds, request.seed or SEED):
        families.setdefault(one.family, []).append(one)
    return [one for one in chain.from_iterable(zip_longest(*families.values())) if one][:count]


def plan(request: Request, results: Results) -> list[CoverageRun]:
    """Return the verdicts, and after them the checks of those that were decided; none where quick."""
    runs = [CoverageRun(scene, ASSESS) for scene in scenes(request)]
    checks = [] if request.quick else [_check(run.drawn, results) for run in runs]
    return [*runs, *(check for check in checks if check)]


def _check(scene: DrawnScene, results: Results) -> CoverageRun | None:
    result = results.get(CoverageRun(scene, ASSESS).name)
    if not isinstance(result, CoverageResult) or not _side(result.verdict.get("answer", "")):
        return None
    return CoverageRun(scene, CHECK, max(result.verdict["levels"], 1) + FINER)


def _side(answer: str) -> str:
    """Return the answer that a sure or a probable one gives, empty of any other."""
    return next((side for side in SURE if answer in (side, PROBABLY[side])), "")


def conclude(request: Request, results: Results) -> StudyReport:
    """Return how many were decided, how many of these finer meshes confirm, and every scene."""
    rows = [dict(zip(COLUMNS, _row(scene, results), strict=True)) for scene in scenes(request)]
    sure = [row for row in rows if row["answer"] in SURE]
    lacking = [row for row in rows if row not in sure]
    probable = [row for row in lacking if _side(str(row["answer"]))]
    decided = [*sure, *probable]
    unchecked, clear = (Counter(str(row[name]) for row in decided) for name in ("judged", "clear"))
    counts = ", ".join(
        f"{count} {name}" for name, count in Counter(row["answer"] for row in rows).most_common()
    )
    sentences = [
        f"Within its {BUDGET:g} s, assess decided {_share(len(decided), len(rows))}, of these {len(sure)} "
        f"surely and {len(probable)} probably: {counts}.",
        f"{FINER} levels more say the same of {_confirmed(decided)} of the decided, {_confirmed(sure)} of "
        f"the sure and {_confirmed(probable)} of the probable ones; in {clear['no']} the half-width of the "
        "finer run leaves the answer open, and its value counts.",
        f"{unchecked['not checked']} were decided and not checked: the finer run takes more than "
        f"{MOST[CHECK]:g} s or tells no number.",
        f"Its change lies within the half-width that was told of {_held(decided, 'modal')} by the reduced "
        f"model and of {_held(decided, 'solid')} by finite elements.",
    ]
    counted = [(*at, n) for at, n in Counter(tuple(row[name] for name in BY) for row in decided).items()]
    shown, words = [*COLUMNS[:-3]], ["scene", "answer", *COLUMNS[-3:]]
    return StudyReport(
        "verdicts",
        "How often assess decides, and is right",
        sentences,
        sheets=[
            Sheet("by", "What was decided", Table.of((*BY, "scenes"), counted, left=(0, 1, 2))),
            Sheet("undecided", "What was not decided, or not surely", _table(words, lacking)),
            Sheet("scenes", LEGEND, _table(shown, rows)),
        ],
        assumptions=[
            f"Scenes drawn with seed {request.seed or SEED}, on which no told error rests. A change of e by "
            f"{TOLERANCE:g} may be neglected.",
            "The truth is a finer run of the same program: it knows no error that all meshes share.",
        ],
        conclusions=[("", sentence) for sentence in sentences],
    )


def _table(columns: Sequence[str], rows: Sequence[Mapping[str, Cell]]) -> Table:
    return Table.of(columns, [[row[name] for name in columns] for row in rows], left=range(5))


def _row(scene: DrawnScene, results: Results) -> tuple[Cell, ...]:
    """Return what became of a scene, by `COLUMNS`."""
    place, run = (scene.name, scene.family, scene.group), results.get(CoverageRun(scene, ASSESS).name)
    if not isinstance(run, CoverageResult) or not run.verdict:
        why = run.reason if run else "not run"
        return *place, "no answer", *[None] * 9, "", why.strip().splitlines()[-1], "", ""
    v, check, judged = run.verdict, _check(scene, results), ""
    truth: tuple[Cell, ...] = None, None, "", ""
    if check:
        found = results.get(check.name)
        truth = None, None, "not checked", ""
        if isinstance(found, CoverageResult) and "e" in found.changes:
            value, half = found.changes["e"]
            judged = JUDGED[SURE[abs(value) > TOLERANCE] != _side(v["answer"])]
            truth = value, half, judged, SURE[abs(abs(value) - TOLERANCE) <= half]
    change = run.changes.get("e", (None, None))
    told = v["answer"], v["model"], v["levels"], *change, run.wall_s, run.cpu_s
    return *place, *told, *truth, v["tried"], v["missing"], v["next"]


def _confirmed(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return of how many of those checked the finer run says the same."""
    right, wrong = (sum(row["judged"] == judged for row in rows) for judged in JUDGED)
    return _share(right, right + wrong)


def _held(rows: Sequence[Mapping[str, Any]], by: str) -> str:
    """Return of how many changes by a model the half-width holds that of the finer run."""
    told = [row for row in rows if row["by"] == by and row["truth"] is not None]
    return _share(sum(abs(row["truth"] - row["change"]) <= row["half-width"] for row in told), len(told))


def _share(count: int, of: int) -> str:
    """Return a count with its share and 95 % Wilson interval."""
    from scipy.stats import binomtest

    if not of:
        return "0 of 0"
    wilson = binomtest(count, of).proportion_ci(method="wilson")
    return f"{count} of {of} ({100 * wilson.low:.0f} to {100 * wilson.high:.0f} %)"
