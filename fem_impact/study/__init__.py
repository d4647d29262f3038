"""Studies: many runs behind an executor, resumable, each result whole or absent."""

from fem_impact.study.request import Request, StudyResult, estimate_study, run_study

__all__ = ["Request", "StudyResult", "estimate_study", "run_study"]
