"""Ladder of causes: the readings of strength switched on one after the other, and each alone.

What they are and what the ladder rests on: docs/explanation/inputs.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact import Scene, load, replace_all
from fem_impact.answers.compare import MEASURED, ComparedQuantity
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.studies.declared import DeclaredSweep, Runs, table_of
from fem_impact.evidence.studies.report_parts import rests_on
from fem_impact.evidence.studies.sets import QUICK
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.tables.table import Table
from rigid.experiments import Statistic, measured_set

if TYPE_CHECKING:
    import pandas


SETS = ("t5b", "t6-17")  # by default: the short rod in slow drops, at 45 and at 17 degrees
SHOWN = MEASURED[:3]  # e, mu, Omega
SLOW: dict[str, Any] = {"effects": ["auto", "-rate-hardening"]}
HARD = {f"{body}.material.law": "hardness" for body in ("projectile", "barrier")}
SKIN = {f"{body}.material.skin": {"factor": 1.5, "depth": "0.11 mm"} for body in ("projectile", "barrier")}
BASE = "tensile, no rate"
STEPS: dict[str, dict[str, Any]] = {
    BASE: SLOW,
    "rate": {},
    "+ hardness": HARD,
    "+ skin": HARD | SKIN,
    "hardness alone": SLOW | HARD,
    "skin alone": SLOW | SKIN,
}
"""Changed keys of the scene in each run."""
LADDER = tuple(STEPS)[:4]
ALONE = {"rate": "rate", "hardness": "hardness alone", "skin": "skin alone"}
"""The run in which a cause is on alone."""


def _scenes(request: Request) -> dict[str, Scene]:
    coarse = {**(QUICK if request.quick else {}), "save.frames": 0}
    names = request.ids or (SETS[:1] if request.quick else SETS)
    return {name: replace_all(load(name), coarse) for name in names}


def _report(runs: Runs) -> StudyReport:
    """Return what each cause changes in each set, beside the tests; a set with a failed run is left out."""
    table = table_of(runs, {quantity.name: quantity.key.of for quantity in SHOWN}, STEPS)
    sentences = [_sentence(name, row) for name, row in table.iterrows()]
    rows = [
        (name, q.name, *(row[q.name, step] for step in STEPS), measured.mean, measured.low, measured.high)
        for name, row in table.iterrows()
        for q, measured in _measured(name)
    ]
    head = ("set", "quantity", *STEPS, "measured", "measured low", "measured high")
    return StudyReport(
        "causes",
        "Ladder of causes: what rate, hardness and skin do, one after the other and alone",
        [_answer(table), *sentences] if rows else ["No set has all its runs: see those that failed."],
        [_picture(table)] if rows else (),
        [Sheet("causes", "Results by step; measured mean and its 95 % interval", Table.of(head, rows))],
        rests_on("causes"),
        conclusions=[("causes", sentence) for sentence in sentences],
    )


def _measured(name: str) -> list[tuple[ComparedQuantity, Statistic]]:
    """Return the shown quantities with the measured means and 95 % intervals of a set."""
    statistics = measured_set(name).statistics()
    return [(quantity, statistics[str(quantity.measured)]) for quantity in SHOWN]


def _picture(table: pandas.DataFrame) -> Picture:
    """Return a panel a set and quantity: the ladder, each cause alone, and the measured interval."""
    panels, places = [], np.arange(len(LADDER), dtype=float)
    for name, row in table.iterrows():
        for quantity, measured in _measured(name):
            values = row[quantity.name]
            half = np.full(len(places), measured.high - measured.mean)
            mean = np.full(len(places), measured.mean)
            series = (
                Series("measured mean, 95 %", places, mean, "dashed", 1, half),
                Series("one after the other", places, values[[*LADDER]].tolist(), "joined", 0),
                Series("each alone", places[1:], values[[*ALONE.values()]].tolist(), "diamonds", 5),
            )
            label = quantity.name + (f", {quantity.key.unit}" if quantity.key.unit != "-" else "")
            panels.append(Panel(name, "strength", label, series, names=LADDER))
    caption = "e, mu and Omega as causes are added one after the other, each alone, and as measured."
    return Picture("causes", caption, tuple(panels), len(SHOWN))


def _answer(table: pandas.DataFrame) -> str:
    """Return the readings that bring all three numbers of a set to the tests, and what changes each most."""
    parts, met = [], []
    for name, row in table.iterrows():
        largest = []
        for quantity in SHOWN:
            values = row[quantity.name]
            changes = {cause: values[step] - values[BASE] for cause, step in ALONE.items()}
            cause = max(changes, key=lambda cause: abs(changes[cause]))
            unit = "" if quantity.key.unit == "-" else f" {quantity.key.unit}"
            largest.append(f"{quantity.name} {changes[cause]:+.2g}{unit} ({cause})")
        parts.append(f"{name} {', '.join(largest)}")
        for step in STEPS:
            if all(m.low <= row[q.name][step] <= m.high for q, m in _measured(name)):
                met.append(f"{step} ({name})")
    return (
        f"{' and '.join(met) or 'None of these readings'} brings e, mu and Omega of a set into the 95 % "
        f"intervals of its tests. The largest changes by one of them alone: {'; '.join(parts)}."
    )


def _sentence(name: str, row: pandas.Series) -> str:
    """Return what each cause changes alone, beside what lacks without any of them."""
    parts = []
    for quantity, measured in _measured(name):
        values = row[quantity.name]
        base = values[BASE]
        changes = ", ".join(f"{cause} {values[step] - base:+.2g}" for cause, step in ALONE.items())
        lacks = f"{quantity.name} {base:.3g}, {measured.mean - base:+.2g} to the measured mean"
        parts.append(f"{lacks}: {changes}, all {values[LADDER[-1]] - base:+.2g}")
    return f"{name}, without any of them and by each alone: {'; '.join(parts)}."


_SWEEP = DeclaredSweep(
    _scenes,
    lambda _, scene: {step: (replace_all(scene, changes), "solid") for step, changes in STEPS.items()},
    _report,
    "{scene}: {variant}",
)
plan, conclude = _SWEEP.plan, _SWEEP.conclude
