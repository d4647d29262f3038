"""The measured sets, each on two meshes, beside the experiments."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.compare import Row, compare, text_table
from fem_impact.cost.limits import mesh_limits
from fem_impact.outcome import Outcome, Unknown, known
from fem_impact.output import COMPARISON, write_table, write_text
from fem_impact.scale import Failure, Job, Results
from fem_impact.scene import MEASURED_SETS, load, replace_all
from fem_impact.study.markdown import summary
from fem_impact.study.present import present
from fem_impact.study.request import Request, StudyResult, failures_of
from fem_impact.study.sensitivity import INPUTS, explanations, sensitivity_jobs, sensitivity_rows

if TYPE_CHECKING:
    from fem_impact.progress import Meter

__all__ = ["conclude", "jobs_of", "plan"]

SCHEMA = "fem-impact/study/1"
QUICK_TIP = 0.6e-3  # m
QUICK_FRAMES = 60  # half the usual
QUICK_SETS = ("t3-machined", "t4", "t5b")
COARSER = 2.0  # tip size of the second mesh over that of the first


def jobs_of(set_id: str, quick: bool, out: Path) -> dict[str, Job]:
    """Return the set's job, its coarser twin and, unless quick, that with each uncertain input changed."""
    scene = load(set_id)
    if quick:
        size = f"{QUICK_TIP * 1e3:g} mm"
        scene = replace_all(scene, {"accuracy.tip_size": size, "save.frames": QUICK_FRAMES})
    coarser = f"{COARSER * scene.accuracy.tip_size * 1e3:g} mm"
    coarse = replace_all(scene, {"accuracy.tip_size": coarser, "save.frames": 0})
    twin = Job(f"{set_id}-coarse", coarse, out=out / f"{set_id}-coarse")
    return {"fine": Job(set_id, scene, out=out / set_id), "coarse": twin} | (
        {} if quick else sensitivity_jobs(twin, out)
    )


def chosen(request: Request) -> tuple[str, ...]:
    """Return the sets that are asked for: all of them, or one of each rod for a first look."""
    return request.ids or (QUICK_SETS if request.quick else MEASURED_SETS)


def plan(request: Request, results: Results) -> list[Job]:
    """Return the jobs of the measured sets."""
    groups = (jobs_of(name, request.quick, request.out) for name in chosen(request))
    return [job for group in groups for job in group.values()]


def conclude(request: Request, results: Results, progress: Meter) -> StudyResult:
    """Compare the sets with the measurements; write study.json, tables, films and pages."""
    out, outcomes, changed = request.out, [], []
    for name in chosen(request):
        found = {kind: results[job.name] for kind, job in jobs_of(name, request.quick, out).items()}
        if isinstance(found["fine"], Outcome):
            outcomes.append(with_limits(found["fine"], found["coarse"], out / name))
        if not request.quick:
            changed += sensitivity_rows(found["coarse"], {i.name: found[i.name] for i in INPUTS})
    document, text = write_study(outcomes, failures_of(results), changed, out)
    folders = [out / outcome.provenance.scene_id for outcome in outcomes]
    return StudyResult(document, text, present(folders, out, progress))


def with_limits(fine: Outcome, coarse: Outcome | Failure, out: Path) -> Outcome:
    """Return the outcome with the limits of two meshes and their bands, and store it."""
    if isinstance(coarse, Failure):
        return _without_limits(fine, f"the coarser mesh failed: {coarse.reason}")
    if known(coarse.cost.tip_size) <= known(fine.cost.tip_size):
        return _without_limits(fine, "the second mesh is not coarser: give a smaller accuracy.tip_size")
    limits, bands = mesh_limits([fine], [coarse])
    limited = replace(fine, validity=replace(fine.validity, mesh_limit=limits, mesh_band=bands))
    limited.write(out / "outcome.json")
    return limited


def _without_limits(fine: Outcome, reason: str) -> Outcome:
    missing = Unknown(reason)
    return replace(fine, validity=replace(fine.validity, mesh_limit=missing, mesh_band=missing))


def write_study(
    outcomes: list[Outcome], failures: list[dict[str, str]], changed: list[Row], out: Path
) -> tuple[dict[str, Any], str]:
    """Write study.json, comparison.csv and summary.md; return the document and its text table."""
    comparison: list[Row] = [row for outcome in outcomes for row in compare(outcome)]
    explained = explanations(comparison, changed)
    document = {
        "schema": SCHEMA,
        "rows": [outcome.to_dict() for outcome in outcomes],
        "comparison": comparison,
        "sensitivity": changed,
        "explanations": explained,
        "failures": failures,
        "notes": [],
    }
    write_text(out / "study.json", json.dumps(document, indent=1, allow_nan=False))
    write_table(out / "comparison.csv", COMPARISON, comparison)
    write_text(out / "summary.md", summary(outcomes, comparison, changed, explained))
    failed = (f"failed: {f['scene_id']}: {f['error']}" for f in failures)
    return document, "\n".join([text_table(comparison), *failed])
