"""One scene with values varied in all combinations: table, figures, report, and a store to go on from."""

import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from fem_impact.answers.report import Request, Sheet, StudyReport, StudyResult, publish
from fem_impact.answers.simulate import compiled, simulate
from fem_impact.answers.sweep_results import (
    HIGH,
    LOW,
    SHORT,
    Results,
    SweepRow,
    known_bands,
    require_columns,
    row_of,
)
from fem_impact.answers.vary import Variation, cases, in_unit, listed, measure
from fem_impact.case.effects.heating import why_off
from fem_impact.errors import FemImpactError, UsageError, did_you_mean
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.files.atomic import checksum, directory_lock, make_directory
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.job import STORE, Failure, Job
from fem_impact.jobs.run import run_jobs
from fem_impact.options import FIDELITIES
from fem_impact.outcome.record import KEY_TABLE, KEYS, ends_of
from fem_impact.outcome.shares import HEATS, heat_ends
from fem_impact.progress import Notice, ProgressMeter, watched
from fem_impact.scene.shipped import named
from fem_impact.scene.types import Scene, digest, require_scene
from fem_impact.tables.text import plain

FIDELITY = "modal"
"""Fidelity of a sweep unless stated: a run takes some ten milliseconds."""

SHOWN = {
    "e_edge": "coefficient of restitution e",
    "mu": "impulse ratio mu",
    "Omega_rad_per_s": "Omega, rad/s",
    "E_vib_over_E_0": "vibration over E_0",
}
"""Columns that are drawn, with the labels of their axes."""
EXPLAINED = (
    "`sweep.csv` holds every number of each outcome after the varied keys; `e_edge` is e at the point of the "
    "tip that touches first; `fem-impact schema` explains every other column."
)
MOST_CURVES, MOST_ROWS = 8, 50
UNMESHED = (
    "accuracy = {:.3g} % is for finite elements: the {} model, which has no mesh to refine, leaves it out "
    "(fidelity solid keeps it)"
)
CELLS = ("tip_size_m", "barrier_size_m")
FRICTION = "friction_f"


def sweep(
    scene: Scene,
    vary: Mapping[str, Iterable[Any]],
    fidelity: str = FIDELITY,
    out: str | Path | None = None,
    workers: int = 1,
    progress: ProgressMeter | None = None,
    executor: Executor | None = None,
    columns: Sequence[str] = (),
    line: str = "",
) -> Results:
    """Compute a scene with values varied in all combinations, each case as a run of its own would.

    Parameters
    ----------
    scene : Scene
    vary : values by key, such as ``{"impact.angle": ["15 deg", "30 deg"], "surface.friction": [0.2, 0.4]}``;
        arrays of numpy and columns of pandas too
    fidelity : rigid, modal or solid; an error that the scene asks for is that of finite elements alone
    out : directory for sweep.csv, figures, summary.md, study.json, and the store of the outcomes, from which
        a second call goes on; None: nothing is kept
    workers : runs at a time; more than one start processes, so call from under ``if __name__ == "__main__":``
    progress : told before the runs which columns cannot be filled, and after each run how long the rest
        takes; None shows that in IPython and notebooks, `fem_impact.silent` nothing
    executor : where the runs are done instead, such as what `fem_impact.jobs.executors.on_scheduler` lends
    columns : numbers that the summary shows and draws; `SHORT` where none are named
    line : the command line that made it, for the summary

    Returns
    -------
    Results
        One row a case; a case that cannot run is a row with its reason. Finite elements run on levels, and
        their numbers have half-widths.

    Raises
    ------
    UsageError, SceneError
        Before any run: the fidelity is unknown, nothing varies, or no combination is a scene.
    OutputPathError
        ``out`` cannot be written, or another process writes to it.

    Examples
    --------
    >>> from fem_impact.scene.shipped import load
    >>> found = sweep(load("t5b"), {"impact.angle": ["15 deg", "30 deg"]}, "rigid")
    >>> found.numbers("Omega_rad_per_s").round(1).tolist()
    [-5.9, -4.1]
    """
    require_scene(scene)
    if fidelity not in FIDELITIES:
        hint = did_you_mean(fidelity, FIDELITIES, f"Use one of {', '.join(FIDELITIES)}.")
        raise UsageError("is not a fidelity.", key="fidelity=", value=fidelity, remedy=hint)
    require_columns(columns)
    vary, asked = listed(vary), scene.accuracy.target
    with watched(progress) as meter, tempfile.TemporaryDirectory() as spare:
        if asked is not None and fidelity != "solid":
            meter(Notice(UNMESHED.format(100 * asked, fidelity)))
            scene = scene.untargeted
        every = cases(scene, vary)
        for sentence in _unfilled(every, fidelity, columns or SHORT):
            meter(Notice(sentence))
        jobs = [
            Job(case.name, case.scene, fidelity, way=simulate) for case in every if case.scene is not None
        ]
        place = Path(out) if out is not None else Path(spare)
        make_directory(place)
        # an executor that is lent stays open; one run at a time needs no other process
        local = ThreadPoolExecutor(1) if workers == 1 else LocalProcesses(workers)
        with directory_lock(place), nullcontext(executor) if executor else local as engine:
            done = run_jobs(jobs, place / STORE, meter, engine)
            results = Results(vary, tuple(row_of(case, done.get(case.name)) for case in every))
            if out is not None:
                publish_sweep(results, scene.title, line, place, columns, cases_digest(every, fidelity))
    return results


