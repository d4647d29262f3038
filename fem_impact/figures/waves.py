"""Position along the axis against time: stretch and bending apart, with the lines of the wave speeds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_impact.figures.panels import Mark, Panel, Picture, Series, ShadedMap
from fem_impact.files.waves import Waves
from fem_impact.tables.table import Table

COLUMNS = ("time_s", "position_m", "stretch", "bending")
ROWS = 240
"""Times that are drawn and written beside the figure; waves.h5 has all."""

AFTER = 4
"""Lengths of the rod that a stretching wave runs in the part after the run."""

QUIETEST = 0.01
"""Least range of a panel's colours, share of that of the other: less is numerical noise."""

NAMES = ("stretch: mean strain of each section", "bending: strain of the side facing the barrier")
CAPTION = (
    "Position along the axis against time: the mean strain of each section, and the part by which "
    "the side facing the barrier differs from it. Dashed: where a front from the contact would be."
)


class _Front(NamedTuple):
    """A wave front: its speed, m/s, its words, and along how many lengths of the rod its line is drawn."""

    speed: float
    words: str
    passes: int


def waves_picture(waves: Waves) -> Picture:
    """Return stretch and bending strain along the axis over time, and where fronts from the contact would be.

    The time axis ends four lengths of the rod, run by a stretching wave, after the run.
    """
    until = waves.end + (AFTER * waves.transit if waves.ringing else 0.0)
    times = np.linspace(0.0, until, ROWS)
    fronts = (
        _Front(waves.speed, "bar wave √(E/ρ)", 4),
        _Front(waves.bending_speed, "fastest bending waves", 2),
    )
    parts = waves.strain(times)
    tops = [1e6 * float(np.percentile(np.abs(part), 99.8)) for part in parts]
    panels = tuple(
        _panel(waves, times, part, max(top, QUIETEST * max(tops), 1e-9), words, front)
        for part, top, words, front in zip(parts, tops, NAMES, fronts, strict=True)
    )
    return Picture("waves", CAPTION, panels, 2, _numbers(times, waves.position, *parts))


def _panel(
    waves: Waves, times: np.ndarray, strain: np.ndarray, limit: float, words: str, front: _Front
) -> Panel:
    label = "axial strain, µm/m (red: tension)"
    shaded = ShadedMap(1e3 * waves.position, 1e6 * times, 1e6 * strain, limit, label)
    turns = np.arange(front.passes + 1)
    line = Series(
        f"{front.words}, {front.speed:.0f} m/s",
        1e3 * waves.length * (turns % 2),
        1e6 * waves.length / front.speed * turns,
        "dashed",
        "ink",
    )
    flight = waves.ringing is not None and waves.ringing.start < times[-1]
    levels = (Mark(1e6 * waves.end, "free ringing, by modes"),) if flight else ()
    return Panel(
        words,
        "position along the axis from the tip, mm",
        "time, µs",
        (line,),
        levels=levels,
        shaded=shaded,
        x_range=(0.0, 1e3 * waves.length),
        y_range=(0.0, 1e6 * float(times[-1])),
    )


def _numbers(times: np.ndarray, position: np.ndarray, stretch: np.ndarray, bending: np.ndarray) -> Table:
    time, place = np.meshgrid(times, position, indexing="ij")
    columns = (time, place, stretch, bending)
    rows = zip(*(column.ravel() for column in columns), strict=True)
    return Table.of(COLUMNS, [[float(f"{x:.6g}") for x in row] for row in rows])
