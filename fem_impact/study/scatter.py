"""What the scatter study says: sentences, tables and pictures of its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc, sobol_indices

from fem_impact.arrays import Array
from fem_impact.figures.lines import Panel, Series
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.study.document import Picture, Request, Sheet, StudyReport, StudyResult, publish
from fem_impact.study.inputs import UNCERTAIN_INPUTS, UncertainInput, changes, sample_values
from fem_impact.tables.table import Table
from rigid import coefficients
from rigid.experiments import correlation, measured_set

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter


MEASURED = ("e", "mu", "Omega")
TOLD_OUTPUTS = (*MEASURED, "E_vib/E_0")
UNITS = {"e": "e", "mu": "mu", "Omega": "Omega, rad/s"}
Told = dict[str, Any]


def study_report(told: Sequence[Told], inputs: Sequence[UncertainInput], fidelity: str) -> StudyReport:
    """Return the study for what every set says (see `fem_impact.study.scatter`)."""
    names = [i.name for i in inputs]
    sentences = [(f"cloud-{t['set']}", sentence) for t in told for sentence in _sentences(t, names)]
    return StudyReport(
        "scatter",
        f"Scatter of the measured sets and what causes it ({fidelity})",
        [sentence for _, sentence in sentences],
        [*(_cloud(t) for t in told), *(_ranks(t, names) for t in told if t["indices"])],
        [_spread_sheet(told), _correlation_sheet(told), _index_sheet(told, names), _sample_sheet(told)],
        [f"{i.name}: {i.words}" + ("" if i.varies else "; one value for all tests of a set") for i in inputs],
        ["sobol", "qmc"],
        sentences,
    )


def _sentences(t: Told, names: Sequence[str]) -> list[str]:
    sd, measured = t["tests"].std(axis=0, ddof=1), t["measured"].std(axis=0, ddof=1)
    parts = [f"{q} {sd[i]:.2g} against {measured[i]:.2g} measured" for i, q in enumerate(MEASURED)]
    lines = [
        f"{t['set']}: inputs that vary from test to test give a standard deviation of {', '.join(parts)}."
    ]
    if t["indices"]:
        total = t["indices"]["total"]
        first = [
            f"{q} by {names[int(total[i].argmax())]} ({total[i].max():.0%})"
            for i, q in enumerate(TOLD_OUTPUTS)
        ]
        lines.append(
            f"{t['set']}: the largest total share of the variance over all inputs is, for {', '.join(first)}."
        )
    return lines


def _cloud(t: Told) -> Picture:
    panels = []
    for a, b in combinations(range(3), 2):
        x, y = MEASURED[a], MEASURED[b]
        model = Series("model, all inputs", t["every"][:, a], t["every"][:, b], "points", 5)
        tests = Series("model, test to test", t["tests"][:, a], t["tests"][:, b], "points", 0)
        seen = Series("measured tests", t["measured"][:, a], t["measured"][:, b], "rings", 1)
        panels.append(Panel(f"{x} and {y}", UNITS[x], UNITS[y], (model, tests, seen)))
    caption = f"{t['set']}: sampled inputs and the single tests."
    return Picture(f"cloud-{t['set']}", caption, tuple(panels), 3)


def _ranks(t: Told, names: Sequence[str]) -> Picture:
    found, at = t["indices"], np.arange(len(names))
    panels = tuple(
        Panel(
            output,
            "input",
            "Sobol index",
            (
                Series("first order", at - 0.08, found["first"][i], "points"),
                Series("total", at + 0.08, found["total"][i], "rings"),
            ),
            levels=(0.0, 1.0),
            names=tuple(names),
        )
        for i, output in enumerate(TOLD_OUTPUTS)
    )
    return Picture(f"sobol-{t['set']}", f"{t['set']}: share of each input in the variance.", panels)


def _spread_sheet(told: Sequence[Told]) -> Sheet:
    rows = []
    for t in told:
        for i, quantity in enumerate(TOLD_OUTPUTS):
            seen = t["measured"][:, i] if i < 3 else None
            measured = [None, None] if seen is None else [float(seen.mean()), float(seen.std(ddof=1))]
            model = [
                float(f)
                for name in ("tests", "every")
                for f in (t[name][:, i].mean(), t[name][:, i].std(ddof=1))
            ]
            rows.append([t["set"], quantity, *model, *measured])
    head = ("set", "quantity", "mean_tests", "sd_tests", "mean_all", "sd_all", "measured_mean", "measured_sd")
    return Sheet(
        "spread",
        "Mean and standard deviation: inputs that vary from test to test, all inputs, measured",
        Table.of(head, rows),
    )


def _correlation_sheet(told: Sequence[Told]) -> Sheet:
    rows = []
    for t in told:
        for a, b in combinations(range(3), 2):
            model = correlation(t["tests"][:, a], t["tests"][:, b])
            seen = correlation(t["measured"][:, a], t["measured"][:, b])
            rows.append(
                [t["set"], f"{MEASURED[a]}, {MEASURED[b]}", model.r, seen.r, seen.low, seen.high, seen.n]
            )
    head = ("set", "pair", "model_r", "measured_r", "measured_low", "measured_high", "tests")
    return Sheet(
        "correlations",
        "Correlation within a set, with Fisher's 95 % interval of the measured one",
        Table.of(head, rows),
    )


def _index_sheet(told: Sequence[Told], names: Sequence[str]) -> Sheet:
    rows = []
    for t in told:
        found = t["indices"]
        for i, output in enumerate(TOLD_OUTPUTS if found else ()):
            for k, name in enumerate(names):
                keys = ("first", "first_half", "total", "total_half")
                rows.append([t["set"], output, name, *(float(found[key][i, k]) for key in keys)])
    head = ("set", "quantity", "input", "first_order", "first_half_95", "total", "total_half_95")
    return Sheet(
        "sobol", "Sobol indices with the half-widths of their bootstrap intervals", Table.of(head, rows)
    )


def _sample_sheet(told: Sequence[Told]) -> Sheet:
    rows = [
        [t["set"], kind, *map(float, row)] for t in told for kind in ("tests", "every") for row in t[kind]
    ]
    head = ("set", "inputs", "e", "mu", "Omega_rad_per_s", "E_vib_over_E_0")
    return Sheet("sample", "Every sampled run", Table.of(head, rows), shown=False)


SEED = 20260101
SIZES = {"modal": 256, "solid": 8}  # points of A and of B
QUICK_SIZES = {"modal": 8, "solid": 2}
SOLID_TIP = "0.8 mm"
RESAMPLES = 200
FEWEST = 4  # finished runs that a correlation needs; the failed ones are rows
OUTPUTS = ("e", "mu", "Omega", "E_vib/E_0")


def plan(request: Request, results: Results) -> list[Job]:
    """Return the sampled jobs of every set that is asked for."""
    return [job for name in _sets(request) for job in _jobs(name, request)]


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Compare spread and correlations with the measured ones, and rank the inputs."""
    told = [_tell(name, request, results) for name in _sets(request)]
    told = [one for one in told if min(len(one["every"]), len(one["tests"])) >= FEWEST]
    return publish(study_report(told, UNCERTAIN_INPUTS, _fidelity(request)), request, results)


