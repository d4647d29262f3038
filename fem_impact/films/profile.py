"""The strain along the axis at one time, as two curves: stretch and bending."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import PALETTE, QUIET
from fem_impact.files.waves import Waves
from fem_impact.films.layout import Frame, Rectangle

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVES = (("stretch: mean of the section", "blue"), ("bending: side facing the barrier", "vermilion"))


@dataclass(frozen=True, slots=True)
class Profile:
    """Axes drawn once into the still picture, and the curves of each frame.

    Parameters
    ----------
    waves : Waves
    corner : tuple of float
        Pixel of position 0 and strain 0.
    slope : tuple of float
        px per m, and px per unit of strain, downwards.
    """

    waves: Waves
    corner: tuple[float, float]
    slope: tuple[float, float]

    @classmethod
    def draw(cls, drawn: Figure, frame: Frame, place: Rectangle, waves: Waves, times: np.ndarray) -> Profile:
        """Draw the axes into a figure that is as large as the frame, high enough for all times."""
        limit = 1.1e6 * max(float(np.abs(part).max()) for part in waves.strain(times))
        axes = drawn.add_axes(
            frame.share(place.left + 54, place.top + 6, place.width - 66, place.height - 48)
        )
        axes.set(xlim=(0.0, 1e3 * waves.length), ylim=(-limit, limit))
        axes.set_xlabel("position along the axis from the tip, mm", fontsize=9, labelpad=1)
        axes.set_ylabel("axial strain, µm/m", fontsize=9, labelpad=1)
        axes.tick_params(labelsize=8, color=QUIET)
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(color="#e2e5e9", linewidth=0.7)
        axes.axhline(0.0, color=QUIET, linewidth=0.7)
        for at, (words, colour) in enumerate(CURVES):
            axes.text(
                0.02,
                0.98 - 0.06 * at,
                words,
                color=PALETTE[colour],
                transform=axes.transAxes,
                va="top",
                fontsize=9,
            )
        (left, zero), (right, top) = axes.transData.transform([(0.0, 0.0), (1e3 * waves.length, limit)])
        slope = (float(right - left) / waves.length, float(top - zero) / limit * 1e6)
        return cls(waves, (float(left), frame.height - float(zero)), slope)

    def mark(self, pen: Any, time: float) -> None:
        """Draw the curves at a time, s."""
        left, zero = self.corner
        x = left + self.slope[0] * self.waves.position
        for rows, (_, colour) in zip(self.waves.strain(np.array([time])), CURVES, strict=True):
            y = zero - self.slope[1] * rows[0]
            pen.line(
                list(zip(x.tolist(), y.tolist(), strict=True)), fill=PALETTE[colour], width=3, joint="curve"
            )
