"""The slenderness criterion: restitution against inclination, per rod, and what rigid theory gets wrong."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from pandas import DataFrame

from fem_impact import Outcome, known
from fem_impact.answers.refine.work import Levels, LevelsJob
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.answers.verdict.vibration import solid_effect
from fem_impact.arrays import Array
from fem_impact.evidence.studies import criterion_findings as findings
from fem_impact.evidence.studies import rods as dropped
from fem_impact.evidence.studies.report_parts import rests_on
from fem_impact.evidence.studies.rod_theory import blind_ratio, spring_bounce, static_restitution, whole_ratio
from fem_impact.evidence.studies.rods import DroppedRod, RodRun
from fem_impact.figures.panels import Mark, Panel, Picture, Series
from fem_impact.jobs.job import Failure, Job
from fem_impact.tables.table import Table
from rigid import LIMIT

GAMMAS, QUICK_GAMMAS = (10, 14, 18, 20, 22, 24, 26.45, 30, 36, 45), (14.0, 26.45, 42.0)
ANGLES = (1.0, 5.0, 10.0, 20.0, 30.0, 40.0, 45.0, 50.0, 60.0, 70.0, 80.0)  # degrees
QUICK_ANGLES = (1.0, 20.0, 45.0, 70.0)
DIAMETERS, QUICK_DIAMETERS = (0.012, 0.019, 0.030), (0.012, 0.019)  # m
FRICTIONS = np.round(np.arange(0.0, 0.951, 0.05), 3)

# by finite elements
SOLID_GAMMAS, QUICK_SOLID_GAMMAS = (10.0, 15.0, 20.0, LIMIT, 35.0, 50.0, 80.0), (15.0, 35.0)
SOLID_ANGLES, QUICK_SOLID_ANGLES = (5.0, 20.0, 35.0, 45.0, 60.0, 75.0), (20.0, 45.0)  # degrees
SURFACES, QUICK_SURFACES = ("contaminated", "machined"), ("machined",)
END_GAMMAS, QUICK_END_GAMMAS = (10.0, 45.0), (14.0,)  # of elastic rods that confirm the modal fidelity

MODAL = {
    findings.HERTZ[0]: DroppedRod(0.1, tip_radius=dropped.TIP),
    findings.HERTZ[1]: DroppedRod(0.1),
    findings.YIELDING: DroppedRod(0.1, yields=True),
}
"""Kinds of contact by the modal fidelity, each a rod whose length, diameter and angle are then varied."""
SPRING = "linear spring"
BLIND, ENDS = "over friction", "elastic, by finite elements"
"""Families of elastic rods over friction, and of those that confirm the modal fidelity."""
Results = Mapping[str, Outcome | Levels | Failure]

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
            [
                *(dropped.length_of(g, d) for g in gammas),
                *(dropped.PAPER_RODS.values() if d == dropped.BODY else ()),
            ]
        )
        for angle in angles
    ]


def families(quick: bool) -> dict[str, list[RodRun]]:
    """Return the runs of vibrating rods by the modal fidelity: each kind of contact, and `BLIND`."""
    frictions = FRICTIONS[::5] if quick else FRICTIONS
    return {
        **{name: [RodRun(r) for r in rods_over_angles(rod, quick)] for name, rod in MODAL.items()},
        BLIND: [
            RodRun(DroppedRod(l, friction=float(f))) for l in dropped.PAPER_RODS.values() for f in frictions
        ],
    }


def solid_rods(quick: bool) -> dict[str, list[DroppedRod]]:
    """Return the vibrating rods of finite elements, by family: surface states, and `ENDS`."""
    gammas, angles = (QUICK_SOLID_GAMMAS, QUICK_SOLID_ANGLES) if quick else (SOLID_GAMMAS, SOLID_ANGLES)
    yielding = {
        f"yielding, {state}": [
            DroppedRod(dropped.length_of(gamma), angle, dropped.STATES[state], True)
            for gamma in gammas
            for angle in angles
        ]
        for state in (QUICK_SURFACES if quick else SURFACES)
    }
    ends = [DroppedRod(dropped.length_of(gamma)) for gamma in (QUICK_END_GAMMAS if quick else END_GAMMAS)]
    return {**yielding, ENDS: ends}


def levels_job(rod: DroppedRod) -> LevelsJob:
    """Return the levels of a rod, and of the same rod that cannot vibrate, on the same meshes."""
    return LevelsJob(f"{rod.name}-levels", rod.scene(), twin=replace(rod, vibrates=False).scene())


def plan(request: Request, results: Results) -> list[Job | LevelsJob]:
    """Return the jobs, the longest first: every rod, and the same rod without vibration."""
    runs_of = families(request.quick)
    twins = [run.twin for name, runs in runs_of.items() if name != BLIND for run in runs]
    solid = [levels_job(rod) for rods in solid_rods(request.quick).values() for rod in rods]
    modal = dropped.longest_first([*(run for runs in runs_of.values() for run in runs), *twins])
    return [*sorted(solid, key=lambda job: job.planned_s, reverse=True), *modal]


def angle_rows(table: DataFrame) -> list[dict[str, Any]]:
    """Return one row per family, rod and angle by modes: e with and without vibration, and T1/tau.

    T1/tau is the first bending period over the contact time of the rod that cannot vibrate. Angles at which
    one of the runs has no e are left out.
    """
    return [
        _angle(row.family, row.rod_run.rod, row.e_edge, row.e_edge_rigid, row.tau_s)
        for row in table.itertuples()
        if None not in (row.tau_s, row.e_edge, row.e_edge_rigid)
    ]


def solid_rows(rods: Mapping[str, Sequence[DroppedRod]], results: Results) -> list[dict[str, Any]]:
    """Return the rows of `angle_rows` by finite elements.

    The change of e, and ``band_of_change``, its half-width, are those of the levels: what a mesh changes of
    both rods alike does not count. Rods whose levels give none are left out.
    """
    rows = []
    for contact, rod in ((contact, rod) for contact, of in rods.items() for rod in of):
        levels = results.get(levels_job(rod).name)
        effect = solid_effect(levels.meshes) if isinstance(levels, Levels) else None
        if effect is not None and (touches := dropped.contacts(effect.stiff)):
            e = known(effect.free.restitution.edge.e)
            rows.append(_angle(contact, rod, e, e - effect.value, touches[0].duration, effect.band))
    return rows


def _angle(
    contact: str, rod: DroppedRod, e: float, e_rigid: float, tau: float, band: float = 0.0
) -> dict[str, Any]:
    values = {
        "e": e,
        "e_rigid": e_rigid,
        "band_of_change": band,
        "T1_over_tau": rod.first_period / tau,
        "T1_over_tau_whole": whole_ratio(replace(rod, angle=45.0)),
    }
    return {**rod.inputs, "contact": contact, "rod": rod, **values}


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


def conclude(request: Request, results: Results) -> StudyReport:
    """Return the study: error of rigid theory per rod, where it passes `LEVELS`, and its governing group."""
    outcomes = {name: run for name, run in results.items() if not isinstance(run, Levels)}
    table, solid = dropped.run_table(families(request.quick), outcomes), solid_rods(request.quick)
    blind = table[table.family == BLIND]
    on_spring = [
        {**rod.inputs, "contact": SPRING, "rod": rod, **spring_bounce(rod)}
        for rod in rods_over_angles(MODAL[findings.HERTZ[1]], request.quick)
    ]
    by_modes = angle_rows(table[table.family != BLIND])
    every = DataFrame([*by_modes, *on_spring, *solid_rows(solid, results)])
    angles, ends = every[every.contact != ENDS], every[every.contact == ENDS]
    upright = dropped.among(angles, contact=findings.YIELDING, diameter_m=dropped.BODY)
    upright = upright[upright.angle_deg <= findings.STEEPEST]
    upright = upright.assign(
        e_static_give=[static_restitution(rod) for rod in upright.rod], e_vibrating=upright.e
    )
    rods = rods_of(angles)
    body = rods[rods.diameter_m == dropped.BODY]
    yielding = [name for name in solid if name != ENDS]
    sentences = findings.by_picture(angles, ends, rods, yielding, upright, blind)
    return StudyReport(
        "criterion",
        "When a rod may be called rigid",
        [sentence for group in sentences.values() for sentence in group],
        [
            onset_picture(body),
            angles_picture(angles),
            static_give_picture(upright),
            master_picture(rods),
            blind_direction_picture(blind),
        ],
        [
            Sheet("levels", LEVEL_CAPTION, level_table(rods)),
            Sheet("rods", "Rods of 19 mm", dropped.as_table(body[RODS_CSV])),
            Sheet("static_give", GIVE_CAPTION, dropped.as_table(upright[GIVE_CSV]), shown=False),
            Sheet("curves", "Every rod and angle", dropped.as_table(angles[ANGLES_CSV]), shown=False),
        ],
        [*rests_on("dropped rods"), *rests_on("criterion")],
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
            for level in findings.LEVELS:
                onsets = [
                    findings.crossing(diameters[d], level, measure) if d else None
                    for d in (thinnest, dropped.BODY, thickest)
                ]
                rows.append([contact, title, level, *onsets, findings.exponent(of_contact, level, measure)])
    head = ("contact", "measure", "level", "gamma_thinnest", "gamma_19_mm", "gamma_thickest", "exponent")
    return Table.of(head, rows)


SHOWN = (1.0, 5.0, 20.0)  # degrees: angles in the picture of the static give
GAMMA, LIMIT_MARK = "gamma, m^-0.3815", (Mark(LIMIT, "limit of Eq 29"),)


def onset_picture(body: DataFrame) -> Picture:
    """Return the largest error of e against gamma, 19 mm, one line per family."""
    series = tuple(
        Series(name, rods.gamma.tolist(), rods.error_of_e.tolist(), "joined", at, _bands(rods))
        for at, (name, rods) in enumerate(findings.by_contact(body).items())
    )
    label = "largest error of e by rigid theory"
    panel = Panel("19 mm", GAMMA, label, series, LIMIT_MARK, tuple(map(Mark, findings.LEVELS)))
    caption = "Where vibration changes the rebound; horizontal lines: the stated levels."
    return Picture("onset", caption, (panel,), 1)


def _bands(rods: DataFrame) -> Array | None:
    """Return the bands of the largest errors, None for rods of the reduced model, which have none."""
    bands: Array = (rods.error_high - rods.error_of_e).to_numpy()
    return bands if rods.band_of_change.any() else None


def angles_picture(angles: DataFrame) -> Picture:
    """Return e against inclination, degrees, one panel per family with up to six of its 19 mm rods.

    ``angles`` are rows of `angle_rows`.
    """
    panels = []
    colours: dict[str, int] = {}
    for name, of_contact in angles[angles.diameter_m == dropped.BODY].groupby("contact", sort=False):
        rods = [rod for _, rod in of_contact.groupby("gamma")]
        series = []
        for at in np.unique(np.linspace(0, len(rods) - 1, 6).astype(int)):
            rod = rods[at]
            label = f"gamma {rod.gamma.iloc[0]:.0f}"
            colour = colours.setdefault(label, len(colours))  # one for each slenderness in all panels
            bands = rod.band_of_change.tolist() if rod.band_of_change.any() else None
            series.append(Series(label, rod.angle_deg.tolist(), rod.e.tolist(), "joined", colour, bands))
        panels.append(Panel(name, "inclination, degrees", "e", tuple(series)))
    caption = "Restitution against inclination, 19 mm rods; bands: of the change of e by vibration."
    return Picture("angles", caption, tuple(panels))


def static_give_picture(upright: DataFrame) -> Picture:
    """Return e of the vibrating rod, by quasi-static bending alone, and of the rigid rod, at three angles."""
    panels = []
    for near in (findings.nearest(upright, angle) for angle in SHOWN):
        series = (
            Series("vibrating", near.gamma.tolist(), near.e.tolist(), "points"),
            Series("quasi-static bending alone", near.gamma.tolist(), near.e_static_give.tolist(), "line"),
            Series("rigid", near.gamma.tolist(), near.e_rigid.tolist(), "dashed"),
        )
        panels.append(Panel(f"{near.angle_deg.iloc[0]:g} degrees", GAMMA, "e", series))
    caption = "Yielding tip, frictionless, 19 mm: what the rod stores elastically never reaches the contact."
    return Picture("static-give", caption, tuple(panels), 3)


def master_picture(rods: DataFrame) -> Picture:
    """Return 1 - largest error of e against T1/tau in both meanings of tau and against gamma."""
    panels = []
    for title, axis, column, marks in (
        ("by T1/tau, tau of the inclined rod", "T1/tau", "T1_over_tau", ()),
        ("by T1/tau, tau of the whole mass", "T1/tau", "T1_over_tau_whole", ()),
        ("by gamma", GAMMA, "gamma", (Mark(LIMIT, "limit"),)),
    ):
        series = [
            Series(name, same[column].tolist(), (1 - same.error_of_e).tolist(), "points", at, _bands(same))
            for at, (name, same) in enumerate(rods.groupby("contact", sort=False))
        ]
        if column == "T1_over_tau_whole":
            series.append(Series("independent reference", *findings.INDEPENDENT, "rings", 6))
        panels.append(Panel(title, axis, "1 - largest error of e", tuple(series), marks))
    caption = "One group or the other: all diameters, contacts and slendernesses."
    return Picture("master", caption, tuple(panels), 3)


def blind_direction_picture(blind: DataFrame) -> Picture:
    """Return vibration against friction of the paper's rods, with mu* of each."""
    series, marks = [], []
    for at, (rod, length) in enumerate(dropped.PAPER_RODS.items()):
        f, share = findings.over_friction(blind, length)
        series.append(Series(rod, f, 100 * share, "joined", at))
        marks.append(Mark(blind_ratio(DroppedRod(length)), f"mu* of {rod}"))
    panel = Panel("elastic, 45 degrees", "f", "vibration, % of E_0", tuple(series), tuple(marks))
    caption = "A contact force of ratio mu* does not excite the first bending mode."
    return Picture("blind-direction", caption, (panel,), 1)
