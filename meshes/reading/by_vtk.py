"""Formats that VTK reads right: CGNS, EnSight, surfaces, and its own."""

from pathlib import Path

from meshes.common import MeshError
from meshes.reading.by_meshio import WARNED, as_stored, by_meshio, with_all_kinds
from meshes.reading.stored import StoredMesh

SURFACES = (".stl", ".obj", ".ply")
PIECES = (".vtk", ".vts", ".vtr", ".vti", ".pvtu", ".pvts", ".pvtr", ".vtm", ".vtkhdf")
ENDINGS = (".cgns", ".case", *PIECES, *SURFACES)


def by_vtk(path: Path) -> StoredMesh:
    """Read a file by VTK; blocks are joined at nodes only if they share them in the file.

    Pieces of one mesh, which parallel programs write apart, are joined where their nodes are equal.

    Raises
    ------
    MeshError
        If VTK finds no cells, or cells that are not read.
    """
    import pyvista

    with_all_kinds()
    with pyvista.vtk_verbosity("off"):  # what is wrong with the cells is told by what follows
        found = pyvista.read(path)
        if isinstance(found, pyvista.MultiBlock):
            found = found.combine(merge_points=False)
        if path.suffix.lower().startswith(".pvt") and isinstance(found, pyvista.UnstructuredGrid):
            found = found.clean(tolerance=0.0, remove_unused_points=False)
    if not isinstance(found, pyvista.DataSet):
        raise MeshError(f"holds a {type(found).__name__}, which is no mesh of cells.")
    return as_stored(pyvista.to_meshio(found))


def vtu(path: Path) -> StoredMesh:
    """Read a file by meshio, which refuses a damaged one, over which VTK may end the process.

    VTK reads one with cells that meshio skips, such as voxels.

    Raises
    ------
    MeshError
        As `by_vtk`, or if it is damaged.
    """
    found = by_meshio(path, ["vtu"])
    return by_vtk(path) if any(told.startswith(WARNED) for told in found.ignored) else found
