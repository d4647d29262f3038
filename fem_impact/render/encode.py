"""Frames into a film: MP4 where its encoder is installed, else WebP or GIF, else a folder of PNG."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.errors import MissingLibraryError, OutputPathError
from fem_impact.output import atomic_path, make_directory

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["SUFFIXES", "best_suffix", "encode"]

SUFFIXES = (".mp4", ".webp", ".gif", ".png")
"""Formats that can be asked for; ``.png`` makes a folder of numbered frames."""

FAST = ["-preset", "veryfast"]
"""Of the encoder: half the time of its default for files a twentieth larger."""


def best_suffix() -> str:
    """Return the suffix of the best format that is available here."""
    if _has_ffmpeg():
        return ".mp4"
    from PIL import features

    return ".webp" if features.check("webp") else ".gif"


def encode(frames: Iterable[np.ndarray], path: Path, fps: int) -> Path:
    """Write frames ``(height, width, 3) uint8`` as a film, in one step; return its path.

    Raises
    ------
    MissingLibraryError
        MP4 is asked for and imageio-ffmpeg is not installed.
    OutputPathError
        The suffix is no film format, or the place cannot be written.
    """
    writers = {".mp4": _write_mp4, ".webp": _write_webp, ".gif": _write_gif}
    if path.suffix == ".png":
        return _write_folder(frames, path.with_suffix(""))
    if path.suffix not in writers:
        raise OutputPathError(f"{path}: a film ends in {', '.join(SUFFIXES)}.")
    if path.suffix == ".mp4" and not _has_ffmpeg():
        raise MissingLibraryError(
            f'{path}: MP4 needs an encoder (GPL): pip install "fem-impact[mp4]", or ask for .webp or .gif.'
        )
    with atomic_path(path) as draft:
        writers[path.suffix](iter(frames), draft, fps)
    return path


def _has_ffmpeg() -> bool:
    return importlib.util.find_spec("imageio_ffmpeg") is not None


def _write_mp4(frames: Iterator[np.ndarray], path: Path, fps: int) -> None:
    imageio_ffmpeg = importlib.import_module("imageio_ffmpeg")
    first = next(frames)
    height, width = first.shape[:2]
    how = {"quality": 7, "macro_block_size": 16, "pix_fmt_out": "yuv420p", "output_params": FAST}
    writer = imageio_ffmpeg.write_frames(str(path), (width, height), fps=fps, **how)
    writer.send(None)
    try:
        for frame in _chain(first, frames):
            writer.send(np.ascontiguousarray(frame))
    finally:
        writer.close()


def _write_webp(frames: Iterator[np.ndarray], path: Path, fps: int) -> None:
    _animate(frames, path, fps, lambda picture: picture, quality=80, method=3)


def _write_gif(frames: Iterator[np.ndarray], path: Path, fps: int) -> None:
    _animate(frames, path, fps, lambda picture: picture.quantize(192), optimize=False)


def _animate(
    frames: Iterator[np.ndarray], path: Path, fps: int, prepare: Callable[[Image], Image], **options: Any
) -> None:
    from PIL import Image

    pictures = (prepare(Image.fromarray(frame)) for frame in frames)
    first = next(pictures)
    first.save(path, save_all=True, append_images=pictures, duration=round(1000 / fps), loop=0, **options)


def _write_folder(frames: Iterable[np.ndarray], folder: Path) -> Path:
    from PIL import Image

    if folder.is_dir():
        for old in folder.glob("frame_*.png"):
            old.unlink()
    make_directory(folder)
    for number, frame in enumerate(frames):
        with atomic_path(folder / f"frame_{number:04d}.png") as draft:
            Image.fromarray(frame).save(draft)
    return folder


def _chain(first: np.ndarray, rest: Iterator[np.ndarray]) -> Iterator[np.ndarray]:
    yield first
    yield from rest
