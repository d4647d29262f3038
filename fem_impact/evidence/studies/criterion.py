"""The slenderness criterion: restitution against inclination, per rod, and what rigid theory gets wrong."""

from __future__ import annotations

from dataclasses import replace
from statistics import fmean
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.answers.refine.extrapolate import limit_of
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.studies import criterion_figures as figures
from fem_impact.evidence.studies import criterion_findings as findings
from fem_impact.evidence.studies.criterion_findings import (
    HERTZ,
    LEVELS,
    STEEPEST,
    YIELDING,
    crossing,
    exponent,
)
from fem_impact.evidence.studies.pairs import COARSER, PLACES
from fem_impact.evidence.studies.rod_runs import (
    RESTITUTION,
    RodRun,
    among,
    as_table,
    longest_first,
    mesh_levels,
    mesh_runs,
    run_table,
)
from fem_impact.evidence.studies.rod_theory import spring_bounce, static_restitution, whole_ratio
from fem_impact.evidence.studies.rods import (
    BODY,
    DROP_NOTES,
    MODAL_NOTE,
    PAPER_RODS,
    STATES,
    TIP,
    DroppedRod,
    length_of,
)
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.tables.table import Table
from rigid import LIMIT

if TYPE_CHECKING:
    from pandas import DataFrame

GAMMAS, QUICK_GAMMAS = (10, 14, 18, 20, 22, 24, 26.45, 30, 36, 45), (14.0, 26.45, 42.0)
ANGLES = (1.0, 5.0, 10.0, 20.0, 30.0, 40.0, 45.0, 50.0, 60.0, 70.0, 80.0)  # degrees
QUICK_ANGLES = (1.0, 20.0, 45.0, 70.0)
DIAMETERS, QUICK_DIAMETERS = (0.012, 0.019, 0.030), (0.012, 0.019)  # m
FRICTIONS = np.round(np.arange(0.0, 0.951, 0.05), 3)

# by finite elements
SOLID_GAMMAS, QUICK_SOLID_GAMMAS = (10.0, 15.0, 20.0, LIMIT, 35.0, 50.0, 80.0), (15.0, 35.0)
SOLID_ANGLES, QUICK_SOLID_ANGLES = (5.0, 20.0, 35.0, 45.0, 60.0, 75.0), (20.0, 45.0)  # degrees
SURFACES, QUICK_SURFACES = ("contaminated", "machined"), ("machined",)
SIZES, QUICK_SIZES = (1.0, COARSER), (COARSER, COARSER**2)  # of elements over the scene's own
END_GAMMAS, QUICK_END_GAMMAS = (10.0, 45.0), (14.0,)  # of elastic rods that confirm the modal fidelity

MODAL = {
    HERTZ[0]: DroppedRod(0.1, tip_radius=TIP),
    HERTZ[1]: DroppedRod(0.1),
    YIELDING: DroppedRod(0.1, yields=True),
}
"""Kinds of contact by the modal fidelity, each a rod whose length, diameter and angle are then varied."""
SPRING = "linear spring"
BLIND, ENDS = "over friction", "elastic, by finite elements"
"""Families of elastic rods over friction, and of those that confirm the modal fidelity."""

ASSUMPTIONS = (
    *DROP_NOTES,
    MODAL_NOTE,
    "Yielding, contaminated and machined: finite elements on two meshes at two places; the band is that of "
    "the difference of e with and without vibration. All other families: modes, without a band.",
    "Error of rigid theory: change of e, at the worst of the angles from 1 to 80 degrees, against a "
    "rod that cannot vibrate on the same contact. At 0 degrees a flat face has no one contact point.",
    "Linear spring: bending and stretching modes of the slender rod, one stiffness for all rods, as "
    "long a contact as Hertz' for 19 mm, gamma 26.45, 45 degrees, 2.1 m/s; solved exactly.",
    "T1: first bending period. tau: contact time of the rod that cannot vibrate, at the angle of its "
    "largest error; or of its whole mass, falling at full speed onto the contact of 45 degrees.",
)
ANGLES_CSV = "contact gamma diameter_m angle_deg e e_rigid band_of_change T1_over_tau".split()
RODS_CSV = "contact gamma diameter_m length_m T1_over_tau T1_over_tau_whole error_of_e spread_of_e".split()
GIVE_CSV = "gamma angle_deg e_rigid e_static_give e_vibrating".split()
"""Columns of curves.csv, of rods.csv and of static_give.csv."""
LEVEL_CAPTION = "Slenderness at which error or spread of e over the angles passes a level, and the exponent"
GIVE_CAPTION = (
    "Yielding tip, frictionless, 19 mm: e of a rigid rod, with quasi-static bending, with vibration"
)


