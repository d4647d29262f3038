"""The still picture around the views, title, colour bars and force curve, and the moving marker."""

from __future__ import annotations

import functools
import io
from collections.abc import Callable
from dataclasses import dataclass
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import INK, PALETTE, QUIET
from fem_impact.films.layout import Frame, FrameLayout, Rectangle
from fem_impact.films.motion import FIELDS, FilmData
from fem_impact.films.profile import Profile
from fem_impact.films.views import CLOSE_WIDTH

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL.Image import Image


CLOCK, LETTER = 220, 11
"""Widths of clock and margins, and of a letter of the title, px."""

CLOSE_UP = "section at the contact (n up, t right), true scale, {:.1f} mm wide"
ALONG = "strain along the axis"

Curve = tuple[np.ndarray, np.ndarray]
"""Times in s and normal contact forces in N."""

Limits = tuple[float, float, float]
"""The first and last time in s and the largest force in N that are drawn."""


@dataclass(frozen=True, slots=True)
class FilmBackground:
    """The parts that are equal in all frames.

    Parameters
    ----------
    layout : FrameLayout
    base : Image
        The still picture that the views are pasted into.
    strip : Strip
    profile : Profile, optional
        The strain along the axis, in the place of the close-up.
    """

    layout: FrameLayout
    base: Image
    strip: Strip
    profile: Profile | None

    @classmethod
    def make(
        cls, layout: FrameLayout, motion: FilmData, title: str, curve: Curve, times: np.ndarray
    ) -> FilmBackground:
        """Draw the still parts once."""
        drawn, waves = blank(layout), motion.movement.waves if motion.field == "strain" else None
        heading(drawn, layout, title)
        fade = ", fading to × 1 at the contact" if motion.peak > 1.0 else ""
        _caption(drawn, layout, layout.rod, f"whole rod, deformation × {motion.peak:g}{fade}")
        _caption(
            drawn,
            layout,
            layout.close,
            CLOSE_UP.format(CLOSE_WIDTH * motion.span * 1e3) if waves is None else ALONG,
        )
        colour_bar(drawn, layout, layout.rod, motion.field, motion.far)
        if waves is None:
            colour_bar(drawn, layout, layout.close, motion.field, motion.near)
        profile = None if waves is None else Profile.draw(drawn, layout, layout.beside, waves, times)
        strip = Strip.draw(drawn, layout, layout.strip, curve, limits_of([curve], times))
        return cls(layout, picture(drawn), strip, profile)

    def compose(
        self,
        rod: np.ndarray,
        close: np.ndarray | None,
        time: float,
        overlay: Callable[[Any], None],
        slow: float,
    ) -> np.ndarray:
        """Return one frame ``(height, width, 3) uint8`` from the views at ``time`` in s.

        ``overlay`` draws over the rod with a pen; a second of the film shows ``slow`` s of motion.
        """
        from PIL import Image, ImageDraw

        frame = self.base.copy()
        frame.paste(Image.fromarray(rod), self.layout.rod.corner)
        if close is not None:
            frame.paste(Image.fromarray(close), self.layout.close.corner)
        pen = ImageDraw.Draw(frame)
        clock(pen, self.layout, time)
        if slow:
            write(pen, (self.layout.width - 24, 42), f"1 s of the film shows {slow * 1e6:.3g} µs", 12)
        self.strip.mark(pen, time)
        if self.profile is not None:
            self.profile.mark(pen, time)
        overlay(pen)
        return np.asarray(frame)


def blank(frame: Frame) -> Figure:
    """Return an empty figure of the size of a frame."""
    from matplotlib.figure import Figure

    return Figure(figsize=(frame.width / 100, frame.height / 100), dpi=100, facecolor="white")


def heading(drawn: Figure, frame: Frame, title: str) -> None:
    """Write the title of the film, shortened to fit beside the clock."""
    place = (24 / frame.width, 1 - 27 / frame.height)
    shown = shorten(title, (frame.width - CLOCK) // LETTER, placeholder=" …")
    drawn.text(*place, shown, fontsize=14, weight="bold", color=INK, va="center", parse_math=False)


def _caption(drawn: Figure, layout: FrameLayout, view: Rectangle, text: str) -> None:
    place = (view.left / layout.width, 1 - (view.top - 10) / layout.height)
    drawn.text(*place, text, fontsize=9.5, color=QUIET, va="center")


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


def below(drawn: Figure, frame: Frame, view: Rectangle, text: str, colour: str) -> None:
    """Write up to two lines under the left corner of a view."""
    place = (view.left / frame.width, 1 - (view.top + view.height + 6) / frame.height)
    drawn.text(*place, text, fontsize=9, color=colour, va="top")


def picture(drawn: Figure) -> Image:
    """Return a figure as an image."""
    from PIL import Image

    stream = io.BytesIO()
    drawn.savefig(stream, format="png", dpi=100)
    return Image.open(stream).convert("RGB")


def write(pen: Any, place: tuple[int, int], text: str, size: int = 22) -> None:
    """Write a text into a frame; ``place`` is its upper right corner, px."""
    pen.text(place, text, font=font(size), fill=INK, anchor="ra")


@functools.cache
def font(size: int) -> Any:
    """Return the font of the words that change from frame to frame; ``size`` in px."""
    from matplotlib.font_manager import findfont
    from PIL import ImageFont

    return ImageFont.truetype(findfont("DejaVu Sans"), size)


def clock(pen: Any, frame: Frame, time: float) -> None:
    """Write the time, s, into the upper right corner."""
    write(pen, (frame.width - 24, 15), f"t = {time * 1e6:.1f} µs")


@dataclass(frozen=True, slots=True)
class Strip:
    """A drawn force curve.

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
    """Return limits that contain several curves over the times of a film."""
    first, last = float(times[0]), float(max(times[-1], times[0] + 1e-9))
    return first, last, max(1.0, *(float(force.max(initial=0.0)) for _, force in curves))


def _track(axes: Axes, height: int, limits: Limits) -> tuple[float, float, float, float]:
    first, last, largest = limits
    corners = axes.transData.transform([(first * 1e6, 0.0), (last * 1e6, largest / 1e3)])
    (left, zero), (right, top) = corners
    return float(left), float(right), height - float(zero), height - float(top)
