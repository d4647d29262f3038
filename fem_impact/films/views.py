"""The pictures of each frame, the whole rod and the contact in section, and what is drawn over the rod."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  without it there is no window to draw in
from matplotlib import colormaps
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from fem_impact.figures.still import INK, PALETTE, QUIET
from fem_impact.films.frame import CLOSE_WIDTH, Rectangle, font
from fem_impact.films.motion import FIELDS, FilmData, nice_factor, to_points
from meshes.hexmesh import FACES, outer_faces, quad_normals

MARGIN = 0.45
"""Free space around the rod in diameters."""

FINER = 2
"""Pixels of the window along an edge of a pixel of the picture, which is their mean: smooth edges."""

SHADES = 256
"""Colours that a field is shown in."""

SLAB = (201.0, 206.0, 214.0)
"""Colour of a rigid barrier."""

CUBE = np.array([[corner >> axis & 1 for axis in range(3)] for corner in (0, 1, 3, 2, 4, 5, 7, 6)], bool)
"""Which corners of a cell lie high along the three axes."""

_MIRROR = np.array([1.0, -1.0, 1.0])


class _View:
    """Faces in an off-screen window; each frame sets the places and colours of their corners.

    A face has corners of its own, so that its shade is part of their colours: VTK then neither lights nor
    looks colours up. Faces seen from behind are left out.
    """

    def __init__(
        self, motion: FilmData, size: tuple[int, int], span: tuple[float, float], quads: np.ndarray
    ) -> None:
        self.motion, self.span, self.quads = motion, span, quads
        shades = colormaps[FIELDS[motion.field].colours](np.arange(SHADES))
        self.palette = 255.0 * shades[:, :3]
        self.window: Any = vtkRenderWindow()
        self.renderer = vtkRenderer()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*(FINER * side for side in size))
        self.window.AddRenderer(self.renderer)
        self.renderer.SetBackground(1.0, 1.0, 1.0)
        self.read = vtkUnsignedCharArray()

    def close(self) -> None:
        """Close the window."""
        self.window.Finalize()

    def _add(self, corners: np.ndarray, colours: np.ndarray) -> "_Faces":
        faces = _Faces(corners, colours)
        self.renderer.AddActor(faces.actor)
        return faces

    def _add_plane(self, towards: np.ndarray) -> None:
        """Draw a rigid barrier as a grey slab; a meshed one is drawn as it is."""
        if self.motion.rod_nodes.all():
            t, reach = self.motion.contact[0], 1.2 * self.motion.span
            low, high = np.array([(t - reach, -reach, -0.08 * self.motion.span), (t + reach, reach, 0.0)])
            corners = np.where(CUBE, high, low)[FACES]
            self._add(corners, np.full((6, 4, 3), SLAB) * _shade(corners, towards))

    def _look(self, middle: np.ndarray, towards: np.ndarray, height: float) -> None:
        """Look at a place against a direction; the picture is ``height`` high, m."""
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(*middle)
        camera.SetPosition(*(middle + towards))
        camera.SetViewUp(0.0, 0.0, 1.0)
        camera.ParallelProjectionOn()
        camera.SetParallelScale(height / 2.0)
        camera.SetClippingRange(0.01, 3.0)

    def _coloured(self, values: np.ndarray) -> np.ndarray:
        """Return the colours, 0 to 255, of values ``(...)`` of the field: ``(..., 3)``."""
        low, high = self.span
        place = ((values - low) * (SHADES / (high - low))).clip(0, SHADES - 1)
        return np.asarray(self.palette[place.astype(np.intp)])

    def _picture(self) -> Image.Image:
        self.window.Render()
        width, height = self.window.GetSize()
        self.window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, self.read)
        drawn = Image.frombuffer("RGBX", (width, height), vtk_to_numpy(self.read), "raw", "RGBX", 0, 1)
        return drawn.reduce(FINER).transpose(Image.Transpose.FLIP_TOP_BOTTOM)


class _Faces:
    """Quadrilaterals of one actor: their corners ``(k, 4, 3)``, m, and colours ``(k, 4, 3)``, 0 to 255."""

    def __init__(self, corners: np.ndarray, colours: np.ndarray) -> None:
        count = 4 * len(corners)
        self.places, self.shades = np.empty((count, 3), np.float32), np.empty((count, 3), np.uint8)
        points, cells, self.mesh, mapper = vtkPoints(), vtkCellArray(), vtkPolyData(), vtkPolyDataMapper()
        points.SetData(numpy_to_vtk(self.places))
        cells.SetData(4, numpy_to_vtkIdTypeArray(np.arange(count), deep=True))
        self.mesh.SetPoints(points)
        self.mesh.SetPolys(cells)
        self.mesh.GetPointData().SetScalars(numpy_to_vtk(self.shades))
        mapper.SetInputData(self.mesh)
        self.actor = vtkActor()
        self.actor.SetMapper(mapper)
        self.actor.GetProperty().LightingOff()
        self.actor.GetProperty().BackfaceCullingOn()
        self.put(corners, colours)

    def put(self, corners: np.ndarray, colours: np.ndarray) -> None:
        self.places[:], self.shades[:] = corners.reshape(-1, 3), colours.reshape(-1, 3)
        self.mesh.GetPoints().Modified()
        self.mesh.GetPointData().GetScalars().Modified()
        self.mesh.Modified()


def _shade(corners: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Return the brightness ``(k, 1, 1)`` of faces lit from the eye."""
    across = quad_normals(corners)
    lit = across @ towards / np.maximum(np.linalg.norm(across, axis=1), 1e-30)
    return np.asarray((0.25 + 0.8 * lit).clip(0.25, 1.0))[:, None, None]


