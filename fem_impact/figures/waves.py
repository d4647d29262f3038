"""Position along the axis against time: stretch and bending apart, with the lines of the wave speeds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fem_impact.figures.style import INK, QUIET, Shape, figure, write_data
from fem_impact.files.waves import Waves

if TYPE_CHECKING:
    from matplotlib.axes import Axes


COLUMNS = ("time_s", "position_m", "stretch", "bending")
ROWS = 240
"""Times that are drawn and written beside the figure; waves.h5 has all."""

AFTER = 4
"""Lengths of the rod that a stretching wave runs in the part after the run."""

QUIETEST = 0.01
"""Least range of a panel's colours, share of that of the other: less is numerical noise."""


NAMES = ("stretch: mean strain of each section", "bending: strain of the side facing the barrier")


class _Front(NamedTuple):
    """A wave front: its speed, m/s, its words, and along how many lengths of the rod its line is drawn."""

    speed: float
    words: str
    passes: int


def waves_figure(waves: Waves, path: str | Path, shape: Shape = "wide") -> Path:
    """Draw stretch and bending strain along the axis over time, and where fronts from the contact would be.

    The time axis ends four lengths of the rod, run by a stretching wave, after the run.

    Parameters
    ----------
    waves : Waves
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    until = waves.end + (AFTER * waves.transit if waves.ringing else 0.0)
    path, times = Path(path), np.linspace(0.0, until, ROWS)
    fronts = (
        _Front(waves.speed, "bar wave √(E/ρ)", 4),
        _Front(waves.bending_speed, "fastest bending waves", 2),
    )
    parts = waves.strain(times)
    write_data(path, COLUMNS, _rows(times, waves.position, *parts))
    tops = [1e6 * float(np.percentile(np.abs(part), 99.8)) for part in parts]
    with figure(path, shape, 4.8 if shape == "wide" else 8.0) as drawn:
        across = (1, 2) if shape == "wide" else (2, 1)
        panels = list(drawn.subplots(*across, squeeze=False, sharex=True, sharey=True).flat)
        for axes, part, words, top, wave in zip(panels, parts, NAMES, tops, fronts, strict=True):
            _panel(axes, waves, times, part, max(top, QUIETEST * max(tops), 1e-9))
            axes.set_title(f"{words}\ndashed: {wave.words}, {wave.speed:.0f} m/s", loc="left", fontsize=9.0)
            turns = np.arange(wave.passes + 1)
            front = {"color": INK, "lw": 1.0, "ls": (0, (4, 2))}
            axes.plot(1e3 * waves.length * (turns % 2), 1e6 * waves.length / wave.speed * turns, **front)
            axes.set_ylim(0.0, 1e6 * until)
            _end(axes, waves, until)
        for axes in panels[:: across[1]]:
            axes.set_ylabel("time, µs")
    return path


def _rows(
    times: np.ndarray, position: np.ndarray, stretch: np.ndarray, bending: np.ndarray
) -> list[list[float]]:
    time, place = np.meshgrid(times, position, indexing="ij")
    columns = (time, place, stretch, bending)
    return [[float(f"{x:.6g}") for x in row] for row in zip(*(c.ravel() for c in columns), strict=True)]


def _panel(axes: Axes, waves: Waves, times: np.ndarray, strain: np.ndarray, limit: float) -> None:
    look: dict[str, Any] = {"cmap": "RdBu_r", "rasterized": True, "shading": "nearest"}
    at = (1e3 * waves.position, 1e6 * times)
    drawn = axes.pcolormesh(*at, 1e6 * strain, vmin=-limit, vmax=limit, **look)
    axes.set(xlabel="position along the axis from the tip, mm", xlim=(0.0, 1e3 * waves.length))
    bar = axes.figure.colorbar(drawn, ax=axes, extend="both", pad=0.02)
    bar.set_label("axial strain, µm/m (red: tension)", color=QUIET)


def _end(axes: Axes, waves: Waves, until: float) -> None:
    """Mark where the flight by modes begins."""
    if waves.ringing is None or waves.ringing.start >= until:
        return
    at = 1e6 * waves.ringing.start
    axes.axhline(at, color=QUIET, lw=0.8)
    look: dict[str, Any] = {"va": "bottom", "fontsize": 7.5, "color": INK}
    axes.text(0.01, at, "free ringing, by modes", transform=axes.get_yaxis_transform(), **look)
