"""Writer of fields over time: frames are appended one by one to a file that others can read meanwhile."""

from __future__ import annotations

import shutil
import time as clock
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import atomic_path
from fem_impact.files.fields_check import check_mesh, check_rows
from fem_impact.files.fields_layout import add_frame, write_mesh
from fem_impact.files.fields_read import read_fields

_WAITS = (0.01, 0.03, 0.1, 0.2)  # s before each further try while a reader has the file open


class FieldWriter:
    """One temporal VTKHDF file: the mesh once, then frames.

    Each frame opens the file, appends and closes it, so that PyVista and ParaView can read between
    frames. A frame that cannot be written is dropped with a warning; the run goes on.

    Parameters
    ----------
    path : path
        The file (``.vtkhdf``); an older one is replaced.
    points : (n, 3) float64, m
        Reference coordinates in the barrier frame (t, b, n).
    cells : (m, 8) int
        Hexahedra in VTK node order.
    cell_data : mapping of str to (m,) arrays, optional
        Cell data that do not change, such as ``body``.
    go_on : bool
        Keep the frames of an older file; set `frames` to drop those written after a checkpoint.

    Raises
    ------
    OutputPathError
        The file cannot be made at all.
    ValueError
        A mesh or a field has the wrong shape.
    """

    def __init__(
        self,
        path: str | Path,
        points: np.ndarray,
        cells: np.ndarray,
        cell_data: Mapping[str, np.ndarray] | None = None,
        go_on: bool = False,
    ) -> None:
        static = dict(cell_data or {})
        check_mesh(np.asarray(points), np.asarray(cells))
        check_rows("cell", len(cells), static)
        self.path = Path(path)
        self._counts = (len(points), len(cells))
        self._shapes: dict[str, tuple[int, ...]] = {}
        self._warnings: list[str] = []
        self._begun = False
        if not go_on:
            with atomic_path(self.path) as draft:
                write_mesh(draft, points, cells, static)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on the frames that were dropped."""
        return tuple(self._warnings)

    @property
    def frames(self) -> int:
        """Number of frames in the file."""
        return len(read_fields(self.path).times)

    @frames.setter
    def frames(self, count: int) -> None:
        """Drop the frames after a checkpoint. Raises ResultError, or ValueError when some are missing."""
        present = self.frames
        if present < count:
            raise ValueError(f"{self.path.name} holds {present} frames of the {int(count)} written before.")
        import h5py

        with h5py.File(self.path, "r+") as file:
            file["VTKHDF"]["Steps"].attrs["NSteps"] = int(count)

    def append(
        self,
        time: float,
        point_data: Mapping[str, np.ndarray],
        cell_data: Mapping[str, np.ndarray] | None = None,
    ) -> bool:
        """Add one frame; return whether it was written.

        Parameters
        ----------
        time : float, s
        point_data : mapping of str to (n,) or (n, k) arrays
            SI values at the points: ``displacement`` (n, 3) m, ``velocity`` (n, 3) m/s.
        cell_data : mapping of str to (m,) or (m, k) arrays
            SI values in the cells: ``mises`` (m,) Pa, ``plastic_strain`` (m,).

        Raises
        ------
        ValueError
            A field has another length or other fields are given than in the first frame.
        """
        cells = dict(cell_data or {})
        self._check_fields(point_data, cells)
        trouble = self._try(time, point_data, cells)
        for wait in _WAITS:
            if not trouble:
                break
            clock.sleep(wait)
            trouble = self._try(time, point_data, cells)
        if trouble:
            self._warnings.append(f"{self.path.name}: the frame at {time:.6g} s was dropped ({trouble}).")
        return not trouble

    def _try(self, time: float, points: Mapping[str, np.ndarray], cells: Mapping[str, np.ndarray]) -> str:
        import h5py

        size = sum(np.asarray(values).size for values in (*points.values(), *cells.values())) * 4
        try:
            # a full disk can damage an HDF5 file for good, so the free space is checked first
            if shutil.disk_usage(self.path.parent).free < 2 * size + 2**20:
                return "the disk is full"
            with self._place() as place, h5py.File(place, "r+") as file:
                add_frame(file["VTKHDF"], time, points, cells)
            self._begun = True
        except (OSError, RuntimeError, KeyError, OutputPathError) as error:
            return str(error) or type(error).__name__
        return ""

    @contextmanager
    def _place(self) -> Iterator[Path]:
        """Yield the file; for the first frame, which creates the data sets, a copy that replaces it."""
        if self._begun:
            yield self.path
            return
        with atomic_path(self.path) as draft:
            shutil.copyfile(self.path, draft)
            yield draft

    def _check_fields(self, points: Mapping[str, np.ndarray], cells: Mapping[str, np.ndarray]) -> None:
        check_rows("point", self._counts[0], points)
        check_rows("cell", self._counts[1], cells)
        shapes = {name: np.shape(values) for name, values in (*points.items(), *cells.items())}
        self._shapes = self._shapes or shapes
        if shapes != self._shapes:
            raise ValueError(f"the frame holds {shapes}, the first one {self._shapes}.")
