"""Where E_0 went in every run of a study: one stacked bar a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.accounts import FINAL
from fem_impact.figures.style import Shape, figure
from fem_impact.output import write_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["study_partition_figure"]


def study_partition_figure(
    rows: Sequence[Mapping[str, Any]], path: str | Path, shape: Shape = "wide"
) -> Path:
    """Draw one stacked bar a run, null shares left white.

    Parameters
    ----------
    rows : sequence of mappings
        Outcomes or rows of study.json.
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    path = Path(path)
    columns = ("scene_id", *(account.key for account in FINAL))
    write_table(path.with_suffix(".csv"), columns, [[row[name] for name in columns] for row in rows])
    with figure(path, shape, 1.6 + 0.3 * len(rows) + (0.0 if shape == "wide" else 0.6)) as drawn:
        axes = drawn.add_subplot()
        _stack(axes, rows)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.set(xlabel="share of E₀ after the last separation, %", xlim=(0.0, 103.0))
        axes.grid(axis="x")
        drawn.legend(loc="outside lower center", ncols=5 if shape == "wide" else 2)
    return path


def _stack(axes: Axes, rows: Sequence[Mapping[str, Any]]) -> None:
    names, left = [row["scene_id"] for row in rows], np.zeros(len(rows))
    for account in FINAL:
        widths = np.array([100.0 * (row[account.key] or 0.0) for row in rows])
        bars = axes.barh(names, widths, left=left, color=account.colour, label=account.label, height=0.72)
        for bar in bars:
            bar.set(edgecolor="white", linewidth=0.4)
        left += widths
