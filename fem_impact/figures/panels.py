"""What a figure shows: panels with lines, points, areas, bars or a shaded map, and their numbers.

A `Picture` is described once; `still` draws it as SVG or PNG, `live` for a page with hover and zoom.
"""

import math
import tomllib
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.tables.table import Cell, Table

Look = Literal[
    "line",
    "thin",
    "dashed",
    "points",
    "rings",
    "joined",
    "diamonds",
    "squares",
    "triangles",
    "area",
    "bars",
    "interval",
    "spread",
]
"""Rings are wider than points, so that both are seen where they agree. Areas and bars of a panel are stacked.
Of an interval and of a spread only the band is drawn, thick and thin. Joined points have no line where
there are three or fewer of them: two or three values show no course."""

LOOKS: dict[str, dict[str, Any]] = tomllib.loads(
    files("fem_impact.figures").joinpath("looks.toml").read_text(encoding="utf-8")
)
"""How each look is drawn, and its sign in a legend."""

FEW = 3
COLUMNS = ("panel", "series", "x_label", "y_label", "x", "y", "band")


@dataclass(frozen=True, slots=True)
class Series:
    """A curve or points: ``x`` and ``y`` of equal length, and the colour: None is the next one.

    The colour is an index of `COLOURS` or a name of the palette. ``band`` holds half-widths, NaN where there
    is none, about ``y``, or about ``x`` in a panel with rows; they are drawn as error bars, up to the
    ``ends`` between which the numbers lie. A value of NaN is a gap. ``texts`` stand beside bars; those of
    points are shown at the pointer. Series of one label look the same in all panels of a figure.
    """

    label: str
    x: ArrayLike
    y: ArrayLike
    look: Look = "line"
    colour: int | str | None = None
    band: ArrayLike | None = None
    texts: tuple[str, ...] = ()
    ends: tuple[float, float] = (-math.inf, math.inf)

    @property
    def drawn(self) -> Look:
        """How it is drawn: joined points only where there are more than `FEW`."""
        few = np.isfinite(np.asarray(self.y, float)).sum() <= FEW
        return "points" if self.look == "joined" and few else self.look


@dataclass(frozen=True, slots=True)
class Mark:
    """A labelled line across the panel, at ``at`` of the axis."""

    at: float
    label: str = ""


@dataclass(frozen=True, slots=True)
class ShadedInterval:
    """A shaded part of the x axis, named above it."""

    start: float
    end: float
    label: str


@dataclass(frozen=True, slots=True)
class ShadedMap:
    """Values over x and y in red (positive) and blue; ``values`` has the shape (n_y, n_x).

    Colours end at plus and minus ``limit``. ``label`` names the values with their unit.
    """

    x: ArrayLike
    y: ArrayLike
    values: ArrayLike
    limit: float
    label: str


@dataclass(frozen=True, slots=True)
class Panel:
    """One pair of axes.

    Parameters
    ----------
    title, x, y : str
        Labels hold the units.
    series : tuple of Series
    marks, levels : tuple of Mark
        Vertical and horizontal lines.
    names, rows : tuple of str
        Names of x = 0, 1, 2 ..., and of y = 0, 1, 2 ... from the top.
    intervals : tuple of ShadedInterval
    shaded : ShadedMap, optional
    x_range, y_range : (float, float), optional
        Ends of the axes; those of the data where None.
    logarithmic : bool
        Whether both axes are.
    equal : bool
        Whether a length is as long along both axes.
    """

    title: str
    x: str
    y: str
    series: tuple[Series, ...]
    marks: tuple[Mark, ...] = ()
    levels: tuple[Mark, ...] = ()
    names: tuple[str, ...] = ()
    rows: tuple[str, ...] = ()
    intervals: tuple[ShadedInterval, ...] = ()
    shaded: ShadedMap | None = None
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    logarithmic: bool = False
    equal: bool = False

    @property
    def informative(self) -> bool:
        """Whether it has names, rows or a map, or more than one place along x."""
        places = {x for series in self.series for x in np.asarray(series.x, float).tolist()}
        return bool(self.names or self.rows or self.shaded) or len(places) > 1

    @property
    def horizontal(self) -> bool:
        """Whether bands and bars lie along x."""
        return bool(self.rows)


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure: name of its files, caption, panels and their number side by side, and its numbers.

    ``numbers`` is written as CSV beside the drawing; where None, it is the series of all panels.
    """

    name: str
    caption: str
    panels: tuple[Panel, ...]
    columns: int = 2
    numbers: Table | None = None

    def table(self) -> Table:
        """Return the numbers that the figure shows."""
        if self.numbers is not None:
            return self.numbers
        rows = [
            [panel.title, series.label, panel.x, panel.y, _named(x, panel.names), _named(y, panel.rows), band]
            for panel in self.panels
            for series in panel.series
            for x, y, band in zip(*map(numbers, (series.x, series.y, half_widths(series))), strict=True)
        ]
        return Table.of(COLUMNS, rows)


def half_widths(series: Series) -> np.ndarray:
    """Return the bands of all points, NaN where there are none, ``(n,) float64``."""
    if series.band is None:
        return np.full(len(np.asarray(series.y)), np.nan)
    return np.asarray(series.band, float)


def error_bars(series: Series, horizontal: bool) -> np.ndarray:
    """Return lengths of the error bars below and above all points, ``(2, n) float64``, up to its ends."""
    values, halves = np.asarray(series.x if horizontal else series.y, float), half_widths(series)
    low, high = series.ends
    return np.maximum([np.minimum(halves, values - low), np.minimum(halves, high - values)], 0.0)


def numbers(values: ArrayLike, digits: int = 17) -> list[float | None]:
    """Return numbers rounded to significant digits, None for NaN."""
    return [None if math.isnan(v) else float(f"{v:.{digits}g}") for v in np.asarray(values, float).tolist()]


def _named(value: float | None, names: tuple[str, ...]) -> Cell:
    return names[round(value)] if names and value is not None else value
