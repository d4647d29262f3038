"""Table 3 beside its caption: what its own rows say about the tip of its rods.

The caption of Table 3 says tip B. Momentum alone binds the rotation of a rod to its velocities by the arms of
the contact point, and those differ between the tips; the finite elements run with both. The scenes with tip A
are a second reading, shown beside: they are none of the thirteen sets and count in none of their numbers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem_impact.answers.compare import MEASURED, Row, compare
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.arrays import Array
from fem_impact.evidence.studies.pairs import with_limits
from fem_impact.evidence.studies.sets import at_places, mesh_jobs
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.record import Outcome
from fem_impact.physics.contact import projectile
from fem_impact.run.tests import tests_of
from fem_impact.scene.shipped import load, replace_all
from fem_impact.tables.table import Cell, Table
from rigid.experiments import MeasuredSet, measured_set

SETS = ("t3-machined", "t3-contaminated", "t3-cleaned")
TIPS = {"B": "{}", "A": "{}-tip-a"}
"""Names of the scenes by tip."""
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


def changes(measured: MeasuredSet) -> tuple[Array, Array]:
    """Return V_n - v_n and V_t - v_t (n,) of the rows, m/s."""
    m = measured.motion
    return np.asarray(m["V_n"] - m["v_n"]), np.asarray(m["V_t"] - m["v_t"])


def fitted_arms(sets: list[MeasuredSet]) -> tuple[Array, Array]:
    """Return d_c, d_d (2,), m, that fit the rows' rotations by least squares, and their standard errors."""
    dV_n, dV_t = (np.concatenate(parts) for parts in zip(*map(changes, sets), strict=True))
    design = np.column_stack([dV_n, -dV_t])
    spin = np.concatenate([s.k2 * s.motion["Omega"] for s in sets])
    arms, (rest,), *_ = np.linalg.lstsq(design, spin)
    covariance = rest / (len(spin) - 2) * np.linalg.inv(design.T @ design)
    return np.asarray(arms), np.sqrt(np.diag(covariance))


def readings() -> tuple[Reading, ...]:
    """Return the arms by which Table 3 was worked out, and those of a rod with either tip."""
    printed = measured_set(SETS[0])
    found = [Reading("as printed", float(printed.arms.d_c), float(printed.arms.d_d), printed.k2)]
    for tip, name in TIPS.items():
        scene = load(name.format(SETS[0]))
        rod = projectile(scene)
        d_c, d_d = rod.arms(scene.impact.angle)
        found.append(Reading(f"tip {tip}", float(d_c), float(d_d), float(rod.k2)))
    return tuple(found)


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the runs of Table 3 with either tip, two meshes at two places; one set if quick."""
    return [job for tip in TIPS for name in _sets(request) for job in _jobs(name, tip, request).values()]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: rotation by momentum alone, and finite elements with either tip."""
    rows: dict[str, list[Row]] = {}
    for tip in TIPS:
        for name in _sets(request):
            runs = {kind: results[job.name] for kind, job in _jobs(name, tip, request).items()}
            if isinstance(runs["fine"], Outcome):
                limited = with_limits(at_places(runs, "fine"), at_places(runs, "coarse"))
                found = compare(limited, tests_of(load(TIPS[tip].format(name))))
                rows.setdefault(tip, []).extend(row for row in found if row["quantity"] in COUNTED)
    sentences = [*_momentum_sentences(), *_model_sentences(rows)]
    return StudyReport(
        "tip",
        "Table 3: tip A or tip B?",
        sentences,
        sheets=[_momentum_sheet(), _model_sheet(rows)],
        assumptions=[
            "The caption of Table 3 says tip B, and the thirteen sets follow it. Tip A is shown beside and "
            "counted nowhere.",
            "Table 3 prints e, mu and e_m; velocities and rotation follow from them with the arms, the "
            "radius of gyration and the approach of 1.6 m/s by which it was worked out.",
            "Arms and radii of gyration of the tips are those of the drawn rods; tip A's shape beyond 60 "
            "degrees of its sphere is an assumption.",
        ],
        conclusions=[("", sentence) for sentence in sentences],
    )


def _sets(request: Request) -> tuple[str, ...]:
    return SETS[:1] if request.quick else SETS


def _jobs(name: str, tip: str, request: Request) -> dict[str, Job]:
    jobs = mesh_jobs(TIPS[tip].format(name), request.quick, request.out)
    return {k: Job(job.name, replace_all(job.scene, {"save.frames": 0})) for k, job in jobs.items()}


