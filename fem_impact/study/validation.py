"""Validation in the terms of ASME V&V 20: the model's error beside every uncertainty of its comparison.

Each measured set runs on two meshes as in the study of the sets, and on the coarser one also over a sample of
all uncertain inputs at once (`fem_impact.study.inputs`). Response surfaces through that sample give the
uncertainty by the inputs, the share of each input in it, the spread from test to test, and the constants that
would meet all sets at once (`fem_impact.study.calibration`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, sqrt
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import qmc

from fem_impact.arrays import Array
from fem_impact.cost.limits import mesh_limits
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.study.compare import MEASURED
from fem_impact.study.document import Request, StudyResult, publish
from fem_impact.study.inputs import UNCERTAIN_INPUTS, changes, sample_values
from fem_impact.study.response import ResponseSurface, fit
from fem_impact.study.sets import HALF_CELL, by_mesh, jobs_of
from rigid import Errors
from rigid.experiments import MeasuredSet, derived_columns, measured_set
from rigid.uncertainty import sensitivities
from rigid.uncertainty.estimate import MOTION

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter

SEED = 20260101  # of all samples
SIZE, QUICK_SIZE = 64, 16  # runs of a set's sample
DRAWN = 1024  # points at which a response surface is evaluated
COVERAGE = 2.0  # E +- 2 u_val, the interval of the model's error (V&V 20, section 6)
NAMES = tuple(q.measured for q in MEASURED if q.measured)
VIBRATION = "E_vib_over_E_0"
OUTPUTS = (*NAMES, VIBRATION)
"""Quantities of a response surface, by their names in the measured sets."""
KEYS = (*(q.key.name for q in MEASURED), VIBRATION)
"""Their keys in an outcome."""
FEWEST = 2 * len(UNCERTAIN_INPUTS)  # finished runs of a sample


@dataclass(frozen=True, slots=True)
class Comparison:
    """One quantity of one set in the terms of V&V 20, each in the unit of the quantity.

    Attributes
    ----------
    S, D : computed value, the limit of two meshes at the nominal inputs; measured mean
    u_num : half of the two-mesh band
    u_input : standard deviation over the uncertain inputs, each uniform over its interval
    u_D : standard error of the mean, and of the tracked velocities
    """

    set: str
    quantity: str
    S: float
    D: float
    u_num: float
    u_input: float
    u_D: float

    @property
    def E(self) -> float:
        """Comparison error S - D."""
        return self.S - self.D

    @property
    def u_val(self) -> float:
        """Standard uncertainty of the comparison error."""
        return hypot(self.u_num, self.u_input, self.u_D)

    @property
    def interval(self) -> tuple[float, float]:
        """Interval of the model's error, E +- 2 u_val."""
        return self.E - COVERAGE * self.u_val, self.E + COVERAGE * self.u_val

    @property
    def verdict(self) -> str:
        """Return whether the comparison shows an error of the model."""
        low, high = self.interval
        if low <= 0 <= high:
            return "no error shown"
        return f"model too {'high' if low > 0 else 'low'} by at least {min(abs(low), abs(high)):.2g}"


@dataclass(frozen=True, slots=True)
class ValidatedSet:
    """What the runs of one measured set give.

    Attributes
    ----------
    name, measured : id of the set, and its tests
    surface : `OUTPUTS` over the uncertain inputs, on the coarser mesh
    shift : (outputs,) float64, limit of two meshes less the coarser mesh, at the nominal inputs
    all_inputs, tests : (n, outputs) float64, drawn over all inputs, over those that vary between tests
    comparisons : one a measured quantity
    """

    name: str
    measured: MeasuredSet
    surface: ResponseSurface
    shift: Array
    all_inputs: Array
    tests: Array
    comparisons: tuple[Comparison, ...]


