"""Studies: many runs behind an executor, resumable, each result whole or absent."""

from fem_impact.study.convergence import Convergence, run_convergence
from fem_impact.study.sets import StudyResult, run_sets

__all__ = ["Convergence", "StudyResult", "run_convergence", "run_sets"]