def _misfit(reading: Reading) -> float:
    """Return the root mean square difference of the rotation from the measured one over all rows, rad/s."""
    off = [reading.rotation(s) - s.motion["Omega"] for s in map(measured_set, SETS)]
    return float(np.sqrt(np.mean(np.concatenate(off) ** 2)))


def _momentum_sentences() -> list[str]:
    sets = [measured_set(name) for name in SETS]
    arms, errors = fitted_arms(sets)
    printed, *tips = readings()
    drawn = "; ".join(f"{t.name} {1e3 * t.d_c:.1f} and {1e3 * t.d_d:.1f} mm" for t in tips)
    missed = ", ".join(f"{t.name} {_misfit(t):.2f}" for t in (printed, *tips))
    best = _misfit(replace(printed, d_c=float(arms[0]), d_d=float(arms[1])))
    second = measured_set("t2")
    same = (second.arms, second.k2) == (sets[0].arms, sets[0].k2)
    nearer = min(tips, key=_misfit)
    return [
        f"The rows of Table 3 turn as rods of {nearer.name} rather than of the other: with its arms momentum "
        f"alone misses their rotation by {_misfit(nearer):.2f} rad/s (root mean square), with the other's by "
        f"{max(map(_misfit, tips)):.2f}.",
        "Momentum alone: the arms d_c and d_d that fit the rotation of the "
        f"{sum(len(s.motion['Omega']) for s in sets)} rows are "
        f"{1e3 * arms[0]:.1f} +- {1e3 * errors[0]:.1f} and {1e3 * arms[1]:.1f} +- {1e3 * errors[1]:.1f} mm "
        f"(one standard error, not independent); those of the drawn rods are {drawn}.",
        f"Misfit by reading, rad/s: {missed}; the scatter about the fit is {best:.2f}.",
        *(
            [
                "Table 3 was worked out with the arms and the radius of gyration of Table 2, whose rods have "
                "tip A."
            ]
            if same
            else []
        ),
    ]


def _momentum_sheet() -> Sheet:
    """Return Omega by momentum alone with each reading, beside the measured mean and its standard error."""
    found, rows = readings(), list[tuple[Cell, ...]]()
    for name in SETS:
        s = measured_set(name)
        mean = s.statistics()["Omega"]
        values = (float(reading.rotation(s).mean()) for reading in found)
        rows.append((name, *values, mean.mean, float(mean.sd / np.sqrt(mean.n))))
    head = ("set", *(f"Omega, {reading.name}" for reading in found), "measured", "standard_error")
    caption = "Omega, rad/s, by momentum from the measured velocities, mean over the rows"
    return Sheet("momentum", caption, Table.of(head, rows))


def _model_sentences(rows: dict[str, list[Row]]) -> list[str]:
    """Return how many numbers each tip meets, and e, mu and Omega of the machined rod."""
    parts = []
    for tip, found in rows.items():
        inside = sum(row["verdict"] == "inside" for row in found)
        missed = sum(row["verdict"].startswith("miss") for row in found)
        parts.append(
            f"with tip {tip} {inside} of {len(found)} lie inside the 95 % interval and {missed} miss it"
        )
    first = [
        f"{row['quantity']} {row['model']:.3g} with tip {tip}, {row['measured_mean']:.3g} measured"
        for quantity in ("e", "mu", "Omega")
        for tip, found in rows.items()
        for row in found
        if row["quantity"] == quantity and _key(row)[0].startswith(SETS[0])
    ]
    if not parts:
        return []
    return [
        f"Finite elements, both counted alike: {'; '.join(parts)}.",
        f"The machined rod: {'; '.join(first)}.",
    ]


def _model_sheet(rows: dict[str, list[Row]]) -> Sheet:
    table: list[tuple[Cell, ...]] = []
    for row in rows.get("B", []):
        same = (r for r in rows.get("A", []) if (r["set"].removesuffix("-tip-a"), r["quantity"]) == _key(row))
        other = next(same, None)
        beside = (other["model"], other["band"], other["verdict"]) if other else (None, None, None)
        measured = (row["measured_mean"], row["measured_low"], row["measured_high"])
        table.append((*_key(row), row["model"], row["band"], row["verdict"], *beside, *measured))
    head = ("set", "quantity", "tip B", "band B", "verdict B", "tip A", "band A", "verdict A")
    caption = (
        "Finite elements with tip B, as the caption says, and with tip A; measured mean and its 95 % interval"
    )
    return Sheet("tips", caption, Table.of((*head, "measured", "low", "high"), table))


def _key(row: Row) -> tuple[str, str]:
    return str(row["set"]), str(row["quantity"])
