"""Validation in the terms of ASME V&V 20: the model's error beside every uncertainty of its comparison.

Each measured set runs on levels as in the study of the sets, and on one coarse mesh also over a sample of all
uncertain inputs at once (`.inputs`). Response surfaces through that sample give the uncertainty by the
inputs, the share of each input in it, and the spread from test to test.
"""

from collections.abc import Sequence

import numpy as np
from scipy.stats import sobol_indices, uniform, wasserstein_distance

from fem_impact import load
from fem_impact.answers.compare import MEASURED
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.answers.v_and_v import COVERAGE, Comparison
from fem_impact.arrays import Array
from fem_impact.evidence.studies import validated
from fem_impact.evidence.studies.inputs import UNCERTAIN_INPUTS, one_mesh, sample_jobs
from fem_impact.evidence.studies.report_parts import asked_sets, comparison_table, rests_on
from fem_impact.evidence.studies.sets import set_job
from fem_impact.figures.panels import Look, Mark, Panel, Picture, Series
from fem_impact.jobs.job import Job, JobResults
from fem_impact.tables.table import Cell, Table

SIZE, QUICK_SIZE = 64, 16  # runs of a set's sample


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the jobs of the requested sets: the run of each, and its sample."""
    return [
        job for name in asked_sets(request) for job in (set_job(name, request.quick), *_sample(name, request))
    ]


def validated_sets(request: Request, results: JobResults) -> list[validated.ValidatedSet]:
    """Return the requested sets, but those whose own run or sample failed."""
    sets = [
        validated.validated_set(
            name,
            results[set_job(name, request.quick).name],
            [results[job.name] for job in _sample(name, request)],
        )
        for name in asked_sets(request)
    ]
    return [compared for compared in sets if compared]


def _sample(name: str, request: Request) -> list[Job]:
    """Return one job per row of the sample of a set, on one mesh."""
    return sample_jobs(
        name, one_mesh(load(name)), validated.unit_sample(QUICK_SIZE if request.quick else SIZE)
    )


AXES = {"e": "e", "mu": "mu", "Omega": "Omega, rad/s"}
TITLES = {
    **dict(zip(validated.NAMES, (q.name for q in MEASURED), strict=True)),
    "E_vib_over_E_0": "E_vib/E_0",
}
SOBOL_POINTS = 1024
TERMS = (len(UNCERTAIN_INPUTS) + 1) * (len(UNCERTAIN_INPUTS) + 2) // 2  # of a surface of second order


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: comparison errors, their uncertainties, and what causes them."""
    sets = validated_sets(request, results)
    compared = [c for study_set in sets for c in study_set.comparisons]
    sentences = _verdict_sentences(compared)
    takes = [_surface_sentence(sets)] if sets else []
    takes += [sentence for study_set in sets for sentence in validated.reach_sentences(study_set)]
    return StudyReport(
        "validation",
        "Validation: error of the model, and how well it is known (ASME V&V 20)",
        [*sentences, *takes],
        [_errors(compared), *(_distributions(sets, name) for name in validated.SHOWN)] if sets else (),
        [
            Sheet(
                "validation",
                "Error of the model E = S - D and its uncertainty",
                comparison_table(compared, "set", "quantity", "beside the tests"),
            ),
            _cause_sheet(sets),
            _spread_sheet(sets),
            _surface_sheet(sets),
        ],
        [
            *rests_on("validation", COVERAGE=COVERAGE),
            *(
                f"{i.name}: {i.description}" + ("" if i.varies else "; one value for all tests of a set")
                for i in UNCERTAIN_INPUTS
            ),
        ],
        ["sobol", "qmc"],
        [("errors", sentence) for sentence in sentences],
    )


def _verdict_sentences(compared: Sequence[Comparison]) -> list[str]:
    """Return how many comparisons show an error of the model, and what limits them."""
    if not compared:
        return ["No set could be compared: see the failed runs."]
    shown = [c for c in compared if c.in_error]
    by_set = {c.set: sum(d.set == c.set for d in shown) for c in shown}
    where = ", ".join(f"{name} {count}" for name, count in by_set.items())
    missed = sum(c.scatter.startswith(validated.MISS) for c in compared)
    parts = {name: sum(getattr(c, name) == max(c.u_num, c.u_input, c.u_D) for c in compared) for name in U}
    limits = ", ".join(f"{U[name]} in {count}" for name, count in parts.items())
    wrong = f"; {len(shown)} do: {where}" if shown else ""
    return [
        f"{len(compared) - len(shown)} of {len(compared)} measured numbers show no error of the model beyond "
        f"what its mesh, its inputs and the tests leave open{wrong}. S is computed, D measured, E = S - D; "
        f"an error shows where E +- {COVERAGE:g} u_val leaves out zero.",
        f"The largest uncertainty is {limits} comparisons. {missed} of the same numbers miss the scatter of "
        "single tests by more than two standard deviations, where inputs are not counted.",
    ]


def _surface_sentence(sets: Sequence[validated.ValidatedSet]) -> str:
    """Return how well the response surfaces give runs that they were not fitted to."""
    at = [validated.NAMES.index(name) for name in validated.SHOWN]
    off = [
        100 * study_set.surface.error[i] / study_set.comparisons[i].u_input for study_set in sets for i in at
    ]
    return (
        "What each miss of e, mu and Omega would take, by response surfaces that give runs left out of them "
        f"within {np.median(off):.0f} % of u_input (median; worst {max(off):.0f} %):"
    )


