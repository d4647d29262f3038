"""Run a study, or estimate its processor time, by the name of its module."""

from __future__ import annotations

from concurrent.futures import Executor
from importlib import import_module
from typing import TYPE_CHECKING

from fem_impact.answers.report import Conclude, Plan, Request, StudyResult
from fem_impact.files.lock import directory_lock
from fem_impact.jobs.run import Results, WorkForecast, estimate, run_jobs
from fem_impact.jobs.store import STORE

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter


def run_study(
    name: str, request: Request, progress: ProgressMeter, executor: Executor | None = None
) -> StudyResult:
    """Run the jobs of a study, evaluate their results and write the study to ``request.out``.

    Parameters
    ----------
    name : module of ``fem_impact.evidence.studies`` with the functions ``plan`` and ``conclude``; ``plan`` is
        called with the results so far until it returns no new job, then ``conclude`` with all results
    progress : meter, updated after each job
    executor : where the jobs run; local processes when None

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
    """Return the expected time of the study's first round of jobs, from a few sample runs.

    Jobs that ``plan`` adds once it has results are not counted.
    """
    with directory_lock(request.out):
        return estimate(_study(name)[0](request, {}), request.out / STORE, progress, executor)


def _study(name: str) -> tuple[Plan, Conclude]:
    """Return ``plan`` and ``conclude`` of a study's module."""
    module = import_module(f"fem_impact.evidence.studies.{name}")
    return module.plan, module.conclude
