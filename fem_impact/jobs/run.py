"""Jobs on an executor, their answers stored, and the forecast of the time that they take."""

import heapq
import time
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from contextlib import nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

from fem_impact.errors import ResultError, RunError
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.job import Answer, Failure, JobKind, Result, Store, Work, compute
from fem_impact.progress import CaseProgress, Notice, ProgressMeter
from fem_impact.run.program import source_digest


@dataclass(frozen=True, slots=True)
class Pace:
    """Processor time of the jobs of a fidelity that have run, over what was planned: median and number."""

    ratio: float = 1.0
    measured: int = 0


def paces(jobs: Iterable[Work[Any]], results: Mapping[str, Any]) -> dict[str, Pace]:
    """Return the pace of each fidelity among the jobs."""
    ratios: dict[str, list[float]] = {}
    for job in jobs:
        run, known = results.get(job.name), ratios.setdefault(job.fidelity, [])
        if run is not None and not isinstance(run, Failure):
            known.append(job.cpu_s(run) / job.planned_s)
    return {name: Pace(median(known), len(known)) if known else Pace() for name, known in ratios.items()}


def expected_costs(jobs: Iterable[Work[Any]], results: Mapping[str, Any]) -> dict[str, float]:
    """Return the expected processor time, s, of each job without a result, by its name.

    It is what the case of the job says, times the pace of the jobs of its fidelity that have run.
    """
    every = list(jobs)
    pace = paces(every, results)
    return {job.name: job.planned_s * pace[job.fidelity].ratio for job in every if job.name not in results}


def makespan(costs: Iterable[float], workers: int) -> float:
    """Return how long the jobs take, s, when the longest left is always given to the next free worker.

    Examples
    --------
    >>> makespan([3.0, 3.0, 2.0, 2.0, 2.0], 2)
    7.0
    >>> makespan([3.0, 3.0, 2.0, 2.0, 2.0], 1000)
    3.0
    """
    ends = [0.0] * workers
    for cost in sorted(costs, reverse=True):
        heapq.heapreplace(ends, ends[0] + cost)
    return max(ends)


@dataclass(slots=True)
class Eta:
    """Reports the time, s, until all jobs are done: expected costs, scaled by time so far over work done.

    ``costs`` are those of the jobs to do, ``total`` is the number of all jobs; the time counts from here on.
    """

    costs: dict[str, float]
    total: int
    meter: ProgressMeter
    begun: float = field(default_factory=lambda: time.monotonic())
    done: float = 0.0

    def __call__(self, name: str, count: int) -> None:
        """Report that ``name`` is done, ``count`` jobs in all."""
        self.done += self.costs[name]
        remaining = max(sum(self.costs.values()) - self.done, 0.0)
        eta = (time.monotonic() - self.begun) * remaining / self.done
        self.meter(CaseProgress(name, count, self.total, eta))


def run_jobs(
    jobs: Iterable[Work[Result]], store: Path, progress: ProgressMeter, executor: Executor | None = None
) -> dict[str, Result | Failure]:
    """Return result or failure of every job by its name, in the order of the jobs.

    Results are kept in ``store`` as they come, so that an interrupted study goes on where it stopped.

    Parameters
    ----------
    jobs : names must differ
    store : SQLite file, made if it is not there
    progress : called after every job with the time that all jobs still need, once with how many are kept
        from before, and for every stored answer that is not of its job and is computed again
    executor : any, such as what `on_scheduler` lends; local processes, one a core, when None

    Raises
    ------
    RunError
        Two jobs have one name, or a worker holds another version of the program.
    """
    by_name = dict[str, Work[Result]]()
    for job in jobs:
        if by_name.setdefault(job.name, job) is not job:
            raise RunError(f"two runs have one name, {job.name}: only one could be kept.")
    with Store.open(store) as base:
        results = stored_results(base, by_name.values(), progress)
        costs = expected_costs(by_name.values(), results)
        if results:
            progress(Notice(f"{len(results)} of {len(by_name)} runs are kept from before."))
        if costs:
            # the longest first, so that no worker is left alone with one at the end
            waiting = [by_name[name] for name in sorted(costs, key=lambda name: -costs[name])]
            with LocalProcesses() if executor is None else nullcontext(executor) as engine:
                _compute(waiting, base, engine, results, Eta(costs, len(by_name), progress))
    return {name: results[name] for name in by_name}


