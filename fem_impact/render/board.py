"""The picture around the views: title, colour bars, force curve; and the marker that moves on it."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import INK, PALETTE, QUIET
from fem_impact.render.layout import Layout
from fem_impact.render.motion import FIELDS, Motion
from fem_impact.render.views import CLOSE_WIDTH, COLOUR_MAP

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL.Image import Image

__all__ = ["Board", "Curve"]

Curve = tuple[np.ndarray, np.ndarray]
"""Times in s and normal contact forces in N."""


@dataclass(frozen=True, slots=True)
class Board:
    """Everything that stays the same over the film.

    Parameters
    ----------
    layout : Layout
    base : Image
        The still picture that the views are pasted into.
    curve : Curve
    track : tuple of float
        Pixel positions: x of the first and last time, y of zero and of the largest force.
    limits : tuple of float
        The first and last time in s and the largest force in N that ``track`` belongs to.
    """

    layout: Layout
    base: Image
    curve: Curve
    track: tuple[float, float, float, float]
    limits: tuple[float, float, float]

    @classmethod
    def make(cls, layout: Layout, motion: Motion, title: str, curve: Curve) -> Board:
        """Draw the still parts once."""
        drawn = _canvas(layout)
        _words(drawn, layout, motion, title)
        _bars(drawn, layout, motion)
        axes, limits = _force(drawn, layout, curve, motion.fields.times)
        return cls(layout, _picture(drawn), curve, _track(axes, layout, limits), limits)

    def compose(self, rod: np.ndarray, close: np.ndarray, time: float) -> np.ndarray:
        """Return one frame ``(height, width, 3) uint8`` from the two views at ``time`` in s."""
        from PIL import Image, ImageDraw

        frame = self.base.copy()
        frame.paste(Image.fromarray(rod), self.layout.rod.corner)
        frame.paste(Image.fromarray(close), self.layout.close.corner)
        pen = ImageDraw.Draw(frame)
        place = (self.layout.width - 24, 15)
        pen.text(place, f"t = {time * 1e6:.1f} µs", font=_font(22), fill=INK, anchor="ra")
        self._mark(pen, time)
        return np.asarray(frame)

    def _mark(self, pen: Any, time: float) -> None:
        left, right, zero, top = self.track
        first, last, largest = self.limits
        x = left + (right - left) * (time - first) / (last - first)
        pen.line([(x, top), (x, zero)], fill=QUIET, width=1)
        if len(self.curve[0]):
            force = float(np.interp(time, *self.curve))
            y = zero + (top - zero) * force / largest
            pen.ellipse([x - 6, y - 6, x + 6, y + 6], fill=PALETTE["vermilion"], outline="white", width=2)


def _canvas(layout: Layout) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(layout.width / 100, layout.height / 100), dpi=100, facecolor="white")


def _words(drawn: Figure, layout: Layout, motion: Motion, title: str) -> None:
    across, down = layout.width, layout.height
    drawn.text(24 / across, 1 - 27 / down, title, fontsize=14, weight="bold", color=INK, va="center")
    fade = ", fading to × 1 at the contact" if motion.peak > 1.0 else ""
    whole = f"whole rod, deformation × {motion.peak:g}{fade}"
    near = (
        f"section at the contact (n up, t right), true scale, {CLOSE_WIDTH * motion.span * 1e3:.1f} mm wide"
    )
    for view, text in ((layout.rod, whole), (layout.close, near)):
        drawn.text(
            view.left / across, 1 - (view.top - 10) / down, text, fontsize=9.5, color=QUIET, va="center"
        )


def _bars(drawn: Figure, layout: Layout, motion: Motion) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    name, unit, _ = FIELDS[motion.field]
    for view, span in ((layout.rod, motion.far), (layout.close, motion.near)):
        axes = drawn.add_axes(
            layout.share(view.left + 130, view.top + view.height + 14, view.width - 200, 10)
        )
        colours = ScalarMappable(Normalize(*span), COLOUR_MAP)
        bar = drawn.colorbar(colours, cax=axes, orientation="horizontal", extend="max")
        bar.ax.tick_params(labelsize=8, color=QUIET, labelcolor=INK, length=2, pad=2)
        place = (view.left / layout.width, 1 - (view.top + view.height + 19) / layout.height)
        drawn.text(*place, f"{name},\n{unit}", fontsize=9, color=INK, va="center")


def _force(
    drawn: Figure, layout: Layout, curve: Curve, times: np.ndarray
) -> tuple[Axes, tuple[float, float, float]]:
    strip = layout.strip
    axes = drawn.add_axes(layout.share(strip.left + 50, strip.top, strip.width - 60, strip.height))
    first, last = float(times[0]), float(max(times[-1], times[0] + 1e-9))
    largest = float(max(curve[1].max(initial=0.0), 1.0))
    axes.plot(curve[0] * 1e6, curve[1] / 1e3, color=PALETTE["blue"], linewidth=1.6)
    axes.fill_between(curve[0] * 1e6, curve[1] / 1e3, color=PALETTE["blue"], alpha=0.12, linewidth=0)
    axes.set(xlim=(first * 1e6, last * 1e6), ylim=(0.0, 1.08 * largest / 1e3))
    axes.set_xlabel("time, µs", fontsize=9, labelpad=1)
    axes.set_ylabel("normal force, kN", fontsize=9)
    axes.tick_params(labelsize=8, color=QUIET)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#e2e5e9", linewidth=0.7)
    return axes, (first, last, largest)


def _track(
    axes: Axes, layout: Layout, limits: tuple[float, float, float]
) -> tuple[float, float, float, float]:
    first, last, largest = limits
    corners = axes.transData.transform([(first * 1e6, 0.0), (last * 1e6, largest / 1e3)])
    (left, zero), (right, top) = corners
    return float(left), float(right), layout.height - float(zero), layout.height - float(top)


def _picture(drawn: Figure) -> Image:
    from PIL import Image

    stream = io.BytesIO()
    drawn.savefig(stream, format="png", dpi=100)
    return Image.open(stream).convert("RGB")


def _font(size: int) -> Any:
    from matplotlib.font_manager import findfont
    from PIL import ImageFont

    return ImageFont.truetype(findfont("DejaVu Sans"), size)
