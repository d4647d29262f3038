"""Ladder of causes: the readings of strength switched on one after the other, and each alone.

A measured set runs at its default mesh, first with the nominal tensile law of both steels and no rate effect,
then with the nominal rate law, with flow stress from hardness, and with a hardened skin. Tensile law and rate
are the nominal inputs; the others are readings that no source made nominal (docs/explanation/inputs.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.answers.compare import MEASURED
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.studies.sets import QUICK
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load, replace_all
from fem_impact.tables.table import Cell, Table
from rigid.experiments import Statistic, measured_set

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


SETS = ("t5b", "t6-17")  # by default: the short rod in slow drops, at 45 and at 17 degrees
SHOWN = MEASURED[:3]  # e, mu, Omega
BASE = "tensile, no rate"
SKIN = {"surface.skin_depth": "0.11 mm", "surface.skin_factor": 1.5}
SLOW = {"effects": ["auto", "-rate-hardening"]}


@dataclass(frozen=True, slots=True)
class Cause:
    """A reading of the strength: name, what it is, and the changed keys of a scene without it."""

    name: str
    description: str
    changes: dict[str, Any]


CAUSES = (
    Cause("rate", "the nominal rate law of both steels", {}),
    Cause(
        "hardness",
        "flow stress of both steels from their hardness instead of their ultimate stress: another reading",
        {"projectile.material.law": "hardness", "barrier.material.law": "hardness"},
    ),
    Cause(
        "skin",
        "a layer of 0.11 mm with 1.5 times the flow stress on both bodies: depth and factor are from memory, "
        "no source could be read",
        SKIN,
    ),
)
STEPS = {
    BASE: (),
    **{("+ " if n else "") + c.name: CAUSES[: n + 1] for n, c in enumerate(CAUSES)},
    **{f"{c.name} alone": (c,) for c in CAUSES[1:]},
}
"""Causes that are on in each run; the first alone is the second step of the ladder."""
LADDER = tuple(STEPS)[: len(CAUSES) + 1]
ALONE = (LADDER[1], *tuple(STEPS)[len(CAUSES) + 1 :])


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return one job a set and step."""
    coarse = {**(QUICK if request.quick else {}), "save.frames": 0}
    return [
        Job(f"{name}: {step}", _changed(replace_all(load(name), coarse), causes))
        for name in _sets(request)
        for step, causes in STEPS.items()
    ]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: results of every step beside the measured ones."""
    runs = {
        name: {step: run for step in STEPS if isinstance(run := results[f"{name}: {step}"], Outcome)}
        for name in _sets(request)
    }
    complete = {name: found for name, found in runs.items() if len(found) == len(STEPS)}
    sentences = [_sentence(name, found) for name, found in complete.items()]
    return StudyReport(
        "causes",
        "Ladder of causes: what rate, hardness and skin do, one after the other and alone",
        [_answer(complete), *sentences] if complete else ["No set has all its runs: see those that failed."],
        [_picture(complete)] if complete else (),
        [_sheet(complete)],
        [
            "One run a step, all on the same mesh at one place of the barrier's grid: no band of meshes.",
            *(f"{cause.name}: {cause.description}." for cause in CAUSES),
            "sliding speed: friction that falls with the speed has no law with constants that could be read, "
            "so it is no step here (docs/explanation/inputs.md).",
            "Friction stays nominal. Nothing is chosen or changed after these runs.",
        ],
        conclusions=[("causes", sentence) for sentence in sentences],
    )


def _sets(request: Request) -> tuple[str, ...]:
    return request.ids or (SETS[:1] if request.quick else SETS)


def _changed(scene: Scene, causes: Sequence[Cause]) -> Scene:
    """Return the scene with these causes on and the others off."""
    changes: dict[str, Any] = {} if CAUSES[0] in causes else dict(SLOW)
    for cause in causes:
        changes |= cause.changes
    return replace_all(scene, changes)


def _statistics(name: str) -> list[Statistic]:
    """Return the measured means and 95 % intervals of `SHOWN`."""
    found = measured_set(name).statistics()
    return [found[str(quantity.measured)] for quantity in SHOWN]


def _sheet(runs: dict[str, dict[str, Outcome]]) -> Sheet:
    rows: list[tuple[Cell, ...]] = []
    for name, found in runs.items():
        for quantity, measured in zip(SHOWN, _statistics(name), strict=True):
            values = (known(quantity.key.of(found[step])) for step in STEPS)
            rows.append((name, quantity.name, *values, measured.mean, measured.low, measured.high))
    head = ("set", "quantity", *STEPS, "measured", "measured low", "measured high")
    return Sheet("causes", "Results by step; measured mean and its 95 % interval", Table.of(head, rows))


def _picture(runs: dict[str, dict[str, Outcome]]) -> Picture:
    """Return a panel a set and quantity: the ladder, each cause alone, and the measured interval."""
    panels, places = [], np.arange(len(LADDER), dtype=float)
    for name, found in runs.items():
        for quantity, measured in zip(SHOWN, _statistics(name), strict=True):
            values = {step: known(quantity.key.of(run)) for step, run in found.items()}
            half = np.full(len(places), measured.high - measured.mean)
            mean = np.full(len(places), measured.mean)
            series = (
                Series("measured mean, 95 %", places, mean, "dashed", 1, half),
                Series("one after the other", places, [values[step] for step in LADDER], "joined", 0),
                Series("each alone", places[1:], [values[step] for step in ALONE], "diamonds", 5),
            )
            label = quantity.name + (f", {quantity.key.unit}" if quantity.key.unit != "-" else "")
            panels.append(Panel(name, "strength", label, series, names=LADDER))
    caption = "e, mu and Omega as causes are added one after the other, each alone, and as measured."
    return Picture("causes", caption, tuple(panels), len(SHOWN))


def _answer(runs: dict[str, dict[str, Outcome]]) -> str:
    """Return the cause that changes each quantity of each set most, alone."""
    parts = []
    for name, found in runs.items():
        for quantity in SHOWN:
            base = known(quantity.key.of(found[BASE]))
            changes = {
                c.name: known(quantity.key.of(found[s])) - base for c, s in zip(CAUSES, ALONE, strict=True)
            }
            most = max(changes, key=lambda cause: abs(changes[cause]))
            parts.append(f"{quantity.name} of {name} by {most} ({changes[most]:+.2g})")
    return f"Each alone, most changes {', '.join(parts)}."


def _sentence(name: str, found: dict[str, Outcome]) -> str:
    """Return what each cause changes alone, beside what lacks without any of them."""
    parts = []
    for quantity, measured in zip(SHOWN, _statistics(name), strict=True):
        base = known(quantity.key.of(found[BASE]))
        changes = ", ".join(
            f"{cause.name} {known(quantity.key.of(found[step])) - base:+.2g}"
            for cause, step in zip(CAUSES, ALONE, strict=True)
        )
        together = known(quantity.key.of(found[LADDER[-1]])) - base
        lacks = f"{quantity.name} {base:.3g}, {measured.mean - base:+.2g} to the measured mean"
        parts.append(f"{lacks}: {changes}, all {together:+.2g}")
    return f"{name}, without any of them and by each alone: {'; '.join(parts)}."
