"""Films of one run, and of several side by side, from their result directories."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image, ImageDraw

from fem_impact.errors import ResultError
from fem_impact.figures.still import INK, QUIET
from fem_impact.films import frame
from fem_impact.films.encode import best_suffix, encode, require_gl
from fem_impact.films.frame import FrameLayout, Rectangle, SideBySideLayout
from fem_impact.films.motion import FilmData, prepare
from fem_impact.films.movement import FPS, WHOLE, Span, film_times, read_movement, slow_motion
from fem_impact.films.views import CloseView, Overlay, RodPicture, needed_height
from fem_impact.outcome.record import Outcome
from fem_impact.tables.history import read_history


@dataclass(frozen=True, slots=True)
class RenderResult:
    """A film that was made: its file or folder of frames, warnings, and the number of frames.

    Warnings tell of another format than MP4, a missing title or force curve.
    """

    path: Path
    notes: tuple[str, ...]
    frames: int


def render(
    result_dir: str | Path,
    out: str | Path | None = None,
    span: Span = WHOLE,
    field: str = "strain",
    size: tuple[int, int] = (1280, 720),
) -> RenderResult:
    """Draw a film of the fields of a run.

    Parameters
    ----------
    result_dir : path
        Folder with fields.vtkhdf, and waves.h5, history.csv and outcome.json where they exist.
    out : path, optional
        The film, .mp4, .webp, .gif, or .png for a folder; default ``film`` in the best format available.
    span : Span
        Times and number of frames; by default slow while the first waves run, faster later, and the free
        ringing after the contact.
    field : "strain", "stress", "velocity" or "plastic"
        The colours: strain along the rod's axis, von Mises stress, speed, or plastic strain. Only the film of
        the strain goes on after the last stored frame.
    size : tuple of int, px
        Width and height, multiples of 16.

    Raises
    ------
    ResultError
        The folder holds no readable fields.
    UsageError
        Field, span or size cannot be drawn.
    MissingLibraryError, OutputPathError
        Off-screen drawing or the encoder is missing; the film cannot be written.
    """
    folder, layout = Path(result_dir), FrameLayout(*size)
    movement, left_out = read_movement(folder)
    times = film_times(movement, field, span)
    motion = prepare(movement, field, times)
    require_gl()
    path, notes = target(folder, out)
    title, made, curve, missing = context(folder)
    background = frame.FilmBackground.make(layout, motion, title, made, curve, times)
    film = encode(_frames(motion, background, times), path, FPS)
    return RenderResult(film, (*notes, *left_out, *missing), len(times))


def target(folder: Path, out: str | Path | None, stem: str = "film") -> tuple[Path, list[str]]:
    """Return the film's path, and a note if it is of another format than MP4."""
    if out is not None:
        return Path(out), []
    suffix = best_suffix()
    other = f"The film is {suffix[1:].upper()}, as no MP4 encoder is installed (extra: fem-impact[mp4])."
    return folder / f"{stem}{suffix}", [] if suffix == ".mp4" else [other]


def context(folder: Path) -> tuple[str, str, tuple[np.ndarray, np.ndarray], list[str]]:
    """Return title, program with the scene's digest, force curve, and a note on each that is missing."""
    title, made, curve, missing = folder.resolve().name, "", (np.zeros(0), np.zeros(0)), []
    try:
        origin = Outcome.read(folder / "outcome.json").provenance
        title, version = origin.scene_title, origin.versions.get("fem-impact", "")
        made = f"fem-impact {version} · scene {origin.scene_digest[:12]}"
    except ResultError as error:
        missing.append(f"The film is named after its folder: {error}")
    try:
        history = read_history(folder / "history.csv")
        curve = (history.numbers("time_s"), history.numbers("force_n_N"))
    except ResultError as error:
        missing.append(f"The film has no force curve: {error}")
    return title, made, curve, missing


