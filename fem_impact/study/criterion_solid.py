"""Yielding rods of the criterion by finite elements on two meshes, with and without vibration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np

from fem_impact.cost.limits import pair_limit
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.study.criterion_measure import Rod, Rods, whole_ratio
from fem_impact.study.gamma_points import Member, Meshes
from fem_impact.study.pairs import COARSER
from fem_impact.study.rods import STATES, Drop, length_of
from rigid import LIMIT

GAMMAS, QUICK_GAMMAS = (10.0, 15.0, 20.0, LIMIT, 35.0, 50.0, 80.0), (15.0, 35.0)
ANGLES, QUICK_ANGLES = (5.0, 20.0, 35.0, 45.0, 60.0, 75.0), (20.0, 45.0)  # degrees
SURFACES, QUICK_SURFACES = ("contaminated", "machined"), ("machined",)
FULL, QUICK = Meshes(1.0, COARSER, None), Meshes(COARSER, COARSER**2, None)
ENDS = (10.0, 45.0)  # gammas of the elastic drops that confirm the modal fidelity
QUICK_ENDS = (14.0,)


def families(quick: bool) -> dict[str, list[Drop]]:
    """Return the drops of each family by name, sorted by rod."""
    gammas, angles, surfaces = (
        (QUICK_GAMMAS, QUICK_ANGLES, QUICK_SURFACES) if quick else (GAMMAS, ANGLES, SURFACES)
    )
    return {
        f"yielding, {state}": [
            Drop(length_of(g), angle, STATES[state], yields=True) for g in gammas for angle in angles
        ]
        for state in surfaces
    }


def elastic_ends(quick: bool) -> list[Drop]:
    """Return the elastic frictionless drops that confirm the modal fidelity; all are among its own."""
    return [Drop(length_of(g)) for g in (QUICK_ENDS if quick else ENDS)]


def jobs(quick: bool) -> list[Job]:
    """Return the jobs of all rods, with and without vibration, on both meshes, and of the elastic ends."""
    meshes = QUICK if quick else FULL
    ends = (member(d).jobs(meshes.own) for drop in elastic_ends(quick) for d in (drop, without(drop)))
    pairs = (
        member(d).jobs(factor)
        for family in families(quick).values()
        for drop in family
        for d in (drop, without(drop))
        for factor in (meshes.own, meshes.second)
    )
    return [job for group in (*pairs, *ends) for job in group]


def member(drop: Drop) -> Member:
    """Return a drop as a point to compute."""
    return Member(drop.name, drop.scene(), drop)


def without(drop: Drop) -> Drop:
    """Return the drop of the same rod that cannot vibrate."""
    return replace(drop, vibrates=False)


def restitution(drop: Drop, factor: float, results: Results) -> float | None:
    """Return e of a drop on a mesh, None where that is not known."""
    (job,) = member(drop).jobs(factor)
    run = results.get(job.name)
    return or_none(run.restitution.edge.e) if isinstance(run, Outcome) else None


def solid_rods(drops: Iterable[Drop], quick: bool, results: Results) -> Rods:
    """Return the rods of a family; angles at which one of the four runs has no e are left out.

    e with and without vibration are limits of two meshes, and so is their difference, whose band is the
    rod's: what the mesh changes of both alike does not count.
    """
    rods = []
    for _, same in groupby(drops, lambda drop: drop.length):
        rows = [(drop, row) for drop in same if (row := _angle(drop, QUICK if quick else FULL, results))]
        if rows:
            angles, (e, stiff, bands, groups) = [d.angle for d, _ in rows], np.array([r for _, r in rows]).T
            first = rows[0][0]
            rods.append(Rod(first, np.array(angles), e, stiff, groups, whole_ratio(first), bands))
    return rods


def _angle(drop: Drop, meshes: Meshes, results: Results) -> Sequence[float] | None:
    """Return limits of e with and without vibration, the band of their difference, and T1/tau."""
    values = [
        restitution(d, at, results) for d in (drop, without(drop)) for at in (meshes.own, meshes.second)
    ]
    (twin,) = member(without(drop)).jobs(meshes.own)
    run = results.get(twin.name)
    touches = (or_none(run.contact.intervals) or ()) if isinstance(run, Outcome) else ()
    if None in values or not touches:
        return None
    fine, coarse, stiff_fine, stiff_coarse = np.array(values, float)
    e, _ = pair_limit(fine, coarse, COARSER)
    stiff, _ = pair_limit(stiff_fine, stiff_coarse, COARSER)
    _, band = pair_limit(fine - stiff_fine, coarse - stiff_coarse, COARSER)
    return e, stiff, band, drop.first_period / touches[0].duration