class RodPicture(_View):
    """The half model and its mirror image: the whole rod on the barrier, deformation magnified.

    ``height`` is that of the picture, m; see `needed_height`.
    """

    def __init__(self, motion: FilmData, size: tuple[int, int], height: float) -> None:
        quads, _ = outer_quads(motion)
        super().__init__(motion, size, motion.far, quads[~on_symmetry(motion, quads)])
        low, high = _corners(motion)
        self.middle = np.array([(low[0] + high[0]) / 2, 0.0, low[2] - MARGIN * motion.span + height / 2])
        side, up = np.radians(-20.0), np.radians(14.0)
        self.towards = np.array([np.sin(side) * np.cos(up), -np.cos(side) * np.cos(up), np.sin(up)])
        self.pixels = size[1] / height  # a metre across the line of sight
        start = np.zeros(len(motion.fields.points))
        self.faces = self._add(*self._whole(motion.fields.points, start))
        self._add_plane(self.towards)
        self._look(self.middle, self.towards, height)

    def draw(self, shown: np.ndarray, colours: np.ndarray) -> Image.Image:
        """Return the picture of positions ``(n, 3) m`` and colours."""
        cells = self.motion.fields.cells
        smooth = to_points(cells, colours, len(shown)) if len(colours) == len(cells) else colours
        self.faces.put(*self._whole(shown, smooth))
        return self._picture()

    def _whole(self, points: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners and colours of the faces of both halves."""
        half, colours = points[self.quads], self._coloured(values)[self.quads]
        corners = np.concatenate([half, (half * _MIRROR)[:, ::-1]])
        both = np.concatenate([colours, colours[:, ::-1]])
        return corners, both * _shade(corners, self.towards)

    def turned(self, vector: np.ndarray) -> np.ndarray:
        """Return a vector (3,) in the picture (2,): to the right and down, in its own unit."""
        right = np.cross(-self.towards, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        return np.array([right @ vector, np.cross(self.towards, right) @ vector * -1.0])


class CloseView(_View):
    """The contact in section on the symmetry plane, true scale, with the mesh."""

    def __init__(self, motion: FilmData, size: tuple[int, int]) -> None:
        quads, self.owners = outer_quads(motion)
        super().__init__(motion, size, motion.near, quads)
        self.faces = self._add(*self._section(motion.fields.points, motion.colours(0.0)))
        edges = self.faces.actor.GetProperty()
        edges.EdgeVisibilityOn()
        edges.SetEdgeColor(0x30 / 255, 0x34 / 255, 0x3A / 255)
        edges.SetEdgeOpacity(0.35)
        edges.SetLineWidth(0.5 * FINER)
        towards = np.array([0.0, -1.0, 0.0])
        self._add_plane(towards)
        height = CLOSE_WIDTH * motion.span * size[1] / size[0]
        self._look(motion.contact + np.array([0.0, 0.0, 0.1 * height]), towards, height)

    def draw(self, true: np.ndarray, colours: np.ndarray) -> Image.Image:
        """Return the picture of positions ``(n, 3) m`` and colours."""
        self.faces.put(*self._section(true, colours))
        return self._picture()

    def _section(self, points: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners and colours of the faces; a cell has one colour."""
        in_cells = len(values) == len(self.motion.fields.cells)
        at = np.repeat(self.owners[:, None], 4, axis=1) if in_cells else self.quads
        return points[self.quads], self._coloured(values[at])


def needed_height(motion: FilmData, size: tuple[int, int]) -> float:
    """Return the height, m, of a picture of ``size`` pixels that shows the whole rod."""
    low, high = _corners(motion)
    across, up = (high - low)[[0, 2]] + 2 * MARGIN * motion.span
    return float(max(up, across * size[1] / size[0]))


def _corners(motion: FilmData) -> tuple[np.ndarray, np.ndarray]:
    points = motion.fields.points[motion.rod_nodes]
    return points.min(axis=0), points.max(axis=0)


def outer_quads(motion: FilmData) -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(k, 4)`` of the faces around the half model, and their cells ``(k,)``."""
    owner, local = outer_faces(motion.fields.cells)
    return motion.fields.cells[owner[:, None], FACES[local]], owner


def on_symmetry(motion: FilmData, quads: np.ndarray) -> np.ndarray:
    """Return which faces ``(k,)`` lie on the plane of motion, inside the whole body."""
    across = np.abs(motion.fields.points[:, 1])
    return np.asarray((across[quads] < 1e-9 * motion.span).all(axis=1))


ARROW = 70.0
"""Length of the velocity's arrow at the start, px."""


@dataclass(frozen=True, slots=True)
class Overlay:
    """Marks over the view of the whole rod, at its place in the frame.

    ``fastest`` is the speed of the centre at the start, m/s, whose arrow is `ARROW` long.
    """

    place: Rectangle
    view: RodPicture
    motion: FilmData
    fastest: float

    @classmethod
    def of(cls, place: Rectangle, view: RodPicture, motion: FilmData) -> "Overlay":
        """Prepare for a view."""
        start = motion.movement.velocity(float(motion.fields.times[0]), motion.weights)
        return cls(place, view, motion, max(float(np.linalg.norm(start)), 1e-12))

    def draw(self, pen: Any, true: np.ndarray, time: float) -> None:
        """Draw all marks at positions ``true`` (n, 3), m."""
        # draw a length of 1, 2 or 5 times a power of ten, at most a third of the view
        length = 1e-6 * nice_factor(self.place.width / 3 / self.view.pixels / 1e-6)
        left, low = self.place.left + 12, self.place.top + 34
        right = left + length * self.view.pixels
        pen.line([(left, low), (right, low)], fill=INK, width=3)
        write_at(pen, np.array([left, low - 18.0]), f"{length * 1e3:g} mm", INK)
        corner = np.array([self.place.left + self.place.width - 56.0, self.place.top + 52.0])
        for name, axis in (("t", [1.0, 0.0, 0.0]), ("n", [0.0, 0.0, 1.0])):
            along = self.view.turned(np.array(axis)) * 34.0
            arrow(pen, corner, corner + along, QUIET, 2)
            write_at(pen, corner + 1.25 * along - np.array([4.0, 8.0]), name, INK)
        velocity = self.motion.movement.velocity(time, self.motion.weights)
        centre = self.motion.weights @ true / self.motion.weights.sum() * [1.0, 0.0, 1.0]
        middle = np.array([self.place.left + self.place.width / 2, self.place.top + self.place.height / 2])
        tail = middle + self.view.turned(centre - self.view.middle) * self.view.pixels
        head = tail + self.view.turned(velocity) * ARROW / self.fastest
        arrow(pen, tail, head, PALETTE["vermilion"], 3)
        beside = np.array([10.0 + 0.7 * self.motion.span * self.view.pixels, -8.0])
        write_at(pen, tail + beside, f"{np.linalg.norm(velocity):.2f} m/s", PALETTE["vermilion"])


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
    pen.text(tuple(place), words, font=font(13), fill=colour)
