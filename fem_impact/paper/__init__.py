"""The paper by rigid theory: audit of its tables, its figures, own data, and an assessment."""

from fem_impact.paper.assess import ASSUMPTIONS, assess
from fem_impact.paper.assess_text import assess_text
from fem_impact.paper.audit_report import CSV_COLUMNS, audit_document, csv_rows
from fem_impact.paper.audit_text import audit_text
from fem_impact.paper.camera import Camera, read_camera
from fem_impact.paper.case import Case
from fem_impact.paper.drawn import Drawn, Statement
from fem_impact.paper.figures import FIGURES, draw_figure
from fem_impact.paper.options import quantity, rod_from_options
from fem_impact.paper.own_data import own_coefficients
from fem_impact.paper.own_text import own_text

__all__ = [
    "ASSUMPTIONS",
    "CSV_COLUMNS",
    "FIGURES",
    "Camera",
    "Case",
    "Drawn",
    "Statement",
    "assess",
    "assess_text",
    "audit_document",
    "audit_text",
    "csv_rows",
    "draw_figure",
    "own_coefficients",
    "own_text",
    "quantity",
    "read_camera",
    "rod_from_options",
]
