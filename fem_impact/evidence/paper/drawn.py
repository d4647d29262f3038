"""A figure of the paper: picture, data, one sentence, and checked statements."""

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from fem_impact.figures.still import INK, figure


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement of the paper, in our words, what was found in the data, and whether the two agree."""

    claim: str
    found: str
    holds: bool


@dataclass(frozen=True, slots=True)
class Drawn:
    """One drawn figure: its number in the paper, PNG, what it shows, and the paper's statements about it.

    The data lie beside the picture as CSV.
    """

    number: int
    picture: Path
    sentence: str
    statements: tuple[Statement, ...]

    @property
    def data(self) -> Path:
        """The CSV file of the figure's numbers."""
        return self.picture.with_suffix(".csv")


@contextmanager
def canvas(path: Path, height: float, sentence: str) -> Iterator[Figure]:
    """Yield a wide figure with the sentence above it; it is saved at the end."""
    with figure(path, height) as drawn:
        drawn.suptitle(textwrap.fill(sentence, 118), x=0.012, ha="left", fontsize=9.0, color=INK)
        yield drawn
