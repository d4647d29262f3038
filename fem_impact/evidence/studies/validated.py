"""A measured set beside its runs, in the terms of ASME V&V 20: error and standard uncertainties."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, sqrt

import numpy as np
from scipy.stats import qmc

from fem_impact import Outcome, known, load
from fem_impact.answers.compare import MEASURED, verdict
from fem_impact.answers.v_and_v import COVERAGE, Comparison
from fem_impact.arrays import Array
from fem_impact.evidence.studies.inputs import UNCERTAIN_INPUTS, sample_values
from fem_impact.evidence.studies.response import ResponseSurface
from rigid import Errors
from rigid.experiments import MeasuredSet, derived_columns, measured_set
from rigid.uncertainty import sensitivities
from rigid.uncertainty.estimate import MOTION

SEED = 20260101  # of all samples
DRAWN = 1024  # points at which a response surface is evaluated
NAMES = tuple(q.measured for q in MEASURED if q.measured)
VIBRATION = "E_vib_over_E_0"
FRICTION = "friction"  # the input that belongs to a surface state, nominal inside its interval
OUTPUTS = (*NAMES, VIBRATION)
"""Quantities of a response surface, by their names in the measured sets."""
KEYS = (*(q.key.name for q in MEASURED), VIBRATION)
"""Their keys in an outcome."""


@dataclass(frozen=True, slots=True)
class ValidatedSet:
    """What the runs of one measured set give.

    Attributes
    ----------
    name, measured : id of the set, and its tests
    surface : `OUTPUTS` over the uncertain inputs, on one coarse mesh
    shift : (outputs,) float64, limit of the levels less the surface, at the nominal inputs; the sample stands
        at one place of the barrier's grid, whose other place differs by up to .07 in e
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


def unit_sample(n: int) -> Array:
    """Return a seeded scrambled Sobol sequence (n, d) in the unit cube of `UNCERTAIN_INPUTS`."""
    sobol = qmc.Sobol(len(UNCERTAIN_INPUTS), rng=np.random.default_rng(SEED))
    return np.asarray(sobol.random(n))


def compared(
    measured: MeasuredSet, S: Array, bands: Sequence[float], u_input: Array
) -> tuple[Comparison, ...]:
    """Return one comparison a measured quantity.

    Parameters
    ----------
    S : (quantities,) float64, limits of the levels at the nominal inputs
    bands : half-widths of their bands
    u_input : (outputs,) float64, root mean square changes over the uncertain inputs
    """
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
            verdict(float(S[i]), bands[i], statistics[name]),
        )
        for i, (quantity, name) in enumerate(zip(MEASURED, NAMES, strict=True))
    )


def scaled(name: str, unit: Array, tests: bool = False) -> Array:
    """Return the sampled inputs (n, d) of a set, each over its own interval from 0 to 1."""
    scene, measured = load(name), measured_set(name)
    low, high = np.array([i.span(scene, measured) for i in UNCERTAIN_INPUTS]).T
    return np.asarray((sample_values(scene, measured, unit, tests) - low) / (high - low))


def nominal_place(name: str) -> Array:
    """Return the nominal inputs (1, d) of a set, each over its own interval from 0 to 1."""
    scene, measured = load(name), measured_set(name)
    low, high = np.array([i.span(scene, measured) for i in UNCERTAIN_INPUTS]).T
    places = np.full(len(UNCERTAIN_INPUTS), 0.5)
    for at, of in enumerate(UNCERTAIN_INPUTS):
        value = scene.surface.friction if of.name == FRICTION else of.nominal
        if value is not None:
            places[at] = (value - low[at]) / (high[at] - low[at])
    return places[None]


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
