"""Where E_0 went in every run of a study: one stacked bar a run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.figures.style import PALETTE, Shape, figure
from fem_impact.outcome import Outcome, or_none, shares
from fem_impact.output import write_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["study_partition_figure"]


def study_partition_figure(rows: Sequence[Outcome], path: str | Path, shape: Shape = "wide") -> Path:
    """Draw one stacked bar a run, shares that are not known left white.

    Parameters
    ----------
    rows : sequence of Outcome
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    path = Path(path)
    listed = shares("figure")
    data = [[row.provenance.scene_id, *(or_none(share.of(row.energy)) for share in listed)] for row in rows]
    write_table(path.with_suffix(".csv"), ("scene_id", *(share.key.name for share in listed)), data)
    with figure(path, shape, 1.6 + 0.3 * len(rows) + (0.0 if shape == "wide" else 0.6)) as drawn:
        axes = drawn.add_subplot()
        _stack(axes, rows)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.set(xlabel="share of E₀ after the last separation, %", xlim=(0.0, 103.0))
        axes.grid(axis="x")
        drawn.legend(loc="outside lower center", ncols=5 if shape == "wide" else 2)
    return path


def _stack(axes: Axes, rows: Sequence[Outcome]) -> None:
    names, left = [row.provenance.scene_id for row in rows], np.zeros(len(rows))
    for share in shares("figure"):
        widths = np.array([100.0 * (or_none(share.of(row.energy)) or 0.0) for row in rows])
        colour = PALETTE[share.colour]
        bars = axes.barh(names, widths, left=left, color=colour, label=share.label, height=0.72)
        for bar in bars:
            bar.set(edgecolor="white", linewidth=0.4)
        left += widths
