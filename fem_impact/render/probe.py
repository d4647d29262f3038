"""Whether off-screen OpenGL works here, asked in a child process since a failure kills the process."""

from __future__ import annotations

import functools
import os
import subprocess
import sys

from fem_impact.errors import MissingLibraryError

__all__ = ["PACKAGES", "require_gl"]

WINDOW = {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"}
PACKAGES = ("libegl1", "libgl1-mesa-dri")
"""Debian packages that off-screen drawing needs."""

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
    """Return when a picture can be drawn off screen, and choose VTK's window for this process.

    Raises
    ------
    MissingLibraryError
        A trial picture in a child process failed; the message names the packages to install.
    """
    found = _trial(tuple(sorted(WINDOW.items())))
    if found:
        raise MissingLibraryError(
            f"Off-screen drawing does not work here ({found}). Install the packages "
            f"{' and '.join(PACKAGES)} (apt-get install {' '.join(PACKAGES)}) and render again; "
            "the computed result is kept."
        )
    os.environ.update(WINDOW)


@functools.cache
def _trial(window: tuple[tuple[str, str], ...]) -> str:
    try:
        done = subprocess.run(
            [sys.executable, "-c", _TRIAL],
            env={**os.environ, **dict(window)},
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"the trial picture could not be drawn: {error}"
    return "" if done.returncode == 0 else _cause(done.returncode, done.stderr)


def _cause(code: int, stderr: str) -> str:
    last = stderr.strip().splitlines()[-1:] or ["no message"]
    return f"the trial picture ended with code {code}: {last[0][:160]}"
