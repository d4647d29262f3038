"""The slenderness criterion: restitution against inclination, per rod, and what rigid theory gets wrong."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.jobs.job import Job
from fem_impact.jobs.run import Results
from fem_impact.study.criterion_measure import Rods, linear_rods, rods_of
from fem_impact.study.criterion_tell import study_report
from fem_impact.study.document import Request, StudyResult, publish
from fem_impact.study.rods import BODY, PAPER_RODS, STATES, TIP, Drop, length_of

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter


GAMMAS, QUICK_GAMMAS = (10, 14, 18, 20, 22, 24, 26.45, 30, 36, 45), (14.0, 26.45, 42.0)
ANGLES = (1.0, 5.0, 10.0, 20.0, 30.0, 40.0, 45.0, 50.0, 60.0, 70.0, 80.0)
QUICK_ANGLES = (1.0, 20.0, 45.0, 70.0)
DIAMETERS, QUICK_DIAMETERS = (0.012, 0.019, 0.030), (0.012, 0.019)
FRICTIONS = np.round(np.arange(0.0, 0.951, 0.05), 3)


@dataclass(frozen=True, slots=True)
class Family:
    """Rods of several diameters on one kind of contact; with ``fixed_tip`` all have one tip radius."""

    name: str
    drop: Drop
    fixed_tip: bool = False


FAMILIES = (
    Family("Hertz, one tip radius", Drop(0.1), fixed_tip=True),
    Family("Hertz, tip in proportion", Drop(0.1)),
    Family("yielding, frictionless", Drop(0.1, yields=True)),
    Family("yielding, machined", Drop(0.1, yields=True, friction=STATES["machined"])),
)


def drops(family: Family, quick: bool) -> list[Drop]:
    """Return the drops of a family, sorted by rod; the paper's rods are among those of 19 mm."""
    gammas = QUICK_GAMMAS if quick else GAMMAS
    chosen = []
    for d in QUICK_DIAMETERS if quick else DIAMETERS:
        lengths = [length_of(g, d) for g in gammas] + (list(PAPER_RODS.values()) if d == BODY else [])
        for length in sorted(lengths):
            rod = replace(
                family.drop, length=length, diameter=d, tip_radius=TIP if family.fixed_tip else None
            )
            chosen += [replace(rod, angle=float(a)) for a in (QUICK_ANGLES if quick else ANGLES)]
    return chosen


def blind_drops(quick: bool) -> list[Drop]:
    """Return elastic drops of the paper's rods at 45 degrees, one per coefficient of friction."""
    frictions = FRICTIONS[::5] if quick else FRICTIONS
    return [Drop(length, friction=float(f)) for length in PAPER_RODS.values() for f in frictions]


def plan(request: Request, results: Results) -> list[Job]:
    """Return the modal job of every drop, and of the same drop with a rod that cannot vibrate."""
    vibrating = [drop for family in FAMILIES for drop in drops(family, request.quick)]
    stiff = [replace(drop, vibrates=False) for drop in vibrating]
    chosen = {d.name: d for d in (*vibrating, *stiff, *blind_drops(request.quick))}
    return [Job(name, drop.scene(), "modal") for name, drop in chosen.items()]


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Return the study: error of rigid theory per rod, where it passes `LEVELS`, and its governing group."""
    quick = request.quick
    families: dict[str, Rods] = {f.name: rods_of(drops(f, quick), results) for f in FAMILIES}
    families["linear spring"] = linear_rods(drops(FAMILIES[1], quick))
    return publish(study_report(families, blind_drops(quick), results), request, results)
