"""Style of all figures: sizes, a palette safe for colour-blind readers, and saving."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from fem_impact.errors import MissingLibraryError
from fem_impact.files.atomic import atomic_path, write_text
from fem_impact.tables.table import Cell, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


Shape = Literal["wide", "narrow"]
"""Wide for paper and desktop, narrow for a phone."""

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
}
"""Colours of Okabe and Ito, and five more of other lightness."""

INK, QUIET = "#1f2328", "#6b7280"
WIDTH = {"wide": 8.4, "narrow": 4.3}

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
def figure(path: Path, shape: Shape, height: float, formulas: bool = False) -> Iterator[Figure]:
    """Yield an empty figure in the style of the project; it is saved to ``path`` at the end.

    Texts between dollar signs are set as formulas only with ``formulas``, since titles and names of the
    user may hold that sign.

    Raises
    ------
    MissingLibraryError
        matplotlib is not installed.
    OutputPathError
        The place cannot be written.
    """
    try:
        import matplotlib
    except ImportError as error:
        raise MissingLibraryError("Figures need matplotlib: pip install matplotlib.") from error
    with matplotlib.rc_context(_STYLE | {"text.parse_math": formulas}):
        drawn = new_figure(shape, height)
        yield drawn
        save(drawn, path)


def new_figure(shape: Shape, height: float) -> Figure:
    """Return an empty figure, ``height`` in inches, that is not registered with pyplot."""
    from matplotlib.figure import Figure

    return Figure(figsize=(WIDTH[shape], height), layout="constrained")


def save(drawn: Figure, path: Path) -> None:
    """Write the figure atomically in the format of the suffix; equal data give equal bytes."""
    dated: dict[str, Any] = {"Date": None} if path.suffix in (".svg", ".pdf") else {}
    with atomic_path(path) as draft:
        drawn.savefig(draft, format=path.suffix.lstrip("."), dpi=150, metadata=dated)


def write_data(picture: Path, columns: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
    """Write the numbers of a figure as CSV beside it, units in the names. Raises OutputPathError."""
    write_text(picture.with_suffix(".csv"), Table.of(columns, rows).csv())


def percent(fraction: float, band: float | None = None) -> str:
    """Return a fraction of E_0 as text in per cent, with two digits or more; with its band, as many places.

    Examples
    --------
    >>> percent(0.626), percent(0.00219), percent(0.0412, 0.00027)
    ('62.6 %', '0.22 %', '4.12 ± 0.03 %')
    """
    value = 100.0 * fraction
    if band:
        places = max(1, -math.floor(math.log10(100.0 * band)))
        return f"{value:.{places}f} ± {100.0 * band:.{places}f} %"
    if abs(value) >= 0.95:
        return f"{value:.1f} %"
    return f"{value:.2g} %" if value else "0 %"
