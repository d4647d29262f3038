"""Coverage: how often the truth lies inside the errors that the program tells, over scenes drawn at random.

Scenes run as a user runs them, with default levels and with the reduced model; where the default run gives
its numbers, again with one level more, and where that is not dear with two.
"""

from __future__ import annotations

from collections.abc import Mapping

from fem_impact.answers.report import Request, StudyReport
from fem_impact.evidence.studies.coverage.report import report_of
from fem_impact.evidence.studies.coverage.run import (
    DEFAULT,
    FINER,
    FINEST,
    MODAL,
    CoverageResult,
    CoverageRun,
)
from fem_impact.evidence.studies.coverage.scenes import DrawnScene, drawn
from fem_impact.jobs.job import Failure

__all__ = ["conclude", "plan"]

COUNT, ANGLES = 16, 5  # scenes of a family, angles of the twelve bodies
QUICK_COUNT, QUICK_ANGLES = 1, 0
AFFORDED = 30.0  # s of processor time of the run with one level more, up to which one with two follows
Results = Mapping[str, CoverageResult | Failure]


def scenes(request: Request) -> list[DrawnScene]:
    """Return the scenes of the study, or the first of each family if quick."""
    return drawn(QUICK_COUNT, QUICK_ANGLES) if request.quick else drawn(COUNT, ANGLES)


def plan(request: Request, results: Results) -> list[CoverageRun]:
    """Return the runs of every scene that the results so far call for.

    The reduced model takes no mesh. A finer run follows where the default run gave numbers, one with two
    levels more where that with one more was not dear; not if quick.
    """
    runs = []
    for scene in scenes(request):
        wanted = [DEFAULT] if scene.body else [MODAL, DEFAULT]
        default, finer = (results.get(CoverageRun(scene, model).name) for model in (DEFAULT, FINER))
        if isinstance(default, CoverageResult) and default.has_numbers:
            wanted.append(FINER)
        if isinstance(finer, CoverageResult) and finer.cpu_s <= AFFORDED and not request.quick:
            wanted.append(FINEST)
        runs += [CoverageRun(scene, model) for model in wanted]
    return runs


def conclude(request: Request, results: Results) -> StudyReport:
    """Return the report of the results; a run whose process died counts as a fault."""
    done = {
        (run.drawn.name, run.model): _result(results[run.name])
        for run in plan(request, results)
        if run.name in results
    }
    return report_of(scenes(request), done)


def _result(result: CoverageResult | Failure) -> CoverageResult:
    return CoverageResult(None, "fault", result.reason) if isinstance(result, Failure) else result
