"""Vibration against slenderness by finite elements, beside the measured sets and the modal fidelity."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise, product
from math import degrees, hypot
from typing import Any

import numpy as np
from pandas import DataFrame

from fem_impact import Scene, load
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.studies import gamma_figures as figures
from fem_impact.evidence.studies import rods as dropped
from fem_impact.evidence.studies.report_parts import rests_on
from fem_impact.jobs.job import Job, JobResults
from fem_impact.tables.table import Table
from fem_impact.tables.text import rounded_up
from rigid import LIMIT

SETS = ("t3-machined", "t4", "t5b")  # tip B at 45 degrees, one of each rod
BETWEEN = (10.0, 14.0, 23.0, LIMIT, 35.0, 45.0, 70.0, 85.0, 100.0, 120.0)  # beside the paper's rods
QUICK_BETWEEN = (LIMIT, 70.0)
FEWER = (15.0, LIMIT, 57.3, 90.0)  # where diameters, speeds and the reading of the strength are changed
DIAMETERS, SPEEDS = (0.010, 0.030), (1.3, 4.2)  # m and m/s, beside those of the curve
ANGLES = (5.0, 15.0, 25.0, 35.0, 60.0, 75.0)  # degrees, beside that of the curve
REDUCED = tuple(10.0 + 2.0 * i for i in range(56))  # gammas of the modal fidelity
QUICK_REDUCED = REDUCED[::11]
PLACES = 2  # of the barrier's grid, of a rod that can vibrate
ONE_PERCENT = 0.01  # of E_0: beyond it vibration counts as large
ALIKE = 0.1  # m^-0.3815, difference of gammas that are called one


def line(quick: bool) -> list[dropped.DroppedRod]:
    """Return the rods of the curve: 19 mm, 2.1 m/s, 45 degrees, elastic and yielding, every state."""
    lengths = [
        *(dropped.length_of(g) for g in (QUICK_BETWEEN if quick else BETWEEN)),
        *dropped.PAPER_RODS.values(),
    ]
    return [
        dropped.DroppedRod(length, friction=f, yields=yields)
        for length in sorted(lengths)
        for yields, kind in dropped.KINDS.items()
        for state, f in dropped.STATES.items()
        if not quick or state == dropped.PLAIN[kind]
    ]


def others(quick: bool) -> list[dropped.DroppedRod]:
    """Return the rods with another diameter, speed, angle or flow curve than the curve's."""
    if quick:
        return []
    changed = [
        *(dropped.DroppedRod(dropped.length_of(g, d), diameter=d) for g in FEWER for d in DIAMETERS),
        *(dropped.DroppedRod(dropped.length_of(g), speed=v) for g in FEWER for v in SPEEDS),
        *(dropped.DroppedRod(length, angle) for length in dropped.PAPER_RODS.values() for angle in ANGLES),
    ]
    harder = [dropped.DroppedRod(dropped.length_of(g), law="hardness") for g in FEWER]
    return [
        replace(rod, friction=dropped.STATES[dropped.PLAIN[kind]], yields=yields)
        for yields, kind in dropped.KINDS.items()
        for rod in (*changed, *(harder if yields else []))
    ]


def reduced(quick: bool) -> list[dropped.DroppedRod]:
    """Return the rods of the modal fidelity: over the same slendernesses, closer together."""
    lengths = {dropped.length_of(g) for g in (QUICK_REDUCED if quick else REDUCED)}
    lengths |= {rod.length for rod in line(quick)}
    states = {(rod.friction, rod.yields) for rod in line(quick)}
    return [
        dropped.DroppedRod(length, friction=f, yields=yields)
        for length in sorted(lengths)
        for f, yields in sorted(states)
    ]


def families(quick: bool) -> dict[str, list[dropped.RodRun]]:
    """Return all runs of vibrating rods, by family."""
    places = 1 if quick else PLACES
    rods = {"curve": line(quick), "other inputs": others(quick)}
    solid = {name: [dropped.RodRun(rod, "solid", places) for rod in of] for name, of in rods.items()}
    sets = [dropped.RodRun(_most_like(load(name)), "solid", places, name) for name in SETS]
    return {**solid, "measured sets": sets, "modes": [dropped.RodRun(rod) for rod in reduced(quick)]}