def stored_results(
    base: Store, jobs: Iterable[Work[Result]], progress: ProgressMeter
) -> dict[str, Result | Failure]:
    """Return the stored results of jobs by name; answers not of their job are reported and left out."""
    results: dict[str, Result | Failure] = {}
    for job in jobs:
        try:
            answer = base.get(job)
            if answer is not None:
                text, reason = answer
                results[job.name] = Failure(job.name, reason) if reason else job.read(text)
        except ResultError as error:
            progress(Notice(f"{job.name} is not taken from the store: {error}"))
    return results


def _compute(
    waiting: Sequence[Work[Result]],
    base: Store,
    executor: Executor,
    results: dict[str, Result | Failure],
    meter: Eta,
) -> None:
    futures = {executor.submit(compute, job): job for job in waiting}
    try:
        for future in as_completed(futures):
            job, answer = futures[future], _answer(future)
            if answer.outcome or answer.lasting:
                base.put(job, answer)
            try:
                reason = answer.reason
                results[job.name] = Failure(job.name, reason) if reason else job.read(answer.outcome)
            except ResultError as error:  # the text is checked like a stored one
                results[job.name] = Failure(job.name, str(error))
            meter(job.name, len(results))
    finally:
        for future in futures:
            future.cancel()


def _answer(future: Future[Answer]) -> Answer:
    try:
        answer = future.result()
    except Exception as error:  # the worker died, or the executor gave up on the job
        return Answer("", "", f"no worker finished it: {error or type(error).__name__}", False, 0.0)
    if answer.program != source_digest():
        raise RunError(
            "a worker computes with another version of fem-impact or of its libraries than this process. "
            "Install the same on all workers."
        )
    return answer


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
    jobs: Iterable[Work[Any]], store: Path, progress: ProgressMeter, executor: Executor | None = None
) -> WorkForecast:
    """Return how long the jobs that are not stored will take on 1 to 1000 workers.

    A job takes the processor time that the case of its scene says, times the median ratio of measured to
    planned time of the jobs of its fidelity. Where none has run yet, a few of the cheaper half do.
    Compilation, the start of workers and sharing a machine's memory among them are not in the figures.
    """
    all_jobs = list(jobs)
    with Store.open(store) as base:
        done = stored_results(base, all_jobs, progress)
    done |= run_jobs(_samples(all_jobs, done), store, progress, executor)
    expected = expected_costs(all_jobs, done)
    groups: dict[JobKind, list[float]] = {}
    for job in all_jobs:
        if job.name in expected:
            groups.setdefault(job.kind, []).append(expected[job.name])
    return WorkForecast(
        len(all_jobs),
        len(done),
        sum(expected.values()),
        max(expected.values(), default=0.0),
        {n: makespan(expected.values(), n) for n in WORKERS},
        [
            JobGroup(fidelity, size or None, len(times), min(times), max(times), sum(times))
            for (fidelity, size), times in groups.items()
        ],
        paces(all_jobs, done),
    )


def _samples(jobs: Sequence[Work[Any]], done: Mapping[str, Any]) -> list[Work[Any]]:
    """Return a few jobs of each fidelity of which none has run, evenly spread over its cheaper half."""
    chosen: list[Work[Any]] = []
    measured = {fidelity for fidelity, pace in paces(jobs, done).items() if pace.measured}
    for fidelity in dict.fromkeys(job.fidelity for job in jobs if job.fidelity not in measured):
        left = [job for job in jobs if job.fidelity == fidelity and job.name not in done]
        limit = median(job.planned_s for job in left) if left else 0.0
        cheap = [job for job in left if job.planned_s <= limit]
        chosen += cheap[:: max(1, len(cheap) // SAMPLE)][:SAMPLE]
    return chosen
