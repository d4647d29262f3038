"""The reduced model beside the finite elements: measured sets, calibration, scenes it was not read from.

Its table `beside` is what every outcome of the reduced model is judged by: a copy stands in
``fem_impact/case/data/reduced.csv``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.studies.reduced_scenes import CALIBRATION, COUNT, design, scene_of
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.keys import Key, Unknown
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS, Scene
from fem_impact.tables.table import Cell, Table

QUICK_COUNT = 4
MODELS = ("modal", "solid")
KEYS = {
    "e": (KEY_TABLE["e_edge"],),
    "mu": (KEY_TABLE["mu"],),
    "Omega": (KEY_TABLE["Omega_rad_per_s"],),
    "E_vib": (KEY_TABLE["E_vib_over_E_0"],),
    "skin": (KEY_TABLE["W_friction_over_E_0"], KEY_TABLE["W_skin_barrier_over_E_0"]),
}
"""Compared quantities, sums of their keys. The harder rod has no plastic work in the reduced model."""
HEAD = ("name", "group", *(f"{name}_{model}" for name in KEYS for model in MODELS))
NEAR_E, NEAR_VIBRATION, OF_VIBRATION = 0.06, 0.003, 0.25  # what counts as near: of e, of E_0, of itself
Row = tuple[Cell, ...]


def scenes(quick: bool) -> list[tuple[str, Scene]]:
    """Return group and scene of every pair of runs: measured sets, calibration, Latin hypercube."""
    drawn = design(QUICK_COUNT if quick else COUNT)
    hypercube = [("hypercube", scene_of(row, f"reduced-{i}")) for i, row in enumerate(drawn)]
    if quick:
        return hypercube
    measured = [("measured", replace_all(load(name), {"save.frames": 0})) for name in MEASURED_SETS]
    read_from = [("calibration", scene_of(row, f"calibration-{i}")) for i, row in enumerate(CALIBRATION)]
    return [*measured, *read_from, *hypercube]


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return both runs of every scene."""
    return [
        Job(f"{scene.id}-{model}", scene, model) for _, scene in scenes(request.quick) for model in MODELS
    ]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: every scene by both models, and how many are near."""
    rows = [
        row
        for group, scene in scenes(request.quick)
        if (row := _row(group, scene.id, [results[f"{scene.id}-{model}"] for model in MODELS]))
    ]
    return study_report(rows)


def _row(group: str, name: str, runs: Sequence[object]) -> Row | None:
    """Return the quantities of a scene by both models; None where one of them failed."""
    outcomes = [run for run in runs if isinstance(run, Outcome)]
    if len(outcomes) < len(MODELS):
        return None
    return (name, group, *(_sum(keys, run) for keys in KEYS.values() for run in outcomes))


def _sum(keys: Sequence[Key], run: Outcome) -> float | None:
    values = [key.of(run) for key in keys]
    return None if any(isinstance(value, Unknown) for value in values) else float(sum(values))


def study_report(rows: Sequence[Row]) -> StudyReport:
    """Return the study of rows with the columns `HEAD`."""
    sentences = [_near(rows, group) for group in _groups(rows)]
    panels = tuple(_panel(rows, name) for name in KEYS)
    return StudyReport(
        "reduced",
        "The reduced model beside the finite elements",
        sentences,
        [Picture("beside", "Each scene by both models; on the line they agree.", panels)] if rows else (),
        [Sheet("beside", "Every scene by both models", Table.of(HEAD, rows))],
        ["Finite elements on one mesh: its error is part of the difference."],
        [],
        [("beside", sentence) for sentence in sentences],
    )


def _groups(rows: Sequence[Row]) -> list[str]:
    return list(dict.fromkeys(str(row[1]) for row in rows))


def _column(rows: Sequence[Row], name: str) -> np.ndarray:
    return np.array([row[HEAD.index(name)] for row in rows], dtype=float)


def _near(rows: Sequence[Row], group: str) -> str:
    """Return how many scenes of a group are near in e and in vibration, and the median differences."""
    own = [row for row in rows if row[1] == group]
    e, vibration = (
        np.abs(_column(own, f"{name}_modal") - _column(own, f"{name}_solid")) for name in ("e", "E_vib")
    )
    close = vibration <= np.maximum(NEAR_VIBRATION, OF_VIBRATION * _column(own, "E_vib_solid"))
    return (
        f"{group}: e within {NEAR_E:g} in {int((e <= NEAR_E).sum())} of {len(own)} scenes, vibration within "
        f"{OF_VIBRATION:.0%} or {NEAR_VIBRATION:g} of E_0 in {int(close.sum())}, both in "
        f"{int(((e <= NEAR_E) & close).sum())}; median difference of e {np.median(e):.3f}, of vibration "
        f"{np.median(vibration):.4f} of E_0."
    )


def _panel(rows: Sequence[Row], name: str) -> Panel:
    """Return one quantity by both models, a colour a group."""
    series = []
    for group in _groups(rows):
        own = [row for row in rows if row[1] == group]
        both = _column(own, f"{name}_solid"), _column(own, f"{name}_modal")
        series.append(Series(group, *both, "points"))
    ends = np.array([np.nanmin(_column(rows, f"{name}_solid")), np.nanmax(_column(rows, f"{name}_solid"))])
    unit = KEYS[name][0].unit
    label = name if unit in ("", "-", "1") else f"{name}, {unit}"
    return Panel(
        name, f"finite elements, {label}", f"reduced model, {label}", (*series, Series("equal", ends, ends))
    )
