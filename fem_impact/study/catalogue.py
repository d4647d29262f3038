"""The studies by name, and how one is run."""

from __future__ import annotations

from concurrent.futures import Executor
from importlib import import_module
from typing import TYPE_CHECKING

from fem_impact.files.lock import directory_lock
from fem_impact.jobs.forecast import WorkForecast, estimate
from fem_impact.jobs.run import Results, run_jobs
from fem_impact.jobs.store import STORE
from fem_impact.study.document import Conclude, Plan, Request, StudyResult

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter


def run_study(
    name: str, request: Request, progress: ProgressMeter, executor: Executor | None = None
) -> StudyResult:
    """Run a study: its jobs through the executor, then its conclusions, written to ``request.out``.

    Parameters
    ----------
    name : module of ``fem_impact.study`` with ``plan`` and ``conclude``: the first is asked
        for jobs, with the results so far, until it names no new one; the second says what follows
    progress : told after every job
    executor : any; local processes when None

    Raises
    ------
    OutputPathError
        Another process writes to ``request.out``, or it cannot be written.
    """
    plan, conclude = _study(name)
    results: Results = {}
    with directory_lock(request.out):
        while new := [job for job in plan(request, results) if job.name not in results]:
            results |= run_jobs(new, request.out / STORE, progress, executor)
        return conclude(request, results, progress)


def estimate_study(
    name: str, request: Request, progress: ProgressMeter, executor: Executor | None = None
) -> WorkForecast:
    """Return what the study would take, later rounds of its plan apart; a few samples are computed."""
    with directory_lock(request.out):
        return estimate(_study(name)[0](request, {}), request.out / STORE, progress, executor)


def _study(name: str) -> tuple[Plan, Conclude]:
    module = import_module(f"fem_impact.study.{name}")
    return module.plan, module.conclude
