"""Fields over time (temporal VTKHDF): checks of their data, and their reader for pictures and checks."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import h5py
import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.atomic import check_digest

if TYPE_CHECKING:
    import pyvista


CORNERS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]],
    float,
)


def jacobian(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return ``(m, 3, 3)``, m: the change of the place along each edge direction at the centres of cells."""
    result: np.ndarray = np.einsum("ki,mkj->mij", CORNERS / 8.0, points[cells])
    return result


def check_mesh(points: np.ndarray, cells: np.ndarray) -> None:
    """Refuse points that are not finite ``(n, 3)`` and cells that are not ``(m, 8)`` numbers of points."""
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points must have shape (n, 3), not {points.shape}.")
    if cells.ndim != 2 or cells.shape[1] != 8:
        raise ValueError(f"cells must have shape (m, 8), not {cells.shape}.")
    check_finite("points", points)
    if cells.dtype.kind not in "iu":
        raise ValueError(f"cells must be whole numbers, not {cells.dtype}.")
    if cells.size and not (0 <= cells.min() and cells.max() < len(points)):
        raise ValueError(f"cells name points {cells.min()} to {cells.max()}, there are {len(points)}.")


def check_times(times: np.ndarray, count: int) -> None:
    """Refuse times that are not ``(count,)`` finite numbers, each later than the one before."""
    if times.shape != (count,):
        raise ValueError(f"times of {count} frames are stated, there are {times.shape}.")
    check_finite("times", times)
    if not (np.diff(times) > 0).all():
        at = int(np.argmin(np.diff(times) > 0)) + 1
        raise ValueError(f"the time of frame {at}, {times[at]:.6g} s, is not after {times[at - 1]:.6g} s.")


def check_rows(kind: str, count: int, data: Mapping[str, np.ndarray]) -> None:
    """Refuse data whose number of rows is not that of the points or cells of the mesh."""
    for name, values in data.items():
        if len(np.atleast_1d(values)) != count:
            raise ValueError(f"{kind} data {name} has shape {np.shape(values)}, the mesh {count} {kind}s.")


def check_finite(name: str, values: np.ndarray) -> None:
    """Refuse what are no numbers, or NaN, or infinite."""
    if values.dtype.kind not in "fiu":
        raise ValueError(f"{name} must be numbers, not {values.dtype}.")
    if not np.isfinite(values).all():
        raise ValueError(f"{name} holds {int((~np.isfinite(values)).sum())} values that are not finite.")


T = TypeVar("T")
ON_REQUEST = ("velocity", "stress")
"""Fields that only a scene with ``save.fields = "all"`` keeps."""
_COLUMNS = {"displacement": (3,), "velocity": (3,), "mises": (), "plastic_strain": (), "stress": (6,)}
_SHRINKS = 1032  # the most by which HDF5's compression makes data smaller
_WAITS = (0.02, 0.1, 0.5, 0.0)  # s before each further try while a writer has the file open


@dataclass(frozen=True, slots=True, repr=False)
class FieldFile:
    """Contents of a field file; the data of frames are read on demand.

    Parameters
    ----------
    path : Path
    times : (n_frames,) float64, s
    points : (n, 3) float64, m
        Reference coordinates.
    cells : (m, 8) int64
        Hexahedra in VTK node order.
    static : mapping of str to (m,) arrays
        Cell data without time.
    point_names, cell_names : tuple of str
        Fields with time.
    """

    path: Path
    times: np.ndarray
    points: np.ndarray
    cells: np.ndarray
    static: Mapping[str, np.ndarray]
    point_names: tuple[str, ...]
    cell_names: tuple[str, ...]

    def __repr__(self) -> str:
        names, end = (*self.point_names, *self.cell_names), 1e6 * self.times.max(initial=0.0)
        return (
            f"FieldFile({str(self.path)!r}: {len(self.cells)} cells, {len(self.times)} frames to "
            f"{end:.3g} us of {', '.join(names)})"
        )

    def point_data(self, name: str, frame: int) -> np.ndarray:
        """Return ``(n,)`` or ``(n, k) float32`` point data of one frame. Raises ResultError."""
        return self._rows("PointData", name, frame, self.point_names)

    def cell_data(self, name: str, frame: int) -> np.ndarray:
        """Return ``(m,)`` or ``(m, k) float32`` cell data of one frame. Raises ResultError."""
        return self._rows("CellData", name, frame, self.cell_names)

    def strain(self, frame: int) -> np.ndarray:
        """Return the strain tensors ``(m, 3, 3)`` at the cell centres, Green's: free of the rigid motion.

        Their axes are those of the barrier (t, b, n) at the start and turn with the body. Raises ResultError.
        """
        moved = self.points + self.point_data("displacement", frame)
        F = np.linalg.solve(jacobian(self.points, self.cells), jacobian(moved, self.cells))  # transposed
        tensors: np.ndarray = 0.5 * (F @ F.transpose(0, 2, 1) - np.eye(3))
        return tensors

    def probe(self, name: str, point: Sequence[float]) -> np.ndarray:
        """Return a field over `times`, ``(n_frames,)`` or ``(n_frames, k)``, at a point of the start, m.

        It is that of the nearest node, of the nearest cell's centre where the field is one of cells; the name
        "strain" gives the tensors ``(n_frames, 3, 3)`` of `strain`. Raises ResultError.
        """
        nodal = name in self.point_names
        places = self.points if nodal else self.points[self.cells].mean(axis=1)
        at = int(np.linalg.norm(places - np.asarray(point, float), axis=1).argmin())
        read = (
            self.strain if name == "strain" else partial(self.point_data if nodal else self.cell_data, name)
        )
        return np.array([read(frame)[at] for frame in range(len(self.times))])

    def grid(self, frame: int) -> pyvista.UnstructuredGrid:
        """Return the mesh of one frame as a PyVista grid, all stored fields on it.

        Points stand where they are at that time, m; ``displacement`` leads from their places at the start.

        Raises
        ------
        ResultError
            There is no such frame, or the file is damaged.
        """
        import pyvista

        moved = {name: self.point_data(name, frame) for name in self.point_names}
        places = self.points + moved.get("displacement", 0.0)
        grid = pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: self.cells}, places)
        grid.point_data.update(moved)
        grid.cell_data.update({name: self.cell_data(name, frame) for name in self.cell_names})
        grid.cell_data.update(dict(self.static))
        grid.field_data["time_s"] = [self.times[frame]]
        return grid

    def grids(self) -> Iterator[tuple[float, pyvista.UnstructuredGrid]]:
        """Yield the time, s, and the `grid` of every frame. Raises ResultError."""
        for frame, time in enumerate(self.times.tolist()):
            yield time, self.grid(frame)

    def _rows(self, kind: str, name: str, frame: int, names: tuple[str, ...]) -> np.ndarray:
        if name not in names:
            more = ' A run keeps it with save.fields = "all".' if name in ON_REQUEST else ""
            held = ", ".join(names) or "none"
            raise ResultError(f'{self.path}: holds no {kind} "{name}"; it holds {held}.{more}')
        if not 0 <= frame < len(self.times):
            raise ResultError(f"{self.path}: frame {frame} is asked for, it holds {len(self.times)}.")
        count = len(self.points if kind == "PointData" else self.cells)
        return _opened(self.path, lambda root: _slice(root, kind, name, frame, count))


