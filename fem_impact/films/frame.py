"""A frame of a film: what lies where, in pixels, and what stands around its views, still or moving."""

import functools
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont
from PIL import Image, ImageDraw, ImageFont

from fem_impact.errors import UsageError
from fem_impact.figures.still import INK, PALETTE, QUIET, replace_undrawn
from fem_impact.files.waves import Waves
from fem_impact.films.motion import FIELDS, FilmData
from fem_impact.tables.text import plain


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangle in pixels."""

    left: int
    top: int
    width: int
    height: int

    @property
    def corner(self) -> tuple[int, int]:
        """The upper left corner."""
        return (self.left, self.top)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return (self.width, self.height)


@dataclass(frozen=True, slots=True)
class Frame:
    """A picture of a film: its sides in px are multiples of 16, as video encoders want them."""

    width: int
    height: int

    def __post_init__(self) -> None:
        if self.width % 16 or self.height % 16 or self.width < 640 or self.height < 480:
            raise UsageError(
                "is no size of a film.",
                key="size=",
                value=f"{self.width}x{self.height}",
                remedy="Use multiples of 16, 640x480 at least.",
            )

    def share(self, left: int, top: int, width: int, height: int) -> tuple[float, float, float, float]:
        """Return a rectangle as matplotlib wants it: shares of the frame from the lower left corner."""
        across, down = self.width, self.height
        return (left / across, 1.0 - (top + height) / down, width / across, height / down)


@dataclass(frozen=True, slots=True)
class FrameLayout(Frame):
    """Two views side by side over a strip with the force curve."""

    @property
    def rod(self) -> Rectangle:
        """The view of the whole rod."""
        return Rectangle(24, 74, self.width // 2 - 36, self.height - 310)

    @property
    def close(self) -> Rectangle:
        """The view of the contact."""
        return Rectangle(self.width // 2 + 12, 74, self.width // 2 - 36, self.height - 310)

    @property
    def beside(self) -> Rectangle:
        """The place of curves instead of the view of the contact: its colour bar is not needed."""
        close = self.close
        return Rectangle(close.left, close.top, close.width, close.height + 36)

    @property
    def strip(self) -> Rectangle:
        """The strip of the force curve."""
        return Rectangle(74, self.height - 176, self.width - 108, 132)


@dataclass(frozen=True, slots=True)
class SideBySideLayout(Frame):
    """Views of ``count`` rods side by side, each over its own force curve."""

    count: int

    @property
    def views(self) -> tuple[Rectangle, ...]:
        """The views of the rods."""
        return tuple(Rectangle(left, 74, self._across - 16, self.height - 290) for left in self._lefts)

    @property
    def strips(self) -> tuple[Rectangle, ...]:
        """The strips of the force curves."""
        return tuple(Rectangle(left + 46, self.height - 176, self._across - 66, 118) for left in self._lefts)

    @property
    def _across(self) -> int:
        return (self.width - 32) // self.count

    @property
    def _lefts(self) -> tuple[int, ...]:
        return tuple(16 + at * self._across for at in range(self.count))


CLOSE_WIDTH = 0.45
"""Width of the close-up in diameters of the rod."""

CLOCK, LETTER = 220, 0.82
"""Width of clock and margins, px, and of a letter of a title, px for a point of its size."""

CLOSE_UP = "section at the contact (n up, t right), true scale, {:.1f} mm wide"
ALONG = "strain along the axis"

Curve = tuple[np.ndarray, np.ndarray]
"""Times in s and normal contact forces in N."""

Limits = tuple[float, float, float]
"""The first and last time in s and the largest force in N that are drawn."""


@dataclass(frozen=True, slots=True)
class FilmBackground:
    """The parts that are equal in all frames.

    Views are pasted into ``base``; a ``profile``, the strain along the axis, takes the place of the close-up.
    """

    layout: FrameLayout
    base: Image.Image
    strip: "Strip"
    profile: "StrainProfile | None"

    @classmethod
    def make(
        cls, layout: FrameLayout, motion: FilmData, title: str, made: str, curve: Curve, times: np.ndarray
    ) -> "FilmBackground":
        """Draw the still parts once."""
        drawn, waves = blank(layout), motion.movement.waves if motion.field == "strain" else None
        heading(drawn, layout, title)
        origin(drawn, layout, [made])
        fade = ", fading to × 1 at the contact" if motion.peak > 1.0 else ""
        _caption(drawn, layout, layout.rod, f"whole projectile, deformation × {motion.peak:g}{fade}")
        beside = CLOSE_UP.format(CLOSE_WIDTH * motion.span * 1e3) if waves is None else ALONG
        _caption(drawn, layout, layout.close, beside)
        colour_bar(drawn, layout, layout.rod, motion.field, motion.far)
        if waves is None:
            colour_bar(drawn, layout, layout.close, motion.field, motion.near)
        profile = None if waves is None else StrainProfile.draw(drawn, layout, layout.beside, waves, times)
        strip = Strip.draw(drawn, layout, layout.strip, curve, limits_of([curve]))
        return cls(layout, picture(drawn), strip, profile)

    def compose(
        self,
        rod: Image.Image,
        close: Image.Image | None,
        time: float,
        overlay: Callable[[Any], None],
        slow: float,
    ) -> Image.Image:
        """Return one frame from the views at ``time`` in s.

        ``overlay`` draws over the rod with a pen; a second of the film shows ``slow`` s of motion.
        """
        frame = self.base.copy()
        frame.paste(rod, self.layout.rod.corner)
        if close is not None:
            frame.paste(close, self.layout.close.corner)
        pen = ImageDraw.Draw(frame)
        clock(pen, self.layout, time)
        if slow:
            write(pen, (self.layout.width - 24, 42), f"1 s of the film shows {plain(slow * 1e6, 3)} µs", 12)
        self.strip.mark(pen, time)
        if self.profile is not None:
            self.profile.mark(pen, time)
        overlay(pen)
        return frame


def blank(frame: Frame) -> Figure:
    """Return an empty figure of the size of a frame."""
    return Figure(figsize=(frame.width / 100, frame.height / 100), dpi=100, facecolor="white")


def heading(drawn: Figure, frame: Frame, title: str) -> None:
    """Write the title of the film beside the clock."""
    place = (24 / frame.width, 1 - 27 / frame.height)
    shown, points = fitted(title, frame.width - CLOCK, 14.0, 8.5)
    drawn.text(*place, shown, fontsize=points, weight="bold", color=INK, va="center", parse_math=False)


def fitted(text: str, width: int, points: float, least: float) -> tuple[str, float]:
    """Return a text in one line of ``points`` or two of ``least`` that fit ``width`` px, and its size."""
    if len(text) <= width / (LETTER * points):
        return text, points
    return fill(text, int(width / (LETTER * least)), max_lines=2, placeholder=" …"), least


def origin(drawn: Figure, frame: Frame, made: Sequence[str]) -> None:
    """Write into the lower left corner which program made the runs, of which scenes."""
    text = "; ".join(dict.fromkeys(one for one in made if one))
    drawn.text(24 / frame.width, 9 / frame.height, text, fontsize=7, color=QUIET, va="center")


def _caption(drawn: Figure, layout: FrameLayout, view: Rectangle, text: str) -> None:
    place = (view.left / layout.width, 1 - (view.top - 10) / layout.height)
    shown, points = fitted(text, view.width, 9.5, 7.0)
    drawn.text(*place, shown, fontsize=points, color=QUIET, va="center")


def colour_bar(drawn: Figure, frame: Frame, view: Rectangle, field: str, span: tuple[float, float]) -> None:
    """Draw the colours of a field under a view."""
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


def picture(drawn: Figure) -> Image.Image:
    """Return a figure as an image."""
    stream = io.BytesIO()
    replace_undrawn(drawn)
    drawn.savefig(stream, format="png", dpi=100)
    return Image.open(stream).convert("RGB")


def write(pen: Any, place: tuple[int, int], text: str, size: int = 22) -> None:
    """Write a text into a frame; ``place`` is its upper right corner, px."""
    pen.text(place, text, font=font(size), fill=INK, anchor="ra")


@functools.cache
def font(size: int) -> Any:
    """Return the font of the words that change from frame to frame; ``size`` in px."""
    return ImageFont.truetype(findfont("DejaVu Sans"), size)


def clock(pen: Any, frame: Frame, time: float) -> None:
    """Write the time, s, into the upper right corner."""
    write(pen, (frame.width - 24, 15), f"t = {time * 1e6:.1f} µs")


def curve_axes(drawn: Figure, frame: Frame, place: Rectangle, x: str, y: str) -> Axes:
    """Return axes for curves at a place of a frame."""
    axes = drawn.add_axes(frame.share(place.left, place.top, place.width, place.height))
    axes.set_xlabel(x, fontsize=9, labelpad=1)
    axes.set_ylabel(y, fontsize=9, labelpad=1)
    axes.tick_params(labelsize=8, color=QUIET)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#e2e5e9", linewidth=0.7)
    return axes


@dataclass(frozen=True, slots=True)
class Strip:
    """A drawn force curve.

    ``track`` holds pixels: x of the first and last time, y of zero and of the largest force.
    """

    curve: Curve
    limits: Limits
    track: tuple[float, float, float, float]

    @classmethod
    def draw(cls, drawn: Figure, frame: Frame, place: Rectangle, curve: Curve, limits: Limits) -> "Strip":
        """Draw the curve into a figure that is as large as the frame."""
        axes = curve_axes(drawn, frame, place, "time, µs", "normal force, kN")
        first, last, largest = limits
        axes.plot(curve[0] * 1e6, curve[1] / 1e3, color=PALETTE["blue"], linewidth=1.6)
        axes.fill_between(curve[0] * 1e6, curve[1] / 1e3, color=PALETTE["blue"], alpha=0.12, linewidth=0)
        axes.set(xlim=(first * 1e6, last * 1e6), ylim=(0.0, 1.08 * largest / 1e3))
        corners = axes.transData.transform([(first * 1e6, 0.0), (last * 1e6, largest / 1e3)])
        (left, zero), (right, top) = corners
        track = (float(left), float(right), frame.height - float(zero), frame.height - float(top))
        return cls(curve, limits, track)

    def mark(self, pen: Any, time: float) -> None:
        """Draw the marker at a time, s; none beyond the axis, no dot where the curve has ended."""
        left, right, zero, top = self.track
        first, last, largest = self.limits
        if time > last:
            return
        x = left + (right - left) * (time - first) / (last - first)
        pen.line([(x, top), (x, zero)], fill=QUIET, width=1)
        if len(self.curve[0]) and time <= self.curve[0][-1]:
            y = zero + (top - zero) * float(np.interp(time, *self.curve)) / largest
            pen.ellipse([x - 6, y - 6, x + 6, y + 6], fill=PALETTE["vermilion"], outline="white", width=2)


def limits_of(curves: Sequence[Curve]) -> Limits:
    """Return limits that contain all contacts of several curves: the free flight after them is left out."""
    ends = [float(times[force > 0.0].max(initial=0.0)) for times, force in curves]
    return 0.0, 1.1 * max(1e-9, *ends), max(1.0, *(float(force.max(initial=0.0)) for _, force in curves))


CURVES = (("stretch: mean of the section", "blue"), ("bending: side facing the barrier", "vermilion"))


@dataclass(frozen=True, slots=True)
class StrainProfile:
    """Axes drawn once into the still picture, and the curves of each frame.

    ``corner`` is the pixel of position 0 and strain 0, ``slope`` px per m and, downwards, per unit of strain.
    """

    waves: Waves
    corner: tuple[float, float]
    slope: tuple[float, float]

    @classmethod
    def draw(
        cls, drawn: Figure, frame: Frame, place: Rectangle, waves: Waves, times: np.ndarray
    ) -> "StrainProfile":
        """Draw the axes into a figure that is as large as the frame, high enough for all times."""
        limit = 1.1e6 * max(float(np.abs(part).max()) for part in waves.strain(times))
        inner = Rectangle(place.left + 54, place.top + 6, place.width - 66, place.height - 48)
        x, y = "position along the axis from the tip, mm", "axial strain, µm/m"
        axes = curve_axes(drawn, frame, inner, x, y)
        axes.set(xlim=(0.0, 1e3 * waves.length), ylim=(-limit, limit))
        axes.axhline(0.0, color=QUIET, linewidth=0.7)
        look: dict[str, Any] = {"transform": axes.transAxes, "va": "top", "fontsize": 9}
        for at, (words, colour) in enumerate(CURVES):
            axes.text(0.02, 0.98 - 0.06 * at, words, color=PALETTE[colour], **look)
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
