"""The paper's figures by number."""

from collections.abc import Callable
from pathlib import Path

from fem_impact.evidence.paper.drawn import Drawn
from fem_impact.evidence.paper.figures_4_5 import figure_4, figure_5
from fem_impact.evidence.paper.figures_6_7 import figure_6, figure_7

FIGURES: dict[int, Callable[[Path], Drawn]] = {4: figure_4, 5: figure_5, 6: figure_6, 7: figure_7}


def draw_figure(number: int, out: str | Path) -> Drawn:
    """Draw figure `number` (4 to 7) of the paper into a directory, data beside it.

    Raises
    ------
    OutputPathError
        The place cannot be written.
    """
    return FIGURES[number](Path(out))
