"""The published measurements as data: tables, measured sets and their statistics."""

from .angles import (
    AtAngle,
    angle_sets,
    at_angle,
    critical_ratio_against_angle,
    drawn_losses,
    loss_against_angle,
)
from .sets import (
    AuditRecord,
    MeasuredSet,
    audit,
    audit_statistics,
    column_arms,
    derived_columns,
    measured_set,
    measured_sets,
    set_ids,
)
from .statistics import (
    Correlation,
    Statistic,
    correlation,
    correlations,
    covariance_of_means,
    of_mean,
    statistic,
)
from .tables import printed_statistics, table

__all__ = [
    "AtAngle",
    "AuditRecord",
    "Correlation",
    "MeasuredSet",
    "Statistic",
    "angle_sets",
    "at_angle",
    "audit",
    "audit_statistics",
    "column_arms",
    "correlation",
    "correlations",
    "covariance_of_means",
    "critical_ratio_against_angle",
    "derived_columns",
    "drawn_losses",
    "loss_against_angle",
    "measured_set",
    "measured_sets",
    "of_mean",
    "printed_statistics",
    "set_ids",
    "statistic",
    "table",
]
