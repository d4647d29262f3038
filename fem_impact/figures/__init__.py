"""Figures of runs and studies; each writes the numbers it shows as CSV beside itself."""

from fem_impact.figures.comparison import comparison_figure
from fem_impact.figures.force import force_figure
from fem_impact.figures.ledger import ledger_figure
from fem_impact.figures.partition import partition_figure
from fem_impact.figures.study_partition import study_partition_figure
from fem_impact.figures.style import Shape

__all__ = [
    "Shape",
    "comparison_figure",
    "force_figure",
    "ledger_figure",
    "partition_figure",
    "study_partition_figure",
]
