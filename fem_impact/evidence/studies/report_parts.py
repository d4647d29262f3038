"""What the reports of several studies share: the texts that they rest on, sets, errors side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from fem_impact.answers.report import Request
from fem_impact.answers.v_and_v import COVERAGE, Comparison
from fem_impact.evidence.data import read_data
from fem_impact.figures.panels import Mark, Panel, Series
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.tables.table import Cell, Table

if TYPE_CHECKING:
    from pandas import DataFrame

COMPARED = ("S", "D", "E", "u_num", "u_input", "u_D", "u_val")
"""Columns of a comparison, by the names of ASME V&V 20."""


def rests_on(study: str, **numbers: object) -> list[str]:
    """Return what the report of a study rests on: texts of data/rests_on.md, with these numbers in them."""
    text = read_data("studies/data/rests_on.md").split(f"## {study}\n")[1].split("\n## ")[0]
    return [" ".join(item.split()).format(**numbers) for item in text.split("\n- ")[1:]]


def asked_sets(request: Request) -> tuple[str, ...]:
    """Return the requested measured sets; by default all, or t5b if quick."""
    return request.ids or (("t5b",) if request.quick else MEASURED_SETS)


def comparison_table(compared: Sequence[Comparison], first: str, second: str, last: str = "") -> Table:
    """Return one row a comparison: its set under ``first``, its quantity under ``second``.

    A column ``last``, where it is named, holds the verdict by the scatter of the tests.
    """
    rows = [
        (c.set, c.quantity, *(getattr(c, name) for name in COMPARED), *c.interval, c.verdict)
        + ((c.scatter,) if last else ())
        for c in compared
    ]
    return Table.of((first, second, *COMPARED, "low", "high", "verdict", *filter(None, [last])), rows)


def frame_rows(frame: DataFrame) -> list[tuple[Cell, ...]]:
    """Return the rows of a frame for a table, None for what is not known."""
    return [tuple(row) for row in frame.astype(object).where(frame.notna(), None).to_numpy()]


def error_panel(title: str, rows: Sequence[str], errors: Mapping[str, Sequence[tuple[int, float]]]) -> Panel:
    """Return errors over their uncertainty, a colour a name, each by the number of its row."""
    series = tuple(
        Series(name, [error for _, error in of], [float(row) for row, _ in of], "points", colour)
        for colour, (name, of) in enumerate(errors.items())
    )
    return Panel(title, "E / u_val", "", series, (Mark(-COVERAGE), Mark(COVERAGE)), rows=tuple(rows))
