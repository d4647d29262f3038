"""The one way that evidence runs: jobs with a store, a report of their results, and its files."""

from concurrent.futures import Executor
from importlib import import_module
from typing import Any

from fem_impact.answers.report import Request, StudyResult, publish
from fem_impact.files.atomic import directory_lock
from fem_impact.jobs.job import STORE, JobResults
from fem_impact.jobs.run import WorkForecast, estimate, run_jobs
from fem_impact.progress import ProgressMeter


def run_study(
    name: str, request: Request, progress: ProgressMeter, executor: Executor | None = None
) -> StudyResult:
    """Run the jobs of a study, evaluate their results and write its report to ``request.out``.

    Parameters
    ----------
    name : str
        Module of ``fem_impact.evidence``, such as "studies.tip", with two functions.
        ``plan(request, results)`` returns its jobs; it is called with the results so far until it returns
        no new one. ``conclude(request, results)`` returns its `StudyReport`.
    progress : meter, updated after each job
    executor : where the jobs run; local processes when None

    Raises
    ------
    OutputPathError
        Another process writes to ``request.out``, or it cannot be written.
    """
    study = _module(name)
    results: JobResults = {}
    with directory_lock(request.out):
        while new := [job for job in study.plan(request, results) if job.name not in results]:
            results |= run_jobs(new, request.out / STORE, progress, executor)
        return publish(study.conclude(request, results), request, results)


def estimate_study(
    name: str, request: Request, progress: ProgressMeter, executor: Executor | None = None
) -> WorkForecast:
    """Return the expected time of the study's first round of jobs, from a few sample runs.

    Jobs that ``plan`` adds once it has results are not counted.
    """
    with directory_lock(request.out):
        return estimate(_module(name).plan(request, {}), request.out / STORE, progress, executor)


def _module(name: str) -> Any:
    return import_module(f"fem_impact.evidence.{name}")
