"""What is drawn over the view of the whole rod: length scale, axes n and t, velocity of the centre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_impact.figures.style import INK, PALETTE, QUIET
from fem_impact.films.kinematics import nice_factor
from fem_impact.films.layout import Rectangle
from fem_impact.films.motion import FilmData
from fem_impact.films.views import RodPicture

ARROW = 70.0
"""Length of the velocity's arrow at the start, px."""


@dataclass(frozen=True, slots=True)
class Overlay:
    """Marks over the view of the whole rod.

    Parameters
    ----------
    place : Rectangle
        Of the view in the frame, px.
    view : RodPicture
    motion : FilmData
    fastest : float, m/s
        Speed of the centre at the start, whose arrow is `ARROW` long.
    """

    place: Rectangle
    view: RodPicture
    motion: FilmData
    fastest: float

    @classmethod
    def of(cls, place: Rectangle, view: RodPicture, motion: FilmData) -> Overlay:
        """Prepare for a view."""
        start = motion.movement.velocity(float(motion.fields.times[0]), motion.weights)
        return cls(place, view, motion, max(float(np.linalg.norm(start)), 1e-12))

    def draw(self, pen: Any, true: np.ndarray, time: float) -> None:
        """Draw all marks at positions ``true`` (n, 3), m."""
        self._scale(pen)
        self._axes(pen)
        velocity = self.motion.movement.velocity(time, self.motion.weights)
        centre = self.motion.weights @ true / self.motion.weights.sum() * [1.0, 0.0, 1.0]
        tail = self._pixel(centre)
        head = tail + self.view.turned(velocity) * ARROW / self.fastest
        arrow(pen, tail, head, PALETTE["vermilion"], 3)
        beside = np.array([10.0 + 0.7 * self.motion.span * self.view.pixels, -8.0])
        write_at(pen, tail + beside, f"{np.linalg.norm(velocity):.2f} m/s", PALETTE["vermilion"])

    def _pixel(self, point: np.ndarray) -> np.ndarray:
        middle = np.array([self.place.left + self.place.width / 2, self.place.top + self.place.height / 2])
        pixel: np.ndarray = middle + self.view.turned(point - self.view.middle) * self.view.pixels
        return pixel

    def _scale(self, pen: Any) -> None:
        """Draw a length of 1, 2 or 5 times a power of ten, at most a third of the view."""
        length = 1e-6 * nice_factor(self.place.width / 3 / self.view.pixels / 1e-6)
        left, low = self.place.left + 12, self.place.top + 34
        right = left + length * self.view.pixels
        pen.line([(left, low), (right, low)], fill=INK, width=3)
        write_at(pen, np.array([left, low - 18.0]), f"{length * 1e3:g} mm", INK)

    def _axes(self, pen: Any) -> None:
        corner = np.array([self.place.left + self.place.width - 56.0, self.place.top + 52.0])
        for name, axis in (("t", [1.0, 0.0, 0.0]), ("n", [0.0, 0.0, 1.0])):
            along = self.view.turned(np.array(axis)) * 34.0
            arrow(pen, corner, corner + along, QUIET, 2)
            write_at(pen, corner + 1.25 * along - np.array([4.0, 8.0]), name, INK)


def arrow(pen: Any, tail: np.ndarray, head: np.ndarray, colour: str, width: int) -> None:
    """Draw an arrow between two pixels; one too short for a head is left out."""
    along = head - tail
    length = float(np.linalg.norm(along))
    if length < 4.0:
        return
    forward = along / length
    side = np.array([-forward[1], forward[0]])
    base = head - 9.0 * forward
    pen.line([tuple(tail), tuple(base)], fill=colour, width=width)
    pen.polygon([tuple(head), tuple(base + 4.5 * side), tuple(base - 4.5 * side)], fill=colour)


def write_at(pen: Any, place: np.ndarray, words: str, colour: str) -> None:
    """Write words with their upper left corner at a pixel."""
    from fem_impact.films.board import font

    pen.text(tuple(place), words, font=font(13), fill=colour)
