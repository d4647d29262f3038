"""Figures of panels with lines and points, and their data."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.figures.style import INK, PALETTE, QUIET, Shape, figure, write_data
from fem_impact.tables.table import Cell

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


Look = Literal["line", "thin", "dashed", "points", "rings", "joined", "diamonds", "area"]
COLOURS = ("blue", "vermilion", "green", "purple", "orange", "sky", "night", "grey")
LETTERS = {"wide": 110, "narrow": 52}
"""Letters of a legend that fit across a picture."""

SAMPLE = 8
"""Width of the sample and the space of a legend entry, letters."""

NEAR = 0.05
"""Least distance, share of the axis, of two marks whose labels stand on the same side."""

COLUMNS = ("panel", "series", "x_label", "y_label", "x", "y", "band")


LOOKS: dict[str, dict[str, Any]] = {
    "line": {"linestyle": "-", "linewidth": 1.4},
    "thin": {"linestyle": (0, (4, 2)), "linewidth": 0.7},
    "dashed": {"linestyle": (0, (5, 1.5)), "linewidth": 1.4},
    "points": {"linestyle": "none", "marker": "o", "markersize": 3.6},
    "rings": {"linestyle": "none", "marker": "o", "markersize": 5.6, "mfc": "none"},
    "joined": {"linestyle": "-", "linewidth": 1.0, "marker": "o", "markersize": 3.2},
    "diamonds": {"linestyle": "none", "marker": "D", "markersize": 4.6, "mfc": "none"},
}
"""Rings are wider than points, so that both are seen where they agree."""

ERROR = {"capsize": 1.8, "elinewidth": 0.9, "capthick": 0.9}
"""How the band of a point looks."""


@dataclass(frozen=True, slots=True)
class Series:
    """A curve or points: ``x`` and ``y`` of equal length, and the colour: None is the next one.

    The colour is an index of `COLOURS` or a name of the palette. ``band`` holds half-widths about ``y``, NaN
    where there is none; they are drawn as error bars. A value of NaN is a gap. The series of a panel that
    look like an ``area`` are stacked. Series of one label look the same in all panels of a figure.
    """

    label: str
    x: ArrayLike
    y: ArrayLike
    look: Look = "line"
    colour: int | str | None = None
    band: ArrayLike | None = None


@dataclass(frozen=True, slots=True)
class Mark:
    """A labelled vertical line at ``x``."""

    x: float
    label: str


@dataclass(frozen=True, slots=True)
class Panel:
    """One pair of axes: title, labels with units, series, marks, levels, and names of x = 0, 1, 2 ..."""

    title: str
    x: str
    y: str
    series: tuple[Series, ...]
    marks: tuple[Mark, ...] = ()
    levels: tuple[float, ...] = ()
    names: tuple[str, ...] = ()


def lines_figure(panels: Sequence[Panel], path: str | Path, shape: Shape = "wide", columns: int = 2) -> Path:
    """Draw panels over one legend that names more than one series; the data go beside it as CSV."""
    path = Path(path)
    write_data(path, COLUMNS, (row for panel in panels for row in _rows(panel)))
    across = columns if shape == "wide" else 1
    down = math.ceil(len(panels) / across)
    labels = {series.label for panel in panels for series in panel.series}
    beside = max(1, LETTERS[shape] // (max(map(len, labels), default=0) + SAMPLE))
    tall = 3.8 if any(panel.names for panel in panels) else 3.2
    with figure(path, shape, tall * down + 0.18 * math.ceil(len(labels) / beside) + 0.1) as drawn:
        grid = list(drawn.subplots(down, across, squeeze=False).flat)
        for axes, panel in zip(grid, panels, strict=False):
            _panel(axes, panel)
        for axes in grid[len(panels) :]:
            axes.set_visible(False)
        _legend(drawn, grid, beside)
    return path


def _rows(panel: Panel) -> list[list[Cell]]:
    return [
        [panel.title, series.label, panel.x, panel.y, panel.names[round(x)] if panel.names else x, y, band]
        for series in panel.series
        for x, y, band in zip(*(_numbers(values) for values in _data(series)), strict=True)
    ]


def _data(series: Series) -> tuple[ArrayLike, ArrayLike, ArrayLike]:
    """Return x, y and half-widths, NaN where there are none."""
    return (
        series.x,
        series.y,
        np.full(len(np.asarray(series.y)), np.nan) if series.band is None else series.band,
    )


def _numbers(values: ArrayLike) -> list[float | None]:
    """Return numbers for a table, None for NaN."""
    return [None if math.isnan(value) else value for value in np.asarray(values, float).tolist()]


def _panel(axes: Axes, panel: Panel) -> None:
    axes.set(title=panel.title, xlabel=panel.x, ylabel=panel.y)
    below: float | np.ndarray = 0.0
    for at, series in enumerate(panel.series):
        colour = _colour(at if series.colour is None else series.colour)
        if series.look == "area":
            above = below + np.asarray(series.y, float)
            axes.fill_between(series.x, below, above, color=colour, linewidth=0, label=series.label)
            below = above
        elif series.band is None:
            axes.plot(series.x, series.y, color=colour, label=series.label, **LOOKS[series.look])
        else:
            look = LOOKS[series.look] | ERROR
            axes.errorbar(series.x, series.y, series.band, color=colour, label=series.label, **look)
    for level in panel.levels:
        axes.axhline(level, color=QUIET, linewidth=0.8, linestyle=(0, (2, 2)))
    if panel.names:
        axes.set_xticks(range(len(panel.names)), panel.names, rotation=35, ha="right", rotation_mode="anchor")
    _marks(axes, sorted(panel.marks, key=lambda mark: mark.x))
    axes.grid()


def _colour(wanted: int | str) -> str:
    return PALETTE[wanted if isinstance(wanted, str) else COLOURS[wanted % len(COLOURS)]]


def _marks(axes: Axes, marks: Sequence[Mark]) -> None:
    """Draw the marks; a label stands left of its line, or right where the mark before is within `NEAR`."""
    for mark in marks:
        axes.axvline(mark.x, color=QUIET, linewidth=0.7, linestyle=(0, (1, 2)))
    low, high = axes.get_xlim()
    before = -math.inf
    # zorder: under the curves
    look: dict[str, Any] = {"rotation": 90, "va": "top", "fontsize": 7.0, "color": QUIET, "zorder": 1.5}
    for mark in marks:
        side = "left" if mark.x - before < NEAR * (high - low) else "right"
        axes.text(mark.x, 0.99, mark.label, transform=axes.get_xaxis_transform(), ha=side, **look)
        before = mark.x


def _legend(drawn: Figure, grid: Sequence[Axes], beside: int) -> None:
    """Draw one legend under all panels with ``beside`` columns, none for a single series."""
    named: dict[str, Artist] = {}
    for axes in grid:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    if len(named) > 1:
        drawn.legend(
            list(named.values()),
            list(named),
            loc="outside lower center",
            ncols=min(beside, len(named)),
            labelcolor=INK,
        )
