"""The published measurements as data: tables, measured sets and their statistics."""

from .audit import AuditRecord, audit, audit_statistics
from .correlation import Correlation, correlation, correlations
from .sets import MeasuredSet, measured_set, measured_sets, set_ids
from .statistics import Statistic, statistic
from .tables import printed_statistics, table

__all__ = [
    "AuditRecord",
    "Correlation",
    "MeasuredSet",
    "Statistic",
    "audit",
    "audit_statistics",
    "correlation",
    "correlations",
    "measured_set",
    "measured_sets",
    "printed_statistics",
    "set_ids",
    "statistic",
    "table",
]