def _unfilled(every: Sequence[Variation], fidelity: str, columns: Sequence[str]) -> list[str]:
    """Return which columns no case can fill, with the reason, as known before any run."""
    scene = next(case.scene for case in every if case.scene is not None)
    try:
        if fidelity != "solid":
            reasons = simulate(scene, fidelity).reasons
        elif "contact-heating" in (case := compiled(scene, "solid")).active:
            reasons = {}
        else:
            reasons = {key.name: why_off(case.bodies) for key in KEYS if key.path[0] == "heat"}
    except FemImpactError:
        return []  # its row says why
    groups: dict[str, list[str]] = {}
    for name in columns:
        if name in reasons:
            groups.setdefault(reasons[name].rstrip("."), []).append(name)
    return [f"not known in this sweep: {', '.join(names)} ({why})" for why, names in groups.items()]


def cases_digest(every: Sequence[Variation], fidelity: str) -> str:
    """Return the SHA-256 of what a sweep computes: its scenes, however their numbers were written."""
    scenes = [str(case.values) if case.scene is None else digest(case.scene) for case in every]
    return checksum({"scenes": scenes, "fidelity": fidelity})


def publish_sweep(
    results: Results, title: str, line: str, out: Path, columns: Sequence[str] = (), cases: str = ""
) -> StudyResult:
    """Write table, figures with their data, summary and study.json of a sweep; Parquet where it can be.

    The table has every column; the summary shows ``columns``, `SHORT` where none are named. A report in
    ``out`` of a sweep with other ``cases`` (`cases_digest`) is set aside.
    """
    drawn = [name for name in columns if KEY_TABLE[name].kind == "number"] if columns else list(SHOWN)
    runs = {row.case.name: row.outcome or Failure(row.case.name, row.reason) for row in results}
    effects = {name for row in results if row.outcome for name in row.outcome.provenance.effects}
    whole, brief = results.table(), results.brief(columns)
    caption = "All cases" if len(whole) <= MOST_ROWS else f"The first {MOST_ROWS} of {len(whole)} cases"
    report = StudyReport(
        "sweep",
        f"Sweep: {title}",
        [
            *_findings(results, drawn),
            *_not_known(results, columns or SHORT),
            *_no_error(results, columns or SHORT),
            *_differing(results),
            EXPLAINED,
        ],
        pictures=_pictures(results, drawn),
        sheets=[Sheet("sweep", caption, whole, brief=replace(brief, rows=brief.rows[:MOST_ROWS]))],
        sources=sorted(effects),
    )
    published = publish(report, Request(out, line=line, cases=cases), runs)
    if find_spec("pyarrow"):
        results.to_dataframe().to_parquet(out / "sweep.parquet")
    return published


def _not_known(results: Results, columns: Sequence[str]) -> list[str]:
    """Return which columns are not known in which cases, with the reason in the first of them."""
    reasons = {row.case.name: row.outcome.reasons for row in results if row.outcome}
    groups: dict[tuple[tuple[str, ...], str], list[str]] = {}
    for name in columns:
        cases = tuple(case for case, why in reasons.items() if name in why)
        if cases:
            groups.setdefault((cases, reasons[cases[0]][name].rstrip(".")), []).append(f"`{name}`")
    sentences = []
    for (cases, why), names in groups.items():
        where = f"{len(cases)} of {len(reasons)} cases, the first of them {cases[0]}"
        where = "any case" if len(cases) == len(reasons) else where
        sentences.append(f"Not known in {where}: {', '.join(names)} ({why}).")
    return sentences


def _no_error(results: Results, columns: Sequence[str]) -> list[str]:
    """Return that the work that can heat the contact has no half-width, and between what it lies."""
    ends = {row.case.name: heat_ends(row.outcome) for row in results if row.outcome}
    first = next((name for name, told in ends.items() if told), "")
    if HEATS.name not in columns or not first:
        return []
    return [f"`{HEATS.name}` has no half-width: in {first} {ends[first]}."]