def rods_over_angles(rod: DroppedRod, quick: bool) -> list[DroppedRod]:
    """Return rods like a given one of every size and angle; the paper's rods are among those of 19 mm."""
    gammas, angles = (QUICK_GAMMAS, QUICK_ANGLES) if quick else (GAMMAS, ANGLES)
    return [
        replace(rod, length=length, diameter=d, angle=angle)
        for d in (QUICK_DIAMETERS if quick else DIAMETERS)
        for length in sorted(
            [*(length_of(g, d) for g in gammas), *(PAPER_RODS.values() if d == BODY else ())]
        )
        for angle in angles
    ]


def families(quick: bool) -> dict[str, list[RodRun]]:
    """Return the runs of vibrating rods, by family: each kind of contact, `BLIND` and `ENDS`."""
    sizes, offsets = (QUICK_SIZES, (0.0,)) if quick else (SIZES, PLACES)
    gammas, angles = (QUICK_SOLID_GAMMAS, QUICK_SOLID_ANGLES) if quick else (SOLID_GAMMAS, SOLID_ANGLES)
    modal = {name: [RodRun(r) for r in rods_over_angles(rod, quick)] for name, rod in MODAL.items()}
    solid = {
        f"yielding, {state}": [
            run
            for gamma in gammas
            for angle in angles
            for run in mesh_runs(DroppedRod(length_of(gamma), angle, STATES[state], True), sizes, offsets)
        ]
        for state in (QUICK_SURFACES if quick else SURFACES)
    }
    frictions = FRICTIONS[::5] if quick else FRICTIONS
    return {
        **modal,
        **solid,
        BLIND: [RodRun(DroppedRod(l, friction=float(f))) for l in PAPER_RODS.values() for f in frictions],
        ENDS: [
            run
            for gamma in (QUICK_END_GAMMAS if quick else END_GAMMAS)
            for run in mesh_runs(DroppedRod(length_of(gamma)), sizes[:1], offsets)
        ],
    }


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the jobs, the longest first: every rod, and the same rod without vibration."""
    runs_of = families(request.quick)
    twins = [run.twin for name, runs in runs_of.items() if name != BLIND for run in runs]
    return longest_first([*(run for runs in runs_of.values() for run in runs), *twins])


def angle_rows(table: DataFrame) -> list[dict[str, Any]]:
    """Return one row per family, rod and angle: e with and without vibration, and T1/tau.

    Values of finite elements are limits of two meshes, and so is the difference of e, whose half-width is
    ``band_of_change``: what the mesh changes of both alike does not count; 0 without a second mesh. T1/tau is
    the first bending period over the contact time of the rod that cannot vibrate. Angles at which one of the
    runs has no e are left out.
    """
    rows = []
    for (contact, _), runs in table.groupby(["family", "point"], sort=False):
        rod, tau = runs.iloc[0].rod_run.rod, mesh_levels(runs, "tau_s")[-1][0]
        if tau is None or runs[[RESTITUTION, "e_edge_rigid"]].isna().any(axis=None):
            continue
        runs = runs.assign(change=runs[RESTITUTION] - runs.e_edge_rigid)
        values = {
            "e": _limit(runs, RESTITUTION)[0],
            "e_rigid": _limit(runs, "e_edge_rigid")[0],
            "band_of_change": _limit(runs, "change")[1],
            "T1_over_tau": rod.first_period / tau,
            "T1_over_tau_whole": whole_ratio(replace(rod, angle=45.0)),
        }
        rows.append({**rod.inputs, "contact": contact, "rod": rod, **values})
    return rows


def _limit(runs: DataFrame, column: str) -> tuple[float, float]:
    """Return the limit of a column over the meshes and its half-width; of one mesh the mean, and 0."""
    levels = mesh_levels(runs, column)
    if len(levels) == 1:
        return fmean(levels[0]), 0.0
    limit = limit_of(sorted(set(runs.element_size), reverse=True), levels)
    return limit.value, limit.uncertainty


def rods_of(angles: DataFrame) -> DataFrame:
    """Return one row per family and rod, over the angles.

    ``error_of_e`` is the largest change of e by vibration, with T1/tau at that angle; ``error_low`` is what
    the bands leave sure of it, ``error_high`` what they allow. ``spread_of_e`` is the largest less the
    smallest e, the published meaning of the criterion, ``spread_rigid`` that of the rod that cannot vibrate.
    """
    error, band = (angles.e - angles.e_rigid).abs(), angles.band_of_change
    angles = angles.assign(error_of_e=error, error_low=error - band, error_high=error + band)
    same = angles.groupby(["contact", "diameter_m", "length_m"], sort=False)
    worst = ["gamma", "T1_over_tau_whole", "error_of_e", "error_low", "error_high", "band_of_change"]
    return (
        same[worst]
        .max()
        .assign(
            T1_over_tau=angles.T1_over_tau[same.error_of_e.idxmax()].to_numpy(),
            spread_of_e=same.e.max() - same.e.min(),
            spread_rigid=same.e_rigid.max() - same.e_rigid.min(),
        )
        .reset_index()
    )


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: error of rigid theory per rod, where it passes `LEVELS`, and its governing group."""
    from pandas import DataFrame

    table = run_table(families(request.quick), results)
    modal, blind = table.fidelity == "modal", table[table.family == BLIND]
    on_spring = [
        {**rod.inputs, "contact": SPRING, "rod": rod, **spring_bounce(rod)}
        for rod in rods_over_angles(MODAL[HERTZ[1]], request.quick)
    ]
    computed = [angle_rows(table[rows]) for rows in (modal & (table.family != BLIND), ~modal)]
    every = DataFrame([*computed[0], *on_spring, *computed[1]])
    angles, ends = every[every.contact != ENDS], every[every.contact == ENDS]
    upright = among(angles, contact=YIELDING, diameter_m=BODY)
    upright = upright[upright.angle_deg <= STEEPEST]
    upright = upright.assign(
        e_static_give=[static_restitution(rod) for rod in upright.rod], e_vibrating=upright.e
    )
    rods = rods_of(angles)
    body = rods[rods.diameter_m == BODY]
    solid = [*dict.fromkeys(table[~modal & (table.family != ENDS)].family)]
    sentences = findings.by_picture(angles, ends, rods, solid, upright, blind)
    return StudyReport(
        "criterion",
        "When a rod may be called rigid",
        [sentence for group in sentences.values() for sentence in group],
        [
            figures.onset(body),
            figures.angles(angles),
            figures.static_give(upright),
            figures.master(rods),
            figures.blind_direction(blind),
        ],
        [
            Sheet("levels", LEVEL_CAPTION, level_table(rods)),
            Sheet("rods", "Rods of 19 mm", as_table(body[RODS_CSV])),
            Sheet("static_give", GIVE_CAPTION, as_table(upright[GIVE_CSV]), shown=False),
            Sheet("curves", "Every rod and angle", as_table(angles[ANGLES_CSV]), shown=False),
        ],
        ASSUMPTIONS,
        ["modal", "thornton", "slenderness"],
        [(name, sentence) for name, group in sentences.items() for sentence in group],
    )


def level_table(rods: DataFrame) -> Table:
    """Return gamma at which each measure passes each level, for three diameters, and the exponent."""
    rows = []
    for contact, of_contact in rods.groupby("contact", sort=False):
        diameters = {d: group for d, group in of_contact.groupby("diameter_m")}
        thinnest, thickest = (min(diameters), max(diameters)) if len(diameters) > 1 else (None, None)
        for title, measure in {"error of e": "error_of_e", "spread of e": "spread_of_e"}.items():
            for level in LEVELS:
                onsets = [
                    crossing(diameters[d], level, measure) if d else None for d in (thinnest, BODY, thickest)
                ]
                rows.append([contact, title, level, *onsets, exponent(of_contact, level, measure)])
    head = ("contact", "measure", "level", "gamma_thinnest", "gamma_19_mm", "gamma_thickest", "exponent")
    return Table.of(head, rows)
