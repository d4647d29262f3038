"""Film of one run from its result directory."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fem_impact.errors import MissingLibraryError, ResultError
from fem_impact.films.encode import best_suffix, encode, require_gl
from fem_impact.films.layout import FrameLayout
from fem_impact.films.motion import FilmData, prepare
from fem_impact.films.movement import read_movement
from fem_impact.films.timeline import FPS, WHOLE, Span, film_times, slow_motion
from fem_impact.outcome.record import Outcome
from fem_impact.tables.history import read_history


@dataclass(frozen=True, slots=True)
class RenderResult:
    """A film that was made.

    Parameters
    ----------
    path : Path
        The film, or the folder of frames.
    notes : tuple of str
        Warnings: another format than MP4, a missing title or force curve.
    frames : int
        Number of frames.
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
    require_libraries()
    path, notes = target(folder, out)
    title, curve, missing = context(folder)
    made = encode(_frames(motion, layout, times, title, curve), path, FPS)
    return RenderResult(made, (*notes, *left_out, *missing), len(times))


def require_libraries() -> None:
    """Check that a film can be drawn here; raises MissingLibraryError."""
    try:
        import matplotlib  # noqa: F401
        import PIL  # noqa: F401
    except ImportError as error:
        raise MissingLibraryError(f"A film needs {error.name}: pip install {error.name}.") from error
    require_gl()


def target(folder: Path, out: str | Path | None, stem: str = "film") -> tuple[Path, list[str]]:
    """Return the film's path, and a note if it is of another format than MP4."""
    if out is not None:
        return Path(out), []
    suffix = best_suffix()
    other = f"The film is {suffix[1:].upper()}, as no MP4 encoder is installed (extra: fem-impact[mp4])."
    return folder / f"{stem}{suffix}", [] if suffix == ".mp4" else [other]


def context(folder: Path) -> tuple[str, tuple[np.ndarray, np.ndarray], list[str]]:
    """Return title, force curve, and a note on each of them that is missing."""
    title, curve, missing = folder.resolve().name, (np.zeros(0), np.zeros(0)), []
    try:
        title = Outcome.read(folder / "outcome.json").provenance.scene_title
    except ResultError as error:
        missing.append(f"The film is named after its folder: {error}")
    try:
        history = read_history(folder / "history.csv")
        curve = (history.numbers("time_s"), history.numbers("force_n_N"))
    except ResultError as error:
        missing.append(f"The film has no force curve: {error}")
    return title, curve, missing


def _frames(
    motion: FilmData,
    layout: FrameLayout,
    times: np.ndarray,
    title: str,
    curve: tuple[np.ndarray, np.ndarray],
) -> Iterator[np.ndarray]:
    from fem_impact.films.board import FilmBackground
    from fem_impact.films.overlay import Overlay
    from fem_impact.films.views import CloseView, RodPicture, needed_height

    board = FilmBackground.make(layout, motion, title, curve, times)
    size = layout.rod.size
    whole = RodPicture(motion, size, needed_height(motion, size))
    near = None if board.profile else CloseView(motion, layout.close.size)
    marks = Overlay.of(layout.rod, whole, motion)
    try:
        for at, time in enumerate(times.tolist()):
            true, shown = motion.positions(time)
            colours = motion.colours(time)
            close = near.draw(true, colours) if near else None
            over = partial(marks.draw, true=true, time=time)
            yield board.compose(whole.draw(shown, colours), close, time, over, slow_motion(times, at))
    finally:
        for view in (whole, near):
            if view is not None:
                view.close()
