"""The measured sets, each on two meshes, beside the experiments."""

from __future__ import annotations

import json
import time
from collections.abc import Iterable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field, replace
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.compare import Row, compare, text_table
from fem_impact.outcome import Outcome
from fem_impact.output import COMPARISON, make_directory, write_table, write_text
from fem_impact.progress import CaseProgress
from fem_impact.scene import MEASURED_SETS, load, replace_all
from fem_impact.study.bands import bands
from fem_impact.study.cases import Case, Failure, compute, stored
from fem_impact.study.markdown import summary
from fem_impact.study.present import present
from fem_impact.study.sensitivity import INPUTS, explanations, sensitivity_cases, sensitivity_rows

if TYPE_CHECKING:
    from fem_impact.progress import Meter

Results = dict[str, Outcome | Failure]

SCHEMA = "fem-impact/study/1"
QUICK_TIP = 0.6e-3  # m
COARSER = 2.0  # tip size of the second mesh over that of the first


@dataclass(frozen=True, slots=True)
class StudyResult:
    """Outcomes as plain rows, the comparison, its text table, what failed, what could not be drawn."""

    rows: list[dict[str, Any]]
    comparison: list[Row]
    table: str
    failures: list[dict[str, str]]
    notes: list[str] = field(default_factory=list)


def cases_of(set_id: str, quick: bool, out: Path) -> dict[str, Case]:
    """Return the set's case, its coarser twin and, unless quick, that with each uncertain input changed."""
    scene = load(set_id)
    if quick:
        scene = replace_all(scene, {"accuracy.tip_size": f"{QUICK_TIP * 1e3:g} mm"})
    size = COARSER * scene.accuracy.tip_size
    coarse = replace_all(scene, {"accuracy.tip_size": f"{size * 1e3:g} mm", "save.frames": 0})
    twin = Case(coarse, out / f"{set_id}-coarse")
    return {"fine": Case(scene, out / set_id), "coarse": twin} | ({} if quick else sensitivity_cases(twin))


def run_sets(
    ids: Iterable[str],
    quick: bool,
    out: Path,
    progress: Meter,
    workers: int,
    executor: Executor | None = None,
    films: bool = True,
) -> StudyResult:
    """Compute measured sets and compare them.

    Parameters
    ----------
    ids : set ids; all 13 when empty
    quick : coarse tips, for a first look
    out : study directory; finished cases in it are not computed again
    progress : told after every case
    workers : processes, one thread each
    executor : any other executor to run the cases in
    films : make a film of each set as well
    """
    chosen = list(ids) or list(MEASURED_SETS)
    cases = {name: cases_of(name, quick, out) for name in chosen}
    make_directory(out)
    done = run_cases(
        [case for group in cases.values() for case in group.values()], progress, workers, executor
    )
    failed = [f for f in done.values() if isinstance(f, Failure)]
    failures = [{"scene_id": f.case.out.name, "error": f.reason} for f in failed]
    outcomes, changed = [], []
    for name in chosen:
        found = {kind: done[case.out.name] for kind, case in cases[name].items()}
        if isinstance(found["fine"], Outcome):
            outcomes.append(with_bands(found["fine"], found["coarse"], out / name))
        if not quick:
            changed += sensitivity_rows(found["coarse"], {i.name: found[i.name] for i in INPUTS})
    result = write_study(outcomes, failures, changed, out)
    notes = present([out / o["scene_id"] for o in outcomes], out, progress, films)
    return replace(result, notes=notes)


def with_bands(fine: Outcome, coarse: Outcome | Failure, out: Path) -> Outcome:
    """Return the outcome with its two-mesh bands, and store it."""
    if isinstance(coarse, Failure):
        return fine.replace(reasons={"bands": f"the coarser mesh failed: {coarse.reason}"})
    if coarse["tip_size_m"] <= fine["tip_size_m"]:
        return fine.replace(
            reasons={"bands": "the second mesh is not coarser: give a smaller accuracy.tip_size"}
        )
    banded = fine.replace(bands=bands(fine, coarse))
    banded.write(out / "outcome.json")
    return banded


def run_cases(cases: list[Case], progress: Meter, workers: int, executor: Executor | None = None) -> Results:
    """Return the result of every case by the name of its directory; stored ones are read."""
    results: Results = {}
    for case in cases:
        found = stored(case)
        if found is not None:
            results[case.out.name] = found
    waiting = [case for case in cases if case.out.name not in results]
    if waiting:
        owned = executor or ProcessPoolExecutor(min(workers, len(waiting)), mp_context=get_context("spawn"))
        try:
            _collect({owned.submit(compute, case): case for case in waiting}, results, len(cases), progress)
        finally:
            if executor is None:
                owned.shutdown(cancel_futures=True)
    return results


def _collect(futures: dict[Future[Any], Case], results: Results, total: int, progress: Meter) -> None:
    begun, first = time.monotonic(), len(results)
    for future in as_completed(futures):
        case = futures[future]
        results[case.out.name] = _result(future, case)
        done = len(results)
        eta = (time.monotonic() - begun) / (done - first) * (total - done)
        progress(CaseProgress(case.out.name, done, total, eta))


def _result(future: Future[Any], case: Case) -> Outcome | Failure:
    try:
        failure: Failure | None = future.result()
    except BrokenExecutor as error:
        return Failure(case, f"its process died: {error}")
    return failure or stored(case) or Failure(case, "its result cannot be read back")


def write_study(
    outcomes: list[Outcome], failures: list[dict[str, str]], changed: list[Row], out: Path
) -> StudyResult:
    """Write study.json, comparison.csv and summary.md, and return the study."""
    comparison = [row for outcome in outcomes for row in compare(outcome)]
    explained = explanations(comparison, changed)
    rows = [outcome.to_dict() for outcome in outcomes]
    document = {
        "schema": SCHEMA,
        "rows": rows,
        "comparison": comparison,
        "sensitivity": changed,
        "explanations": explained,
        "failures": failures,
        "notes": [],
    }
    write_text(out / "study.json", json.dumps(document, indent=1, allow_nan=False))
    write_table(out / "comparison.csv", COMPARISON, comparison)
    write_text(out / "summary.md", summary(rows, comparison, changed, explained))
    table = "\n".join([text_table(comparison), *(f"failed: {f['scene_id']}: {f['error']}" for f in failures)])
    return StudyResult(rows, comparison, table, failures)