def _frames(motion: FilmData, background: frame.FilmBackground, times: np.ndarray) -> Iterator[Image.Image]:
    layout = background.layout
    size = layout.rod.size
    whole = RodPicture(motion, size, needed_height(motion, size))
    near = None if background.profile else CloseView(motion, layout.close.size)
    marks = Overlay.of(layout.rod, whole, motion)
    try:
        for at, time in enumerate(times.tolist()):
            true, shown = motion.positions(time)
            colours = motion.colours(time)
            close = near.draw(true, colours) if near else None
            over = partial(marks.draw, true=true, time=time)
            yield background.compose(whole.draw(shown, colours), close, time, over, slow_motion(times, at))
    finally:
        for view in (whole, near):
            if view is not None:
                view.close()


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
        Folders as `fem_impact.render` takes them.
    out : path, optional
        The film; without it ``film-side-by-side`` in the first folder.
    span : Span
        Times and number of frames; by default those of the run that goes on longest.
    size : tuple of int, px
        Width and height, multiples of 16.

    Raises
    ------
    ResultError, MissingLibraryError, OutputPathError
        As `fem_impact.render`.
    """
    folders = [Path(result) for result in results]
    read = [read_movement(folder) for folder in folders]
    movements = [movement for movement, _ in read]
    motions = _on_one_scale([prepare(m, "strain", film_times(m, "strain", WHOLE)) for m in movements])
    require_gl()
    path, notes = target(folders[0], out, "film-side-by-side")
    titles, made, curves, missing = zip(*map(context, folders), strict=True)
    times = film_times(max(movements, key=lambda movement: movement.end), "strain", span)
    layout = SideBySideLayout(*size, len(folders))
    background = PairBackground.make(layout, motions, titles, made, curves)
    film = encode(_side_by_side_frames(background, motions, times), path, FPS)
    left_out = [left_out for _, left_out in read]
    return RenderResult(film, (*notes, *chain(*left_out, *missing)), len(times))


def _on_one_scale(motions: Sequence[FilmData]) -> list[FilmData]:
    """Give all motions the widest colour range and the smallest magnification."""
    top = max(motion.far[1] for motion in motions)
    peak = min(motion.peak for motion in motions)
    return [replace(motion, far=(-top, top), peak=peak) for motion in motions]


@dataclass(frozen=True, slots=True)
class PairBackground:
    """The parts that are equal in all frames.

    Views are pasted into ``base``; ``ends`` are those of the runs, s.
    """

    layout: SideBySideLayout
    base: Image.Image
    strips: tuple[frame.Strip, ...]
    ends: tuple[float, ...]

    @classmethod
    def make(
        cls,
        layout: SideBySideLayout,
        motions: Sequence[FilmData],
        titles: Sequence[str],
        made: Sequence[str],
        curves: Sequence[frame.Curve],
    ) -> "PairBackground":
        """Draw the still parts once, with title and force curve of each run."""
        drawn = frame.blank(layout)
        frame.heading(drawn, layout, TITLE)
        frame.origin(drawn, layout, made)
        limits = frame.limits_of(curves)
        strips = []
        for title, curve, view, place in zip(titles, curves, layout.views, layout.strips, strict=True):
            _title(drawn, layout, view, title)
            strips.append(frame.Strip.draw(drawn, layout, place, curve, limits))
        middle = layout.views[len(layout.views) // 2]
        frame.colour_bar(drawn, layout, middle, "strain", motions[0].far)
        scale = f"one scale; deformation × {motions[0].peak:g},\nfading to × 1 at the contact"
        frame.below(drawn, layout, layout.views[0], scale, QUIET)
        ends = tuple(motion.movement.end for motion in motions)
        return cls(layout, frame.picture(drawn), tuple(strips), ends)

    def compose(self, pictures: Sequence[Image.Image], time: float) -> Image.Image:
        """Return one frame from the views at ``time`` in s."""
        image = self.base.copy()
        pen = ImageDraw.Draw(image)
        for drawn, view in zip(pictures, self.layout.views, strict=True):
            image.paste(drawn, view.corner)
        for strip, view, end in zip(self.strips, self.layout.views, self.ends, strict=True):
            strip.mark(pen, time)
            if time > end:
                place = (view.left + view.width - 8, view.top + 4)
                frame.write(pen, place, f"over at {end * 1e6:.0f} µs", 13)
        frame.clock(pen, self.layout, time)
        return image


def _title(drawn: Figure, layout: SideBySideLayout, view: Rectangle, title: str) -> None:
    place = (view.left / layout.width, 1 - (view.top - 2) / layout.height)
    lines, points = frame.fitted(title, view.width, 9.5, 7.0)
    drawn.text(*place, lines, fontsize=points, color=INK, va="bottom", linespacing=1.1, parse_math=False)


def _side_by_side_frames(
    background: PairBackground, motions: Sequence[FilmData], times: np.ndarray
) -> Iterator[Image.Image]:
    sizes = [view.size for view in background.layout.views]
    height = max(needed_height(motion, size) for motion, size in zip(motions, sizes, strict=True))
    views = [RodPicture(motion, size, height) for motion, size in zip(motions, sizes, strict=True)]
    try:
        for time in times:
            shown = [min(float(time), motion.movement.end) for motion in motions]
            drawn = [
                view.draw(motion.positions(at)[1], motion.colours(at))
                for view, motion, at in zip(views, motions, shown, strict=True)
            ]
            yield background.compose(drawn, float(time))
    finally:
        for view in views:
            view.close()
