"""Vibration against slenderness, and when a rod may be called rigid.

By finite elements rods at one angle, elastic and yielding, with one input changed, and measured sets; by
finite elements and the reduced model rods at all angles, each beside the same rod that cannot vibrate.
"""

from dataclasses import replace
from itertools import product
from math import degrees, hypot
from typing import Any

import numpy as np
from pandas import DataFrame

from fem_impact import load
from fem_impact.answers.refine.work import LevelsJob
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.studies import gamma_table as runs
from fem_impact.evidence.studies.gamma_figures import pictures
from fem_impact.evidence.studies.gamma_findings import LEVELS, STEEPEST, findings
from fem_impact.evidence.studies.gamma_table import VIBRATION, Results, RodRun, among, crossing, exponent
from fem_impact.evidence.studies.report_parts import frame_rows, rests_on
from fem_impact.evidence.studies.rod_theory import static_restitution
from fem_impact.evidence.studies.rods import (
    BODY,
    KINDS,
    PAPER_RODS,
    PLAIN,
    STATES,
    TIP,
    DroppedRod,
    length_of,
)
from fem_impact.jobs.job import Job
from fem_impact.tables.table import Table
from fem_impact.tables.text import rounded_up
from rigid import LIMIT
from rigid.slenderness import EXPONENT

SETS = ("t3-machined", "t4", "t5b")  # tip B at 45 degrees, one of each rod
FEWER = (15.0, LIMIT, 57.3, 90.0)  # gammas of rods with another diameter, speed or flow curve
OTHER_DIAMETERS, OTHER_SPEEDS = (0.010, 0.030), (1.3, 4.2)  # m and m/s, beside those of the curve
OTHER_ANGLES = (5.0, 15.0, 25.0, 35.0, 60.0, 75.0)  # degrees, beside that of the curve

# of the whole study and of the quick one; angles in degrees, diameters in m
PLACES = 2, 1  # of the barrier's grid, of a rod that can vibrate
BETWEEN = (10.0, 14.0, 23.0, LIMIT, 35.0, 45.0, 70.0, 85.0, 100.0, 120.0), (LIMIT, 70.0)
REDUCED = tuple(10.0 + 2.0 * i for i in range(56)), tuple(10.0 + 22.0 * i for i in range(6))
GAMMAS = (10, 14, 18, 20, 22, 24, LIMIT, 30, 36, 45), (14.0, LIMIT, 42.0)
ANGLES = (1.0, 5.0, 10.0, 20.0, 30.0, 40.0, 45.0, 50.0, 60.0, 70.0, 80.0), (1.0, 20.0, 45.0, 70.0)
DIAMETERS = (0.012, BODY, 0.030), (0.012, BODY)
FRICTIONS = np.round(np.arange(0.0, 0.951, 0.05), 3), np.round(np.arange(0.0, 0.951, 0.25), 3)
MESHED_GAMMAS = (10.0, 15.0, 20.0, LIMIT, 35.0, 50.0, 80.0), (15.0, 35.0)
MESHED_ANGLES = (5.0, 20.0, 35.0, 45.0, 60.0, 75.0), (20.0, 45.0)
SURFACES = ("contaminated", "machined"), ("machined",)
END_GAMMAS = (10.0, 45.0), (14.0,)
ALIKE = 0.1  # m^-0.3815, difference of gammas that count as the same


def curve(quick: bool) -> list[DroppedRod]:
    """Return the rods of the curve: 19 mm, 2.1 m/s, 45 degrees, elastic and yielding, every state."""
    return [
        DroppedRod(length, friction=f, yields=yields)
        for length in sorted([*map(length_of, BETWEEN[quick]), *PAPER_RODS.values()])
        for yields, kind in KINDS.items()
        for state, f in STATES.items()
        if not quick or state == PLAIN[kind]
    ]


def other_inputs() -> list[DroppedRod]:
    """Return the rods with another diameter, speed, angle or flow curve than the curve's."""
    changed = [
        *(DroppedRod(length_of(g, d), diameter=d) for g in FEWER for d in OTHER_DIAMETERS),
        *(DroppedRod(length_of(g), speed=v) for g in FEWER for v in OTHER_SPEEDS),
        *(DroppedRod(length, angle) for length in PAPER_RODS.values() for angle in OTHER_ANGLES),
    ]
    harder = [DroppedRod(length_of(g), law="hardness") for g in FEWER]
    return [
        replace(rod, friction=STATES[PLAIN[kind]], yields=yields)
        for yields, kind in KINDS.items()
        for rod in (*changed, *(harder if yields else []))
    ]


def measured(name: str) -> DroppedRod:
    """Return the yielding rod with length, diameter, tip, angle, speed and friction of a measured set."""
    scene = load(name)
    rod, impact = scene.projectile, scene.impact
    speed, angle = hypot(impact.v_n, impact.v_t), round(degrees(impact.angle), 9)
    return DroppedRod(rod.length, angle, scene.surface.friction, True, rod.diameter, rod.tip_radius, speed)


