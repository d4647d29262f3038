"""Reports: one self-contained HTML file for a run or a study."""

from fem_impact.report.all_page import write_all
from fem_impact.report.study_data import STUDY_SCHEMA, Study, read_study
from fem_impact.report.study_page import draw_study
from fem_impact.report.write import write_report

__all__ = ["STUDY_SCHEMA", "Study", "draw_study", "read_study", "write_all", "write_report"]