def _differing(results: Results) -> Iterator[str]:
    """Yield what else than the varied keys differs from case to case: cells of the meshes, friction."""
    ends = []
    for name in CELLS:
        sizes = results.numbers(name)
        if np.isfinite(sizes).any() and np.nanmax(sizes) > (1 + 1e-6) * np.nanmin(sizes):
            ends.append(f"`{name}` {1e3 * np.nanmin(sizes):.3g} to {1e3 * np.nanmax(sizes):.3g} mm")
    if ends:
        yield (
            f"The cells of the meshes differ between the cases ({', '.join(ends)}), as they follow the "
            "scene: a part of each difference is the mesh's. State accuracy.tip_size for equal cells."
        )
    values = results.numbers(FRICTION)
    if any(key.startswith("surface") for key in results.vary) or not np.isfinite(values).any():
        return
    low, high = np.nanmin(values), np.nanmax(values)
    if high - low >= 1e-6:
        yield (
            f"The friction differs between the cases (`{FRICTION}` {low:.3g} to {high:.3g}), as it follows "
            "the pair of materials: a part of each difference is the friction's. State surface.friction for "
            "an equal one."
        )


def _findings(results: Results, drawn: Sequence[str]) -> list[str]:
    """Return how many cases failed, and where each drawn quantity is smallest and largest."""
    failed = sum(row.outcome is None for row in results)
    sentences = [f"{len(results)} cases of {', '.join(results.vary)}; {failed} failed."]
    for name in drawn:
        values, label = results.numbers(name), SHOWN.get(name, name)
        if np.isfinite(values).any():
            ends = (int(np.nanargmin(values)), int(np.nanargmax(values)))
            low, high = (f"{results.rows[at].told(name)} ({_stated(results.rows[at])})" for at in ends)
            titled = f"{label[0].upper()}{label[1:]} (`{name}`)" if name in SHOWN else f"`{name}`"
            sentences.append(f"{titled}: from {low} to {high}{_widest(results, name)}.")
    return sentences


def _widest(results: Results, name: str) -> str:
    """Tell cases whose half-width is larger than the range of the sweep: they tell little of what changes."""
    values, halves = results.numbers(name), {}
    for at, row in enumerate(results):
        half = known_bands(row.outcome).get(name) if row.outcome else None
        if half is not None and half > np.nanmax(values) - np.nanmin(values):
            halves[at] = half
    if not halves:
        return ""
    at = max(halves, key=lambda one: halves[one])
    return (
        f"; {len(halves)} of {len(results)} cases have a half-width larger than that range, the largest "
        f"{plain(halves[at], 2)} ({_stated(results.rows[at])})"
    )


def _stated(row: SweepRow, without: str = "") -> str:
    return ", ".join(f"{key} = {named(value)}" for key, value in row.case.values.items() if key != without)


def _pictures(results: Results, drawn: Sequence[str]) -> list[Picture]:
    """Return each drawn quantity over the key with most values, a curve for each choice of the others."""
    key = max(results.vary, key=lambda name: len(results.vary[name]))
    unit = measure(results.vary[key][0])[1]
    along = [in_unit(row.case.values[key], unit) for row in results]
    if len(results.vary[key]) < 2 or any(isinstance(x, str) for x in along):
        return []
    curves: dict[str, list[int]] = {}
    for at, row in enumerate(results):
        curves.setdefault(_stated(row, key) or "all", []).append(at)
    label = f"{key}, {unit}" if unit else key
    panels = [_panel(results, name, label, along, curves) for name in drawn]
    shown = tuple(panel for panel in panels if panel.series)
    omitted = "" if len(curves) <= MOST_CURVES else f" The first {MOST_CURVES} of {len(curves)} curves."
    return [Picture("sweep", f"What changes with {key}.{omitted}", shown)] if shown else []


def _panel(
    results: Results, name: str, label: str, along: list[Any], curves: Mapping[str, list[int]]
) -> Panel:
    values, series = results.numbers(name), []
    has_band = name + HIGH in results.table((name,)).names
    ends = [results.numbers(name + end) for end in (LOW, HIGH)] if has_band else []
    bands = np.maximum(values - ends[0], ends[1] - values) if ends else None  # one end may be cut
    for title, places in list(curves.items())[:MOST_CURVES]:
        known = [at for at in places if np.isfinite(values[at])]
        if known:
            band = None if bands is None else bands[known]
            x = [along[at] for at in known]
            series.append(Series(title, x, values[known], "joined", band=band, ends=ends_of(KEY_TABLE[name])))
    title = SHOWN.get(name, name)
    return Panel(title, label, title, tuple(series))
