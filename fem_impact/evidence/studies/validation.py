"""Validation in the terms of ASME V&V 20: the model's error beside every uncertainty of its comparison.

Each measured set runs on levels as in the study of the sets, and on one coarse mesh also over a sample of all
uncertain inputs at once (`.inputs`). Response surfaces through that sample give the uncertainty by the
inputs, the share of each input in it, and the spread from test to test.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem_impact import Outcome, Unknown, load, replace_all
from fem_impact.answers.report import Request, StudyReport
from fem_impact.evidence.studies.inputs import UNCERTAIN_INPUTS, changes, one_mesh, sample_values
from fem_impact.evidence.studies.response import fit
from fem_impact.evidence.studies.sets import set_job
from fem_impact.evidence.studies.validated import (
    DRAWN,
    KEYS,
    ValidatedSet,
    compared,
    nominal_place,
    outputs,
    scaled,
    unit_sample,
)
from fem_impact.evidence.studies.validation_report import study_report
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.scene.types import MEASURED_SETS
from rigid.experiments import measured_set

SIZE, QUICK_SIZE = 64, 16  # runs of a set's sample
FEWEST = 2 * len(UNCERTAIN_INPUTS)  # finished runs of a sample


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the jobs of the requested sets: the run of each, and its sample."""
    return [job for name in _sets(request) for job in (_nominal(name, request), *_sample(name, request))]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: comparison errors, their uncertainties, and what causes them."""
    sets = [study_set for name in _sets(request) if (study_set := _validated(name, request, results))]
    return study_report(sets)


def _sets(request: Request) -> tuple[str, ...]:
    """Return the requested sets; by default all, or one of the quick study."""
    return request.ids or (("t5b",) if request.quick else MEASURED_SETS)


def _nominal(name: str, request: Request) -> Job:
    """Return the run at nominal inputs, without its fields."""
    job = set_job(name, request.quick, request.out)
    return replace(job, scene=replace_all(job.scene, {"save.frames": 0}), out=None)


def _sample(name: str, request: Request) -> list[Job]:
    """Return one job per row of the sample of a set, on one mesh."""
    scene, measured = one_mesh(load(name)), measured_set(name)
    unit = unit_sample(QUICK_SIZE if request.quick else SIZE)
    return [
        Job(f"{name}-{at}", replace_all(scene, changes(scene, row)))
        for at, row in enumerate(sample_values(scene, measured, unit, tests=False))
    ]


def _validated(name: str, request: Request, results: JobResults) -> ValidatedSet | None:
    """Return the set from its runs; None where its own or too much of its sample failed."""
    measured, nominal = measured_set(name), results[_nominal(name, request).name]
    runs = [results[job.name] for job in _sample(name, request)]
    finished = {i: run for i, run in enumerate(runs) if isinstance(run, Outcome)}
    if not isinstance(nominal, Outcome) or len(finished) < FEWEST:
        return None
    limits, bands = nominal.validity.mesh_limit, nominal.validity.mesh_band
    if isinstance(limits, Unknown) or isinstance(bands, Unknown):
        return None
    sampled = scaled(name, unit_sample(len(runs)))[list(finished)]
    surface = fit(sampled, np.array([outputs(run, measured) for run in finished.values()]))
    every, tests = (surface(scaled(name, unit_sample(DRAWN), only)) for only in (False, True))
    S = np.array([limits[key] for key in KEYS])
    nominal_values = surface(nominal_place(name))[0]
    u_input = np.sqrt(np.mean((every - nominal_values) ** 2, axis=0))
    comparisons = compared(measured, S, [bands[key] for key in KEYS], u_input)
    return ValidatedSet(name, measured, surface, S - nominal_values, every, tests, comparisons)