def _most_like(scene: Scene) -> dropped.DroppedRod:
    """Return the yielding rod with length, diameter, tip, angle, speed and friction of a scene."""
    rod, impact = scene.projectile, scene.impact
    speed, angle = hypot(impact.v_n, impact.v_t), round(degrees(impact.angle), 9)
    return dropped.DroppedRod(
        rod.length, angle, scene.surface.friction, True, rod.diameter, rod.tip_radius, speed
    )


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the jobs, the longest first; with results also those that are cut after a first contact."""
    runs = [run for family in families(request.quick).values() for run in family]
    solid = [run for run in runs if run.fidelity == "solid"]
    cut = [job for run in solid if run.name in results and (job := dropped.cut_job(run, results[run.name]))]
    return dropped.longest_first([*runs, *(run.twin for run in solid)], cut)


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: curves with bands, where the energy went, and the modal fidelity beside them."""
    table = dropped.run_table(families(request.quick), results)
    points, modes = dropped.points_of(table, results), table[table.family == "modes"]
    sentences = findings(points)
    pictures = [figures.curve(points, modes), figures.later_contacts(points)]
    pictures += [figures.other_inputs(points)] if (points.family == "other inputs").any() else []
    gaps = points[points.reason != ""]
    gaps_sheet = Sheet(
        "gaps",
        "Points without a value or a band",
        dropped.as_table(gaps.loc[:, :"law"].assign(reason=gaps.reason)),
    )
    sheets = [
        Sheet("rods", "The paper's rods at 45 degrees and 2.1 m/s, by finite elements", rod_table(points)),
        *([gaps_sheet] if len(gaps) else []),
        Sheet(
            "points",
            "Every point by finite elements",
            dropped.as_table(points.loc[:, :"reason"]),
            shown=False,
        ),
        Sheet("contacts", "Every contact of every point", contact_table(points), shown=False),
        Sheet(
            "reduced",
            "The reduced model (modal)",
            dropped.as_table(modes.loc[:, : dropped.RESTITUTION]),
            shown=False,
        ),
    ]
    return StudyReport(
        "gamma",
        "Vibration against slenderness",
        sentences,
        pictures,
        sheets,
        [*rests_on("dropped rods"), *rests_on("gamma")],
        ["modal", "thornton", "slenderness"],
        [("vibration", sentence) for sentence in sentences],
    )


def rod_table(points: DataFrame) -> Table:
    """Return one row per paper's rod, kind of contact and surface state."""
    curve = points[points.family == "curve"]
    rows = [
        {
            "rod": rod,
            "contact": kind,
            "surface": state,
            "E_vib/E_0, %": _with_band(p.E_vib_over_E_0, p.E_vib_over_E_0_band, 100.0, 2),
            "e": _with_band(p.e_edge, p.e_edge_band, 1.0, 3),
            "e if rigid": p.e_edge_rigid,
            "contacts": p.contacts,
            "peak force, kN": _with_band(p.peak_force_N, p.peak_force_N_band, 1e-3, 1),
            "T1/tau": p.T1_over_tau,
            "E_vib/E_0 by modes, %": None if p.by_modes is None else 100 * p.by_modes,
        }
        for (rod, length), kind, (state, f) in product(
            dropped.PAPER_RODS.items(), dropped.KINDS.values(), dropped.STATES.items()
        )
        for p in dropped.among(curve, length_m=length, contact=kind, f=f).itertuples()
    ]
    return Table.of(tuple(rows[0]), rows)


def _with_band(value: float | None, band: float | None, scale: float, places: int) -> str | None:
    if value is None:
        return None
    return f"{scale * value:.{places}f}" + ("" if band is None else f" ± {rounded_up(scale * band, places)}")


def contact_table(points: DataFrame) -> Table:
    """Return one row per contact of every point, of its last level."""
    rows = [
        [p.point, p.gamma, at, touch.start, touch.end, touch.impulse_n, touch.impulse_t]
        for p in points.itertuples()
        for at, touch in enumerate(p.intervals, 1)
    ]
    head = ("point", "gamma", "contact", "start_s", "end_s", "impulse_n_Ns", "impulse_t_Ns")
    return Table.of(head, rows)