def plan(request: Request, results: Results) -> list[Job]:
    """Return the jobs of the requested sets: two meshes at two places, and the sample."""
    return [
        job for name in _sets(request) for job in (*_meshes(name, request).values(), *_sample(name, request))
    ]


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Return the study: comparison errors, their uncertainties, what causes them, calibrated constants."""
    from fem_impact.study.validation_report import study_report

    sets = [found for name in _sets(request) if (found := _validated(name, request, results))]
    return publish(study_report(sets), request, results)


def _sets(request: Request) -> tuple[str, ...]:
    """Return the requested sets; by default all, or one of the quick study."""
    return request.ids or (("t5b",) if request.quick else MEASURED_SETS)


def _meshes(name: str, request: Request) -> dict[str, Job]:
    """Return the jobs at nominal inputs by mesh and place, without their fields."""
    jobs = jobs_of(name, request.quick, request.out)
    kinds = ("fine", "coarse", f"fine-{HALF_CELL}", f"coarse-{HALF_CELL}")
    return {
        kind: Job(jobs[kind].name, replace_all(jobs[kind].scene, {"save.frames": 0}))
        for kind in kinds
        if kind in jobs
    }


def unit_sample(n: int) -> Array:
    """Return a seeded scrambled Sobol sequence (n, d) in the unit cube of `UNCERTAIN_INPUTS`."""
    sobol = qmc.Sobol(len(UNCERTAIN_INPUTS), rng=np.random.default_rng(SEED))
    return np.asarray(sobol.random(n))


def _sample(name: str, request: Request) -> list[Job]:
    """Return one job per row of the sample of a set, on the coarser mesh."""
    scene, measured = _meshes(name, request)["coarse"].scene, measured_set(name)
    unit = unit_sample(QUICK_SIZE if request.quick else SIZE)
    return [
        Job(f"{name}-{at}", replace_all(scene, changes(scene, row)))
        for at, row in enumerate(sample_values(scene, measured, unit, tests=False))
    ]


def _validated(name: str, request: Request, results: Results) -> ValidatedSet | None:
    """Return the set from its runs; None where one of its meshes or too much of its sample failed."""
    measured = measured_set(name)
    meshes, failed = by_mesh({kind: results[job.name] for kind, job in _meshes(name, request).items()})
    runs = [results[job.name] for job in _sample(name, request)]
    finished = {i: run for i, run in enumerate(runs) if isinstance(run, Outcome)}
    if failed or len(finished) < FEWEST:
        return None
    sampled = scaled(name, unit_sample(len(runs)))[list(finished)]
    surface = fit(sampled, np.array([outputs(run, measured) for run in finished.values()]))
    every, tests = (surface(scaled(name, unit_sample(DRAWN), only)) for only in (False, True))
    limits, bands = mesh_limits(meshes["fine"], meshes["coarse"])
    S = np.array([limits[key] for key in KEYS])
    compared = _compared(measured, S, [bands[key] for key in KEYS], every.std(axis=0))
    shift = S - np.mean([outputs(run, measured) for run in meshes["coarse"]], axis=0)
    return ValidatedSet(name, measured, surface, shift, every, tests, compared)


def _compared(
    measured: MeasuredSet, S: Array, bands: Sequence[float], u_input: Array
) -> tuple[Comparison, ...]:
    statistics, tracking = measured.statistics(), tracking_uncertainty(measured)
    return tuple(
        Comparison(
            measured.id,
            quantity.name,
            float(S[i]),
            statistics[name].mean,
            bands[i] / COVERAGE,
            float(u_input[i]),
            hypot(statistics[name].sd / sqrt(statistics[name].n), tracking[name]),
        )
        for i, (quantity, name) in enumerate(zip(MEASURED, NAMES, strict=True))
    )


def scaled(name: str, unit: Array, tests: bool = False) -> Array:
    """Return the sampled inputs (n, d) of a set, each over its own interval from 0 to 1."""
    scene, measured = load(name), measured_set(name)
    low, high = np.array([i.span(scene, measured) for i in UNCERTAIN_INPUTS]).T
    return np.asarray((sample_values(scene, measured, unit, tests) - low) / (high - low))


def outputs(run: Outcome, measured: MeasuredSet) -> list[float]:
    """Return `OUTPUTS` of a run, worked out as the table of the measured set was."""
    m = run.motion
    motion = {name: np.asarray(getattr(m, name)) for name in MOTION}
    body = {**measured.body, "k2": m.k_squared}
    derived: dict[str, Array] = {**motion, **derived_columns(motion, **body, mass=measured.mass)}
    return [*(float(derived[name]) for name in NAMES), known(run.energy.vibration)]


def tracking_uncertainty(measured: MeasuredSet) -> dict[str, float]:
    """Return the standard uncertainty of the measured means, by name, by the error of tracked velocities."""
    at = {name: np.asarray(np.mean(measured.motion[name])) for name in MOTION}
    slopes = sensitivities(lambda **v: {**v, **derived_columns(v, **measured.body, mass=measured.mass)}, at)
    sd = {name: Errors().tracking_sd * value for name, value in at.items()}
    return {q: hypot(*(float(by[name] * sd[name]) for name in by)) for q, by in slopes.items()}
