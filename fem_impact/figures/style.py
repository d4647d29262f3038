"""Style of all figures: size, a palette safe for colour-blind readers, the sides of labels, and saving."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from fem_impact.figures.panels import Mark
from fem_impact.files.atomic import atomic_path, write_text
from fem_impact.tables.table import Cell, Table
from fem_impact.tables.text import plain, with_band

if TYPE_CHECKING:
    from matplotlib.figure import Figure


INK, QUIET = "#1f2328", "#6b7280"
PALETTE = {
    "blue": "#0072B2",
    "sky": "#56B4E9",
    "orange": "#E69F00",
    "vermilion": "#D55E00",
    "green": "#009E73",
    "purple": "#CC79A7",
    "yellow": "#F0E442",
    "grey": "#999999",
    "sand": "#F3CF8E",
    "night": "#1B3A57",
    "brown": "#7A4B1E",
    "olive": "#A3A847",
    "ink": INK,
}
"""Colours of Okabe and Ito, five more of other lightness, and that of texts."""

COLOURS = ("blue", "vermilion", "green", "purple", "orange", "sky", "night", "grey", "brown")
"""Colours of series in order."""

WIDTH = 8.4  # inches
NEAR = 0.05
"""Least distance, share of the axis, of two marks whose labels stand on the same side."""

_STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.axisbelow": True,
    "grid.color": "#e2e5e9",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "text.color": INK,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "svg.hashsalt": "fem-impact",
}


@contextmanager
def figure(path: Path, height: float, width: float = WIDTH) -> Iterator[Figure]:
    """Yield an empty figure in the style of the project; it is saved to ``path`` at the end.

    Raises
    ------
    OutputPathError
        The place cannot be written.
    """
    import matplotlib

    with matplotlib.rc_context(_STYLE):
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
    with atomic_path(path) as draft:
        drawn.savefig(draft, format=path.suffix.lstrip("."), dpi=150, metadata=dated)


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


def percent(fraction: float, band: float | None = None) -> str:
    """Return a fraction of E_0 as text in per cent, with two digits or more; with its band as `with_band`.

    Examples
    --------
    >>> percent(0.626), percent(0.00219), percent(0.0412, 0.00027), percent(0.024, 0.39)
    ('62.6 %', '0.22 %', '4.120 ± 0.027 %', '2 (0 to 42) %')
    """
    value = 100.0 * fraction
    if band:
        return f"{with_band(value, 100.0 * band, 0.0, 100.0)} %".replace("+-", "±")
    if abs(value) >= 0.95:
        return f"{value:.1f} %"
    return f"{plain(value, 2)} %" if value else "0 %"
