"""Formats that VTK reads right: CGNS, EnSight, surfaces, and its own that are structured or in pieces."""

from pathlib import Path

import numpy as np

from meshes.arrays import IntArray
from meshes.errors import MeshError
from meshes.reading.stored import Elements, StoredMesh, counted

__all__ = ["ENDINGS", "by_vtk"]

SURFACES = (".stl", ".obj", ".ply")
ENDINGS = (".cgns", ".case", ".vts", ".vtr", ".vti", ".pvtu", ".pvts", ".pvtr", ".vtm", ".vtkhdf", *SURFACES)
# kinds of cells by VTK's numbers
KINDS = {10: "tetra", 12: "hexahedron", 13: "wedge", 14: "pyramid", 24: "tetra10", 25: "hexahedron20"}
KINDS |= {26: "wedge15", 27: "pyramid13", 29: "hexahedron27"}
VOXEL, VOXEL_CORNERS = 11, (0, 1, 3, 2, 4, 5, 7, 6)
FACES = {5: "triangle", 9: "quad"}
FLAT = {1: "vertex", 2: "vertex", 3: "line", 4: "line", 7: "polygon", 8: "pixel", 21: "line3"}
FLAT |= {22: "triangle6", 23: "quad8", 28: "quad9"}


def by_vtk(path: Path) -> StoredMesh:
    """Read a file by VTK; blocks are joined at nodes only if they share them in the file.

    Raises
    ------
    MeshError
        If VTK finds no cells, or cells that are not read.
    """
    import pyvista

    with pyvista.vtk_verbosity("off"):  # what is wrong with the cells is told by what follows
        found = pyvista.read(path)
        if isinstance(found, pyvista.MultiBlock):
            found = found.combine(merge_points=False)
    if not isinstance(found, pyvista.UnstructuredGrid):
        if not hasattr(found, "cast_to_unstructured_grid"):
            raise MeshError(f"holds a {type(found).__name__}, which is no mesh of cells.")
        found = found.cast_to_unstructured_grid()
    blocks: list[tuple[str, IntArray]] = []
    ignored, faces = [], Elements()
    for number, cells in found.cells_dict.items():
        kind, nodes = int(number), np.asarray(cells, np.int64)
        if kind == VOXEL:
            blocks.append(("hexahedron", nodes[:, VOXEL_CORNERS]))
        elif kind in KINDS:
            blocks.append((KINDS[kind], nodes))
        elif kind in FACES:
            for around in nodes.tolist():
                faces.add_face(FACES[kind], around)
        elif kind in FLAT:
            ignored.append(counted(len(nodes), f"cell of type {FLAT[kind]}"))
        else:
            raise MeshError(f"holds {counted(len(nodes), f'cell of VTK type {kind}')}, which are not read.")
    points = np.asarray(found.points, np.float64)
    return StoredMesh(points, tuple(blocks), {}, tuple(ignored), surfaces=faces.surfaces())
