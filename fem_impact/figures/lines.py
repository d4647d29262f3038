"""Panels of lines and points with their data: the figure of every study that compares curves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.figures.style import INK, PALETTE, QUIET, Shape, figure
from fem_impact.output import write_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Mark", "Panel", "Series", "lines_figure"]

COLOURS = ("blue", "vermilion", "green", "purple", "orange", "sky", "night", "grey")
LETTERS = {"wide": 110, "narrow": 46}
"""Letters of an axis label that fit across a picture."""
COLUMNS = ("panel", "series", "x_label", "y_label", "x", "y")


@dataclass(frozen=True, slots=True)
class Series:
    """A curve or a cloud: ``x`` and ``y`` of one length, a colour by number (in order when None)."""

    label: str
    x: ArrayLike
    y: ArrayLike
    look: Literal["line", "dashed", "points", "rings"] = "line"
    colour: int | None = None


@dataclass(frozen=True, slots=True)
class Mark:
    """A place on the x axis with a word."""

    x: float
    word: str


@dataclass(frozen=True, slots=True)
class Panel:
    """One pair of axes: title, labels with units, series, marks and levels, logarithmic or not."""

    title: str
    x: str
    y: str
    series: tuple[Series, ...]
    marks: tuple[Mark, ...] = ()
    levels: tuple[float, ...] = ()
    log: bool = False


def lines_figure(panels: Sequence[Panel], path: str | Path, shape: Shape = "wide", columns: int = 2) -> Path:
    """Draw panels with one legend a panel that names more than its title; the data go beside it as CSV."""
    path = Path(path)
    write_table(path.with_suffix(".csv"), COLUMNS, [row for panel in panels for row in _rows(panel)])
    across = columns if shape == "wide" else 1
    down = math.ceil(len(panels) / across)
    with figure(path, shape, 3.3 * down + 0.2) as drawn:
        every = _axes(drawn, down, across)
        for axes, panel in zip(every, panels, strict=False):
            _panel(axes, panel, LETTERS[shape] // across)
        for axes in every[len(panels) :]:
            axes.set_visible(False)
    return path


def _rows(panel: Panel) -> list[list[float | str | None]]:
    return [
        [panel.title, series.label, panel.x, panel.y, float(x), float(y)]
        for series in panel.series
        for x, y in zip(np.asarray(series.x), np.asarray(series.y), strict=True)
    ]


def _axes(drawn: Figure, down: int, across: int) -> list[Axes]:
    return list(drawn.subplots(down, across, squeeze=False).flat)


def _panel(axes: Axes, panel: Panel, letters: int) -> None:
    axes.set(title=panel.title, xlabel=fill(panel.x, letters), ylabel=panel.y)
    for at, series in enumerate(panel.series):
        _draw(axes, series, PALETTE[COLOURS[(at if series.colour is None else series.colour) % len(COLOURS)]])
    for level in panel.levels:
        axes.axhline(level, color=QUIET, linewidth=0.8, linestyle=(0, (2, 2)))
    if panel.log:
        axes.set(xscale="log", yscale="log")
    for mark in panel.marks:
        _mark(axes, mark)
    axes.grid()
    if len(panel.series) > 1:
        axes.legend(fontsize=7.5, labelcolor=INK)


def _draw(axes: Axes, series: Series, colour: str) -> None:
    if series.look in ("line", "dashed"):
        style = "-" if series.look == "line" else (0, (5, 1.5))
        axes.plot(series.x, series.y, color=colour, linestyle=style, linewidth=1.4, label=series.label)
    else:
        face = colour if series.look == "points" else "none"
        axes.plot(series.x, series.y, "o", color=colour, mfc=face, markersize=3.6, label=series.label)


def _mark(axes: Axes, mark: Mark) -> None:
    axes.axvline(mark.x, color=QUIET, linewidth=0.7, linestyle=(0, (1, 2)))
    axes.text(
        mark.x,
        0.99,
        mark.word,
        transform=axes.get_xaxis_transform(),
        rotation=90,
        ha="right",
        va="top",
        fontsize=7.0,
        color=QUIET,
    )
