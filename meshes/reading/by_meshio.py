"""Formats that meshio reads right: VTK, MED, Medit, XDMF and others."""

from collections import Counter
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from meshes.common import IntArray, MeshError
from meshes.reading.stored import NODES, Elements, StoredMesh, counted

VOXEL = (0, 1, 3, 2, 4, 5, 7, 6)  # corners of VTK's voxel in the order of a hexahedron
FACES = ("triangle", "quad")
FLAT = ("vertex", "line", "polygon")  # cells of points, lines and surfaces of any number of corners
WARNED = "what meshio warns of: "
VALUES = 50  # of a whole number of cells, up to which it counts as a mark of regions


def with_all_kinds() -> Any:
    """Return meshio with the dimension of kinds of cells that it reads, but whose dimension it lacks."""
    import meshio
    from meshio._mesh import topological_dimension

    for kind in NODES:
        topological_dimension.setdefault(kind, 3)
    return meshio


def parsed(path: Path, kind: str) -> tuple[Any, str]:
    """Return meshio's mesh of a file, and what it warns of; not by `meshio.read`, which ends the process.

    It writes what it skips of a file to the terminal.
    """
    with redirect_stdout(StringIO()) as out, redirect_stderr(out):
        mesh = getattr(with_all_kinds(), kind.removesuffix("-xml")).read(path)
    return mesh, " ".join(out.getvalue().split())


def by_meshio(path: Path, kinds: list[str]) -> StoredMesh:
    """Read a file in the first of meshio's formats that fits.

    Raises
    ------
    MeshError
        If none fits, or it holds volume cells that are not read.
    """
    refused = []
    for kind in kinds:
        try:
            stored, warned = parsed(path, kind)
        except ImportError:
            raise
        except Exception as error:
            # meshio passes on whatever its parsers raise on a broken file: XML, struct and index errors
            refused.append(f"{kind}: {' '.join(str(error).split())[:80] or type(error).__name__}")
        else:
            found = as_stored(stored)
            told = (f"{WARNED}{warned[:80]}",) if warned else ()
            return replace(found, ignored=(*found.ignored, *told))
    raise MeshError(f"is not readable ({'; '.join(refused)}). Write it again, as .vtu for example.")


def as_stored(mesh: Any) -> StoredMesh:
    """Return what a mesh of meshio holds.

    Raises
    ------
    MeshError
        If it holds volume cells that are not read.
    """
    blocks, left_out = [], Counter[str]()
    at, faces_at = list[IntArray](), list[IntArray]()  # numbers of the cells, or of the faces, of each block
    first, found = 0, Elements()
    for block in mesh.cells:
        kind, cells = block.type, np.asarray(block.data)
        if kind == "voxel":
            kind, cells = "hexahedron", cells[:, VOXEL]
        begin, first_face = first, len(found.faces)
        if kind.startswith(FACES):
            for nodes in cells.tolist():
                found.add_face(kind, nodes)
        elif kind.startswith(FLAT):
            left_out[kind] += len(cells)
        elif kind in NODES:
            blocks.append((kind, cells.astype(np.int64)))
            first += len(cells)
        else:
            raise MeshError(f"holds {counted(len(cells), f'cell of type {kind}')}, which are not read.")
        at.append(np.arange(begin, first))
        faces_at.append(np.arange(first_face, len(found.faces)))
    told = tuple(counted(count, f"cell of type {kind}") for kind, count in left_out.items())
    points = np.asarray(mesh.points, np.float64)
    # the named sets of nodes, of MED its groups of nodes
    sets = {name: np.asarray(nodes, np.int64) for name, nodes in mesh.point_sets.items()}
    for family, names in (getattr(mesh, "point_tags", None) or {}).items():
        here = np.flatnonzero(np.asarray(mesh.point_data.get("point_tags", [])) == family)
        for name in names:
            sets[name] = np.concatenate([sets[name], here]) if name in sets else here
    surfaces = replace(found.surfaces(), sets=_sets(mesh, faces_at), nodes=sets)
    return StoredMesh(points, tuple(blocks), _sets(mesh, at), told, surfaces=surfaces)


def _sets(mesh: Any, at: list[IntArray]) -> dict[str, IntArray]:
    """Return named sets, and regions by the whole numbers that cells are marked with.

    The numbers ``at`` which the cells of each block count are none for those of another dimension.
    """
    sets: dict[str, list[IntArray]] = {}
    for name, members in mesh.cell_sets.items():
        for places, chosen in zip(at, members, strict=False):
            if chosen is not None and len(places):
                sets.setdefault(name, []).append(places[np.asarray(chosen, np.int64)])
    tags = getattr(mesh, "cell_tags", None) or {}  # the groups of MED that a family of cells belongs to
    for key, values in mesh.cell_data.items():
        for places, marks in zip(at, values, strict=False):
            marks = np.asarray(marks)
            if not len(places) or marks.ndim != 1 or marks.dtype.kind not in "iu":
                continue
            for mark in np.unique(marks)[: VALUES + 1]:
                groups = tags.get(int(mark), ()) if key == "cell_tags" else ()
                for one in {f"{key.rpartition(':')[2]} {mark}", *groups}:
                    sets.setdefault(one, []).append(places[marks == mark])
    return {name: np.unique(np.concatenate(parts)) for name, parts in sets.items()}