def findings(points: DataFrame) -> list[str]:
    """Return the sentences of the study."""
    curve = points[points.family == "curve"]
    sentences = [
        what_the_limit_says(curve),
        *(how_much(curve, kind) for kind in dropped.PLAIN),
        *(where_it_peaks(curve, kind) for kind in dropped.PLAIN),
        *(other_inputs(points, kind) for kind in dropped.PLAIN),
        measured_sets(points),
        *(modes_less_elements(curve, kind) for kind in dropped.PLAIN),
        how_sure(points),
    ]
    return [sentence for sentence in sentences if sentence]


def how_much(curve: DataFrame, kind: str) -> str:
    """Return vibration of the paper's rods, in the surface state of `PLAIN`."""
    shares = {p.length_m: share(p) for p in _known(figures.plain_line(curve, kind))}
    rods = [f"{shares[length]} ({rod} rod)" for rod, length in dropped.PAPER_RODS.items() if length in shares]
    tip = f"A{'n' if kind == 'elastic' else ''} {kind} tip ({dropped.PLAIN[kind]}, 45 degrees, 2.1 m/s)"
    return f"{tip} leaves as vibration, of E_0: {', '.join(rods)}." if rods else ""


def where_it_peaks(curve: DataFrame, kind: str) -> str:
    """Return the slenderness of most vibration, and what makes it fall beyond."""
    points = [p for p in _known(figures.plain_line(curve, kind)) if p.E_vib_over_E_0_own_mesh is not None]
    if len(points) < 2:
        return ""
    top = max(points, key=_vibration)
    after = points[points.index(top) + 1 :]
    peak = f"{kind.capitalize()}, {dropped.PLAIN[kind]}: vibration is largest at gamma {top.gamma:.0f} with "
    peak += f"{share(top)} of E_0"
    if not after:
        return f"{peak}, the longest rod."
    low, last = min(after, key=_vibration), after[-1]
    bands = [p.E_vib_over_E_0_band or 0.0 for p in (top, low)]
    if _vibration(top) - _vibration(low) <= sum(bands):
        return f"{peak}; beyond it stays within the bands (least {share(low)} at gamma {low.gamma:.0f})."
    again = f" At gamma {last.gamma:.0f} it is {share(last)}." if last is not low else ""
    return f"{peak}; it falls {_fall(top, low)}{again}"


def _fall(top: Any, low: Any) -> str:
    """Return how far vibration falls, and which part of that later contacts make."""
    last, fall = low.E_vib_over_E_0_own_mesh, _vibration(top) - _vibration(low)
    first = last if low.E_vib_over_E_0_first_contact is None else low.E_vib_over_E_0_first_contact
    back = first - last
    mostly = "later contacts give energy back" if back > fall / 2 else "the first contact itself leaves less"
    return (
        f"to {share(low)} at gamma {low.gamma:.0f}, mostly because {mostly}: the first contact leaves "
        f"{100 * first:.2g} % there, "
        + (f"later contacts change that by {-100 * back:+.2g} % of E_0." if back else "no later one follows.")
    )


def what_the_limit_says(curve: DataFrame) -> str:
    """Return vibration and e at the limit of Eq 29, and where vibration passes `ONE_PERCENT`."""
    sentences = []
    for kind, state in dropped.PLAIN.items():
        points = _known(figures.plain_line(curve, kind))
        for p in [p for p in points if abs(p.gamma - LIMIT) < 1e-6]:
            change = ""
            if p.e_edge is not None and p.e_edge_rigid is not None:
                change = f" and e is {p.e_edge:.3f} where a rod that cannot vibrate has {p.e_edge_rigid:.3f}"
            where = f"{kind.capitalize()}, {state}: vibration there takes {share(p)} of E_0{change}"
            sentences.append(f"{where}; {_passes(points)}.")
    rods = ", ".join(
        name for name, length in dropped.PAPER_RODS.items() if dropped.DroppedRod(length).gamma <= LIMIT
    )
    called = f"The limit gamma <= {LIMIT} calls the {rods} rod rigid and the longer ones not."
    return " ".join([called, *sentences]) if sentences else ""


