"""Shares of E_0 of one run and of a study's runs, and the comparison of model and measurement."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import INK, PALETTE, QUIET, Shape, figure, percent, write_data
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import EnergyShare, shares
from fem_impact.tables.csv import COMPARISON

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


UNSEEN = 1e-5
"""Fraction of E_0 below which a bar is not drawn."""

TITLE = {"wide": 9.5, "narrow": 7.5}
"""Font size of a panel's title, points, at which the longest title fits."""


def partition_figure(outcome: Outcome, path: str | Path, shape: Shape = "wide") -> Path:
    """Draw the known shares of E_0 after the last separation, of two meshes their limits and bands.

    Parameters
    ----------
    outcome : Outcome
        Shares that are not known are left out (the record holds the reasons).
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    path = Path(path)
    listed = [share for share in shares("figure") if not isinstance(share.of(outcome.energy), Unknown)]
    values = [known(outcome.estimate(share.key)[0]) for share in listed]
    names = [share.key.name.removesuffix("_over_E_0") for share in listed]
    write_data(path, ("account", "fraction_of_E_0"), zip(names, values, strict=True))
    with figure(path, shape, 0.9 + 0.27 * max(len(listed), 1)) as drawn:
        axes = drawn.add_subplot()
        # bars below UNSEEN are 0: the number beside a negative one would cover its name
        widths = [100.0 * value if abs(value) > UNSEEN else 0.0 for value in values]
        bars = axes.barh([share.label for share in listed], widths, height=0.68)
        for bar, share in zip(bars, listed, strict=True):
            bar.set_color(PALETTE[share.colour])
        axes.bar_label(bars, [_label(share, outcome) for share in listed], padding=4, fontsize=8.5)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.margins(x=0.22)
        axes.grid(axis="x")
        axes.set_xlabel("share of E₀ after the last separation, %", color=QUIET)
    return path


def _label(share: EnergyShare, outcome: Outcome) -> str:
    energy = outcome.energy
    if share.key.path[-1] == "vibration" and or_none(energy.below_floor):
        return f"below floor ({percent(or_none(energy.vibration_floor) or 0.0)})"
    value, width = outcome.estimate(share.key)
    return percent(known(value), width)


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
    write_data(path, ("scene_id", *(share.key.name for share in listed)), data)
    names, left = [row.provenance.scene_id for row in rows], np.zeros(len(rows))
    with figure(path, shape, 1.6 + 0.3 * len(rows) + (0.0 if shape == "wide" else 0.6)) as drawn:
        axes = drawn.add_subplot()
        for share in listed:
            widths = np.array([100.0 * (or_none(share.of(row.energy)) or 0.0) for row in rows])
            look: dict[str, Any] = {"color": PALETTE[share.colour], "edgecolor": "white", "linewidth": 0.4}
            axes.barh(names, widths, left=left, label=share.label, height=0.72, **look)
            left += widths
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.set(xlabel="share of E₀ after the last separation, %", xlim=(0.0, 103.0))
        axes.grid(axis="x")
        drawn.legend(loc="outside lower center", ncols=5 if shape == "wide" else 2)
    return path


def comparison_figure(rows: Sequence[Mapping[str, Any]], path: str | Path, shape: Shape = "wide") -> Path:
    """Draw measured means with their 95 % intervals, and the model with its two-mesh band.

    Parameters
    ----------
    rows : sequence of mappings
        Rows of ``comparison`` in study.json; null values are left out of the picture.
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    path = Path(path)
    write_data(path, COMPARISON, [[row[name] for name in COMPARISON] for row in rows])
    quantities, sets = ([*dict.fromkeys(row[name] for row in rows)] for name in ("quantity", "set"))
    columns = min(4 if shape == "wide" else 2, max(len(quantities), 1))
    lines = math.ceil(max(len(quantities), 1) / columns)
    with figure(path, shape, 0.6 + lines * (0.75 + 0.24 * len(sets))) as drawn:
        panels = list(drawn.subplots(lines, columns, sharey=True, squeeze=False).flat)
        for panel, quantity in zip(panels, quantities, strict=False):
            _panel(panel, [row for row in rows if row["quantity"] == quantity], sets, TITLE[shape])
        for panel in panels[len(quantities) :]:
            panel.set_visible(False)
        _legend(drawn, panels[0], shape)
    return path


def _panel(axes: Axes, rows: Sequence[Mapping[str, Any]], sets: list[str], size: float) -> None:
    unit = rows[0]["unit"]
    title = rows[0]["quantity"].replace(" in ", "\nin ")  # long names take two lines
    axes.set_title(title + (f", {unit}" if unit not in ("", "-") else ""), fontsize=size)
    for row in rows:
        _line(axes, row, sets.index(row["set"]))
    axes.set_yticks(range(len(sets)), sets)
    axes.set_ylim(len(sets) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.locator_params(axis="x", nbins=4, steps=[1, 2, 5, 10])
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid()


def _line(axes: Axes, row: Mapping[str, Any], at: int) -> None:
    mean, low, high, model = (
        row[name] for name in ("measured_mean", "measured_low", "measured_high", "model")
    )
    if mean is not None and row["measured_sd"] is not None:
        spread = (mean - row["measured_sd"], mean + row["measured_sd"])
        axes.plot(spread, (at - 0.16,) * 2, color=PALETTE["grey"], linewidth=1.0)
    if low is not None and high is not None:
        axes.plot((low, high), (at - 0.16,) * 2, color=INK, linewidth=3.2, solid_capstyle="butt")
    if mean is not None:
        axes.plot(mean, at - 0.16, "|", color=INK, markersize=8)
    if model is not None:
        colour = PALETTE["vermilion"]
        band = row["band"] or 0.0
        axes.errorbar(model, at + 0.16, xerr=band, fmt="D", color=colour, markersize=4.2, linewidth=1.2)


def _legend(drawn: Figure, axes: Axes, shape: Shape) -> None:
    axes.plot([], [], color=INK, linewidth=3.2, label="measured mean, 95 % interval")
    axes.plot([], [], color=PALETTE["grey"], linewidth=1.0, label="± one standard deviation")
    axes.errorbar([], [], xerr=[], fmt="D", color=PALETTE["vermilion"], label="model, two-mesh band")
    columns = 3 if shape == "wide" else 1
    drawn.legend(loc="outside lower center", ncols=columns, labelcolor=QUIET)
