"""Pictures as SVG, PNG or PDF, drawn by matplotlib, with their numbers as CSV beside them; the style of all.

The style: size, a palette safe for colour-blind readers, the sides of labels, and saving.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fem_impact.figures.panels import LOOKS, Mark, Panel, Picture, Series, error_bars
from fem_impact.files.atomic import atomic_path, write_text
from fem_impact.tables.table import Cell, Table
from fem_impact.tables.text import formula, plain

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


STYLE: Mapping[str, dict[str, Any]] = tomllib.loads(
    files("fem_impact.figures").joinpath("style.toml").read_text(encoding="utf-8")
)
PALETTE: Mapping[str, str] = STYLE["palette"]
"""Colours of Okabe and Ito, others of other lightness, and those of texts."""
INK, QUIET = PALETTE["ink"], PALETTE["quiet"]

COLOURS = ("blue", "vermilion", "green", "purple", "orange", "sky", "night", "grey", "brown")
"""Colours of series in order."""

WIDTH = 8.4  # inches
NEAR = 0.05
"""Least distance, share of the axis, of two marks whose labels stand on the same side."""


@contextmanager
def figure(path: Path, height: float, width: float = WIDTH) -> Iterator[Figure]:
    """Yield an empty figure in the style of the project; it is saved to ``path`` at the end.

    Raises
    ------
    OutputPathError
        The place cannot be written.
    """
    import matplotlib

    style: dict[Any, Any] = {key: PALETTE.get(value, value) for key, value in STYLE["matplotlib"].items()}
    with matplotlib.rc_context(style):
        drawn = new_figure(height, width)
        yield drawn
        save(drawn, path)


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """Return an empty figure, in inches, that is not registered with pyplot."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def save(drawn: Figure, path: Path) -> None:
    """Write the figure atomically in the format of the suffix; equal data give equal bytes."""
    dated: dict[str, Any] = {"Date": None} if path.suffix in (".svg", ".pdf") else {}
    replace_undrawn(drawn)
    with atomic_path(path) as draft:
        drawn.savefig(draft, format=path.suffix.lstrip("."), dpi=150, metadata=dated)


def replace_undrawn(drawn: Figure) -> None:
    """Put a question mark for each letter of a figure's texts that its font does not have, such as CJK."""
    from matplotlib.text import Text

    for text in drawn.findobj(Text):
        words, known = text.get_text(), _letters()
        if undrawn := {letter for letter in words if letter not in known and not letter.isspace()}:
            text.set_text(words.translate(dict.fromkeys(map(ord, undrawn), "?")))


@cache
def _letters() -> frozenset[str]:
    """Return the letters of the font of figures and films."""
    from matplotlib.font_manager import findfont, get_font

    return frozenset(map(chr, get_font(findfont("DejaVu Sans")).get_charmap()))


