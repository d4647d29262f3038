"""Table 3 beside its caption: what its own rows say about the tip of its rods.

The caption says tip B. Momentum alone binds the rotation of a rod to its velocities by the arms of the
contact point, and those differ between the tips; the finite elements run with both. The scenes with tip A
are a second reading: none of the thirteen sets, counted in none of their numbers
(docs/explanation/measured-sets.md).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fem_impact import Outcome, load
from fem_impact.answers.compare import MEASURED, compare
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.arrays import Array
from fem_impact.evidence.studies.sets import set_job
from fem_impact.jobs.job import Job, JobResults
from fem_impact.run.tests import tests_of
from fem_impact.tables.table import Cell, Table
from rigid.experiments import MeasuredSet, measured_set

SETS = ("t3-machined", "t3-contaminated", "t3-cleaned")
TIPS = {"B": "{}", "A": "{}-tip-a"}
"""Names of the scenes by tip."""
COUNTED = tuple(quantity.name for quantity in MEASURED)
Compared = Mapping[tuple[str, str], Mapping[str, Any]]
"""Rows of `compare` by set and quantity."""


@dataclass(frozen=True, slots=True)
class Reading:
    """Arms, m, and squared radius of gyration, m2, with which momentum gives the rotation."""

    name: str
    d_c: float
    d_d: float
    k2: float

    def rotation(self, measured: MeasuredSet) -> Array:
        """Return Omega (n,), rad/s, of the rows: k2 Omega = d_c dV_n - d_d dV_t (Eq 18 with e_m = -1)."""
        dV_n, dV_t = changes(measured)
        return np.asarray((self.d_c * dV_n - self.d_d * dV_t) / self.k2)

    @property
    def misfit(self) -> float:
        """Root mean square difference of the rotation from the measured one over all rows, rad/s."""
        off = [self.rotation(s) - s.motion["Omega"] for s in map(measured_set, SETS)]
        return float(np.sqrt(np.mean(np.concatenate(off) ** 2)))


def changes(measured: MeasuredSet) -> tuple[Array, Array]:
    """Return V_n - v_n and V_t - v_t (n,) of the rows, m/s."""
    m = measured.motion
    return np.asarray(m["V_n"] - m["v_n"]), np.asarray(m["V_t"] - m["v_t"])


def fitted_arms(sets: Sequence[MeasuredSet]) -> tuple[Array, Array]:
    """Return d_c, d_d (2,), m, that fit the rows' rotations by least squares, and their standard errors."""
    dV_n, dV_t = (np.concatenate(parts) for parts in zip(*map(changes, sets), strict=True))
    design = np.column_stack([dV_n, -dV_t])
    spin = np.concatenate([s.k2 * s.motion["Omega"] for s in sets])
    arms, (rest,), *_ = np.linalg.lstsq(design, spin)
    covariance = rest / (len(spin) - 2) * np.linalg.inv(design.T @ design)
    return np.asarray(arms), np.sqrt(np.diag(covariance))


def readings() -> tuple[Reading, ...]:
    """Return the arms by which Table 3 was worked out, and those of a rod with either tip."""
    printed, drawn = measured_set(SETS[0]), []
    for tip, name in TIPS.items():
        scene = load(name.format(SETS[0]))
        rod = scene.projectile.rigid_body
        d_c, d_d = rod.arms(scene.impact.angle)
        drawn.append(Reading(f"tip {tip}", float(d_c), float(d_d), float(rod.k2)))
    return Reading("as printed", float(printed.arms.d_c), float(printed.arms.d_d), printed.k2), *drawn


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the runs of Table 3 with either tip; of one set if quick."""
    return [set_job(TIPS[tip].format(name), request.quick) for tip in TIPS for name in _sets(request)]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: rotation by momentum alone, and finite elements with either tip."""
    rows: dict[str, Compared] = {tip: _compared(tip, request, results) for tip in TIPS}
    sentences = [*_momentum_sentences(), *_model_sentences(rows)]
    return StudyReport(
        "tip",
        "Table 3: tip A or tip B?",
        sentences,
        sheets=[_momentum_sheet(), _model_sheet(rows)],
        assumptions=["Tip A is shown beside the thirteen sets, which have tip B, and counted nowhere."],
        conclusions=[("", sentence) for sentence in sentences],
    )


def _sets(request: Request) -> tuple[str, ...]:
    return SETS[:1] if request.quick else SETS