def over_angles(quick: bool) -> list[DroppedRod]:
    """Return elastic rods of every size and angle; the paper's rods are among those of 19 mm."""
    lengths = {d: [length_of(g, d) for g in GAMMAS[quick]] for d in DIAMETERS[quick]}
    lengths[BODY] += PAPER_RODS.values()
    return [
        DroppedRod(length, angle, diameter=d)
        for d in lengths
        for length in sorted(lengths[d])
        for angle in ANGLES[quick]
    ]


def families(quick: bool) -> dict[str, list[RodRun]]:
    """Return all runs of vibrating rods, by family."""
    line, places = curve(quick), PLACES[quick]
    lengths = sorted({*map(length_of, REDUCED[quick]), *(rod.length for rod in line)})
    states = sorted({(rod.friction, rod.yields) for rod in line})
    inclined = over_angles(quick)
    return {
        runs.CURVE: [RodRun(rod, "solid", places) for rod in line],
        runs.OTHERS: [] if quick else [RodRun(rod, "solid", places) for rod in other_inputs()],
        runs.MEASURED: [RodRun(measured(name), "solid", places, name) for name in SETS],
        runs.MODES: [RodRun(DroppedRod(l, friction=f, yields=y)) for l in lengths for f, y in states],
        runs.BLIND: [
            RodRun(DroppedRod(l, friction=float(f))) for l in PAPER_RODS.values() for f in FRICTIONS[quick]
        ],
        runs.HERTZ[0]: [RodRun(replace(rod, tip_radius=TIP)) for rod in inclined],
        runs.HERTZ[1]: [RodRun(rod) for rod in inclined],
        runs.YIELDING: [RodRun(replace(rod, yields=True)) for rod in inclined],
        runs.SPRING: [RodRun(rod, "spring") for rod in inclined],
        **{
            runs.BY_MESHES[state]: [
                RodRun(DroppedRod(length_of(g), angle, STATES[state], True), "pair")
                for g in MESHED_GAMMAS[quick]
                for angle in MESHED_ANGLES[quick]
            ]
            for state in SURFACES[quick]
        },
        runs.ENDS: [RodRun(DroppedRod(length_of(g)), "pair") for g in END_GAMMAS[quick]],
    }


def plan(request: Request, results: Results) -> list[Job | LevelsJob]:
    """Return the jobs, the longest first; with results also those that are cut after a first contact."""
    planned, cut = dict[str, RodRun](), list[Job]()
    for family, members in families(request.quick).items():
        for run in (run for run in members if run.way != "spring"):
            planned[run.name] = run
            if run.way != "pair" and family not in (runs.MODES, runs.BLIND):
                planned[run.twin.name] = run.twin
            if run.way == "solid" and (job := run.cut_job(results)):
                cut.append(job)
    return sorted([*(run.job() for run in planned.values()), *cut], key=lambda job: -job.planned_s)


def conclude(request: Request, results: Results) -> StudyReport:
    """Return the study: vibration and where the energy is, the error of rigid theory, and its group."""
    table = runs.table_of(families(request.quick), results)
    angles = table[table.family.isin(runs.ANGLED)]
    angles = angles[angles[["e_edge", "e_edge_rigid", "T1_over_tau"]].notna().all(axis=1)]
    upright = among(angles, family=runs.YIELDING, diameter_m=BODY)
    upright = upright[upright.angle_deg <= STEEPEST]
    upright = upright.assign(e_static_give=[static_restitution(rod) for rod in upright.rod])
    rods = runs.rods_of(angles)
    body = rods[rods.diameter_m == BODY].rename(columns={"family": "contact"})
    points = table[table.way == "solid"]
    gaps = points[points.reason != ""]
    sentences = findings(table, angles, rods, upright)
    shown = {
        "The paper's rods at 45 degrees and 2.1 m/s, by finite elements": ("paper_rods", paper_table(points)),
        OTHERS_CAPTION: ("other_inputs", others_table(points)),
        "Points without a value or a band": ("gaps", as_table(gaps[[*INPUTS, "reason"]])),
        LEVEL_CAPTION: ("levels", level_table(rods)),
        "Rods of 19 mm": ("rods", as_table(body[RODS_CSV])),
    }
    files = {
        GIVE_CAPTION: ("static_give", upright[GIVE_CSV]),
        "Every contact of every point by finite elements": ("contacts", contacts_of(points)),
        "Every run of a rod, by family": ("points", table.drop(columns=["rod", "intervals"])),
    }
    return StudyReport(
        "gamma",
        "Vibration against slenderness, and when a rod may be called rigid",
        [sentence for _, sentence in sentences],
        pictures(table, angles, rods, upright),
        [
            *(Sheet(name, caption, content) for caption, (name, content) in shown.items() if len(content)),
            *(Sheet(name, caption, as_table(rows), shown=False) for caption, (name, rows) in files.items()),
        ],
        rests_on("gamma"),
        ["modal", "thornton", "slenderness"],
        sentences,
    )