def _passes(points: Sequence[Any]) -> str:
    """Return from which slenderness on vibration takes more than `ONE_PERCENT`, by linear interpolation."""
    first = points[0]
    if _vibration(first) > ONE_PERCENT:
        return (
            f"it takes more than {ONE_PERCENT:.0%} of E_0 from gamma {first.gamma:.0f} on, the shortest rod"
        )
    for low, high in pairwise(points):
        below, above = _vibration(low), _vibration(high)
        if above > ONE_PERCENT:
            gamma = low.gamma + (high.gamma - low.gamma) * (ONE_PERCENT - below) / (above - below)
            return f"it passes {ONE_PERCENT:.0%} of E_0 at gamma {gamma:.1f}"
    return f"it never reaches {ONE_PERCENT:.0%} of E_0"


def other_inputs(points: DataFrame, kind: str) -> str:
    """Return vibration of rods as slender as the longest of the paper with one input changed."""
    usual = dropped.DroppedRod(max(dropped.PAPER_RODS.values()))
    changed = [
        f"{_changed(p, usual)} {share(p)}"
        for p in _known(points[(points.family == "other inputs") & (points.contact == kind)])
        if abs(p.gamma - usual.gamma) < ALIKE
    ]
    curve = dropped.among(figures.plain_line(points[points.family == "curve"], kind), length_m=usual.length)
    if not changed or curve.empty:
        return ""
    return (
        f"Other inputs at gamma {usual.gamma:.0f}, {kind}, {dropped.PLAIN[kind]}: vibration is "
        f"{share(next(curve.itertuples()))} of E_0 on the curve ({usual.diameter * 1e3:g} mm, "
        f"{usual.speed:g} m/s, {usual.angle:g} degrees), and with {', '.join(changed)}."
    )


def _changed(point: Any, usual: dropped.DroppedRod) -> str:
    """Return the input of a point that is not the usual one."""
    if point.law != usual.law:
        return f"strength from {point.law}"
    if point.angle_deg != usual.angle:
        return f"{point.angle_deg:g} degrees"
    speed, diameter = point.speed_m_per_s, point.diameter_m
    return f"{speed:g} m/s" if speed != usual.speed else f"{diameter * 1e3:g} mm"


def measured_sets(points: DataFrame) -> str:
    """Return vibration of the measured sets' own scenes."""
    sets = [
        f"{p.point} (gamma {p.gamma:.1f}, {p.speed_m_per_s:.2f} m/s) {share(p)}"
        for p in _known(points[points.family == "measured sets"])
    ]
    return f"The measured sets' own scenes keep as vibration, of E_0: {', '.join(sets)}." if sets else ""


def modes_less_elements(curve: DataFrame, kind: str) -> str:
    """Return how far the modal fidelity lies from the points of the curve."""
    points = _known(curve[(curve.contact == kind) & curve.by_modes.notna()])
    differences = [p.by_modes - p.E_vib_over_E_0 for p in points]
    if not differences:
        return ""
    return (
        f"{kind.capitalize()} tips: vibration by modes less by finite elements, of E_0: root mean square "
        f"{100 * np.linalg.norm(differences) / len(differences) ** 0.5:.2g} %, largest "
        f"{100 * max(differences, key=abs):+.2g} %, over {len(differences)} points of the curve."
    )


def how_sure(points: DataFrame) -> str:
    """Return how many points have a band as narrow as wanted, and how many are gaps."""
    close = points.band_as_wanted == "yes"
    doubted = points.doubted & ~close
    residuals = points.residual_over_E_0.dropna().astype(float).abs()
    return (
        f"Levels give vibration of {close.sum()} of {len(points)} points within {dropped.CLOSE:.0%} of "
        f"itself or {dropped.LEAST:g} of E_0; in {doubted.sum()} of the others its two counts, by modes and "
        f"without them, differ by more. {(points.reason != '').sum()} points have no value or no band. "
        f"The largest residual of their ledgers is {max(residuals, default=0.0):.1g} of E_0."
    )


def share(point: Any) -> str:
    """Return vibration of a point with its band, rounded up to 0.01, in per cent."""
    value, band = 100 * (point.E_vib_over_E_0 or 0.0), point.E_vib_over_E_0_band
    if band is None:
        return f"{value:.2g} %"
    if value < 0.0:
        return f"less than {value + 100 * band:.2f} %"
    return f"{value:.2f} ± {rounded_up(100 * band, 2)} %"


def _known(points: DataFrame) -> list[Any]:
    """Return the points whose vibration is known, each with the columns as attributes."""
    return list(points[points[dropped.VIBRATION].notna()].itertuples())


def _vibration(point: Any) -> float:
    return float(point.E_vib_over_E_0)
