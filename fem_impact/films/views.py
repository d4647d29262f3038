"""The two pictures of each frame: the whole rod, and the contact in section."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.films.kinematics import to_points
from fem_impact.films.motion import FIELDS, FilmData

if TYPE_CHECKING:
    import pyvista


CLOSE_WIDTH = 0.45
"""Width of the close-up in diameters of the rod."""

MARGIN = 0.45
"""Free space around the rod in diameters."""

_MIRROR = np.array([1.0, -1.0, 1.0])


class _View:
    """A closed surface in an off-screen window; each frame sets its points and colours.

    The faces on the far side are culled, which saves a third of the time of a picture.
    """

    def __init__(
        self, motion: FilmData, size: tuple[int, int], span: tuple[float, float], **look: Any
    ) -> None:
        import pyvista

        self.motion = motion
        self.surface = outer_surface(motion)
        self.nodes = np.asarray(self.surface.point_data["vtkOriginalPointIds"])
        self.cells = np.asarray(self.surface.cell_data["vtkOriginalCellIds"])
        self.plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(size), lighting="light kit")
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
        picture: np.ndarray = self.plotter.screenshot(return_img=True)
        return picture


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
        self._aim(height, size[1])

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

    def _aim(self, height: float, pixels: int) -> None:
        low, high = _corners(self.motion)
        self.middle = np.array([(low[0] + high[0]) / 2, 0.0, low[2] - MARGIN * self.motion.span + height / 2])
        side, up = np.radians(-20.0), np.radians(14.0)
        self.towards = np.array([np.sin(side) * np.cos(up), -np.cos(side) * np.cos(up), np.sin(up)])
        self.pixels = pixels / height  # a metre across the line of sight
        _look_at(self.plotter, self.middle, self.towards, height)


class CloseView(_View):
    """The contact in section on the symmetry plane, true scale, with the mesh."""

    def __init__(self, motion: FilmData, size: tuple[int, int]) -> None:
        look = {"show_edges": True, "edge_color": "#30343a", "line_width": 0.5, "edge_opacity": 0.35}
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
    import pyvista

    cells = {pyvista.CellType.HEXAHEDRON: motion.fields.cells}
    grid = pyvista.UnstructuredGrid(cells, motion.fields.points)
    return grid.extract_surface(pass_pointid=True, pass_cellid=True, algorithm="dataset_surface")


def _add_plane(plotter: Any, motion: FilmData) -> None:
    """Draw a rigid barrier as a grey slab; a meshed one is drawn as it is."""
    import pyvista

    if motion.rod_nodes.all():
        t, reach = motion.contact[0], 1.2 * motion.span
        slab = pyvista.Box((t - reach, t + reach, -reach, reach, -0.08 * motion.span, 0.0))
        plotter.add_mesh(slab, color="#c9ced6")


def _look_at(plotter: Any, middle: np.ndarray, towards: np.ndarray, height: float) -> None:
    plotter.camera_position = [tuple(middle + towards), tuple(middle), (0.0, 0.0, 1.0)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = height / 2.0
    plotter.camera.clipping_range = (0.01, 3.0)
