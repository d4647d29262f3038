"""What is asked of a study, and what a study is: jobs, and what follows from their results."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.output import make_directory
from fem_impact.scale import STORE, Estimate, Failure, Job, Results, estimate, run_jobs

if TYPE_CHECKING:
    from fem_impact.progress import Meter

__all__ = ["Request", "StudyResult", "estimate_study", "failures_of", "run_study"]


@dataclass(frozen=True, slots=True)
class Request:
    """What is asked of a study.

    Attributes
    ----------
    out : Path
        Directory of the study, with the store of its results.
    ids : tuple of str
        Measured sets, where the study is about them; all when empty.
    quick : bool
        A small version for a first look.
    fidelity : str
        Of the studies that leave the choice; each has its default.
    """

    out: Path
    ids: tuple[str, ...] = ()
    quick: bool = False
    fidelity: str = ""

    def command(self, study: str) -> str:
        """Return the command that asks for this."""
        options = [*self.ids, *(["--quick"] if self.quick else [])]
        options += ["--fidelity", self.fidelity] if self.fidelity else []
        return " ".join(["fem-impact study", study, *options])


@dataclass(frozen=True, slots=True)
class StudyResult:
    """The document that study.json holds, its text for a terminal, and notes on what could not be drawn."""

    document: dict[str, Any]
    text: str
    notes: list[str] = field(default_factory=list)


Plan = Callable[[Request, Results], list[Job]]
Conclude = Callable[[Request, Results, "Meter"], StudyResult]


def run_study(name: str, request: Request, progress: Meter, executor: Executor | None = None) -> StudyResult:
    """Run a study: its jobs through the executor, then its conclusions, written to ``request.out``.

    Parameters
    ----------
    name : module of ``fem_impact.study`` with ``plan`` and ``conclude``: the first is asked
        for jobs, with the results so far, until it names no new one; the second says what follows
    progress : told after every job
    executor : any; local processes when None
    """
    plan, conclude = _study(name)
    make_directory(request.out)
    results: Results = {}
    while new := [job for job in plan(request, results) if job.name not in results]:
        results |= run_jobs(new, request.out / STORE, progress, executor)
    return conclude(request, results, progress)


def estimate_study(
    name: str, request: Request, progress: Meter, executor: Executor | None = None
) -> Estimate:
    """Return what the study would take, later rounds of its plan apart; a few samples are computed."""
    return estimate(_study(name)[0](request, {}), request.out / STORE, progress, executor)


def failures_of(results: Results) -> list[dict[str, str]]:
    """Return one row a failed job."""
    failed = (result for result in results.values() if isinstance(result, Failure))
    return [{"scene_id": failure.name, "error": failure.reason} for failure in failed]


def _study(name: str) -> tuple[Plan, Conclude]:
    module = import_module(f"fem_impact.study.{name}")
    return module.plan, module.conclude