def _compared(tip: str, request: Request, results: JobResults) -> Compared:
    """Return the counted quantities of the sets with a tip, beside the tests."""
    return {
        (name, str(row["quantity"])): row
        for name in _sets(request)
        if isinstance(run := results[set_job(TIPS[tip].format(name), request.quick).name], Outcome)
        for row in compare(run, tests_of(load(TIPS[tip].format(name))))
        if row["quantity"] in COUNTED
    }


def _momentum_sentences() -> list[str]:
    sets = [measured_set(name) for name in SETS]
    arms, errors = fitted_arms(sets)
    printed, *tips = readings()
    drawn = "; ".join(f"{t.name} {1e3 * t.d_c:.1f} and {1e3 * t.d_d:.1f} mm" for t in tips)
    missed = ", ".join(f"{t.name} {t.misfit:.2f}" for t in (printed, *tips))
    best = replace(printed, d_c=float(arms[0]), d_d=float(arms[1])).misfit
    nearer, other = sorted(tips, key=lambda tip: tip.misfit)
    sentences = [
        f"The rows of Table 3 turn as rods of {nearer.name} rather than of the other: with its arms momentum "
        f"alone misses their rotation by {nearer.misfit:.2f} rad/s (root mean square), with the other's by "
        f"{other.misfit:.2f}.",
        "Momentum alone: the arms d_c and d_d that fit the rotation of the "
        f"{sum(len(s.motion['Omega']) for s in sets)} rows are "
        f"{1e3 * arms[0]:.1f} +- {1e3 * errors[0]:.1f} and {1e3 * arms[1]:.1f} +- {1e3 * errors[1]:.1f} mm "
        f"(one standard error, not independent); those of the drawn rods are {drawn}.",
        f"Misfit by reading, rad/s: {missed}; the scatter about the fit is {best:.2f}.",
    ]
    second = measured_set("t2")
    if (second.arms, second.k2) == (sets[0].arms, sets[0].k2):
        worked_out = "Table 3 was worked out with the arms and the radius of gyration of Table 2, whose rods"
        sentences.append(f"{worked_out} have tip A.")
    return sentences


def _momentum_sheet() -> Sheet:
    """Return Omega by momentum alone with each reading, beside the measured mean and its standard error."""
    rows: list[tuple[Cell, ...]] = []
    for s in map(measured_set, SETS):
        mean = s.statistics()["Omega"]
        values = (float(reading.rotation(s).mean()) for reading in readings())
        rows.append((s.id, *values, mean.mean, float(mean.sd / np.sqrt(mean.n))))
    head = ("set", *(f"Omega, {reading.name}" for reading in readings()), "measured", "standard_error")
    caption = "Omega, rad/s, by momentum from the measured velocities, mean over the rows"
    return Sheet("momentum", caption, Table.of(head, rows))


def _model_sentences(rows: Mapping[str, Compared]) -> list[str]:
    """Return how many numbers each tip meets, and e, mu and Omega of the machined rod."""
    parts = []
    for tip, compared in rows.items():
        verdicts = [row["verdict"] for row in compared.values()]
        inside, missed = verdicts.count("inside"), sum(v.startswith("miss") for v in verdicts)
        if verdicts:
            within = f"{inside} of {len(verdicts)} lie inside the 95 % interval"
            parts.append(f"with tip {tip} {within} and {missed} miss it")
    machined = [
        f"{quantity} {row['model']:.3g} with tip {tip}, {row['measured_mean']:.3g} measured"
        for quantity in ("e", "mu", "Omega")
        for tip, compared in rows.items()
        if (row := compared.get((SETS[0], quantity)))
    ]
    if not parts:
        return []
    return [
        f"Finite elements, both counted alike: {'; '.join(parts)}.",
        f"The machined rod: {'; '.join(machined)}.",
    ]


def _model_sheet(rows: Mapping[str, Compared]) -> Sheet:
    model, measured = ("model", "band", "verdict"), ("measured_mean", "measured_low", "measured_high")
    table = [
        (
            *key,
            *(row[name] for name in model),
            *(rows["A"].get(key, {}).get(name) for name in model),
            *(row[name] for name in measured),
        )
        for key, row in rows["B"].items()
    ]
    head = ("set", "quantity", "tip B", "band B", "verdict B", "tip A", "band A", "verdict A")
    caption = (
        "Finite elements with tip B, as the caption says, and with tip A; measured mean and its 95 % interval"
    )
    return Sheet("tips", caption, Table.of((*head, "measured", "low", "high"), table))
