"""The published measurements as data: tables, measured sets and their statistics."""

from .sets import MeasuredSet, measured_set, measured_sets, set_ids
from .statistics import Statistic, statistic
from .tables import printed_statistics, table

__all__ = [
    "MeasuredSet",
    "Statistic",
    "measured_set",
    "measured_sets",
    "printed_statistics",
    "set_ids",
    "statistic",
    "table",
]