def _sets(request: Request) -> tuple[str, ...]:
    return request.ids or (("t5b",) if request.quick else MEASURED_SETS)


def _fidelity(request: Request) -> str:
    return request.fidelity or "modal"


def _size(request: Request) -> int:
    return (QUICK_SIZES if request.quick else SIZES)[_fidelity(request)]


def design(n: int) -> dict[str, Array]:
    """Return samples of the unit cube by name: A, B, (n, d) each, and AB_i with column i of B in A.

    A seeded scrambled Sobol sequence; ``tests-A`` and ``tests-B`` are A and B again, for the inputs that vary
    from test to test.
    """
    d = len(UNCERTAIN_INPUTS)
    cube = qmc.Sobol(2 * d, rng=np.random.default_rng(SEED)).random(n)
    A, B = cube[:, :d], cube[:, d:]
    mixed = {}
    for i in range(d):
        mixed[f"AB{i}"] = A.copy()
        mixed[f"AB{i}"][:, i] = B[:, i]
    return {"A": A, "B": B, **mixed, "tests-A": A, "tests-B": B}


def _jobs(name: str, request: Request) -> list[Job]:
    scene, measured, fidelity = load(name), measured_set(name), _fidelity(request)
    coarse = {"accuracy.tip_size": SOLID_TIP, "save.frames": 0} if fidelity == "solid" else {}
    jobs = []
    for part, unit in design(_size(request)).items():
        values = sample_values(scene, measured, unit, part.startswith("tests"))
        for at, row in enumerate(values):
            changed = replace_all(scene, {**changes(scene, row), **coarse})
            jobs.append(Job(f"{name}-{part}-{at}", changed, fidelity))
    return jobs


