"""Scatter of the measured sets from their uncertain inputs: sampled runs, Sobol indices, findings and tables.

A set runs on a scrambled Sobol sequence over `fem_impact.study.inputs.UNCERTAIN_INPUTS`: once with all inputs
sampled, for the Sobol indices, and once with those only that vary from test to test, to compare spread and
correlations with the measured ones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc, sobol_indices

from fem_impact.arrays import Array
from fem_impact.figures.lines import Panel, Series
from fem_impact.jobs.job import Failure, Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.study.document import Picture, Request, Sheet, StudyReport, StudyResult, publish
from fem_impact.study.inputs import UNCERTAIN_INPUTS, UncertainInput, changes, sample_values
from fem_impact.tables.table import Table
from rigid import coefficients
from rigid.experiments import correlations, measured_set

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter


SEED = 20260101  # of the sample and of the bootstrap
SIZES = {"modal": 256, "solid": 8}  # rows of A and of B by fidelity
QUICK_SIZES = {"modal": 8, "solid": 2}
SOLID_TIP = "0.8 mm"  # tip size of solid runs
RESAMPLES = 200  # of the bootstrap
FEWEST = 4  # finished runs that a correlation needs; the study lists the failed ones
MEASURED = ("e", "mu", "Omega")
OUTPUTS = (*MEASURED, "E_vib/E_0")
AXES = {"e": "e", "mu": "mu", "Omega": "Omega, rad/s"}
SetScatter = dict[str, Any]
"""Scatter of one set.

"set": its name; "all", "tests" (n, 4): `OUTPUTS` of the finished runs with all inputs sampled, and with
those that vary from test to test; "measured" (m, 3): `MEASURED` of the single tests; "indices": `_indices`.
"""


def plan(request: Request, results: Results) -> list[Job]:
    """Return the sampled jobs of the requested sets."""
    return [job for name in _sets(request) for job in _jobs(name, request)]


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Return the study: spread and correlations beside the measured ones, and the rank of the inputs."""
    scatters = [_set_scatter(name, request, results) for name in _sets(request)]
    scatters = [s for s in scatters if min(len(s["all"]), len(s["tests"])) >= FEWEST]
    return publish(study_report(scatters, UNCERTAIN_INPUTS, _fidelity(request)), request, results)


def _sets(request: Request) -> tuple[str, ...]:
    """Return the requested sets; by default all, or one of the quick study."""
    return request.ids or (("t5b",) if request.quick else MEASURED_SETS)


def _fidelity(request: Request) -> str:
    return request.fidelity or "modal"


def _size(request: Request) -> int:
    """Return the number of rows of A and of B."""
    return (QUICK_SIZES if request.quick else SIZES)[_fidelity(request)]


def design(n: int) -> dict[str, Array]:
    """Return samples (n, d) of the unit cube by name: A, B, and ABi, which is A with column i of B.

    A and B are columns of one seeded scrambled Sobol sequence. ``tests-A`` and ``tests-B`` are A and B again,
    for runs in which only the inputs that vary from test to test are sampled.
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
    """Return one job per row of each sample of a set."""
    scene, measured, fidelity = load(name), measured_set(name), _fidelity(request)
    coarse = {"accuracy.tip_size": SOLID_TIP, "save.frames": 0} if fidelity == "solid" else {}
    jobs = []
    for part, unit in design(_size(request)).items():
        values = sample_values(scene, measured, unit, part.startswith("tests"))
        for at, row in enumerate(values):
            changed = replace_all(scene, {**changes(scene, row), **coarse})
            jobs.append(Job(f"{name}-{part}-{at}", changed, fidelity))
    return jobs


def _set_scatter(name: str, request: Request, results: Results) -> SetScatter:
    """Return the scatter of one set from its runs."""
    n, arms = _size(request), measured_set(name).arms
    parts = {
        part: np.array([_output(results[f"{name}-{part}-{at}"], arms) for at in range(n)])
        for part in design(n)
    }
    tests = np.concatenate([parts["tests-A"], parts["tests-B"]])
    sampled = np.concatenate([parts["A"], parts["B"]])
    measured = measured_set(name).recomputed()
    return {
        "set": name,
        "all": sampled[np.isfinite(sampled).all(axis=1)],
        "tests": tests[np.isfinite(tests).all(axis=1)],
        "measured": np.column_stack([measured[key] for key in MEASURED]),
        "indices": _indices(parts),
    }


def _output(run: Outcome | Failure, arms: Any) -> list[float]:
    """Return `OUTPUTS` of a run with the arms of the measured set's table; nan if it failed."""
    if isinstance(run, Failure):
        return [np.nan] * len(OUTPUTS)
    m = run.motion
    rebound = coefficients(m.v_n, m.v_t, m.V_n, m.V_t, m.Omega, d_c=arms.d_c, d_d=arms.d_d, k2=m.k_squared)
    return [float(rebound.e), float(rebound.mu), m.Omega, known(run.energy.vibration)]