INPUTS = ("point", *DroppedRod(0.1).inputs)
GIVE_CSV = ["gamma", "angle_deg", "e_edge_rigid", "e_static_give", "e_edge"]
RODS_CSV = "contact gamma diameter_m length_m T1_over_tau T1_over_tau_whole error_of_e spread_of_e".split()
GIVE_CAPTION = "Yielding tip, frictionless, 19 mm: e with quasi-static bending alone"
OTHERS_CAPTION = "Rods as slender as the longest with one input changed, and the measured sets' own scenes"
LEVEL_CAPTION = (
    "Slenderness at which error or spread of e over the angles passes a level, and the power of the diameter "
    f"with which that length grows (published {EXPONENT})"
)


def as_table(rows: DataFrame) -> Table:
    """Return a frame as a table for a report."""
    return Table.of([*rows], frame_rows(rows))


def paper_table(points: DataFrame) -> Table:
    """Return one row per paper's rod, kind of contact and surface state."""
    rows = [
        {
            "rod": rod,
            "contact": kind,
            "surface": state,
            "E_vib/E_0, %": with_band(p, VIBRATION, 100.0, 2),
            "e": with_band(p, "e_edge", 1.0, 3),
            "e if rigid": p.e_edge_rigid,
            "contacts": p.contacts,
            "peak force, kN": with_band(p, "peak_force_N", 1e-3, 1),
            "T1/tau": p.T1_over_tau,
            "E_vib/E_0 by modes, %": 100 * p.by_modes,
        }
        for (rod, length), kind, (state, f) in product(PAPER_RODS.items(), KINDS.values(), STATES.items())
        for p in among(points, family=runs.CURVE, length_m=length, contact=kind, f=f).itertuples()
    ]
    return as_table(DataFrame(rows))


def others_table(points: DataFrame) -> Table:
    """Return one row per rod as slender as the paper's longest with another input, and per measured set."""
    longest = (points.gamma - DroppedRod(max(PAPER_RODS.values())).gamma).abs() < ALIKE
    others = points[(points.family == runs.MEASURED) | ((points.family == runs.OTHERS) & longest)]
    rows = [
        {
            "rod": p.point if p.family == runs.MEASURED else "",
            "contact": p.contact,
            "gamma": p.gamma,
            "diameter, mm": 1e3 * p.diameter_m,
            "speed, m/s": p.speed_m_per_s,
            "angle, degrees": p.angle_deg,
            "strength from": p.law,
            "E_vib/E_0, %": with_band(p, VIBRATION, 100.0, 2),
        }
        for p in others.itertuples()
    ]
    return as_table(DataFrame(rows))


def with_band(point: Any, key: str, scale: float, places: int) -> str | None:
    """Return a number of a point with its band, rounded up; None where it is not known."""
    number, band = scale * getattr(point, key), scale * getattr(point, f"{key}_band")
    if np.isnan(number):
        return None
    return f"{number:.{places}f}" + ("" if np.isnan(band) else f" ± {rounded_up(band, places)}")


def contacts_of(points: DataFrame) -> DataFrame:
    """Return one row per contact of every point, of its last level."""
    rows = [
        {
            "point": p.point,
            "gamma": p.gamma,
            "contact": at,
            "start_s": touch.start,
            "end_s": touch.end,
            "impulse_n_Ns": touch.impulse_n,
            "impulse_t_Ns": touch.impulse_t,
        }
        for p in points.itertuples()
        for at, touch in enumerate(p.intervals, 1)
    ]
    return DataFrame(rows)


def level_table(rods: DataFrame) -> Table:
    """Return gamma at which each measure passes each level, for three diameters, and the exponent."""
    rows = []
    for contact, of_contact in rods.groupby("family", sort=False):
        by_diameter = dict(iter(of_contact.groupby("diameter_m")))
        ends = (min(by_diameter), max(by_diameter)) if len(by_diameter) > 1 else (None, None)
        diameters = {"gamma_thinnest": ends[0], "gamma_19_mm": BODY, "gamma_thickest": ends[1]}
        for title, measure in {"error of e": "error_of_e", "spread of e": "spread_of_e"}.items():
            for level in LEVELS:
                row = {"contact": contact, "measure": title, "level": level}
                for name, d in diameters.items():
                    row[name] = crossing(by_diameter[d], level, measure) if d else None
                rows.append({**row, "exponent": exponent(of_contact, level, measure)})
    return as_table(DataFrame(rows))
