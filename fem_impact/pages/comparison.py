"""Model beside measured tests: the figure and the tables of one run or of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fem_impact.answers.compare import compare
from fem_impact.errors import ResultError
from fem_impact.figures.partition import comparison_picture
from fem_impact.files.atomic import make_directory
from fem_impact.outcome.record import Outcome
from fem_impact.pages.html import Markup, details, join, paragraph, section, table
from fem_impact.pages.page import download, figure
from fem_impact.run.tests import tests_of
from fem_impact.scene.types import OWN, Scene
from fem_impact.tables.table import DASH, Cell, Marked, Table

HEAD = ("model", "measured", "95 % interval of the mean", "n", "verdict")


def beside_tests(outcome: Outcome, scene: Scene | None, folder: Path) -> Markup:
    """Return the section that sets a run beside the tests its scene names; nothing where it names none.

    Its figure and data are written to ``folder/figures``. Tests that can no longer be read are told.
    """
    title = "Beside the measured tests"
    if scene is None or scene.measured is None:
        return Markup("")
    try:
        tests = tests_of(scene)
    except (ResultError, OSError) as error:
        return section(title, paragraph(f"The tests can no longer be read: {error}"))
    rows = [row for row in compare(outcome, tests) if row["measured_mean"] is not None]
    known = [row for row in rows if row["model"] is not None]
    inside = sum(is_inside(row["verdict"]) for row in known)
    own = scene.measured.endswith(OWN)
    name = Path(scene.measured).name if own else f"the published set {scene.measured}"
    told = paragraph(
        f"{inside} of {len(known)} computed quantities lie inside the 95 % interval of the measured mean "
        f"({max(row['n'] for row in rows)} tests, {name})."
    )
    shown = Table.of(("quantity", *HEAD), [[_titled(row), *_cells(row)] for row in rows], left=(0, 5))
    return section(title, told, table(shown, compact=True), comparison_part(rows, folder))


def _titled(row: Mapping[str, Any]) -> str:
    unit = "" if row["unit"] in ("", "-") else f", {row['unit']}"
    return f"{row['quantity']}{unit}"


def comparison_part(rows: Sequence[Mapping[str, Any]], folder: Path, since: Path | None = None) -> Markup:
    """Return the figure of model and measurement; one newer than the file ``since`` is not drawn again."""
    if all(row["measured_mean"] is None for row in rows):
        return Markup("")
    figures = make_directory(folder / "figures")
    drawn = figure(comparison_picture(rows), figures, since)
    return join([drawn, download(figures / "comparison.csv", "its data")])


def comparison_tables(rows: Sequence[Mapping[str, Any]]) -> Markup:
    """Return a table a quantity that was measured: model, measurement, interval and verdict of each set."""
    quantities = dict.fromkeys(row["quantity"] for row in rows if row["measured_mean"] is not None)
    return join(_quantity([row for row in rows if row["quantity"] == name]) for name in quantities)


def _quantity(rows: Sequence[Mapping[str, Any]]) -> Markup:
    measured = [row for row in rows if row["measured_mean"] is not None]
    inside = sum(is_inside(row["verdict"]) for row in measured)
    shown = Table.of(("set", *HEAD), [[str(row["set"]), *_cells(row)] for row in rows], left=(0, 5))
    title = f"{_titled(rows[0])}: {inside} of {len(measured)} inside"
    return details(title, table(shown, compact=True))


def _cells(row: Mapping[str, Any]) -> list[Cell]:
    low, high = row["measured_low"], row["measured_high"]
    measured = row["measured_mean"] is not None
    style = ("inside" if is_inside(row["verdict"]) else "outside") if measured else ""
    spread = "" if row["measured_sd"] is None else f" ± {row['measured_sd']:.2g}"
    return [
        Marked(_three(row["model"]) + ("" if row["band"] is None else f" ± {row['band']:.2g}"), style),
        _three(row["measured_mean"]) + spread,
        None if low is None or high is None else f"{_three(low)} to {_three(high)}",
        row["n"],
        Marked(str(row["verdict"] or DASH), style),
    ]


def _three(value: float | None) -> str:
    return DASH if value is None else f"{value:#.3g}".rstrip(".").replace("-", "−")


def is_inside(verdict: Any) -> bool:
    """Return whether a verdict says that the model lies inside the 95 % interval of the mean."""
    return str(verdict).startswith("inside")
