"""The pictures of each frame, the whole rod and the contact in section, and what is drawn over the rod."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista
from PIL import Image

from fem_impact.figures.still import INK, PALETTE, QUIET
from fem_impact.films.frame import CLOSE_WIDTH, Rectangle, font
from fem_impact.films.motion import FIELDS, FilmData, nice_factor, to_points

MARGIN = 0.45
"""Free space around the rod in diameters."""

FINER = 2
"""Pixels of the window along an edge of a pixel of the picture, which is their mean: smooth edges."""

_MIRROR = np.array([1.0, -1.0, 1.0])


class _View:
    """A closed surface in an off-screen window; each frame sets its points and colours.

    The faces on the far side are culled, which saves a third of the time of a picture; one light and a finer
    window, beside five lights and VTK's smoothing of edges, two fifths.
    """

    def __init__(
        self, motion: FilmData, size: tuple[int, int], span: tuple[float, float], **look: Any
    ) -> None:
        self.motion = motion
        self.surface = outer_surface(motion)
        self.nodes = np.asarray(self.surface.point_data["vtkOriginalPointIds"])
        self.cells = np.asarray(self.surface.cell_data["vtkOriginalCellIds"])
        window = [FINER * side for side in size]
        self.plotter: Any = pyvista.Plotter(off_screen=True, window_size=window, lighting="none")
        self.plotter.add_light(pyvista.Light(light_type="headlight"))
        self.plotter.disable_anti_aliasing()
        self.plotter.renderer.set_background("white")
        self.look = {
            "cmap": FIELDS[motion.field].colours,
            "clim": list(span),
            "show_scalar_bar": False,
            **look,
        }

    def close(self) -> None:
        """Close the window."""
        self.plotter.close()

    def _put(self, mesh: Any, points: np.ndarray, colours: np.ndarray) -> None:
        mesh.points = points[self.nodes]
        data = mesh.point_data if len(colours) == len(points) else mesh.cell_data
        data["colour"] = colours[self.nodes if len(colours) == len(points) else self.cells]

    def _picture(self) -> np.ndarray:
        self.plotter.render()
        return np.asarray(Image.fromarray(self.plotter.screenshot(return_img=True)).reduce(FINER))


class RodPicture(_View):
    """The half model and its mirror image: the whole rod on the barrier, deformation magnified.

    ``height`` is that of the picture, m; see `needed_height`.
    """

    def __init__(self, motion: FilmData, size: tuple[int, int], height: float) -> None:
        super().__init__(motion, size, motion.far, ambient=0.25, diffuse=0.8)
        self.mirrored = self.surface.copy()
        for mesh, hidden in ((self.surface, "back"), (self.mirrored, "front")):
            self._put(mesh, motion.fields.points, np.zeros(len(motion.fields.points)))
            self.plotter.add_mesh(mesh, scalars="colour", culling=hidden, **self.look)
        _add_plane(self.plotter, motion)
        low, high = _corners(motion)
        self.middle = np.array([(low[0] + high[0]) / 2, 0.0, low[2] - MARGIN * motion.span + height / 2])
        side, up = np.radians(-20.0), np.radians(14.0)
        self.towards = np.array([np.sin(side) * np.cos(up), -np.cos(side) * np.cos(up), np.sin(up)])
        self.pixels = size[1] / height  # a metre across the line of sight
        _look_at(self.plotter, self.middle, self.towards, height)

    def draw(self, shown: np.ndarray, colours: np.ndarray) -> np.ndarray:
        """Return the picture ``(h, w, 3) uint8`` of positions ``(n, 3) m`` and colours."""
        fields = self.motion.fields
        in_cells = len(colours) == len(fields.cells)
        smooth = to_points(fields.cells, colours, len(shown)) if in_cells else colours
        self._put(self.surface, shown, smooth)
        self._put(self.mirrored, shown * _MIRROR, smooth)
        return self._picture()

    def turned(self, vector: np.ndarray) -> np.ndarray:
        """Return a vector (3,) in the picture (2,): to the right and down, in its own unit."""
        right = np.cross(-self.towards, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        return np.array([right @ vector, np.cross(self.towards, right) @ vector * -1.0])


class CloseView(_View):
    """The contact in section on the symmetry plane, true scale, with the mesh."""

    def __init__(self, motion: FilmData, size: tuple[int, int]) -> None:
        look = {"show_edges": True, "edge_color": "#30343a", "line_width": 0.5 * FINER, "edge_opacity": 0.35}
        super().__init__(motion, size, motion.near, lighting=False, **look)
        self._put(self.surface, motion.fields.points, motion.colours(0.0))
        self.plotter.add_mesh(self.surface, scalars="colour", culling="back", **self.look)
        _add_plane(self.plotter, motion)
        height = CLOSE_WIDTH * motion.span * size[1] / size[0]
        middle = motion.contact + np.array([0.0, 0.0, 0.1 * height])
        _look_at(self.plotter, middle, np.array([0.0, -1.0, 0.0]), height)

    def draw(self, true: np.ndarray, colours: np.ndarray) -> np.ndarray:
        """Return the picture ``(h, w, 3) uint8`` of positions ``(n, 3) m`` and colours."""
        self._put(self.surface, true, colours)
        return self._picture()


def needed_height(motion: FilmData, size: tuple[int, int]) -> float:
    """Return the height, m, of a picture of ``size`` pixels that shows the whole rod."""
    low, high = _corners(motion)
    across, up = (high - low)[[0, 2]] + 2 * MARGIN * motion.span
    return float(max(up, across * size[1] / size[0]))


def _corners(motion: FilmData) -> tuple[np.ndarray, np.ndarray]:
    points = motion.fields.points[motion.rod_nodes]
    return points.min(axis=0), points.max(axis=0)


def outer_surface(motion: FilmData) -> pyvista.PolyData:
    """Return the outside of the half model, with the numbers of its points and cells in the mesh."""
    cells = {pyvista.CellType.HEXAHEDRON: motion.fields.cells}
    grid = pyvista.UnstructuredGrid(cells, motion.fields.points)
    return grid.extract_surface(pass_pointid=True, pass_cellid=True, algorithm="dataset_surface")


def _add_plane(plotter: Any, motion: FilmData) -> None:
    """Draw a rigid barrier as a grey slab; a meshed one is drawn as it is."""
    if motion.rod_nodes.all():
        t, reach = motion.contact[0], 1.2 * motion.span
        slab = pyvista.Box((t - reach, t + reach, -reach, reach, -0.08 * motion.span, 0.0))
        plotter.add_mesh(slab, color="#c9ced6")


def _look_at(plotter: Any, middle: np.ndarray, towards: np.ndarray, height: float) -> None:
    plotter.camera_position = [tuple(middle + towards), tuple(middle), (0.0, 0.0, 1.0)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = height / 2.0
    plotter.camera.clipping_range = (0.01, 3.0)


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
