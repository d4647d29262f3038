"""The work-precision plot: error against CPU time, one panel a quantity, with the Pareto front."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cost.judge import Judged, front
from fem_impact.figures.style import PALETTE, QUIET, figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["work_precision"]

LOOKS = {
    "rigid": ("rigid", "s", "purple"),
    "modal": ("modal", "D", "orange"),
    "mesh": ("one mesh", "o", "blue"),
    "pair": ("two meshes, extrapolated", "^", "green"),
    "numerics": ("other elements or step", "x", "vermilion"),
}
"""Words, marker and colour of each kind of setting."""


def work_precision(settings: Sequence[Judged], names: Sequence[str], path: Path) -> None:
    """Draw relative error against CPU time, both logarithmic, of some quantities."""
    rows = (len(names) + 1) // 2
    with figure(path, "wide", 0.6 + 2.7 * rows) as drawn:
        panels = drawn.subplots(rows, min(2, len(names)), squeeze=False, sharex=True).ravel()
        for panel, name in zip(panels, names, strict=False):
            _panel(panel, [one for one in settings if one.error[name] and one.kind in LOOKS], name)
        for panel in panels[len(names) :]:
            panel.set_visible(False)
        drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(LOOKS) + 1)


def _panel(axes: Axes, settings: Sequence[Judged], name: str) -> None:
    best = front(settings, [name])
    axes.plot(*_points(best, name), color=QUIET, label="no other beats it")
    for kind, (words, marker, colour) in LOOKS.items():
        of = [one for one in settings if one.kind == kind]
        axes.plot(*_points(of, name), marker, color=PALETTE[colour], label=words, markersize=5)
    axes.set(title=name, xscale="log", yscale="log", xlabel="CPU time, s", ylabel="error, %")
    axes.tick_params(labelbottom=True)  # though panels share their x axis: one may have none below it
    _plain(axes)
    axes.grid(alpha=0.5)


def _plain(axes: Axes) -> None:
    """Write plain numbers at the ticks, and within one decade at round steps instead of powers of ten."""
    from matplotlib.ticker import MaxNLocator, NullFormatter

    low, high = axes.get_ylim()
    if high < 10 * low:
        axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def _points(settings: Sequence[Judged], name: str) -> tuple[list[float], list[float]]:
    return [one.cpu_s for one in settings], [100 * (one.error[name] or 0.0) for one in settings]
