"""Layout of a temporal VTKHDF file with one mesh for all times (VTK file formats, VTKHDF 2.2)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import h5py


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
    import h5py

    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 2])
        root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        root["Points"] = np.asarray(points, dtype=np.float64)
        root["Connectivity"] = np.asarray(cells, dtype=np.int64).ravel()
        root["Offsets"] = np.arange(len(cells) + 1, dtype=np.int64) * 8
        root["Types"] = np.full(len(cells), VTK_HEXAHEDRON, dtype=np.uint8)
        for name, count in (
            ("Points", len(points)),
            ("Cells", len(cells)),
            ("ConnectivityIds", 8 * len(cells)),
        ):
            root[f"NumberOf{name}"] = np.array([count], dtype=np.int64)
        _write_steps(root, static)


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
            _put_rows(root[kind], name, at, np.asarray(values, dtype=np.float32))
            _put_step(steps[f"{kind}Offsets"], name, at, at * len(values))
    for name in root["CellData"]:
        if name not in cell_data:
            _put_step(steps["CellDataOffsets"], name, at, 0)
    for name in STEP_ROWS:
        _put_step(steps, name, at, 1 if name == "NumberOfParts" else 0)
    _put_step(steps, "Values", at, time)
    root.file.flush()  # a run killed here must not leave a counted frame without its data
    steps.attrs["NSteps"] = at + 1


def _write_steps(root: h5py.Group, static: Mapping[str, np.ndarray]) -> None:
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = 0
    _series(steps, "Values", np.float64)
    for name in STEP_ROWS:
        _series(steps, name, np.int64, columns=1 if name.startswith("C") else 0)
    for kind in ("PointData", "CellData"):
        root.create_group(kind)
        steps.create_group(f"{kind}Offsets")
    for name, values in static.items():
        root["CellData"][name] = np.asarray(values)
        _series(steps["CellDataOffsets"], name, np.int64)


def _series(group: h5py.Group, name: str, dtype: Any, columns: int = 0) -> h5py.Dataset:
    tail = (columns,) if columns else ()
    return group.create_dataset(
        name, shape=(0, *tail), maxshape=(None, *tail), chunks=(_CHUNK_STEPS, *tail), dtype=dtype
    )


def _put_step(group: h5py.Group, name: str, at: int, value: float) -> None:
    series = group[name] if name in group else _series(group, name, np.int64)
    series.resize(at + 1, axis=0)
    series[at] = value


def _put_rows(group: h5py.Group, name: str, at: int, values: np.ndarray) -> None:
    if name not in group:
        free = (None, *values.shape[1:])
        piece = (_CHUNK_FRAMES * len(values), *values.shape[1:])
        group.create_dataset(name, shape=(0, *values.shape[1:]), maxshape=free, chunks=piece, dtype="f4")
    rows = group[name]
    rows.resize((at + 1) * len(values), axis=0)
    rows[at * len(values) :] = values
