"""Fields over time, written frame by frame to a VTKHDF 2.2 file that others can read meanwhile."""

import shutil
import time as clock
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import atomic_path
from fem_impact.files.fields import check_mesh, check_rows, read_fields

VTK_HEXAHEDRON = 12
STEP_ROWS = ("PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets", "NumberOfParts")
_CHUNK_STEPS = 256
# Frames per HDF5 chunk. The B-tree node that indexes chunks holds 64 of them and is split in several writes
# when it is full. Up to 64 * 16 = 1024 frames, a writer killed at any moment leaves all
# earlier frames readable.
_CHUNK_FRAMES = 16


def write_mesh(path: Path, points: np.ndarray, cells: np.ndarray, static: Mapping[str, np.ndarray]) -> None:
    """Write the mesh, the cell data that never change and an empty list of times.

    Parameters
    ----------
    path : Path
        New file.
    points : (n, 3) float64, m
        Reference coordinates.
    cells : (m, 8) int
        Hexahedra in VTK order.
    static : mapping of str to (m,) or (m, k) arrays
        Cell data without time.
    """
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 2])
        root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        root["Points"] = np.asarray(points, dtype=np.float64)
        root["Connectivity"] = np.asarray(cells, dtype=np.int64).ravel()
        root["Offsets"] = np.arange(len(cells) + 1, dtype=np.int64) * 8
        root["Types"] = np.full(len(cells), VTK_HEXAHEDRON, dtype=np.uint8)
        counts = {"Points": len(points), "Cells": len(cells), "ConnectivityIds": 8 * len(cells)}
        for name, count in counts.items():
            root[f"NumberOf{name}"] = np.array([count], dtype=np.int64)
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = 0
        _series(steps, "Values", np.float64)
        for name in STEP_ROWS:
            _series(steps, name, np.int64, tail=(1,) if name.startswith("C") else ())
        for kind in ("PointData", "CellData"):
            root.create_group(kind)
            steps.create_group(f"{kind}Offsets")
        for name, values in static.items():
            root["CellData"][name] = np.asarray(values)
            _series(steps["CellDataOffsets"], name, np.int64)


def add_frame(
    root: h5py.Group, time: float, point_data: Mapping[str, np.ndarray], cell_data: Mapping[str, np.ndarray]
) -> None:
    """Append one frame; the count of steps is raised last, so an interrupted frame is not counted.

    Parameters
    ----------
    root : h5py.Group
        The group VTKHDF of a file open for writing.
    time : float, s
    point_data, cell_data : mapping of str to (n,), (n, k) or (m,), (m, k) arrays
        Stored in single precision.
    """
    steps, at = root["Steps"], int(root["Steps"].attrs["NSteps"])
    for kind, data in (("PointData", point_data), ("CellData", cell_data)):
        for name, values in data.items():
            new, group = np.asarray(values, dtype=np.float32), root[kind]
            if name not in group:
                _series(group, name, np.float32, new.shape[1:], _CHUNK_FRAMES * len(new))
            rows = group[name]
            rows.resize((at + 1) * len(new), axis=0)
            rows[at * len(new) :] = new
            _put_step(steps[f"{kind}Offsets"], name, at, at * len(new))
    for name in root["CellData"]:
        if name not in cell_data:
            _put_step(steps["CellDataOffsets"], name, at, 0)
    for name in STEP_ROWS:
        _put_step(steps, name, at, 1 if name == "NumberOfParts" else 0)
    _put_step(steps, "Values", at, time)
    root.file.flush()  # a run killed here must not leave a counted frame without its data
    steps.attrs["NSteps"] = at + 1


def _series(
    group: h5py.Group, name: str, dtype: Any, tail: tuple[int, ...] = (), piece: int = _CHUNK_STEPS
) -> h5py.Dataset:
    """Make a data set that grows by rows of the shape ``tail``, ``piece`` of them in a chunk."""
    return group.create_dataset(name, (0, *tail), dtype, maxshape=(None, *tail), chunks=(piece, *tail))


def _put_step(group: h5py.Group, name: str, at: int, value: float) -> None:
    series = group[name] if name in group else _series(group, name, np.int64)
    series.resize(at + 1, axis=0)
    series[at] = value


def _packed(new: h5py.File, name: str, item: h5py.Group | h5py.Dataset) -> None:
    """Copy a group or a data set of a finished file, a data set compressed, frame by frame."""
    if hasattr(item, "keys"):
        made = new.create_group(name)
    else:
        grows = item.maxshape[0] is None and item.dtype == np.float32
        piece = (item.chunks[0] // _CHUNK_FRAMES, *item.shape[1:]) if grows else item.chunks or True
        made = new.create_dataset(
            name, item.shape, item.dtype, chunks=piece, maxshape=item.maxshape, compression=1, shuffle=True
        )
        for at in range(0, len(item), made.chunks[0]):
            made[at : at + made.chunks[0]] = item[at : at + made.chunks[0]]
    made.attrs.update(item.attrs)


_WAITS = (0.0, 0.01, 0.03, 0.1, 0.2)  # s before each try while a reader has the file open


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
        with h5py.File(self.path, "r+") as file:
            file["VTKHDF"]["Steps"].attrs["NSteps"] = int(count)

    def pack(self) -> None:
        """Write the finished file anew, compressed without loss, to some four tenths of its size.

        Not while frames come: a piece that is compressed again at each frame would not survive a kill.
        """
        try:
            with atomic_path(self.path) as draft, h5py.File(self.path) as old, h5py.File(draft, "w") as new:
                old.visititems(lambda name, item: _packed(new, name, item))
        except (OSError, OutputPathError) as error:
            self._warnings.append(f"{self.path.name}: was not compressed ({error}).")

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
        check_rows("point", self._counts[0], point_data)
        check_rows("cell", self._counts[1], cells)
        shapes = {name: np.shape(values) for name, values in (*point_data.items(), *cells.items())}
        self._shapes = self._shapes or shapes
        if shapes != self._shapes:
            raise ValueError(f"the frame holds {shapes}, the first one {self._shapes}.")
        for wait in _WAITS:
            clock.sleep(wait)
            trouble = self._try(time, point_data, cells)
            if not trouble:
                return True
        self._warnings.append(f"{self.path.name}: the frame at {time:.6g} s was dropped ({trouble}).")
        return False

    def _try(self, time: float, points: Mapping[str, np.ndarray], cells: Mapping[str, np.ndarray]) -> str:
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