def write_data(picture: Path, columns: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
    """Write the numbers of a figure as CSV beside it, units in the names. Raises OutputPathError."""
    write_text(picture.with_suffix(".csv"), Table.of(columns, rows).csv())


def colour_of(colour: int | str | None, at: int) -> str:
    """Return the colour of the series at a place, by its index or name, of its place where that is None."""
    name = colour if isinstance(colour, str) else COLOURS[(at if colour is None else colour) % len(COLOURS)]
    return PALETTE[name]


def label_sides(
    marks: Iterable[Mark], low: float, high: float
) -> list[tuple[Mark, Literal["left", "right"]]]:
    """Return marks from left to right with the alignment of their labels on an axis from low to high.

    A label stands left of its line, or right where the mark before is within `NEAR`.
    """
    placed: list[tuple[Mark, Literal["left", "right"]]] = []
    before = -math.inf
    for mark in sorted(marks, key=lambda mark: mark.at):
        placed.append((mark, "left" if mark.at - before < NEAR * (high - low) else "right"))
        before = mark.at
    return placed


def percent(fraction: float) -> str:
    """Return a fraction of E_0 as text in per cent, with two digits or more.

    Examples
    --------
    >>> percent(0.626), percent(0.00219)
    ('62.6 %', '0.22 %')
    """
    value = 100.0 * fraction
    if abs(value) >= 0.95:
        return f"{value:.1f} %"
    return f"{plain(value, 2)} %" if value else "0 %"


LETTERS = 110
"""Letters of a legend that fit across a picture."""

SAMPLE = 8
"""Width of the sample and the space of a legend entry, letters."""

ERROR = {"capsize": 1.8, "elinewidth": 0.9, "capthick": 0.9}
"""How the band of a point looks."""


def draw(picture: Picture, path: str | Path) -> Path:
    """Draw a picture over one legend that names more than one series; its numbers go beside it as CSV.

    The suffix of the path is the format.

    Raises
    ------
    OutputPathError
        The place cannot be written.
    """
    path, panels = Path(path), picture.panels
    write_text(path.with_suffix(".csv"), picture.table().csv())
    across = max(1, min(picture.columns, len(panels)))
    down = math.ceil(len(panels) / across)
    labels = {series.label for panel in panels for series in panel.series}
    beside = max(1, LETTERS // (max(map(len, labels), default=0) + SAMPLE))
    height = max(map(_height, panels), default=1.0) * down
    with figure(path, height + 0.18 * math.ceil(len(labels) / beside) + 0.1) as drawn:
        grid = list(drawn.subplots(down, across, squeeze=False).flat)
        for at, (axes, panel) in enumerate(zip(grid, panels, strict=False)):
            _panel(axes, panel)
            if at % across and panel.rows == panels[at - 1].rows:
                axes.tick_params(axis="y", labelleft=not panel.rows)
        for axes in grid[len(panels) :]:
            axes.set_visible(False)
        # draw one legend under all panels with ``beside`` columns, none for a single series or named bars
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
    return path


def _height(panel: Panel) -> float:
    """Return the height of a panel, inches."""
    if panel.rows:
        return 0.95 + 0.27 * len(panel.rows)
    areas = any(series.drawn == "area" for series in panel.series)
    return 4.8 if panel.shaded else 3.8 if panel.names or areas else 3.2


def _panel(axes: Axes, panel: Panel) -> None:
    title = formula(panel.title).replace(" in ", "\nin ") if panel.rows else formula(panel.title)
    axes.set(title=title, xlabel=formula(panel.x), ylabel=formula(panel.y))
    if shaded := panel.shaded:
        colours: dict[str, Any] = {"cmap": "RdBu_r", "rasterized": True, "shading": "nearest"}
        colours |= {"vmin": -shaded.limit, "vmax": shaded.limit}
        drawn = axes.pcolormesh(shaded.x, shaded.y, shaded.values, **colours)
        bar = axes.figure.colorbar(drawn, ax=axes, extend="both", pad=0.02)
        bar.set_label(formula(shaded.label), color=QUIET)
    below = np.zeros(max(1, len(panel.rows)))
    for at, series in enumerate(panel.series):
        below = _series(axes, series, colour_of(series.colour, at), below, panel.horizontal)
    for level in panel.levels:
        axes.axhline(level.at, color=QUIET, linewidth=0.8, linestyle=(0, (2, 2)))
        look: dict[str, Any] = {"ha": "right", "va": "bottom", "fontsize": 7.5, "color": INK, "zorder": 5}
        look |= {"bbox": {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.0}}
        axes.text(0.99, level.at, formula(level.label), transform=axes.get_yaxis_transform(), **look)
    if panel.names:
        axes.set_xticks(range(len(panel.names)), panel.names, rotation=35, ha="right", rotation_mode="anchor")
    if panel.rows:
        axes.set_yticks(range(len(panel.rows)), map(formula, panel.rows))
        axes.set_ylim(len(panel.rows) - 0.5, -0.5)
        axes.tick_params(axis="y", length=0)
        axes.locator_params(axis="x", nbins=4, steps=[1, 2, 5, 10])
        axes.xaxis.set_major_formatter("{x:g}")
        axes.margins(x=0.22 if any(series.texts for series in panel.series) else 0.05)
    if panel.logarithmic:
        _logarithmic(axes)
    if panel.equal:
        axes.set_aspect("equal", adjustable="datalim")
    if panel.x_range:
        axes.set_xlim(panel.x_range)
    if panel.y_range:
        axes.set_ylim(panel.y_range)
    _marks(axes, panel)
    for part in panel.intervals:
        axes.axvspan(part.start, part.end, color="#eef2f6", zorder=0)
        look = {"ha": "center", "va": "bottom", "fontsize": 7.5, "color": QUIET}
        at_top = axes.get_xaxis_transform()
        axes.text((part.start + part.end) / 2, 1.005, part.label, transform=at_top, **look)
    axes.grid(axis="x" if panel.rows else "both")


def _series(axes: Axes, series: Series, colour: str, below: np.ndarray, horizontal: bool) -> np.ndarray:
    """Draw a series over what is stacked so far; return what the next area or bar stands on."""
    label = formula(series.label)
    if series.drawn == "area":
        above: np.ndarray = below + np.asarray(series.y, float)
        axes.fill_between(series.x, below, above, color=colour, linewidth=0, label=label)
        return above
    if series.drawn == "bars":
        widths, at = np.asarray(series.x, float), np.asarray(series.y, int)
        edge: dict[str, Any] = {"edgecolor": "white", "linewidth": 0.4}
        bars = axes.barh(at, widths, left=below[at], height=0.7, color=colour, label=label, **edge)
        if series.texts:
            axes.bar_label(bars, list(map(formula, series.texts)), padding=4, fontsize=8.5)
        below[at] += np.nan_to_num(widths)
        return below
    look = LOOKS[series.drawn]["still"]
    if series.band is None:
        axes.plot(series.x, series.y, color=colour, label=label, **look)
    else:
        bands: dict[str, Any] = {"xerr" if horizontal else "yerr": error_bars(series, horizontal)}
        axes.errorbar(series.x, series.y, **bands, color=colour, label=label, **ERROR | look)
    return below


def _logarithmic(axes: Axes) -> None:
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    axes.set(xscale="log", yscale="log")
    low, high = axes.get_ylim()
    if high < 10 * low:  # less than a decade: ticks at even round steps
        axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    elif high < 100 * low:  # less than two
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def _marks(axes: Axes, panel: Panel) -> None:
    """Draw the marks, their words under the curves."""
    for mark in panel.marks:
        axes.axvline(mark.at, color=QUIET, linewidth=0.7, linestyle=(0, (1, 2)))
    look: dict[str, Any] = {"rotation": 90, "va": "top", "fontsize": 7.0, "color": QUIET, "zorder": 1.5}
    for mark, side in label_sides(panel.marks, *axes.get_xlim()):
        axes.text(mark.at, 0.99, formula(mark.label), transform=axes.get_xaxis_transform(), ha=side, **look)
