"""Model beside measurement: one panel a quantity, one line a set."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.figures.style import INK, PALETTE, QUIET, Shape, figure
from fem_impact.output import COMPARISON, write_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["comparison_figure"]

TITLE = {"wide": 9.5, "narrow": 7.5}
"""Sizes of a panel's title, points, at which the longest stays over its panel."""


def comparison_figure(rows: Sequence[Mapping[str, Any]], path: str | Path, shape: Shape = "wide") -> Path:
    """Draw measured means with their 95 % intervals, and the model with its two-mesh band.

    Parameters
    ----------
    rows : sequence of mappings
        Rows of ``comparison`` in study.json; null values are left out of the picture.
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    path = Path(path)
    write_table(
        path.with_suffix(".csv"), COMPARISON, [{name: row[name] for name in COMPARISON} for row in rows]
    )
    quantities, sets = _distinct(rows, "quantity"), _distinct(rows, "set")
    columns = min(4 if shape == "wide" else 2, max(len(quantities), 1))
    lines = math.ceil(max(len(quantities), 1) / columns)
    with figure(path, shape, 0.6 + lines * (0.75 + 0.24 * len(sets))) as drawn:
        panels = _panels(drawn, lines, columns)
        for panel, quantity in zip(panels, quantities, strict=False):
            _panel(panel, [row for row in rows if row["quantity"] == quantity], sets, TITLE[shape])
        for panel in panels[len(quantities) :]:
            panel.set_visible(False)
        _legend(drawn, panels[0], shape)
    return path


def _distinct(rows: Sequence[Mapping[str, Any]], name: str) -> list[str]:
    return list(dict.fromkeys(row[name] for row in rows))


def _panels(drawn: Figure, lines: int, columns: int) -> list[Axes]:
    return list(drawn.subplots(lines, columns, sharey=True, squeeze=False).flat)


def _panel(axes: Axes, rows: Sequence[Mapping[str, Any]], sets: list[str], size: float) -> None:
    unit = rows[0]["unit"]
    axes.set_title(rows[0]["quantity"] + (f", {unit}" if unit not in ("", "-") else ""), fontsize=size)
    for row in rows:
        _line(axes, row, sets.index(row["set"]))
    axes.set_yticks(range(len(sets)), sets)
    axes.set_ylim(len(sets) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.locator_params(axis="x", nbins=4, steps=[1, 2, 5, 10])
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid()


def _line(axes: Axes, row: Mapping[str, Any], at: int) -> None:
    mean, low, high, model = (
        row[name] for name in ("measured_mean", "measured_low", "measured_high", "model")
    )
    if mean is not None and row["measured_sd"] is not None:
        spread = (mean - row["measured_sd"], mean + row["measured_sd"])
        axes.plot(spread, (at - 0.16,) * 2, color=PALETTE["grey"], linewidth=1.0)
    if low is not None and high is not None:
        axes.plot((low, high), (at - 0.16,) * 2, color=INK, linewidth=3.2, solid_capstyle="butt")
    if mean is not None:
        axes.plot(mean, at - 0.16, "|", color=INK, markersize=8)
    if model is not None:
        colour = PALETTE["vermilion"]
        band = row["band"] or 0.0
        axes.errorbar(model, at + 0.16, xerr=band, fmt="D", color=colour, markersize=4.2, linewidth=1.2)


def _legend(drawn: Figure, axes: Axes, shape: Shape) -> None:
    axes.plot([], [], color=INK, linewidth=3.2, label="measured mean, 95 % interval")
    axes.plot([], [], color=PALETTE["grey"], linewidth=1.0, label="± one standard deviation")
    axes.errorbar([], [], xerr=[], fmt="D", color=PALETTE["vermilion"], label="model, two-mesh band")
    columns = 3 if shape == "wide" else 1
    drawn.legend(loc="outside lower center", ncols=columns, labelcolor=QUIET)
