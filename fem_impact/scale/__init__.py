"""Many runs behind an executor: content-addressed, resumable, in local processes or on a cluster."""

from fem_impact.scale.cluster import on_scheduler
from fem_impact.scale.crowd import Estimate, estimate
from fem_impact.scale.job import Failure, Job
from fem_impact.scale.local import LocalProcesses
from fem_impact.scale.run import Results, run_jobs
from fem_impact.scale.store import STORE, Store

__all__ = [
    "STORE",
    "Estimate",
    "Failure",
    "Job",
    "LocalProcesses",
    "Results",
    "Store",
    "estimate",
    "on_scheduler",
    "run_jobs",
]
