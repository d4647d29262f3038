"""Yielding rods of the criterion by finite elements on two meshes, with and without vibration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np

from fem_impact.answers.refine.extrapolate import limit_of
from fem_impact.evidence.studies.criterion_measure import Rod, Rods, whole_ratio
from fem_impact.evidence.studies.gamma_points import Member, Meshes
from fem_impact.evidence.studies.pairs import COARSER, PLACES
from fem_impact.evidence.studies.rods import STATES, Drop, length_of
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from rigid import LIMIT

GAMMAS, QUICK_GAMMAS = (10.0, 15.0, 20.0, LIMIT, 35.0, 50.0, 80.0), (15.0, 35.0)
ANGLES, QUICK_ANGLES = (5.0, 20.0, 35.0, 45.0, 60.0, 75.0), (20.0, 45.0)  # degrees
SURFACES, QUICK_SURFACES = ("contaminated", "machined"), ("machined",)
FULL, QUICK = Meshes(1.0, COARSER), Meshes(COARSER, COARSER**2)
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
    ends = (member(d, quick).jobs(meshes.own) for drop in elastic_ends(quick) for d in (drop, without(drop)))
    pairs = (
        member(d, quick).jobs(factor)
        for family in families(quick).values()
        for drop in family
        for d in (drop, without(drop))
        for factor in (meshes.own, meshes.second)
    )
    return [job for group in (*pairs, *ends) for job in group]


def member(drop: Drop, quick: bool) -> Member:
    """Return a drop as a point to compute, at one place of the barrier's grid if it is to be quick."""
    return Member(drop.name, drop.scene(), drop, (0.0,) if quick else PLACES)


def without(drop: Drop) -> Drop:
    """Return the drop of the same rod that cannot vibrate."""
    return replace(drop, vibrates=False)


def restitution(one: Member, factor: float, results: JobResults) -> list[float] | None:
    """Return e of a drop on a mesh at each place, None where one of them is not known."""
    runs = [results.get(job.name) for job in one.jobs(factor)]
    found = [or_none(run.restitution.edge.e) for run in runs if isinstance(run, Outcome)]
    known = [e for e in found if e is not None]
    return known if len(known) == len(runs) else None


def solid_rods(drops: Iterable[Drop], quick: bool, results: JobResults) -> Rods:
    """Return the rods of a family; angles at which one of the four runs has no e are left out.

    e with and without vibration are limits of two meshes, and so is their difference, whose band is the
    rod's: what the mesh changes of both alike does not count.
    """
    rods = []
    for _, same in groupby(drops, lambda drop: drop.length):
        rows = [(drop, row) for drop in same if (row := _angle(drop, quick, results))]
        if rows:
            angles, (e, stiff, bands, groups) = [d.angle for d, _ in rows], np.array([r for _, r in rows]).T
            first = rows[0][0]
            rods.append(Rod(first, np.array(angles), e, stiff, groups, whole_ratio(first), bands))
    return rods


def _angle(drop: Drop, quick: bool, results: JobResults) -> Sequence[float] | None:
    """Return limits of e with and without vibration, the band of their difference, and T1/tau."""
    meshes, stiff = QUICK if quick else FULL, member(without(drop), quick)
    sizes = [meshes.own, meshes.second]
    both = [[restitution(one, at, results) for at in sizes] for one in (member(drop, quick), stiff)]
    run = results.get(stiff.jobs(meshes.own)[0].name)
    touches = (or_none(run.contact.intervals) or ()) if isinstance(run, Outcome) else ()
    if any(None in on_meshes for on_meshes in both) or not touches:
        return None
    e, e_rigid = (np.array(on_meshes, float) for on_meshes in both)
    limit, rigid, change = (limit_of(sizes, values.tolist()) for values in (e, e_rigid, e - e_rigid))
    return limit.value, rigid.value, change.uncertainty, drop.first_period / touches[0].duration
