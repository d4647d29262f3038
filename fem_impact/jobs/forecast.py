"""Forecast of the time that the jobs of a study take."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.jobs.run import expected_costs, makespan, run_jobs, stored_results
from fem_impact.jobs.store import Store

if TYPE_CHECKING:
    from fem_impact.jobs.job import Job, Kind
    from fem_impact.progress import ProgressMeter


WORKERS = (1, 2, 10, 100, 1000)  # numbers of workers that a time is forecast for
SAMPLE = 8  # jobs of a fidelity that are computed (and stored) when none was measured yet


@dataclass(frozen=True, slots=True)
class WorkForecast:
    """Numbers of all and of stored jobs; of the others total time, longest job and wall time by workers, s.

    ``kinds`` has one row per kind of job: fidelity, tip size, jobs to do, expected cost, measured jobs.
    """

    jobs: int
    stored: int
    work_s: float
    longest_s: float
    wall_s: dict[int, float]
    kinds: list[dict[str, Any]]


def estimate(
    jobs: Iterable[Job], store: Path, progress: ProgressMeter, executor: Executor | None = None
) -> WorkForecast:
    """Return how long the jobs that are not stored will take on 1 to 1000 workers.

    Where no job of a fidelity was measured yet, a few are: the cheapest ones, evenly spread. Compilation, the
    start of workers and sharing a machine's memory among them are not in the figures.
    """
    wanted = list(jobs)
    with Store.open(store) as base:
        measured = {fidelity for fidelity, _ in base.costs()}
    run_jobs(_samples(wanted, measured), store, progress, executor)
    with Store.open(store) as base:
        costs, done = base.costs(), stored_results(base, wanted, progress)
    remaining = [job for job in wanted if job.name not in done]
    expected = expected_costs(remaining, costs)
    wall = {n: makespan(expected.values(), n) for n in WORKERS}
    longest = max(expected.values(), default=0.0)
    kinds = _kinds(remaining, expected, costs)
    return WorkForecast(len(wanted), len(done), sum(expected.values()), longest, wall, kinds)


def _samples(jobs: list[Job], measured: set[str]) -> list[Job]:
    """Return a few jobs of each fidelity that was never measured, those with the coarsest tip."""
    chosen: list[Job] = []
    for fidelity in dict.fromkeys(job.fidelity for job in jobs if job.fidelity not in measured):
        same = [job for job in jobs if job.fidelity == fidelity]
        coarsest = max(job.kind for job in same)
        cheap = [job for job in same if job.kind == coarsest]
        chosen += cheap[:: max(1, len(cheap) // SAMPLE)][:SAMPLE]
    return chosen


def _kinds(
    jobs: list[Job], expected: dict[str, float], costs: dict[Kind, list[float]]
) -> list[dict[str, Any]]:
    by_kind: dict[Kind, list[float]] = {}
    for job in jobs:
        by_kind.setdefault(job.kind, []).append(expected[job.name])
    return [
        {
            "fidelity": fidelity,
            "tip_size_m": size or None,
            "jobs": len(times),
            "cost_s": times[0],
            "measured": len(costs.get((fidelity, size), [])),
        }
        for (fidelity, size), times in by_kind.items()
    ]
