"""The force curve under a view, and the marker that moves on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import PALETTE, QUIET
from fem_impact.render.layout import Frame, Rectangle

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Curve", "Limits", "Strip", "limits_of"]

Curve = tuple[np.ndarray, np.ndarray]
"""Times in s and normal contact forces in N."""

Limits = tuple[float, float, float]
"""The first and last time in s and the largest force in N that are drawn."""


@dataclass(frozen=True, slots=True)
class Strip:
    """A curve as it was drawn.

    Parameters
    ----------
    curve : Curve
    limits : Limits
    track : tuple of float
        Pixel positions: x of the first and last time, y of zero and of the largest force.
    """

    curve: Curve
    limits: Limits
    track: tuple[float, float, float, float]

    @classmethod
    def draw(cls, drawn: Figure, frame: Frame, place: Rectangle, curve: Curve, limits: Limits) -> Strip:
        """Draw the curve into a figure that is as large as the frame."""
        axes = drawn.add_axes(frame.share(place.left, place.top, place.width, place.height))
        first, last, largest = limits
        axes.plot(curve[0] * 1e6, curve[1] / 1e3, color=PALETTE["blue"], linewidth=1.6)
        axes.fill_between(curve[0] * 1e6, curve[1] / 1e3, color=PALETTE["blue"], alpha=0.12, linewidth=0)
        axes.set(xlim=(first * 1e6, last * 1e6), ylim=(0.0, 1.08 * largest / 1e3))
        axes.set_xlabel("time, µs", fontsize=9, labelpad=1)
        axes.set_ylabel("normal force, kN", fontsize=9)
        axes.tick_params(labelsize=8, color=QUIET)
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(color="#e2e5e9", linewidth=0.7)
        return cls(curve, limits, _track(axes, frame.height, limits))

    def mark(self, pen: Any, time: float) -> None:
        """Draw the marker at a time, s; none where the curve has ended."""
        left, right, zero, top = self.track
        first, last, largest = self.limits
        x = left + (right - left) * (time - first) / (last - first)
        pen.line([(x, top), (x, zero)], fill=QUIET, width=1)
        if len(self.curve[0]) and time <= self.curve[0][-1]:
            y = zero + (top - zero) * float(np.interp(time, *self.curve)) / largest
            pen.ellipse([x - 6, y - 6, x + 6, y + 6], fill=PALETTE["vermilion"], outline="white", width=2)


def limits_of(curves: list[Curve], times: np.ndarray) -> Limits:
    """Return limits that hold several curves over the times of a film."""
    first, last = float(times[0]), float(max(times[-1], times[0] + 1e-9))
    return first, last, max(1.0, *(float(force.max(initial=0.0)) for _, force in curves))


def _track(axes: Axes, height: int, limits: Limits) -> tuple[float, float, float, float]:
    first, last, largest = limits
    corners = axes.transData.transform([(first * 1e6, 0.0), (last * 1e6, largest / 1e3)])
    (left, zero), (right, top) = corners
    return float(left), float(right), height - float(zero), height - float(top)
