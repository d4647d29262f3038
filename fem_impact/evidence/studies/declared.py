"""A study that is declared: scenes, variants of each, columns of their outcomes, and what is told of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fem_impact.answers.report import Request, StudyReport
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.record import Outcome

if TYPE_CHECKING:
    import pandas

    from fem_impact.scene.types import Scene


@dataclass(frozen=True, slots=True)
class DeclaredSweep:
    """Scenes, each run in some variants.

    Attributes
    ----------
    scenes : function of the request to the scenes by name
    variants : function of a scene to its variants by name: changed scene and fidelity
    columns : functions of an outcome to a number, by the name of the column
    report : function of `table` to the study's report
    label : name of a job by ``scene`` and ``variant``
    """

    scenes: Callable[[Request], Mapping[str, Scene]]
    variants: Callable[[Scene], Mapping[str, tuple[Scene, str]]]
    columns: Mapping[str, Callable[[Outcome], Any]]
    report: Callable[[pandas.DataFrame], StudyReport]
    label: str = "{scene}-{variant}"

    def jobs(self, request: Request) -> dict[str, dict[str, Job]]:
        """Return the jobs by scene and variant."""
        return {
            name: {
                variant: Job(self.label.format(scene=name, variant=variant), *changed)
                for variant, changed in self.variants(scene).items()
            }
            for name, scene in self.scenes(request).items()
        }

    def plan(self, request: Request, results: JobResults) -> list[Job]:
        """Return all jobs."""
        return [job for variants in self.jobs(request).values() for job in variants.values()]

    def table(self, request: Request, results: JobResults) -> pandas.DataFrame:
        """Return one row a scene all of whose runs have an outcome, with columns (column, variant)."""
        import pandas

        rows = {}
        for scene, variants in self.jobs(request).items():
            finished = {
                v: run for v, job in variants.items() if isinstance(run := results[job.name], Outcome)
            }
            if len(finished) == len(variants):
                rows[scene] = {
                    (name, v): of(run) for name, of in self.columns.items() for v, run in finished.items()
                }
        return pandas.DataFrame.from_dict(rows, orient="index", dtype=object)  # what is not known stays None

    def conclude(self, request: Request, results: JobResults) -> StudyReport:
        """Return the report of the results."""
        return self.report(self.table(request, results))
