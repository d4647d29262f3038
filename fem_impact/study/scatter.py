"""Scatter: a measured set with its uncertain inputs sampled, beside the scatter of its tests; Sobol indices.

Saltelli's two samples A and B and their mixed ones AB_i give first-order and total indices (Saltelli et al.
2010, doi:10.1016/j.cpc.2009.09.018, as in `scipy.stats.sobol_indices`); A and B together give the spread.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc, sobol_indices

from fem_impact.outcome import Outcome, known
from fem_impact.scale import Job, Results
from fem_impact.scene import MEASURED_SETS, load, replace_all
from fem_impact.study.document import publish
from fem_impact.study.request import Request, StudyResult
from fem_impact.study.scatter_inputs import INPUTS, changes, sample_values
from fem_impact.study.scatter_tell import paper
from rigid import coefficients
from rigid.experiments import measured_set

if TYPE_CHECKING:
    from fem_impact.progress import Meter

__all__ = ["conclude", "plan"]

Array = NDArray[np.float64]

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


def conclude(request: Request, results: Results, progress: Meter) -> StudyResult:
    """Compare spread and correlations with the measured ones, and rank the inputs."""
    told = [_tell(name, request, results) for name in _sets(request)]
    told = [one for one in told if min(len(one["every"]), len(one["tests"])) >= FEWEST]
    return publish(paper(told, INPUTS, _fidelity(request)), request, results)


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
    d = len(INPUTS)
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
    mixed = np.stack([parts[f"AB{i}"].T for i in range(len(INPUTS))])
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
