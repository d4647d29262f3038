"""The picture around the views: title, colour bars, force curve; and the marker that moves on it."""

from __future__ import annotations

import functools
import io
from dataclasses import dataclass
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import INK, QUIET
from fem_impact.render.layout import Frame, Layout, Rectangle
from fem_impact.render.motion import FIELDS, Motion
from fem_impact.render.strip import Curve, Strip, limits_of
from fem_impact.render.views import CLOSE_WIDTH

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from PIL.Image import Image

__all__ = ["Board", "below", "blank", "clock", "colour_bar", "heading", "picture", "write"]

CLOCK, LETTER = 220, 11
"""Pixels that clock and margins take of the first line, and that a letter of the title takes of it."""


@dataclass(frozen=True, slots=True)
class Board:
    """Everything that stays the same over the film.

    Parameters
    ----------
    layout : Layout
    base : Image
        The still picture that the views are pasted into.
    strip : Strip
    """

    layout: Layout
    base: Image
    strip: Strip

    @classmethod
    def make(cls, layout: Layout, motion: Motion, title: str, curve: Curve) -> Board:
        """Draw the still parts once."""
        drawn = blank(layout)
        _words(drawn, layout, motion, title)
        for view, span in ((layout.rod, motion.far), (layout.close, motion.near)):
            colour_bar(drawn, layout, view, motion.field, span)
        limits = limits_of([curve], motion.fields.times)
        strip = Strip.draw(drawn, layout, layout.strip, curve, limits)
        return cls(layout, picture(drawn), strip)

    def compose(self, rod: np.ndarray, close: np.ndarray, time: float) -> np.ndarray:
        """Return one frame ``(height, width, 3) uint8`` from the two views at ``time`` in s."""
        from PIL import Image, ImageDraw

        frame = self.base.copy()
        frame.paste(Image.fromarray(rod), self.layout.rod.corner)
        frame.paste(Image.fromarray(close), self.layout.close.corner)
        pen = ImageDraw.Draw(frame)
        clock(pen, self.layout, time)
        self.strip.mark(pen, time)
        return np.asarray(frame)


def blank(frame: Frame) -> Figure:
    """Return an empty figure of a frame's pixels."""
    from matplotlib.figure import Figure

    return Figure(figsize=(frame.width / 100, frame.height / 100), dpi=100, facecolor="white")


def heading(drawn: Figure, frame: Frame, title: str) -> None:
    """Write the title of the film, as much of it as fits beside the clock."""
    place = (24 / frame.width, 1 - 27 / frame.height)
    words = shorten(title, (frame.width - CLOCK) // LETTER, placeholder=" …")
    drawn.text(*place, words, fontsize=14, weight="bold", color=INK, va="center")


def _words(drawn: Figure, layout: Layout, motion: Motion, title: str) -> None:
    across, down = layout.width, layout.height
    heading(drawn, layout, title)
    fade = ", fading to × 1 at the contact" if motion.peak > 1.0 else ""
    whole = f"whole rod, deformation × {motion.peak:g}{fade}"
    near = (
        f"section at the contact (n up, t right), true scale, {CLOSE_WIDTH * motion.span * 1e3:.1f} mm wide"
    )
    for view, text in ((layout.rod, whole), (layout.close, near)):
        drawn.text(
            view.left / across, 1 - (view.top - 10) / down, text, fontsize=9.5, color=QUIET, va="center"
        )


def colour_bar(drawn: Figure, frame: Frame, view: Rectangle, field: str, span: tuple[float, float]) -> None:
    """Draw the colours of a field under a view."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    shown = FIELDS[field]
    axes = drawn.add_axes(frame.share(view.left + 130, view.top + view.height + 14, view.width - 200, 10))
    colours = ScalarMappable(Normalize(*span), shown.colours)
    ends = "both" if span[0] < 0 else "max"
    bar = drawn.colorbar(colours, cax=axes, orientation="horizontal", extend=ends)
    bar.ax.tick_params(labelsize=8, color=QUIET, labelcolor=INK, length=2, pad=2)
    below(drawn, frame, view, f"{shown.name},\n{shown.unit}", INK)


def below(drawn: Figure, frame: Frame, view: Rectangle, words: str, colour: str) -> None:
    """Write up to two lines under the left corner of a view, which is pasted over what rises above it."""
    place = (view.left / frame.width, 1 - (view.top + view.height + 6) / frame.height)
    drawn.text(*place, words, fontsize=9, color=colour, va="top")


def picture(drawn: Figure) -> Image:
    """Return a figure as an image."""
    from PIL import Image

    stream = io.BytesIO()
    drawn.savefig(stream, format="png", dpi=100)
    return Image.open(stream).convert("RGB")


def write(pen: Any, place: tuple[int, int], text: str, size: int = 22) -> None:
    """Write a word that changes from frame to frame; ``place`` is its upper right corner."""
    pen.text(place, text, font=_font(size), fill=INK, anchor="ra")


@functools.cache
def _font(size: int) -> Any:
    from matplotlib.font_manager import findfont
    from PIL import ImageFont

    return ImageFont.truetype(findfont("DejaVu Sans"), size)


def clock(pen: Any, frame: Frame, time: float) -> None:
    """Write the time, s, into the upper right corner."""
    write(pen, (frame.width - 24, 15), f"t = {time * 1e6:.1f} µs")