def read_fields(path: str | Path) -> FieldFile:
    """Open a field file, also while a run still appends to it.

    Raises
    ------
    ResultError
        The file is missing, damaged, no field file, or not the one that its run wrote.
    """
    check_digest(Path(path))
    return _opened(Path(path), lambda root: _describe(Path(path), root))


def _describe(path: Path, root: h5py.Group) -> FieldFile:
    steps = int(root["Steps"].attrs["NSteps"])
    times, points = _rows(root["Steps"]["Values"], 0, max(steps, 0)), _rows(root["Points"])
    cells = _rows(root["Connectivity"]).reshape(-1, 8)
    check_times(times, steps)
    check_mesh(points, cells)
    moving = {name for name, rows in root["CellData"].items() if rows.maxshape[0] is None}
    static = {name: _rows(root["CellData"][name]) for name in root["CellData"] if name not in moving}
    check_rows("cell", len(cells), static)
    return FieldFile(path, times, points, cells, static, tuple(root["PointData"]), tuple(sorted(moving)))


def _rows(dataset: h5py.Dataset, start: int = 0, stop: int | None = None) -> np.ndarray:
    """Return rows of a dataset.

    Raises
    ------
    ValueError
        It states more bytes than the whole file can have, or holds what are no numbers.
    """
    first, last, _ = slice(start, stop).indices(dataset.shape[0])
    size = (last - first) * math.prod(dataset.shape[1:]) * dataset.dtype.itemsize
    if size > _SHRINKS * dataset.file.id.get_filesize():
        raise ValueError(f"{dataset.name} states {size} bytes, more than the file has")
    rows: np.ndarray = dataset[first:last]
    check_finite(dataset.name, rows)
    return rows


def _slice(root: h5py.Group, kind: str, name: str, frame: int, count: int) -> np.ndarray:
    """Return the rows of one frame; frames of ``count`` rows follow each other without gaps."""
    start = int(root["Steps"][f"{kind}Offsets"][name][frame])
    if start != frame * count:
        raise ValueError(f"{kind} {name} of frame {frame} is said to start at row {start}")
    rows = _rows(root[kind][name], start, start + count)
    if rows.shape != (count, *_COLUMNS.get(name, rows.shape[1:])):
        raise ValueError(f"{kind} {name} of frame {frame} has shape {rows.shape}, the mesh {count} rows")
    return rows


def _opened(path: Path, read: Callable[[h5py.Group], T]) -> T:
    if not path.is_file():
        raise ResultError(f"{path}: there is no such field file.")
    for wait in _WAITS:
        try:
            with h5py.File(path, "r") as file:
                return read(file["VTKHDF"])
        except BlockingIOError:
            clock.sleep(wait)  # a writer is at work on it
        except (OSError, LookupError, ValueError, RuntimeError, AttributeError, TypeError) as error:
            reason = str(error).rstrip(".")
            raise ResultError(f"{path}: not a readable field file ({reason}).") from error
    raise ResultError(f"{path}: another program keeps this file locked; try again when it is done.")