def _indices(parts: Mapping[str, Array]) -> dict[str, Array] | None:
    """Return first-order and total Sobol indices (4, d) with half-widths of their 95 % bootstrap intervals.

    None if a run failed.
    """
    mixed = np.stack([parts[f"AB{i}"].T for i in range(len(UNCERTAIN_INPUTS))])
    samples = {"f_A": parts["A"].T, "f_B": parts["B"].T, "f_AB": mixed}
    if not all(np.isfinite(values).all() for values in samples.values()):
        return None
    n, generator = len(parts["A"]), np.random.default_rng(SEED)
    resampled = [_both(samples, generator.integers(n, size=n)) for _ in range(RESAMPLES)]
    low, high = np.percentile(resampled, (2.5, 97.5), axis=0)
    first, total = _both(samples, np.arange(n))
    half = 0.5 * (high - low)
    return {"first": first, "total": total, "first_half": half[0], "total_half": half[1]}


def _both(samples: Mapping[str, Array], rows: NDArray[np.int64]) -> tuple[Array, Array]:
    """Return first-order and total Sobol indices (4, d) of some rows of the samples."""
    indices = sobol_indices(func={name: values[..., rows] for name, values in samples.items()}, n=len(rows))
    return np.asarray(indices.first_order), np.asarray(indices.total_order)


def study_report(
    scatters: Sequence[SetScatter], inputs: Sequence[UncertainInput], fidelity: str
) -> StudyReport:
    """Return the study from the scatter of each set."""
    names = [i.name for i in inputs]
    sentences = [(f"cloud-{s['set']}", sentence) for s in scatters for sentence in _sentences(s, names)]
    return StudyReport(
        "scatter",
        f"Scatter of the measured sets and what causes it ({fidelity})",
        [sentence for _, sentence in sentences],
        [
            *(_cloud(s) for s in scatters),
            *(_ranks(s, names) for s in scatters if s["indices"]),
        ],
        [
            _spread_sheet(scatters),
            _correlation_sheet(scatters),
            _index_sheet(scatters, names),
            _sample_sheet(scatters),
        ],
        [
            f"{i.name}: {i.description}" + ("" if i.varies else "; one value for all tests of a set")
            for i in inputs
        ],
        ["sobol", "qmc"],
        sentences,
    )


def _sentences(scatter: SetScatter, names: Sequence[str]) -> list[str]:
    """Return the findings of a set: spread beside the measured one, and the input of largest total index."""
    set_id = scatter["set"]
    sd, measured = scatter["tests"].std(axis=0, ddof=1), scatter["measured"].std(axis=0, ddof=1)
    parts = [f"{q} {sd[i]:.2g} against {measured[i]:.2g} measured" for i, q in enumerate(MEASURED)]
    lines = [f"{set_id}: inputs that vary from test to test give a standard deviation of {', '.join(parts)}."]
    if scatter["indices"]:
        total = scatter["indices"]["total"]
        first = [
            f"{q} by {names[int(total[i].argmax())]} ({total[i].max():.0%})" for i, q in enumerate(OUTPUTS)
        ]
        lines.append(
            f"{set_id}: the largest total share of the variance over all inputs is, for {', '.join(first)}."
        )
    return lines


