"""A figure of the paper: picture, data, one sentence, and checked statements."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.figures.style import INK, figure
from fem_impact.files.atomic import write_text
from fem_impact.tables.table import Cell, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement of the paper, in our words, and its check against the data.

    Attributes
    ----------
    claim, found : str
        What the paper states, and what was found.
    holds : bool
        Whether the two agree.
    """

    claim: str
    found: str
    holds: bool


@dataclass(frozen=True, slots=True)
class Drawn:
    """One drawn figure.

    Attributes
    ----------
    number : int
        In the paper.
    picture, data : Path
        PNG and CSV.
    sentence : str
        What the figure shows.
    statements : tuple of Statement
        The paper's statements about it, checked.
    """

    number: int
    picture: Path
    data: Path
    sentence: str
    statements: tuple[Statement, ...]


def paths(out: Path, number: int) -> tuple[Path, Path]:
    """Return the places of picture and data."""
    return out / f"figure-{number}.png", out / f"figure-{number}.csv"


def write_data(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
    """Write the numbers of a figure beside it, units in the names."""
    write_text(path, Table.of(columns, rows).csv())


@contextmanager
def canvas(path: Path, height: float, sentence: str) -> Iterator[Figure]:
    """Yield a wide figure with the sentence above it; it is saved at the end."""
    with figure(path, "wide", height) as drawn:
        drawn.suptitle(textwrap.fill(sentence, 118), x=0.012, ha="left", fontsize=9.0, color=INK)
        yield drawn
