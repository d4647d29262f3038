"""Film of several runs side by side at one scale and time, with the contact force of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.figures.style import INK, QUIET
from fem_impact.films.board import (
    Curve,
    Strip,
    below,
    blank,
    clock,
    colour_bar,
    heading,
    limits_of,
    picture,
    write,
)
from fem_impact.films.encode import encode
from fem_impact.films.film import RenderResult, context, require_libraries, target
from fem_impact.films.layout import Abreast, Rectangle
from fem_impact.films.motion import FilmData, prepare
from fem_impact.films.movement import read_movement
from fem_impact.films.timeline import FPS, WHOLE, Span, film_times
from fem_impact.films.views import RodPicture, needed_height

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from PIL.Image import Image


TITLE = "Strain along the axis: of one sign over a section in longitudinal waves, of both in bending"


def render_side_by_side(
    results: Sequence[str | Path],
    out: str | Path | None = None,
    span: Span = WHOLE,
    size: tuple[int, int] = (1280, 720),
) -> RenderResult:
    """Draw one film of several runs: one scale, one magnification, one colour range, one clock.

    A rod whose run has ended keeps its last frame. Colours are the strain along the rod's axis.

    Parameters
    ----------
    results : paths
        Folders as `fem_impact.films.render` takes them.
    out : path, optional
        The film; without it ``film-side-by-side`` in the first folder.
    span : Span
        Times and number of frames; by default those of the run that goes on longest.
    size : tuple of int, px
        Width and height, multiples of 16.

    Raises
    ------
    ResultError, MissingLibraryError, OutputPathError
        As `fem_impact.films.render`.
    """
    folders = [Path(result) for result in results]
    read = [read_movement(folder) for folder in folders]
    movements = [movement for movement, _ in read]
    motions = _alike([prepare(m, "strain", film_times(m, "strain", WHOLE)) for m in movements])
    require_libraries()
    path, notes = target(folders[0], out, "film-side-by-side")
    contexts = [context(folder) for folder in folders]
    times = film_times(max(movements, key=lambda movement: movement.end), "strain", span)
    board = PairBackground.make(Abreast(*size, len(folders)), motions, [c[:2] for c in contexts], times)
    made = encode(_frames(board, motions, times), path, FPS)
    groups = [*(left_out for _, left_out in read), *(missing for *_, missing in contexts)]
    left_out = [sentence for sentences in groups for sentence in sentences]
    return RenderResult(made, (*notes, *left_out), len(times))


def _alike(motions: Sequence[FilmData]) -> list[FilmData]:
    """Give all motions the widest colour range and the smallest magnification."""
    top = max(motion.far[1] for motion in motions)
    peak = min(motion.peak for motion in motions)
    return [replace(motion, far=(-top, top), peak=peak) for motion in motions]


@dataclass(frozen=True, slots=True)
class PairBackground:
    """The parts that are equal in all frames.

    Parameters
    ----------
    layout : Abreast
    base : Image
        The still picture that the views are pasted into.
    strips : tuple of Strip
    ends : tuple of float
        End of each run, s.
    """

    layout: Abreast
    base: Image
    strips: tuple[Strip, ...]
    ends: tuple[float, ...]

    @classmethod
    def make(
        cls,
        layout: Abreast,
        motions: Sequence[FilmData],
        runs: Sequence[tuple[str, Curve]],
        times: np.ndarray,
    ) -> PairBackground:
        """Draw the still parts once; ``runs`` holds title and force curve of each run."""
        drawn = blank(layout)
        heading(drawn, layout, TITLE)
        limits = limits_of([curve for _, curve in runs], times)
        strips = []
        for (title, curve), view, place in zip(runs, layout.views, layout.strips, strict=True):
            _title(drawn, layout, view, title)
            strips.append(Strip.draw(drawn, layout, place, curve, limits))
        middle = layout.views[len(layout.views) // 2]
        colour_bar(drawn, layout, middle, "strain", motions[0].far)
        scale = f"one scale; deformation × {motions[0].peak:g},\nfading to × 1 at the contact"
        below(drawn, layout, layout.views[0], scale, QUIET)
        ends = tuple(motion.movement.end for motion in motions)
        return cls(layout, picture(drawn), tuple(strips), ends)

    def compose(self, pictures: Sequence[np.ndarray], time: float) -> np.ndarray:
        """Return one frame ``(height, width, 3) uint8`` from the views at ``time`` in s."""
        from PIL import Image, ImageDraw

        frame = self.base.copy()
        pen = ImageDraw.Draw(frame)
        for drawn, view in zip(pictures, self.layout.views, strict=True):
            frame.paste(Image.fromarray(drawn), view.corner)
        for strip, view, end in zip(self.strips, self.layout.views, self.ends, strict=True):
            strip.mark(pen, time)
            if time > end:
                place = (view.left + view.width - 8, view.top + 4)
                write(pen, place, f"over at {end * 1e6:.0f} µs", 13)
        clock(pen, self.layout, time)
        return np.asarray(frame)


def _title(drawn: Figure, layout: Abreast, view: Rectangle, title: str) -> None:
    place = (view.left / layout.width, 1 - (view.top - 2) / layout.height)
    lines = fill(title, view.width // 8, max_lines=2, placeholder=" …")
    drawn.text(*place, lines, fontsize=9.5, color=INK, va="bottom", linespacing=1.1, parse_math=False)


def _frames(board: PairBackground, motions: Sequence[FilmData], times: np.ndarray) -> Iterator[np.ndarray]:
    sizes = [view.size for view in board.layout.views]
    height = max(needed_height(motion, size) for motion, size in zip(motions, sizes, strict=True))
    views = [RodPicture(motion, size, height) for motion, size in zip(motions, sizes, strict=True)]
    try:
        for time in times:
            shown = [min(float(time), motion.movement.end) for motion in motions]
            drawn = [
                view.draw(motion.positions(at)[1], motion.colours(at))
                for view, motion, at in zip(views, motions, shown, strict=True)
            ]
            yield board.compose(drawn, float(time))
    finally:
        for view in views:
            view.close()
