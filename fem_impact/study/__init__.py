"""Studies: many runs behind an executor, resumable, each result whole or absent."""

from fem_impact.study.sets import StudyResult, run_sets

__all__ = ["StudyResult", "run_sets"]
