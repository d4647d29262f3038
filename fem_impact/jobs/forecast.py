"""Forecast of the time that the jobs of a study take."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

from fem_impact.jobs.run import Pace, Results, expected_costs, makespan, paces, run_jobs, stored_results
from fem_impact.jobs.store import Store

if TYPE_CHECKING:
    from fem_impact.jobs.job import Job, Kind
    from fem_impact.progress import ProgressMeter


WORKERS = (1, 2, 10, 100, 1000)  # numbers of workers that a time is forecast for
SAMPLE = 8  # jobs of a fidelity that are computed (and stored) when none has run yet


@dataclass(frozen=True, slots=True)
class JobGroup:
    """Jobs of one fidelity and tip size, m (None without a mesh), that are still to do.

    ``least_s``, ``most_s`` and ``work_s`` are the shortest and longest expected processor time of one, s, and
    that of all.
    """

    fidelity: str
    tip_size_m: float | None
    jobs: int
    least_s: float
    most_s: float
    work_s: float


@dataclass(frozen=True, slots=True)
class WorkForecast:
    """Numbers of all and of stored jobs; of the others times, s: all, the longest, by number of workers.

    ``paces`` holds measured over planned time of each fidelity.
    """

    jobs: int
    stored: int
    work_s: float
    longest_s: float
    wall_s: dict[int, float]
    groups: list[JobGroup]
    paces: dict[str, Pace]


def estimate(
    jobs: Iterable[Job], store: Path, progress: ProgressMeter, executor: Executor | None = None
) -> WorkForecast:
    """Return how long the jobs that are not stored will take on 1 to 1000 workers.

    A job takes the processor time that the plan of its scene says, times the median ratio of measured to
    planned time of the jobs of its fidelity. Where none has run yet, a few of the cheaper half do.
    Compilation, the start of workers and sharing a machine's memory among them are not in the figures.
    """
    wanted = list(jobs)
    with Store.open(store) as base:
        done = stored_results(base, wanted, progress)
    done |= run_jobs(_samples(wanted, done), store, progress, executor)
    expected = expected_costs(wanted, done)
    groups: dict[Kind, list[float]] = {}
    for job in wanted:
        if job.name in expected:
            groups.setdefault(job.kind, []).append(expected[job.name])
    return WorkForecast(
        len(wanted),
        len(done),
        sum(expected.values()),
        max(expected.values(), default=0.0),
        {n: makespan(expected.values(), n) for n in WORKERS},
        [
            JobGroup(fidelity, size or None, len(times), min(times), max(times), sum(times))
            for (fidelity, size), times in groups.items()
        ],
        paces(wanted, done),
    )


def _samples(jobs: list[Job], done: Results) -> list[Job]:
    """Return a few jobs of each fidelity of which none has run, evenly spread over its cheaper half."""
    chosen: list[Job] = []
    measured = {fidelity for fidelity, pace in paces(jobs, done).items() if pace.measured}
    for fidelity in dict.fromkeys(job.fidelity for job in jobs if job.fidelity not in measured):
        left = [job for job in jobs if job.fidelity == fidelity and job.name not in done]
        limit = median(job.planned_s for job in left) if left else 0.0
        cheap = [job for job in left if job.planned_s <= limit]
        chosen += cheap[:: max(1, len(cheap) // SAMPLE)][:SAMPLE]
    return chosen
