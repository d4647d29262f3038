"""The measured sets, each on two meshes, beside the experiments."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.cost.limits import mesh_limits
from fem_impact.files.atomic import write_text
from fem_impact.jobs.job import Failure, Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import Key, Unknown, known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import shares
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.study.compare import Row, compare, text_table
from fem_impact.study.document import Request, StudyResult, failures_of
from fem_impact.study.inputs import INPUT_CHANGES, WORDS, explanations, sensitivity_jobs, sensitivity_rows
from fem_impact.tables.csv import COMPARISON, write_table
from fem_impact.tables.markdown import table

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter

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


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Compare the sets with the measurements; write study.json, tables, films and pages."""
    out, outcomes, changed = request.out, [], []
    for name in chosen(request):
        found = {kind: results[job.name] for kind, job in jobs_of(name, request.quick, out).items()}
        if isinstance(found["fine"], Outcome):
            outcomes.append(with_limits(found["fine"], found["coarse"], out / name))
        if not request.quick:
            changed += sensitivity_rows(found["coarse"], {i.name: found[i.name] for i in INPUT_CHANGES})
    document, text = write_study(outcomes, failures_of(results), changed, out)
    folders = [out / outcome.provenance.scene_id for outcome in outcomes]
    return StudyResult(document, text, tuple(folders))


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


COMPARED = ("e", "mu", "Omega", "E_ln/E_0", "E_lt/E_0", "E_r/E_0")


def summary(
    outcomes: Sequence[Outcome], comparison: list[Row], changed: list[Row], explained: list[Row]
) -> str:
    """Return the tables, with those of the changed inputs if they were computed."""
    tables = [_beside(comparison), _shares(outcomes), *_limits(outcomes)]
    if changed:
        words = "\n".join(f"- `{name}`: {meaning}" for name, meaning in WORDS.items())
        tables += [_changes(changed), _explanations(explained), words]
    return "\n\n".join(tables) + "\n"


def _beside(comparison: list[Row]) -> str:
    cells = {(row["set"], row["quantity"]): _cell(row) for row in comparison if row["quantity"] in COMPARED}
    names = list(dict.fromkeys(row["set"] for row in comparison))
    return table(["set", *COMPARED], [[name, *(cells[name, q] for q in COMPARED)] for name in names])


def _cell(row: Row) -> str:
    """Return model +- band / measured mean +- SD, and a mark: bold inside, ? undecided, plain else."""
    digits = 1 if row["quantity"] == "Omega" else 3
    band = f" ± {row['band']:.{digits}f}" if row["band"] is not None else ""
    model = f"{row['model']:.{digits}f}{band}"
    measured = f"{row['measured_mean']:.{digits}f} ± {row['measured_sd']:.{digits}f}"
    if row["verdict"] == "inside":
        return f"**{model}** / {measured}"
    return f"{model} / {measured}{' ?' if row['verdict'].startswith('undecided') else ''}"


def _shares(outcomes: Sequence[Outcome]) -> str:
    listed = shares("report")
    head = ["set", *(f"{share.label}, %" for share in listed), "residual", "steps", "CPU s"]
    body = [
        [
            o.provenance.scene_id,
            *(_percent(o, share.key) for share in listed),
            f"{o.energy.residual:.0e}",
            f"{known(o.cost.steps)}",
            f"{o.cost.cpu:.0f}",
        ]
        for o in outcomes
    ]
    return table(head, body)


def _limits(outcomes: Sequence[Outcome]) -> list[str]:
    """Return a row a set with two meshes: limits of e and E_vib, how uncertain, what the finer took."""
    head = ["set", "e, limit", "of e, %", "E_vib / E_0, %, limit", "of E_vib, %", "CPU s"]
    body = []
    for o in (o for o in outcomes if or_none(o.validity.mesh_band)):
        limits, bands = known(o.validity.mesh_limit), known(o.validity.mesh_band)
        (e, e_band), (vib, vib_band) = ((limits[k], bands[k]) for k in ("e_edge", "E_vib_over_E_0"))
        of = [f"{100 * band / abs(value):.2g}" for value, band in ((e, e_band), (vib, vib_band))]
        cells = [f"{e:.3f} ± {e_band:.3f}", of[0], f"{100 * vib:.3f} ± {100 * vib_band:.3f}", of[1]]
        body.append([o.provenance.scene_id, *cells, f"{o.cost.cpu:.0f}"])
    return [table(head, body)] if body else []


def _percent(outcome: Outcome, key: Key) -> str:
    value, band = outcome.estimate(key)
    share = or_none(value)
    if share is None:
        return "–"
    digits = 2 if abs(100 * share) < 10 else 1
    return f"{100 * share:.{digits}f}" + (f" ± {100 * band:.{digits}f}" if band is not None else "")


def _changes(changed: list[Row]) -> str:
    """Return a row a set and quantity: its value on the coarser mesh and what each input changes."""
    found: dict[tuple[str, str], dict[str, Row]] = {}
    for row in changed:
        found.setdefault((row["set"], row["quantity"]), {})[row["input"]] = row
    body = [
        [*key, f"{next(iter(of.values()))['base']:.3g}", *(_change(of.get(name)) for name in WORDS)]
        for key, of in found.items()
    ]
    return table(["set", "quantity", "coarser mesh", *WORDS], body)


def _change(row: Row | None) -> str:
    return "" if row is None else f"{row['changed'] - row['base']:+.2g}"


def _explanations(explained: list[Row]) -> str:
    """Return a row a quantity that lies outside: what alone could bring it in, and what cannot."""
    head = ["set", "quantity", "model", "measured", "could explain it", "cannot"]
    body = [
        [
            row["set"],
            row["quantity"],
            f"{row['model']:.3g}",
            f"{row['measured_mean']:.3g}",
            ", ".join(row["could"]) or "none of these",
            ", ".join(f"{name} ({s:+.0%})" for name, s in row["shares"].items() if name not in row["could"]),
        ]
        for row in explained
    ]
    return table(head, body)
