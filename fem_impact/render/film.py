"""Film of one run from its result directory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_impact.errors import MissingLibraryError, ResultError
from fem_impact.files.fields_read import FieldFile, read_fields
from fem_impact.outcome.record import Outcome
from fem_impact.render.encode import best_suffix, encode, require_gl
from fem_impact.render.layout import FrameLayout
from fem_impact.render.motion import FilmData, prepare
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
    frames: int | None = None,
    field: str = "mises",
    size: tuple[int, int] = (1280, 720),
    fps: int = 20,
) -> RenderResult:
    """Draw a film of the fields of a run.

    Parameters
    ----------
    result_dir : path
        Folder with fields.vtkhdf, and history.csv and outcome.json where they exist.
    out : path, optional
        The film, .mp4, .webp, .gif, or .png for a folder; default ``film`` in the best format available.
    frames : int, optional
        Number of frames, evenly chosen; all when None.
    field : "mises", "velocity" or "strain"
        The colours: von Mises stress, speed, or strain along the rod's axis.
    size : tuple of int, px
        Width and height, multiples of 16.
    fps : int, 1/s

    Raises
    ------
    ResultError
        The folder holds no readable fields.
    MissingLibraryError, OutputPathError
        Off-screen drawing or the encoder is missing; the film cannot be written.
    """
    folder = Path(result_dir)
    fields = read_fields(folder / "fields.vtkhdf")
    chosen = _choose(len(fields.times), frames)
    motion = prepare(fields, field, chosen)
    require_libraries()
    path, notes = target(folder, out)
    title, curve, missing = context(folder, fields)
    made = encode(_frames(motion, FrameLayout(*size), chosen, title, curve), path, fps)
    return RenderResult(made, (*notes, *missing), len(chosen))


def _choose(stored: int, wanted: int | None) -> Sequence[int]:
    """Return the indices of ``wanted`` frames evenly over the ``stored`` ones; all when None."""
    if wanted is not None and wanted < 1:
        raise ResultError(f"frames = {wanted}: a film needs one frame at least.")
    count = stored if wanted is None else min(wanted, stored)
    return [int(number) for number in np.unique(np.linspace(0, max(stored - 1, 0), count).round())]


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


def context(folder: Path, fields: FieldFile) -> tuple[str, tuple[np.ndarray, np.ndarray], list[str]]:
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
    chosen: Sequence[int],
    title: str,
    curve: tuple[np.ndarray, np.ndarray],
) -> Iterator[np.ndarray]:
    from fem_impact.render.board import FilmBackground
    from fem_impact.render.views import CloseView, RodPicture, needed_height

    board = FilmBackground.make(layout, motion, title, curve)
    size = layout.rod.size
    whole = RodPicture(motion, size, needed_height(motion, size))
    near = CloseView(motion, layout.close.size)
    try:
        for frame in chosen:
            true, shown = motion.positions(frame)
            colours = motion.colours(frame)
            pictures = whole.draw(shown, colours), near.draw(true, colours)
            yield board.compose(*pictures, float(motion.fields.times[frame]))
    finally:
        whole.close()
        near.close()