def _cloud(scatter: SetScatter) -> Picture:
    """Return the runs and the single tests of a set in each plane of two measured quantities."""
    panels = []
    for a, b in combinations(range(3), 2):
        x, y = MEASURED[a], MEASURED[b]
        model = Series("model, all inputs", scatter["all"][:, a], scatter["all"][:, b], "points", 5)
        tests = Series("model, test to test", scatter["tests"][:, a], scatter["tests"][:, b], "points", 0)
        seen = Series("measured tests", scatter["measured"][:, a], scatter["measured"][:, b], "rings", 1)
        panels.append(Panel(f"{x} and {y}", AXES[x], AXES[y], (model, tests, seen)))
    caption = f"{scatter['set']}: sampled inputs and the single tests."
    return Picture(f"cloud-{scatter['set']}", caption, tuple(panels), 3)


def _ranks(scatter: SetScatter, names: Sequence[str]) -> Picture:
    """Return first-order and total Sobol indices of a set, one panel per output."""
    indices, at = scatter["indices"], np.arange(len(names))
    panels = tuple(
        Panel(
            output,
            "input",
            "Sobol index",
            (
                Series("first order", at - 0.08, indices["first"][i], "points"),
                Series("total", at + 0.08, indices["total"][i], "rings"),
            ),
            levels=(0.0, 1.0),
            names=tuple(names),
        )
        for i, output in enumerate(OUTPUTS)
    )
    return Picture(
        f"sobol-{scatter['set']}", f"{scatter['set']}: share of each input in the variance.", panels
    )


def _spread_sheet(scatters: Sequence[SetScatter]) -> Sheet:
    rows = []
    for scatter in scatters:
        for i, quantity in enumerate(OUTPUTS):
            known_in = ("tests", "all", "measured") if quantity in MEASURED else ("tests", "all")
            columns = [scatter[name][:, i] for name in known_in]
            spreads = [float(f) for column in columns for f in (column.mean(), column.std(ddof=1))]
            rows.append([scatter["set"], quantity, *spreads, *([] if quantity in MEASURED else [None, None])])
    head = ("set", "quantity", "mean_tests", "sd_tests", "mean_all", "sd_all", "measured_mean", "measured_sd")
    return Sheet(
        "spread",
        "Mean and standard deviation: inputs that vary from test to test, all inputs, measured",
        Table.of(head, rows),
    )


def _correlation_sheet(scatters: Sequence[SetScatter]) -> Sheet:
    rows = []
    for scatter in scatters:
        model, measured = (
            correlations(dict(zip(MEASURED, scatter[name].T[:3], strict=True)))
            for name in ("tests", "measured")
        )
        for pair, of_tests in measured.items():
            interval = (of_tests.low, of_tests.high)
            rows.append([scatter["set"], ", ".join(pair), model[pair].r, of_tests.r, *interval, of_tests.n])
    head = ("set", "pair", "model_r", "measured_r", "measured_low", "measured_high", "tests")
    return Sheet(
        "correlations",
        "Correlation within a set, with Fisher's 95 % interval of the measured one",
        Table.of(head, rows),
    )


def _index_sheet(scatters: Sequence[SetScatter], names: Sequence[str]) -> Sheet:
    rows = []
    for scatter in scatters:
        indices = scatter["indices"]
        for i, output in enumerate(OUTPUTS if indices else ()):
            for k, name in enumerate(names):
                keys = ("first", "first_half", "total", "total_half")
                rows.append([scatter["set"], output, name, *(float(indices[key][i, k]) for key in keys)])
    head = ("set", "quantity", "input", "first_order", "first_half_95", "total", "total_half_95")
    return Sheet(
        "sobol", "Sobol indices with the half-widths of their bootstrap intervals", Table.of(head, rows)
    )


def _sample_sheet(scatters: Sequence[SetScatter]) -> Sheet:
    rows = [
        [scatter["set"], kind, *map(float, row)]
        for scatter in scatters
        for kind in ("tests", "all")
        for row in scatter[kind]
    ]
    head = ("set", "inputs", "e", "mu", "Omega_rad_per_s", "E_vib_over_E_0")
    return Sheet("sample", "Every sampled run", Table.of(head, rows), shown=False)
