"""Table 3 beside its caption: what its own rows say about the tip of its rods.

The caption says tip B. Momentum alone binds the rotation of a rod to its velocities by the arms of the
contact point, and those differ between the tips; the finite elements run with both. The scenes with tip A
are a second reading: none of the thirteen sets, counted in none of their numbers
(docs/explanation/measured-sets.md).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from pandas import DataFrame

from fem_impact import Scene, load, simulate
from fem_impact.answers.compare import MEASURED, compare
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.arrays import Array
from fem_impact.evidence.studies.declared import DeclaredSweep, Runs
from fem_impact.evidence.studies.report_parts import frame_rows
from fem_impact.evidence.studies.sets import set_job
from fem_impact.run.tests import tests_of
from fem_impact.tables.table import Cell, Table
from rigid.experiments import MeasuredSet, measured_set

SETS = ("t3-machined", "t3-contaminated", "t3-cleaned")
TIPS, TIP_A = ("B", "A"), "{}-tip-a"  # and the name of the scene of a set with tip A
COUNTED = tuple(quantity.name for quantity in MEASURED)


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
    for tip, name in zip(TIPS, (SETS[0], TIP_A.format(SETS[0])), strict=True):
        scene = load(name)
        rod = scene.projectile.rigid_body
        d_c, d_d = rod.arms(scene.impact.angle)
        drawn.append(Reading(f"tip {tip}", float(d_c), float(d_d), float(rod.k2)))
    return Reading("as printed", float(printed.arms.d_c), float(printed.arms.d_d), printed.k2), *drawn


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


def _model_sentences(rows: DataFrame) -> list[str]:
    """Return how many numbers each tip meets, and e, mu and Omega of the machined rod."""
    parts = []
    for tip, verdicts in rows.groupby("tip", sort=False).verdict:
        inside, missed = (verdicts == "inside").sum(), verdicts.str.startswith("miss").sum()
        within = f"{inside} of {len(verdicts)} lie inside the 95 % interval"
        parts.append(f"with tip {tip} {within} and {missed} miss it")
    machined = [
        f"{row.quantity} {row.model:.3g} with tip {row.tip}, {row.measured_mean:.3g} measured"
        for quantity in ("e", "mu", "Omega")
        for row in rows[(rows.set == SETS[0]) & (rows.quantity == quantity)].itertuples()
    ]
    return [
        f"Finite elements, both counted alike: {'; '.join(parts)}.",
        f"The machined rod: {'; '.join(machined)}.",
    ]


def _model_sheet(rows: DataFrame) -> Sheet:
    model, measured = ["model", "band", "verdict"], ["measured_mean", "measured_low", "measured_high"]
    of_tip = {tip: same.set_index(["set", "quantity"]) for tip, same in rows.groupby("tip", sort=False)}
    table = of_tip["B"][model].join([of_tip["A"][model].add_suffix(" A"), of_tip["B"][measured]])
    head = ("set", "quantity", "tip B", "band B", "verdict B", "tip A", "band A", "verdict A")
    caption = (
        "Finite elements with tip B, as the caption says, and with tip A; measured mean and its 95 % interval"
    )
    rows_of = frame_rows(table.reset_index())
    return Sheet("tips", caption, Table.of((*head, "measured", "low", "high"), rows_of))


def _scenes(request: Request) -> dict[str, Scene]:
    """Return the sets of Table 3, one if quick, as the study of the sets runs them."""
    return {name: set_job(name, request.quick).scene for name in (SETS[:1] if request.quick else SETS)}


def _with_either_tip(name: str, scene: Scene) -> dict[str, tuple[Scene, str]]:
    tip_a = replace(load(TIP_A.format(name)), accuracy=scene.accuracy, save=scene.save)
    return {"B": (scene, "solid"), "A": (tip_a, "solid")}


def _report(runs: Runs) -> StudyReport:
    """Return the study: rotation by momentum alone, and finite elements with either tip."""
    rows = DataFrame(
        [
            {**row, "set": name, "tip": tip}
            for tip in TIPS
            for name, by_tip in runs.items()
            if tip in by_tip
            for row in compare(by_tip[tip], tests_of(load(name)))
            if row["quantity"] in COUNTED
        ]
    )
    sentences = [*_momentum_sentences(), *(_model_sentences(rows) if len(rows) else [])]
    return StudyReport(
        "tip",
        "Table 3: tip A or tip B?",
        sentences,
        sheets=[_momentum_sheet(), *([_model_sheet(rows)] if {*TIPS} <= {*rows.get("tip", ())} else [])],
        assumptions=["Runs with tip A in place of B are shown beside the sets, and counted nowhere."],
        conclusions=[("", sentence) for sentence in sentences],
    )


_SWEEP = DeclaredSweep(_scenes, _with_either_tip, _report, simulate)
plan, conclude = _SWEEP.plan, _SWEEP.conclude