def _tell(name: str, request: Request, results: Results) -> dict[str, Any]:
    """Return what one set says: values by part, spread, measured columns, indices."""
    n = _size(request)
    arms = measured_set(name).arms
    parts = {part: _outputs([results[f"{name}-{part}-{at}"] for at in range(n)], arms) for part in design(n)}
    tests = np.concatenate([parts["tests-A"], parts["tests-B"]])
    every = np.concatenate([parts["A"], parts["B"]])
    measured = measured_set(name).recomputed()
    return {
        "set": name,
        "every": every[np.isfinite(every).all(axis=1)],
        "tests": tests[np.isfinite(tests).all(axis=1)],
        "measured": np.column_stack([measured[key] for key in ("e", "mu", "Omega")]),
        "indices": _indices(parts),
    }


def _outputs(runs: list[Any], arms: Any) -> Array:
    """Return `OUTPUTS` (n, 4) with the arms that the table was worked out with; nan where a run failed."""
    return np.array([_output(run, arms) if isinstance(run, Outcome) else [np.nan] * 4 for run in runs])


def _output(run: Outcome, arms: Any) -> list[float]:
    m = run.motion
    found = coefficients(m.v_n, m.v_t, m.V_n, m.V_t, m.Omega, d_c=arms.d_c, d_d=arms.d_d, k2=m.k_squared)
    return [float(found.e), float(found.mu), m.Omega, known(run.energy.vibration)]


def _indices(parts: Mapping[str, Array]) -> dict[str, Array] | None:
    """Return first-order and total indices (4, d) with the half-widths of their 95 % intervals."""
    mixed = np.stack([parts[f"AB{i}"].T for i in range(len(UNCERTAIN_INPUTS))])
    given = {"f_A": parts["A"].T, "f_B": parts["B"].T, "f_AB": mixed}
    if not all(np.isfinite(values).all() for values in given.values()):
        return None
    n, chance = len(parts["A"]), np.random.default_rng(SEED)
    again = [_both(given, chance.integers(n, size=n)) for _ in range(RESAMPLES)]
    low, high = np.percentile(again, (2.5, 97.5), axis=0)
    first, total = _both(given, np.arange(n))
    half = 0.5 * (high - low)
    return {"first": first, "total": total, "first_half": half[0], "total_half": half[1]}


def _both(given: Mapping[str, Array], rows: NDArray[np.int64]) -> tuple[Array, Array]:
    """Return first-order and total indices (4, d) of some rows of the samples."""
    found = sobol_indices(func={name: values[..., rows] for name, values in given.items()}, n=len(rows))
    return np.asarray(found.first_order), np.asarray(found.total_order)
