"""Mesh files of the program's own, written and read by meshio."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from uuid import uuid4

import numpy as np
import numpy.typing as npt

from meshes.common import MeshError
from meshes.hexmesh import HexMesh
from meshes.reading.by_meshio import parsed

Data = Mapping[str, npt.NDArray[np.generic]]

_FORMATS = {".vtu": "vtu", ".msh": "gmsh"}


@dataclass(frozen=True, slots=True)
class MeshFile:
    """Content of a mesh file.

    Attributes
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64
        VTK hexahedron order.
    point_data, cell_data : dict of (n, ...) and (m, ...) arrays
    """

    points: npt.NDArray[np.float64]
    cells: npt.NDArray[np.int64]
    point_data: Data = field(default_factory=dict)
    cell_data: Data = field(default_factory=dict)


def write(
    path: str | Path, mesh: HexMesh, point_data: Data | None = None, cell_data: Data | None = None
) -> None:
    """Write a mesh with its levels, whole or not at all.

    Parameters
    ----------
    path : path
        Ends in .vtu (VTK) or .msh (Gmsh 4.1), both binary.
    mesh : HexMesh
    point_data, cell_data : mapping, optional
        Arrays by name, one row a node or a cell.

    Raises
    ------
    MeshError
        If the ending is unknown or an array has the wrong length.
    """
    import meshio

    target = Path(path)
    kind = _format(target)
    cells = {"level": mesh.level.astype(np.int64), **(cell_data or {})}
    _require_rows(target, point_data or {}, len(mesh.points), "nodes")
    _require_rows(target, cells, len(mesh.cells), "cells")
    if kind == "gmsh":
        cells |= {name: np.ones(len(mesh.cells), np.int32) for name in ("gmsh:physical", "gmsh:geometrical")}
    stored = meshio.Mesh(
        mesh.points,
        [("hexahedron", mesh.cells)],
        point_data=dict(point_data or {}),
        cell_data={name: [values] for name, values in cells.items()},
    )
    # written beside the target and moved into place, so that no reader meets half a file
    part = target.with_name(f".{target.stem}-{uuid4().hex}{target.suffix}")
    try:
        meshio.write(part, stored, file_format=kind, binary=True)
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)


def read(path: str | Path) -> MeshFile:
    """Read the hexahedra of a file.

    Raises
    ------
    MeshError
        If the file is missing, of an unknown ending, broken or without hexahedra.
    """
    source = Path(path)
    kind = _format(source)
    if not source.is_file():
        raise MeshError(f"{source}: no such file; give the path of a written mesh")
    try:
        stored, _ = parsed(source, kind)
    except Exception as error:
        # meshio passes on whatever its parsers raise on a broken file: XML, struct and index errors.
        raise MeshError(f"{source}: not a readable {kind} file ({error}); write it again") from error
    if "hexahedron" not in stored.cells_dict:
        raise MeshError(f"{source}: holds no hexahedra but {sorted(stored.cells_dict)}")
    named = {
        name: by_type["hexahedron"] for name, by_type in stored.cell_data_dict.items() if ":" not in name
    }
    cells = stored.cells_dict["hexahedron"].astype(np.int64)
    return MeshFile(stored.points.astype(np.float64), cells, dict(stored.point_data), named)


def _format(path: Path) -> str:
    if path.suffix not in _FORMATS:
        raise MeshError(f"{path}: ending {path.suffix!r} is unknown; use one of {sorted(_FORMATS)}")
    return _FORMATS[path.suffix]


def _require_rows(path: Path, data: Data, count: int, what: str) -> None:
    for name, values in data.items():
        if len(values) != count:
            raise MeshError(f"{path}: {name!r} has {len(values)} rows for {count} {what}")
