"""A study that is declared: scenes, variants of each, columns of their outcomes, and what is told of them."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import pandas

from fem_impact import Outcome, Scene
from fem_impact.answers.report import Request, StudyReport
from fem_impact.jobs.job import Job, JobResults
from fem_impact.options import RunOptions

Runs = Mapping[str, Mapping[str, Outcome]]
"""Outcomes by scene and variant; failed runs are left out."""


@dataclass(frozen=True, slots=True)
class DeclaredSweep:
    """Scenes, each run in some variants.

    Attributes
    ----------
    scenes : function of the request to the scenes by name
    variants : function of a scene's name and the scene to its variants by name: changed scene and fidelity
    report : function of the `Runs` to the study's report
    way : as that of a `Job`
    """

    scenes: Callable[[Request], Mapping[str, Scene]]
    variants: Callable[[str, Scene], Mapping[str, tuple[Scene, str]]]
    report: Callable[[Runs], StudyReport]
    way: Callable[[Scene, str, RunOptions], Outcome] | None = None

    def jobs(self, request: Request) -> dict[str, dict[str, Job]]:
        """Return the jobs by scene and variant."""
        return {
            name: {
                variant: Job(f"{name}-{variant}", *changed, way=self.way)
                for variant, changed in self.variants(name, scene).items()
            }
            for name, scene in self.scenes(request).items()
        }

    def plan(self, request: Request, results: JobResults) -> list[Job]:
        """Return all jobs."""
        return [job for variants in self.jobs(request).values() for job in variants.values()]

    def conclude(self, request: Request, results: JobResults) -> StudyReport:
        """Return the report of the results."""
        return self.report(
            {
                scene: {v: run for v, job in jobs.items() if isinstance(run := results[job.name], Outcome)}
                for scene, jobs in self.jobs(request).items()
            }
        )


def table_of(
    runs: Runs, columns: Mapping[str, Callable[[Outcome], Any]], variants: Iterable[str]
) -> pandas.DataFrame:
    """Return one row a scene that has all variants, columns (column, variant); what is not known is None.

    ``columns`` are functions of an outcome to a number, by the name of the column.
    """
    named = [*variants]
    rows = {
        scene: {(name, variant): of(finished[variant]) for name, of in columns.items() for variant in named}
        for scene, finished in runs.items()
        if set(named) <= set(finished)
    }
    return pandas.DataFrame.from_dict(rows, orient="index", dtype=object)
