"""A measured set beside its runs, in the terms of ASME V&V 20: error and standard uncertainties.

Response surfaces give its results as polynomials of the uncertain inputs, fitted to a sample of runs, and how
far the inputs reach towards a measurement that the model misses.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations_with_replacement

import numpy as np
from scipy.stats import qmc

from fem_impact import Outcome, known, load
from fem_impact.answers.compare import MEASURED, verdict
from fem_impact.answers.v_and_v import COVERAGE, Comparison, compared_with
from fem_impact.arrays import Array
from fem_impact.errors import RunError
from fem_impact.evidence.studies.inputs import UNCERTAIN_INPUTS, interval_ends, sample_values
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import or_none
from rigid.experiments import MeasuredSet, derived_columns, measured_set
from rigid.uncertainty import MOTION

SPARE = 1.3  # runs over coefficients that a surface of second order needs


@dataclass(frozen=True, slots=True)
class ResponseSurface:
    """Least-squares polynomials in inputs scaled to 0 ... 1 (Box & Wilson 1951, J. R. Stat. Soc. B 13, 1-45).

    Attributes
    ----------
    coefficients : (terms, quantities) float64
    order : 1 or 2
    error : (quantities,) float64, root mean square error at runs that the fit was not given, by leaving out
        one run after the other (PRESS: Allen 1974, doi:10.1080/00401706.1974.10489157)
    """

    coefficients: Array
    order: int
    error: Array

    def __call__(self, unit: Array) -> Array:
        """Return the quantities (n, quantities) at inputs (n, d) scaled to 0 ... 1."""
        values: Array = _terms(unit, self.order) @ self.coefficients
        return values


def fit(unit: Array, values: Array) -> ResponseSurface:
    """Return the surfaces through runs: of second order where there are enough of them, else of first.

    Parameters
    ----------
    unit : (n, d) float64, inputs scaled to 0 ... 1
    values : (n, quantities) float64

    Raises
    ------
    RunError
        There are too few runs for a surface of first order.

    Examples
    --------
    >>> x = np.linspace(0, 1, 9)[:, None]
    >>> surface = fit(x, 3 * x**2)
    >>> surface.order, float(surface(np.array([[0.3]]))[0, 0].round(6))
    (2, 0.27)
    """
    runs, inputs = unit.shape
    full = (inputs + 1) * (inputs + 2) // 2
    order = 2 if runs >= SPARE * full else 1
    terms = _terms(unit, order)
    if runs <= terms.shape[1]:
        raise RunError(f"{runs} finished runs are too few for {inputs} uncertain inputs.")
    q, r = np.linalg.qr(terms)
    coefficients = np.linalg.solve(r, q.T @ values)
    omitted = (values - terms @ coefficients) / (1 - np.sum(q**2, axis=1))[:, None]
    return ResponseSurface(coefficients, order, np.sqrt(np.mean(omitted**2, axis=0)))


def _terms(unit: Array, order: int) -> Array:
    """Return the columns 1, x_i and, for second order, x_i x_j, with x = 2 unit - 1."""
    x = 2 * unit - 1
    pairs = combinations_with_replacement(range(x.shape[1]), 2) if order == 2 else ()
    return np.column_stack([np.ones(len(x)), x, *(x[:, i] * x[:, j] for i, j in pairs)])


SEED = 20260101  # of all samples
FEWEST = 2 * len(UNCERTAIN_INPUTS)  # finished runs of a sample
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

    def drawn(self, at: int) -> tuple[Array, Array]:
        """Return output ``at`` of `all_inputs` and of `tests` (n,), shifted to the limit of the levels."""
        return self.all_inputs[:, at] + self.shift[at], self.tests[:, at] + self.shift[at]


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
    statistics = measured.statistics()
    return tuple(
        replace(
            compared_with(measured, name, float(S[i]), bands[i] / COVERAGE, float(u_input[i]), measured.id),
            quantity=quantity.name,
            scatter=verdict(float(S[i]), bands[i], statistics[name]),
        )
        for i, (quantity, name) in enumerate(zip(MEASURED, NAMES, strict=True))
    )


def scaled(name: str, unit: Array, tests: bool = False) -> Array:
    """Return the sampled inputs (n, d) of a set, each over its own interval from 0 to 1."""
    scene, measured = load(name), measured_set(name)
    low, high = interval_ends(scene, measured)
    return np.asarray((sample_values(scene, measured, unit, tests) - low) / (high - low))


def nominal_place(name: str) -> Array:
    """Return the nominal inputs (1, d) of a set, each over its own interval from 0 to 1."""
    scene = load(name)
    low, high = interval_ends(scene, measured_set(name))
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


def validated_set(
    name: str, nominal: Outcome | Failure, runs: Sequence[Outcome | Failure]
) -> ValidatedSet | None:
    """Return a set from its own run and those of its sample; None where it or too much of these failed."""
    measured = measured_set(name)
    finished = {i: run for i, run in enumerate(runs) if isinstance(run, Outcome)}
    if not isinstance(nominal, Outcome) or len(finished) < FEWEST:
        return None
    limits, bands = or_none(nominal.validity.mesh_limit), or_none(nominal.validity.mesh_band)
    if limits is None or bands is None:
        return None
    sampled = scaled(name, unit_sample(len(runs)))[list(finished)]
    surface = fit(sampled, np.array([outputs(run, measured) for run in finished.values()]))
    every, tests = (surface(scaled(name, unit_sample(DRAWN), only)) for only in (False, True))
    S = np.array([limits[key] for key in KEYS])
    nominal_values = surface(nominal_place(name))[0]
    u_input = np.sqrt(np.mean((every - nominal_values) ** 2, axis=0))
    comparisons = compared(measured, S, [bands[key] for key in KEYS], u_input)
    return ValidatedSet(name, measured, surface, S - nominal_values, every, tests, comparisons)


PLACES = np.linspace(0.0, 1.0, 21)  # of one input over its interval
SHOWN = ("e", "mu", "Omega")
MISS = "miss by"


@dataclass(frozen=True, slots=True)
class Reach:
    """What inputs can do about the error of one quantity, in its unit.

    Attributes
    ----------
    missed : the comparison
    name, place : of the single input that brings the model nearest to the tests, and where in its interval,
        0 to 1
    change : by that input
    low, high : smallest and largest change by all inputs at once
    """

    missed: Comparison
    name: str
    place: float
    change: float
    low: float
    high: float

    @property
    def left(self) -> float:
        """Error that all inputs together leave, 0 where they reach the measured mean."""
        E = self.missed.E
        return E + float(np.clip(-E, self.low, self.high))

    @property
    def sentence(self) -> str:
        """What it would take."""
        ends = {0.0: "at its lower end", 1.0: "at its upper end"}
        where = ends.get(self.place, f"at {100 * self.place:.0f} % of its interval")
        unit = " rad/s" if self.missed.quantity == "Omega" else ""
        causes = (
            f"{self.missed.quantity} is off by {self.missed.E:+.2g}{unit}; {self.name} {where} alone changes "
            f"it by {self.change:+.2g}, all inputs together by {self.low:+.2g} to {self.high:+.2g}"
        )
        return f"{causes}, which leaves {self.left:+.2g} to what is not among them" if self.left else causes


def misses(validated: ValidatedSet) -> list[Comparison]:
    """Return comparisons of e, mu and Omega that show an error of the model or miss the scatter."""
    return [
        c for c in validated.comparisons if c.quantity in SHOWN and (c.in_error or c.scatter.startswith(MISS))
    ]


def reach(validated: ValidatedSet, missed: Comparison) -> Reach:
    """Return what the inputs of a set, each inside its interval, can do about a missed quantity."""
    at, nominal = NAMES.index(missed.quantity), nominal_place(validated.name)
    before = validated.surface(nominal)[0, at]
    single = np.repeat(nominal, len(UNCERTAIN_INPUTS) * len(PLACES), axis=0)
    for i in range(len(UNCERTAIN_INPUTS)):
        single[i * len(PLACES) : (i + 1) * len(PLACES), i] = PLACES
    changes = validated.surface(single)[:, at] - before
    best = int(np.abs(missed.E + changes).argmin())
    every = validated.all_inputs[:, at] - before
    return Reach(
        missed,
        UNCERTAIN_INPUTS[best // len(PLACES)].name,
        float(PLACES[best % len(PLACES)]),
        float(changes[best]),
        float(every.min()),
        float(every.max()),
    )


def reach_sentences(validated: ValidatedSet) -> list[str]:
    """Return one sentence on the missed quantities of a set; none where nothing is missed."""
    parts = [reach(validated, missed).sentence for missed in misses(validated)]
    return [f"{validated.name}: {'; '.join(parts)}."] if parts else []
