"""One scene with values varied in all combinations: table, figures, report, and a store to go on from."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.errors import UsageError, did_you_mean
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.files.atomic import make_directory
from fem_impact.files.lock import directory_lock
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.job import Failure, Job
from fem_impact.jobs.run import run_jobs
from fem_impact.jobs.store import STORE
from fem_impact.options import FIDELITIES
from fem_impact.progress import NullMeter
from fem_impact.scene.types import Scene
from fem_impact.study.document import Request, Sheet, StudyReport, StudyResult, publish
from fem_impact.study.results import Results, Row, row_of
from fem_impact.study.vary import cases, in_unit, measure

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter


FIDELITY = "modal"
"""Fidelity of a sweep unless stated: a run takes some ten milliseconds."""

SHOWN = {
    "e_edge": "coefficient of restitution e",
    "mu": "impulse ratio mu",
    "Omega_rad_per_s": "Omega, rad/s",
    "E_vib_over_E_0": "vibration over E_0",
}
"""Columns that are drawn, with the labels of their axes."""
COLUMNS = (
    "In `sweep.csv` the varied keys come first; `e_edge` is e at the point of the tip that touches first; "
    "`fem-impact schema` explains every other column."
)
MOST_CURVES = 8


def sweep(
    scene: Scene,
    vary: Mapping[str, Sequence[Any]],
    fidelity: str = FIDELITY,
    out: str | Path | None = None,
    workers: int = 1,
    progress: ProgressMeter | None = None,
    executor: Executor | None = None,
) -> Results:
    """Compute a scene with values varied in all combinations.

    Parameters
    ----------
    scene : Scene
    vary : values by key, such as ``{"impact.angle": ["15 deg", "30 deg"], "surface.friction": [0.2, 0.4]}``
    fidelity : rigid, modal or solid
    out : directory with the store of the outcomes, from which a second call goes on; a temporary one if None
    workers : runs at a time; more than one start processes, so call from under ``if __name__ == "__main__":``
    progress : told after each run
    executor : where the runs are done instead, such as what `fem_impact.jobs.executors.on_scheduler` lends

    Returns
    -------
    Results
        One row a case; a case that cannot run is a row with its reason.

    Raises
    ------
    UsageError, SceneError
        Before any run: the fidelity is unknown, nothing varies, or no combination is a scene.
    OutputPathError
        ``out`` cannot be written, or another process writes to it.
    """
    if fidelity not in FIDELITIES:
        hint = did_you_mean(fidelity, FIDELITIES, f"Use one of {', '.join(FIDELITIES)}.")
        raise UsageError("is not a fidelity.", key="fidelity", value=fidelity, remedy=hint)
    made = cases(scene, vary)
    jobs = [Job(case.name, case.scene, fidelity) for case in made if case.scene is not None]
    with tempfile.TemporaryDirectory() as spare:
        place = Path(out) if out is not None else Path(spare)
        make_directory(place)
        # an executor that is lent stays open
        with directory_lock(place), nullcontext(executor) if executor else _engine(workers) as engine:
            found = run_jobs(jobs, place / STORE, progress or NullMeter(), engine)
    return Results(dict(vary), tuple(row_of(case, found.get(case.name)) for case in made))


def _engine(workers: int) -> Executor:
    """Return this process for one run at a time, else local processes."""
    return ThreadPoolExecutor(1) if workers == 1 else LocalProcesses(workers)


def publish_sweep(results: Results, title: str, line: str, out: Path) -> StudyResult:
    """Write table, figures with their data, summary and study.json of a sweep; Parquet where it can be."""
    runs = {row.case.name: row.outcome or Failure(row.case.name, row.reason) for row in results}
    effects = {name for row in results if row.outcome for name in row.outcome.provenance.effects}
    report = StudyReport(
        "sweep",
        f"Sweep: {title}",
        _findings(results),
        pictures=_pictures(results),
        sheets=[Sheet("sweep", "All cases", results.table(), shown=False)],
        sources=sorted(effects),
    )
    made = publish(report, Request(out, line=line), runs)
    if find_spec("pandas") and find_spec("pyarrow"):
        results.to_dataframe().to_parquet(out / "sweep.parquet")
    return made


def _findings(results: Results) -> list[str]:
    """Return how many cases failed, and where each shown quantity is smallest and largest."""
    failed = sum(row.outcome is None for row in results)
    sentences = [f"{len(results)} cases of {', '.join(results.vary)}; {failed} failed."]
    for name, label in SHOWN.items():
        values = results.numbers(name)
        if np.isfinite(values).any():
            ends = (int(np.nanargmin(values)), int(np.nanargmax(values)))
            low, high = (f"{values[at]:.4g} ({_stated(results.rows[at])})" for at in ends)
            sentences.append(f"{label[0].upper()}{label[1:]} (`{name}`): from {low} to {high}.")
    sentences.append(COLUMNS)
    return sentences


def _stated(row: Row, without: str = "") -> str:
    return ", ".join(f"{key} = {value}" for key, value in row.case.values.items() if key != without)


def _pictures(results: Results) -> list[Picture]:
    """Return each shown quantity over the key with most values, a curve for each choice of the others."""
    key = max(results.vary, key=lambda name: len(results.vary[name]))
    unit = measure(results.vary[key][0])[1]
    along = [in_unit(row.case.values[key], unit) for row in results]
    if len(results.vary[key]) < 2 or any(isinstance(x, str) for x in along):
        return []
    curves: dict[str, list[int]] = {}
    for at, row in enumerate(results):
        curves.setdefault(_stated(row, key) or "all", []).append(at)
    label = f"{key}, {unit}" if unit else key
    panels = [_panel(results, name, label, along, curves) for name in SHOWN]
    drawn = tuple(panel for panel in panels if panel.series)
    left_out = "" if len(curves) <= MOST_CURVES else f" The first {MOST_CURVES} of {len(curves)} curves."
    return [Picture("sweep", f"What changes with {key}.{left_out}", drawn)] if drawn else []


def _panel(
    results: Results, name: str, label: str, along: list[Any], curves: Mapping[str, list[int]]
) -> Panel:
    values, series = results.numbers(name), []
    for title, places in list(curves.items())[:MOST_CURVES]:
        known = [at for at in places if np.isfinite(values[at])]
        if known:
            series.append(Series(title, [along[at] for at in known], values[known], "joined"))
    return Panel(SHOWN[name], label, SHOWN[name], tuple(series))
