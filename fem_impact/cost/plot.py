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
    "rigid": ("s", "purple"),
    "modal": ("D", "orange"),
    "mesh": ("o", "blue"),
    "pair": ("^", "green"),
    "numerics": ("x", "vermilion"),
}


def work_precision(settings: Sequence[Judged], names: Sequence[str], path: Path) -> None:
    """Draw relative error against CPU time, both logarithmic, of some quantities."""
    rows = (len(names) + 1) // 2
    with figure(path, "wide", 0.6 + 2.7 * rows) as drawn:
        panels = drawn.subplots(rows, min(2, len(names)), squeeze=False, sharex=True).ravel()
        for panel, name in zip(panels, names, strict=False):
            _panel(panel, [one for one in settings if one.error[name] and one.kind in LOOKS], name)
        drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(LOOKS) + 1)


def _panel(axes: Axes, settings: Sequence[Judged], name: str) -> None:
    best = front(settings, [name])
    axes.plot(*_points(best, name), color=QUIET, label="Pareto front")
    for kind, (marker, colour) in LOOKS.items():
        of = [one for one in settings if one.kind == kind]
        axes.plot(*_points(of, name), marker, color=PALETTE[colour], label=kind, markersize=5)
    axes.set(title=name, xscale="log", yscale="log", xlabel="CPU time, s", ylabel="error, %")
    axes.grid(which="both", alpha=0.5)


def _points(settings: Sequence[Judged], name: str) -> tuple[list[float], list[float]]:
    return [one.cpu_s for one in settings], [100 * (one.error[name] or 0.0) for one in settings]
