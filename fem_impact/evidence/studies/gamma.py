"""Vibration against slenderness by finite elements, beside the measured sets and the modal fidelity."""

from __future__ import annotations

from dataclasses import replace
from math import degrees, hypot
from typing import TYPE_CHECKING

from fem_impact.answers.report import Request, StudyReport
from fem_impact.evidence.studies.gamma_findings import PLAIN, Curves
from fem_impact.evidence.studies.gamma_points import Member, Meshes, first_jobs, more_jobs, point_of
from fem_impact.evidence.studies.gamma_report import study_report
from fem_impact.evidence.studies.pairs import COARSER, PLACES
from fem_impact.evidence.studies.rods import PAPER_RODS, STATES, Drop, length_of
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.scene.shipped import load
from rigid import LIMIT

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


SETS = ("t3-machined", "t4", "t5b")  # tip B at 45 degrees, one of each rod
BETWEEN = (10.0, 14.0, 23.0, LIMIT, 35.0, 45.0, 70.0, 85.0, 100.0, 120.0)  # beside the paper's rods
QUICK_BETWEEN = (LIMIT, 70.0)
FEWER = (15.0, LIMIT, 57.3, 90.0)  # where diameters, speeds and the reading of the strength are changed
DIAMETERS, SPEEDS = (0.010, 0.030), (1.3, 4.2)  # m and m/s, beside those of the curve
ANGLES = (5.0, 15.0, 25.0, 35.0, 60.0, 75.0)  # degrees, beside that of the curve
REDUCED = tuple(10.0 + 2.0 * i for i in range(56))  # gammas of the modal fidelity
QUICK_REDUCED = REDUCED[::11]
FULL, QUICK = Meshes(1.0, COARSER, (0.5, 0.25)), Meshes(COARSER, COARSER**2)
MOST = 400.0  # s of processor time that a finer mesh may be expected to take


def line(quick: bool) -> list[Drop]:
    """Return the drops of the curve: 19 mm, 2.1 m/s, 45 degrees, elastic and yielding, every state."""
    lengths = [*(length_of(g) for g in (QUICK_BETWEEN if quick else BETWEEN)), *PAPER_RODS.values()]
    every = [
        Drop(length, friction=f, yields=y)
        for length in sorted(lengths)
        for y in (False, True)
        for f in STATES.values()
    ]
    return [drop for drop in every if not quick or drop.friction == STATES[PLAIN[drop.yields]]]


def others(quick: bool) -> list[Drop]:
    """Return the drops with another diameter, speed, angle or flow curve than the curve's."""
    if quick:
        return []
    changed = [
        *(Drop(length_of(g, d), diameter=d) for g in FEWER for d in DIAMETERS),
        *(Drop(length_of(g), speed=v) for g in FEWER for v in SPEEDS),
        *(Drop(length, angle) for length in PAPER_RODS.values() for angle in ANGLES),
    ]
    harder = [Drop(length_of(g), law="hardness") for g in FEWER]
    return [
        replace(drop, friction=STATES[PLAIN[y]], yields=y)
        for y in (False, True)
        for drop in (*changed, *(harder if y else []))
    ]


def members(quick: bool) -> list[Member]:
    """Return every point by finite elements: the curve, other inputs, and the measured sets."""
    places = (0.0,) if quick else PLACES
    return [
        *(Member(drop.name, drop.scene(), drop, places) for drop in (*line(quick), *others(quick))),
        *(Member(name, load(name), _like(load(name)), places) for name in SETS),
    ]


def _like(scene: Scene) -> Drop:
    """Return the yielding drop with rod, angle, speed and friction of a scene."""
    rod, impact = scene.projectile, scene.impact
    speed, angle = hypot(impact.v_n, impact.v_t), round(degrees(impact.angle), 9)
    return Drop(rod.length, angle, scene.surface.friction, True, rod.diameter, rod.tip_radius, speed)


def reduced(quick: bool) -> list[Drop]:
    """Return the drops of the modal fidelity: over the same slendernesses, closer together."""
    lengths = {length_of(g) for g in (QUICK_REDUCED if quick else REDUCED)}
    lengths |= {drop.length for drop in line(quick)}
    states = {(drop.friction, drop.yields) for drop in line(quick)}
    return [
        Drop(length, friction=f, yields=yields) for length in sorted(lengths) for f, yields in sorted(states)
    ]


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the jobs, the longest first; with results also those that these call for."""
    quick = request.quick
    meshes, jobs = QUICK if quick else FULL, [Job(d.name, d.scene(), "modal") for d in reduced(quick)]
    for one in members(quick):
        jobs += first_jobs(one, meshes)
        jobs += _more(one, meshes, results) if results else []
    unique = {job.name: job for job in jobs}.values()
    return sorted(unique, key=lambda job: job.planned_s, reverse=True)


def _more(one: Member, meshes: Meshes, results: JobResults) -> list[Job]:
    """Return the jobs that the results of a point call for; measured sets keep the meshes of their study."""
    only = replace(meshes, finer=()) if one.name in SETS else meshes
    wanted = (job for job in more_jobs(one, only, results) if job.kind[1])  # a mesh that is not refused
    return [job for job in wanted if job.planned_s <= MOST]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: curves with bands, where the energy went, and the modal fidelity beside them."""
    quick = request.quick
    meshes = QUICK if quick else FULL
    points = {one.name: point_of(one, meshes, results) for one in members(quick)}
    curves = Curves(
        [points[drop.name] for drop in line(quick)],
        [points[drop.name] for drop in others(quick)],
        [points[name] for name in SETS],
        [(drop, results.get(drop.name)) for drop in reduced(quick)],
    )
    return study_report(curves)
