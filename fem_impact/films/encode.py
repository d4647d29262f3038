"""Film formats, and the check that off-screen drawing works.

MP4 needs imageio-ffmpeg; the others are WebP, GIF and a folder of PNG files.
"""

import importlib.util
import itertools
import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

from PIL import Image, features

from fem_impact.errors import MissingLibraryError, OutputPathError
from fem_impact.files.atomic import atomic_path, make_directory

SUFFIXES = (".mp4", ".webp", ".gif", ".png")
"""Formats that can be asked for; ``.png`` makes a folder of numbered frames."""

FAST = ["-preset", "veryfast"]
"""Options of the MP4 encoder: half the time of its default for files 5 % larger."""

WEBP: dict[str, Any] = {"quality": 75, "method": 0, "kmin": 0, "kmax": 0}
"""Options of WebP. Key frames after the first are left out: a film that starts at its first frame needs
none, and each is encoded twice. Of 36 frames, beside method 2 at quality 80: .66 of the time, 1.21 of the
bytes, 38.2 for 38.5 dB of signal over error."""

WINDOW = {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"}
"""Environment that makes VTK draw off screen."""

PACKAGES = ("libegl1", "libgl1-mesa-dri")
"""Debian packages that off-screen drawing needs."""


def best_suffix() -> str:
    """Return the suffix of the best format that is available here."""
    if _has_ffmpeg():
        return ".mp4"
    return ".webp" if features.check("webp") else ".gif"


def encode(frames: Iterable[Image.Image], path: Path, fps: int) -> Path:
    """Write frames of mode RGB as a film, in one step; return its path.

    Raises
    ------
    MissingLibraryError
        MP4 is asked for and imageio-ffmpeg is not installed.
    OutputPathError
        The suffix is no film format, or the place cannot be written.
    """
    writers: dict[str, Callable[[Iterator[Image.Image], Path, int], None]] = {
        ".mp4": _write_mp4,
        ".webp": partial(_animate, prepare=lambda picture: picture, **WEBP),
        ".gif": partial(_animate, prepare=lambda picture: picture.quantize(192), optimize=False),
    }
    if path.suffix == ".png":
        folder = path.with_suffix("")
        if folder.is_dir():
            for old in folder.glob("frame_*.png"):
                old.unlink()
        make_directory(folder)
        for number, frame in enumerate(frames):
            with atomic_path(folder / f"frame_{number:04d}.png") as draft:
                frame.save(draft)
        return folder
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


def _write_mp4(frames: Iterator[Image.Image], path: Path, fps: int) -> None:
    imageio_ffmpeg = importlib.import_module("imageio_ffmpeg")
    first = next(frames)
    how = {"quality": 7, "macro_block_size": 16, "pix_fmt_out": "yuv420p", "output_params": FAST}
    writer = imageio_ffmpeg.write_frames(str(path), first.size, fps=fps, **how)
    writer.send(None)
    try:
        for frame in itertools.chain([first], frames):
            writer.send(frame.tobytes())
    finally:
        writer.close()


def _animate(
    frames: Iterator[Image.Image],
    path: Path,
    fps: int,
    prepare: Callable[[Image.Image], Image.Image],
    **options: Any,
) -> None:
    pictures = map(prepare, frames)
    first = next(pictures)
    first.save(path, save_all=True, append_images=pictures, duration=round(1000 / fps), loop=0, **options)


# VTK alone: with pyvista the trial takes three times as long
_TRIAL = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
)
mapper, actor, renderer = vtkPolyDataMapper(), vtkActor(), vtkRenderer()
window, picture, sphere = vtkRenderWindow(), vtkWindowToImageFilter(), vtkSphereSource()
mapper.SetInputConnection(sphere.GetOutputPort())
actor.SetMapper(mapper)
renderer.AddActor(actor)
window.SetOffScreenRendering(1)
window.SetSize(32, 32)
window.AddRenderer(renderer)
window.Render()
picture.SetInput(window)
picture.Update()
drawn = vtk_to_numpy(picture.GetOutput().GetPointData().GetScalars())
raise SystemExit(0 if drawn.std() > 0 else 3)
"""


def require_gl() -> None:
    """Check that a picture can be drawn off screen, and set VTK's window for this process.

    Raises
    ------
    MissingLibraryError
        A trial picture in a child process failed; the message names the packages to install.
    """
    fault = _trial()
    if fault:
        raise MissingLibraryError(
            f"Off-screen drawing does not work here ({fault}). Install the packages "
            f"{' and '.join(PACKAGES)} (apt-get install {' '.join(PACKAGES)}) and render again; "
            "the computed result is kept."
        )
    os.environ.update(WINDOW)


@cache
def _trial() -> str:
    try:
        done = subprocess.run(
            [sys.executable, "-c", _TRIAL],
            env={**os.environ, **WINDOW},
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"the trial picture could not be drawn: {error}"
    if done.returncode == 0:
        return ""
    last = done.stderr.strip().splitlines()[-1:] or ["no message"]
    return f"the trial picture ended with code {done.returncode}: {last[0][:160]}"
