"""Vibration against slenderness: maps by the modal fidelity, some of their points by finite elements too.

The points computed with finite elements are called anchors.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.jobs.job import Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.study.document import Request, StudyResult, publish
from fem_impact.study.gamma_report import FIRST, SOLID, Maps, study_report
from fem_impact.study.rods import BODY, PAPER_RODS, STATES, Drop, length_of

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter


FINE = np.concatenate([np.arange(10.0, 60.0, 2.0), np.arange(60.0, 121.0, 10.0)])
COARSE = np.array([10.0, 15.0, 20.0, 30.0, 40.0, 60.0, 80.0, 120.0])
QUICK_FINE, QUICK_COARSE = np.arange(10.0, 121.0, 22.0), np.array([20.0, 60.0])
SPEED = 2.1  # m/s
DIAMETERS, SPEEDS = (0.010, 0.030), (1.3, 4.2)  # beside 19 mm and 2.1 m/s
ANGLES, QUICK_ANGLES = (5.0, 12.0, 20.0, 28.0, 36.0, 45.0, 54.0, 63.0, 72.0), (20.0, 45.0)
ANCHOR_TIP, QUICK_TIP = 0.6e-3, 0.8e-3  # m
LONG = 0.4  # m: an anchor beyond the paper's rods
SLACK = 1e-6  # s: a cut run ends so long after its first contact


def line(quick: bool) -> list[Drop]:
    """Return the drops of the fine line over gamma: 19 mm, 2.1 m/s, 45 degrees, every state and yielding."""
    return [
        Drop(length_of(g), friction=f, yields=yields)
        for g in (QUICK_FINE if quick else FINE)
        for yields in (False, True)
        for f in STATES.values()
    ]


def grid(quick: bool) -> list[Drop]:
    """Return the drops of the map over diameter, speed, gamma, yielding, surface state and angle."""
    gammas, angles = (QUICK_COARSE, QUICK_ANGLES) if quick else (COARSE, ANGLES)
    others = [] if quick else [*((d, SPEED) for d in DIAMETERS), *((BODY, speed) for speed in SPEEDS)]
    return [
        Drop(length_of(g, d), angle, f, yields, d, speed=speed)
        for d, speed in [(BODY, SPEED), *others]
        for g in gammas
        for yields in (False, True)
        for f in STATES.values()
        for angle in angles
    ]


def anchors(quick: bool) -> list[Drop]:
    """Return the drops that also run with finite elements."""
    if quick:
        return [Drop(PAPER_RODS["0.08 m"], friction=STATES["machined"], yields=True)]
    lengths = (*PAPER_RODS.values(), LONG)
    elastic = [Drop(length) for length in lengths]
    machined = [Drop(length, friction=STATES["machined"], yields=True) for length in lengths]
    longest_shortest = [machined[0], machined[2]]
    contaminated = [replace(drop, friction=STATES["contaminated"]) for drop in longest_shortest]
    steep = [replace(drop, angle=20.0) for drop in longest_shortest]
    return [*elastic, *machined, *contaminated, *steep, replace(elastic[0], friction=STATES["machined"])]


def plan(request: Request, results: Results) -> list[Job]:
    """Return the jobs of maps and anchors; with results, also drops with two contacts cut after the first."""
    tip = QUICK_TIP if request.quick else ANCHOR_TIP
    chosen = anchors(request.quick)
    drops = {drop.name: drop for drop in (*line(request.quick), *grid(request.quick), *chosen)}
    jobs = {name: Job(name, drop.scene(), "modal") for name, drop in drops.items()}
    solid = [Job(f"{SOLID}{drop.name}", drop.scene(tip), "solid") for drop in chosen]
    cut = []
    for drop in line(request.quick):
        run = results.get(drop.name)
        if isinstance(run, Outcome) and len(known(run.contact.intervals)) > 1:
            scene, end = drop.scene(), known(run.contact.intervals)[0].end + SLACK
            scene = replace(scene, accuracy=replace(scene.accuracy, max_time=end))
            cut.append(Job(f"{FIRST}{drop.name}", scene, "modal"))
    return [*jobs.values(), *solid, *cut]


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Return the study: maps, differences from finite elements, vibration returned by later contacts."""
    quick = request.quick
    maps = Maps(line(quick), grid(quick), anchors(quick), results)
    return publish(study_report(maps, QUICK_TIP if quick else ANCHOR_TIP), request, results)
