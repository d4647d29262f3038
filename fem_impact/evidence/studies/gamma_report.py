"""The gamma study's report: what it says, its figures and its tables."""

from __future__ import annotations

from fem_impact.answers.report import Sheet, StudyReport
from fem_impact.evidence.studies.gamma_figure import curve_picture, later_picture, others_picture
from fem_impact.evidence.studies.gamma_findings import Curves, findings
from fem_impact.evidence.studies.gamma_tables import (
    contact_table,
    gap_table,
    point_table,
    reduced_table,
    rod_table,
)
from fem_impact.evidence.studies.rods import DROP_NOTES, MODAL_NOTE

NOTES = (
    *DROP_NOTES,
    "The paper's rods have tip B here, as in its Tables 3 to 6; tip A (nose) of Table 2 is another contact.",
    "Limits of vanishing elements and their bands by the rule of the measured sets, from the two finest "
    "meshes of a point: all orders of convergence from 3/4 up.",
    "tau: contact time of the same rod if it could not vibrate, on the coarser mesh. T1: first bending "
    "period.",
    "Measured sets: their own scenes, with their own speeds, on the meshes of the study of the sets; the "
    "curve is that of one speed, 2.1 m/s.",
    MODAL_NOTE,
)
CURVE = (
    "Vibration after the impact by finite elements, with the bands of two meshes: 19 mm rods at 45 degrees, "
    "2.1 m/s. Diamonds: measured sets from their own scenes. Thin lines: the reduced model (modal). Last "
    "row: where the energy is after the impact."
)


def study_report(curves: Curves) -> StudyReport:
    """Return the study."""
    found, points = findings(curves), [*curves.line, *curves.others, *curves.sets]
    gaps = [point for point in points if point.gap]
    pictures = [curve_picture(curves, CURVE), later_picture(curves)]
    pictures += [others_picture(curves)] if curves.others else []
    return StudyReport(
        "gamma",
        "Vibration against slenderness",
        found,
        pictures,
        [
            Sheet(
                "rods", "The paper's rods at 45 degrees and 2.1 m/s, by finite elements", rod_table(curves)
            ),
            *([Sheet("gaps", "Points without a value or a band", gap_table(gaps))] if gaps else []),
            Sheet("points", "Every point by finite elements", point_table(points), shown=False),
            Sheet("contacts", "Every contact of every point", contact_table(points), shown=False),
            Sheet("reduced", "The reduced model (modal)", reduced_table(curves), shown=False),
        ],
        NOTES,
        ["modal", "thornton", "slenderness"],
        [("vibration", sentence) for sentence in found],
    )
