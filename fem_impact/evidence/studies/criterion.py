"""The slenderness criterion: restitution against inclination, per rod, and what rigid theory gets wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem_impact.answers.report import Request, StudyReport
from fem_impact.evidence.studies import criterion_solid
from fem_impact.evidence.studies.criterion_measure import linear_rods, modal_restitution, rods_of
from fem_impact.evidence.studies.criterion_report import HERTZ, YIELDING, study_report
from fem_impact.evidence.studies.criterion_solid import member, restitution, solid_rods, without
from fem_impact.evidence.studies.rods import BODY, PAPER_RODS, TIP, Drop, length_of
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults

GAMMAS, QUICK_GAMMAS = (10, 14, 18, 20, 22, 24, 26.45, 30, 36, 45), (14.0, 26.45, 42.0)
ANGLES = (1.0, 5.0, 10.0, 20.0, 30.0, 40.0, 45.0, 50.0, 60.0, 70.0, 80.0)
QUICK_ANGLES = (1.0, 20.0, 45.0, 70.0)
DIAMETERS, QUICK_DIAMETERS = (0.012, 0.019, 0.030), (0.012, 0.019)
Values = float | list[float] | None  # at one place of the barrier's grid, or at each
FRICTIONS = np.round(np.arange(0.0, 0.951, 0.05), 3)


FAMILIES = {
    HERTZ[0]: Drop(0.1, tip_radius=TIP),
    HERTZ[1]: Drop(0.1),
    YIELDING: Drop(0.1, yields=True),
}
"""Kinds of contact by the modal fidelity, each as a drop whose length, diameter and angle are then varied."""


def drops(family: Drop, quick: bool) -> list[Drop]:
    """Return the drops of a family, sorted by rod; the paper's rods are among those of 19 mm."""
    gammas, angles = (QUICK_GAMMAS, QUICK_ANGLES) if quick else (GAMMAS, ANGLES)
    return [
        replace(family, length=length, diameter=d, angle=angle)
        for d in (QUICK_DIAMETERS if quick else DIAMETERS)
        for length in sorted(
            [*(length_of(g, d) for g in gammas), *(PAPER_RODS.values() if d == BODY else ())]
        )
        for angle in angles
    ]


def blind_drops(quick: bool) -> list[Drop]:
    """Return elastic drops of the paper's rods at 45 degrees, one per coefficient of friction."""
    frictions = FRICTIONS[::5] if quick else FRICTIONS
    return [Drop(length, friction=float(f)) for length in PAPER_RODS.values() for f in frictions]


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the jobs by finite elements, the longest first, and those by modes."""
    solid = sorted(criterion_solid.jobs(request.quick), key=lambda job: job.planned_s, reverse=True)
    return [*solid, *modal_jobs(request.quick)]


def modal_jobs(quick: bool) -> list[Job]:
    """Return the modal job of every drop, and of the same drop with a rod that cannot vibrate."""
    vibrating = [drop for family in FAMILIES.values() for drop in drops(family, quick)]
    stiff = [replace(drop, vibrates=False) for drop in vibrating]
    chosen = {d.name: d for d in (*vibrating, *stiff, *blind_drops(quick))}
    return [Job(name, drop.scene(), "modal") for name, drop in chosen.items()]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: error of rigid theory per rod, where it passes `LEVELS`, and its governing group."""
    quick = request.quick
    families = {name: rods_of(drops(family, quick), results) for name, family in FAMILIES.items()}
    families["linear spring"] = linear_rods(drops(FAMILIES[HERTZ[1]], quick))
    found = {name: solid_rods(of, quick, results) for name, of in criterion_solid.families(quick).items()}
    families |= {name: rods for name, rods in found.items() if rods}
    confirmed = criterion_solid.elastic_ends(quick)
    ends = [(drop, *_ends(drop, quick, results)) for drop in confirmed]
    return study_report(families, tuple(found), ends, blind_drops(quick), results)


def _ends(drop: Drop, quick: bool, results: JobResults) -> tuple[float | None, float | None]:
    """Return the change of e by vibration of an elastic drop by finite elements and by modes."""
    factor, stiff = (criterion_solid.QUICK if quick else criterion_solid.FULL).own, without(drop)
    solid = [restitution(member(one, quick), factor, results) for one in (drop, stiff)]
    modal = [modal_restitution(one, results) for one in (drop, stiff)]
    return _change(*solid), _change(*modal)


def _change(e: Values, e_rigid: Values) -> float | None:
    return None if e is None or e_rigid is None else float(np.mean(e) - np.mean(e_rigid))
