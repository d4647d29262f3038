"""Contact force over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.figures.style import PALETTE, QUIET, Shape, figure
from fem_impact.outcome import ContactInterval
from fem_impact.output import Table, write_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["force_figure"]

COLUMNS = ("time_s", "force_n_N", "force_t_N")


def force_figure(
    history: Table, contacts: Sequence[ContactInterval], path: str | Path, shape: Shape = "wide"
) -> Path:
    """Draw normal and tangential contact force on the whole rod, contact intervals shaded.

    Parameters
    ----------
    history : Table
        history.csv, forces in N.
    contacts : sequence of ContactInterval
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"

    Raises
    ------
    ResultError
        A column is missing or holds no numbers.
    """
    path = Path(path)
    time, normal, tangential = (history.numbers(name) for name in COLUMNS)
    write_table(path.with_suffix(".csv"), COLUMNS, zip(time, normal, tangential, strict=True))
    with figure(path, shape, 3.6 if shape == "wide" else 4.0) as drawn:
        axes = drawn.add_subplot()
        axes.plot(time * 1e6, normal / 1e3, color=PALETTE["blue"], label="normal (out of the barrier)")
        _dashed(axes, time * 1e6, tangential / 1e3)
        _shade(axes, contacts)
        axes.set(xlabel="time, µs", ylabel="contact force on the rod, kN")
        axes.grid(axis="y")
        axes.axhline(0.0, color=QUIET, linewidth=0.7)
        drawn.legend(loc="outside lower center", ncols=2 if shape == "wide" else 1)
    return path


def _dashed(axes: Axes, time: np.ndarray, force: np.ndarray) -> None:
    dashes = (0, (5, 1.5))
    axes.plot(time, force, color=PALETTE["vermilion"], linestyle=dashes, label="tangential (up the slope)")


def _shade(axes: Axes, contacts: Sequence[ContactInterval]) -> None:
    for contact in contacts:
        start, end = contact.start * 1e6, contact.end * 1e6
        axes.axvspan(start, end, color="#eef2f6", zorder=0)
        axes.text(
            (start + end) / 2,
            1.005,
            f"{contact.impulse_n:.3g} N s",
            transform=axes.get_xaxis_transform(),
            ha="center",
            va="bottom",
            fontsize=7.5,
            color=QUIET,
        )
