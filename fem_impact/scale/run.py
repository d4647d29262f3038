"""Jobs through any executor: what is stored is read, the rest is computed and stored as it comes."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Executor, Future, as_completed
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.errors import RunError
from fem_impact.scale.costs import Eta, expected_costs
from fem_impact.scale.job import Answer, Failure, Job, compute, read_outcome
from fem_impact.scale.local import LocalProcesses
from fem_impact.scale.store import Store
from fem_impact.sources import source_digest

if TYPE_CHECKING:
    from fem_impact.outcome import Outcome
    from fem_impact.progress import Meter

__all__ = ["Results", "run_jobs", "stored"]

Results = dict[str, "Outcome | Failure"]


def run_jobs(jobs: Iterable[Job], store: Path, progress: Meter, executor: Executor | None = None) -> Results:
    """Return outcome or failure of every job by its name, in the order of the jobs.

    Results are kept in ``store`` as they come, so that an interrupted study goes on where it stopped.

    Parameters
    ----------
    jobs : names must differ
    store : SQLite file, made if it is not there
    progress : told after every job, with the time that all jobs still need
    executor : any, such as what `on_scheduler` lends; local processes, one a core, when None

    Raises
    ------
    RunError
        A worker holds another version of the program.
    """
    wanted = {job.name: _placed(job) for job in jobs}
    with Store.open(store) as base:
        found = {name: stored(base, job) for name, job in wanted.items()}
        results = {name: result for name, result in found.items() if result is not None}
        costs = expected_costs((wanted[name] for name in wanted if name not in results), base.costs())
        if costs:
            # the longest first, so that no worker is left alone with one at the end
            waiting = [wanted[name] for name in sorted(costs, key=lambda name: -costs[name])]
            with LocalProcesses() if executor is None else nullcontext(executor) as engine:
                _compute(waiting, base, engine, results, Eta.start(costs, len(wanted), progress))
    return {name: results[name] for name in wanted}


def _placed(job: Job) -> Job:
    """Name the place absolutely: a worker may stand in another directory than this process."""
    return job if job.out is None else replace(job, out=job.out.absolute())


def stored(base: Store, job: Job) -> Outcome | Failure | None:
    """Return the result of a job if the store holds it."""
    held = base.get(job.key)
    if held is None:
        return None
    outcome, reason = held
    return Failure(job.name, reason) if reason else read_outcome(job, outcome)


def _compute(waiting: list[Job], base: Store, executor: Executor, results: Results, meter: Eta) -> None:
    futures = {executor.submit(compute, job): job for job in waiting}
    try:
        for future in as_completed(futures):
            job, answer = futures[future], _answer(future)
            if answer.outcome or answer.lasting:
                base.put(job, answer)
            outcome = read_outcome(job, answer.outcome) if answer.outcome else None
            results[job.name] = outcome or Failure(job.name, answer.reason or "its files cannot be read back")
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