U = {"u_num": "the mesh", "u_input": "the inputs", "u_D": "the measurement"}


def _errors(compared: Sequence[Comparison]) -> Picture:
    """Return the error and its interval of every set, one panel a quantity."""
    sets = tuple(dict.fromkeys(c.set for c in compared))
    panels = []
    for name in validated.SHOWN:
        rows = [c for c in compared if c.quantity == name]
        at = np.array([sets.index(c.set) for c in rows], dtype=float)
        widths = [COVERAGE * c.u_val for c in rows]
        errors = Series("E = S - D, ± 2 u_val", at, [c.E for c in rows], "points", 0, widths)
        panels.append(
            Panel(f"Error of {name}", "set", AXES[name], (errors,), levels=(Mark(0.0),), names=sets)
        )
    caption = "Error of the model and the interval that contains it, set by set."
    return Picture("errors", caption, tuple(panels), 1)


def _distributions(sets: Sequence[validated.ValidatedSet], name: str) -> Picture:
    """Return the distribution of a quantity in each set: model over all inputs, test to test, measured."""
    at, panels = validated.NAMES.index(name), []
    for study_set in sets:
        model, tests = study_set.drawn(at)
        series = (
            _steps("model, all inputs", model, "line", 5),
            _steps("model, test to test", tests, "dashed", 0),
            _steps("measured tests", study_set.measured.recomputed()[name], "points", 1),
        )
        panels.append(Panel(study_set.name, AXES[name], "share below", series))
    caption = f"{name}: share of tests below a value, computed and measured."
    return Picture(f"distribution-{name}", caption, tuple(panels), 3)


def _steps(label: str, values: Array, look: Look, colour: int) -> Series:
    """Return the empirical distribution of values, at most 64 points of it."""
    ordered = np.sort(values)
    rank = (np.arange(len(ordered)) + 0.5) / len(ordered)
    every = slice(None, None, max(1, len(ordered) // 64))
    return Series(label, ordered[every], rank[every], look, colour)


def _cause_sheet(sets: Sequence[validated.ValidatedSet]) -> Sheet:
    """Return the share of each input in the variance of each quantity: total Sobol indices."""
    rows: list[tuple[Cell, ...]] = []
    names = [i.name for i in UNCERTAIN_INPUTS]
    for study_set in sets:
        sample = sobol_indices(
            func=lambda unit, surface=study_set.surface: surface(unit.T).T,
            n=SOBOL_POINTS,
            dists=[uniform()] * len(names),
            rng=np.random.default_rng(validated.SEED),
        )
        indices = np.maximum(sample.total_order, 0.0)  # (outputs, inputs)
        rows += [
            (study_set.name, TITLES[output], *map(float, (error, *shares)))
            for output, shares, error in zip(validated.OUTPUTS, indices, study_set.surface.error, strict=True)
            if output in (*validated.SHOWN, validated.VIBRATION)
        ]
    caption = (
        "Share of each input in the variance of the results (total Sobol index of the response surface), and "
        "the surface's own error"
    )
    return Sheet("causes", caption, Table.of(("set", "quantity", "surface_error", *names), rows))


def _spread_sheet(sets: Sequence[validated.ValidatedSet]) -> Sheet:
    """Return spreads by test-to-test inputs and by all, the measured one, and the area metric."""
    rows: list[tuple[Cell, ...]] = []
    for study_set in sets:
        measured = study_set.measured.recomputed()
        for at, name in enumerate(validated.OUTPUTS):
            (model, tests), seen = study_set.drawn(at), measured.get(name)
            moments = [float(f) for v in (tests, model) for f in (v.mean(), v.std(ddof=1))]
            tested: list[float | None] = [None, None, None]
            if seen is not None:
                tested = [*map(float, (seen.mean(), seen.std(ddof=1), wasserstein_distance(seen, model)))]
            rows.append((study_set.name, TITLES[name], *moments, *tested))
    head = "set quantity mean_tests sd_tests mean_all sd_all measured_mean measured_sd area".split()
    caption = (
        "Mean and standard deviation over the inputs that vary from test to test, over all inputs, measured; "
        "area between computed and measured distributions (area metric, in the unit of the quantity)"
    )
    return Sheet("spread", caption, Table.of(head, rows))


def _surface_sheet(sets: Sequence[validated.ValidatedSet]) -> Sheet:
    """Return the response surfaces of e, mu and Omega, from which other constants can be judged."""
    rows: list[tuple[Cell, ...]] = []
    for study_set in sets:
        for at in (validated.NAMES.index(name) for name in validated.SHOWN):
            c, coefficients = study_set.comparisons[at], study_set.surface.coefficients[:, at]
            known = (c.D, c.u_num, c.u_D, study_set.surface.error[at], study_set.shift[at])
            second = np.zeros(TERMS - len(coefficients))  # of a surface of first order
            rows.append((study_set.name, c.quantity, *map(float, (*known, *coefficients, *second))))
    head = (*"set quantity D u_num u_D surface_error shift".split(), *(f"c{i}" for i in range(TERMS)))
    caption = (
        "Coefficients of the response surfaces (1, x_i, x_i x_j, with x from -1 to 1 over each interval)"
    )
    return Sheet("surfaces", caption, Table.of(head, rows), shown=False)
