"""Coverage: how often the truth lies inside the errors that the program tells, over scenes drawn at random.

Scenes run as a user runs them, with default levels and with the reduced model; where the default run gives
its numbers and is not dear, again with one level more, and where that is not dear with two. Where the
reduced model gives its numbers, finite elements tell as well what a twin changes that cannot vibrate.
"""

from collections.abc import Mapping

from fem_impact.answers.report import Request, StudyReport
from fem_impact.evidence.studies.coverage.report import report_of
from fem_impact.evidence.studies.coverage.run import (
    DEFAULT,
    FINEST,
    MODAL,
    NEXT,
    TWINS,
    CoverageResult,
    CoverageRun,
)
from fem_impact.evidence.studies.coverage.scenes import SEED, DrawnScene, drawn
from fem_impact.jobs.job import Failure

__all__ = ["conclude", "plan"]

COUNT, ANGLES = 16, 5  # scenes of a family, angles of the twelve bodies
QUICK_COUNT, QUICK_ANGLES = 1, 0
Results = Mapping[str, CoverageResult | Failure]


def scenes(request: Request) -> list[DrawnScene]:
    """Return the scenes of the study, a first part of them where that is asked for, or the quick one."""
    seed = request.seed or SEED
    if request.quick:
        return drawn(QUICK_COUNT, QUICK_ANGLES, seed)
    count = request.first or COUNT
    return drawn(count, min(count, ANGLES), seed)


def plan(request: Request, results: Results) -> list[CoverageRun]:
    """Return the runs of every scene that the results so far call for.

    A finer run follows one that gave numbers and was not dear (`NEXT`); one
    with two levels more, or with a twin, does not if quick.
    """
    runs = []
    for scene in scenes(request):
        wanted = [MODAL, DEFAULT]
        for model, (before, most_s) in NEXT.items():
            done = results.get(CoverageRun(scene, before).name)
            affords = isinstance(done, CoverageResult) and done.has_numbers and done.cpu_s <= most_s
            if affords and not (request.quick and model in (FINEST, TWINS)):
                wanted.append(model)
        runs += [CoverageRun(scene, model) for model in wanted]
    return runs


def conclude(request: Request, results: Results) -> StudyReport:
    """Return the report of the results; a run whose process died counts as a fault."""
    done = {}
    for run in plan(request, results):
        result = results.get(run.name)
        if isinstance(result, Failure):
            result = CoverageResult(None, "fault", result.reason)
        if result is not None:
            done[run.drawn.name, run.model] = result
    return report_of(scenes(request), done, request.seed or SEED)
