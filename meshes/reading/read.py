"""The reader of a mesh file: by its ending, and by its content where an ending stands for several formats."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from meshes.common import MeshError, MissingReaderError
from meshes.reading.abaqus import abaqus
from meshes.reading.ansys import ansys
from meshes.reading.by_meshio import by_meshio
from meshes.reading.by_vtk import ENDINGS, by_vtk, vtu
from meshes.reading.exodus import exodus
from meshes.reading.gmsh import gmsh, is_gmsh
from meshes.reading.kratos import kratos
from meshes.reading.lsdyna import lsdyna
from meshes.reading.nastran import nastran
from meshes.reading.radioss import radioss
from meshes.reading.stored import StoredMesh
from meshes.reading.ucd import is_ucd, ucd
from meshes.reading.universal import universal

Reader = Callable[[Path], StoredMesh]
READERS: dict[str, Reader] = {
    ".inp": abaqus,
    ".bdf": nastran,
    ".nas": nastran,
    ".fem": nastran,
    ".dat": nastran,
    ".k": lsdyna,
    ".key": lsdyna,
    ".dyn": lsdyna,
    ".rad": radioss,
    ".cdb": ansys,
    ".e": exodus,
    ".ex2": exodus,
    ".exo": exodus,
    ".exii": exodus,
    ".g": exodus,
    ".gen": exodus,
    ".mdpa": kratos,
    ".avs": ucd,
    ".ucd": ucd,
    ".unv": universal,
    ".vtu": vtu,
}
# formats of other programs that are not read, and what makes of each a file that is
CONVERTED = {
    (".step", ".stp", ".iges", ".igs", ".brep", ".sat", ".x_t"): "is a drawing without a mesh. Mesh it, with "
    "Gmsh or Salome for example, and save the mesh as .msh or .med.",
    (".wrl", ".3mf"): "is a surface without cells inside. Save it as .stl, which is checked for gaps.",
    (".gz", ".zip", ".bz2", ".xz", ".7z"): "is packed. Unpack it first.",
    (".odb", ".cae", ".frd", ".op2", ".rst", ".d3plot", ".mph", ".sldprt", ".wbpj", ".hm", ".cas"): "holds a "
    "model or results of a program in its own form. Export the mesh there, as an input deck (.inp, .bdf, .k, "
    ".cdb, .unv) for example.",
    (
        ".foam",
        ".neu",
        ".gambit",
        ".ugrid",
        ".svg",
        ".wkt",
    ): "is not read. Convert it to .vtu, with ParaView or meshio for example.",
}
POINTER = "version https://git-lfs"
ENOUGH = 4000  # letters of a file that show its format


def stored_mesh(path: str | Path) -> StoredMesh:
    """Return what a mesh file of any format holds.

    Raises
    ------
    MeshError
        If the file is missing or broken, of a format that is not read, or holds what is not.
    MissingReaderError
        If a library that reads the format is not installed.
    """
    import meshio

    source = Path(path)
    name = source.name.lower()
    for endings, problem in CONVERTED.items():
        if name.endswith(endings):
            raise MeshError(problem)
    if not source.is_file():
        raise MeshError("there is no such file.")
    try:
        if reader := _reader(source):
            return _tried(reader, source)
        known = meshio.extension_to_filetypes
        fitting = [ending for ending in known if name.endswith(ending)]
        if not fitting:
            raise MeshError(
                f"ends in {source.suffix!r}, a format that is not read. Use .vtu, .msh, .inp, .bdf, .k, "
                ".cdb, .rad, .unv, .med or .e."
            )
        return by_meshio(source, known[fitting[-1]])
    except ImportError as error:
        raise MissingReaderError(str(error.name), source.suffix) from error


def extent(path: str | Path) -> float:
    """Return the largest distance along an axis between nodes of the cells of a file, nan where it has none.

    It is in the unit of the file, and known of cells that make no body, too.
    """
    try:
        stored = stored_mesh(path)
    except MeshError:
        return float("nan")
    named = np.concatenate([cells.ravel() for _, cells in stored.blocks] or [np.empty(0, np.int64)])
    points = stored.points[np.unique(named[(named >= 0) & (named < len(stored.points))])]
    return float(np.ptp(points, axis=0).max()) if len(points) else float("nan")


def _tried(reader: Reader, source: Path) -> StoredMesh:
    """Read a file; what the reader stumbles over is told as a broken file."""
    try:
        return reader(source)
    except (IndexError, KeyError, ValueError, ArithmeticError, OSError, TypeError, RuntimeError) as error:
        if isinstance(error, MeshError):
            raise
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise MeshError(f"is not readable as {reader.__name__} ({reason}). Write it again.") from error


def _reader(source: Path) -> Reader | None:
    """Return the reader of a file's format, None where it is one of meshio's."""
    with source.open("rb") as file:
        start = file.read(ENOUGH)
    text = start.decode("latin-1")
    if text.startswith(POINTER):
        raise MeshError("is a pointer of Git LFS, not the file itself. Fetch it: git lfs pull.")
    ending = source.suffix.lower()
    upper = text.upper()
    if is_gmsh(text) and ending == ".msh":
        return gmsh
    if ending in (".inp", ".dat", ".txt", ".msh"):
        if is_ucd(text):
            return ucd
        if "NBLOCK" in upper or "/PREP7" in upper:
            return ansys
        if "*KEYWORD" in upper:
            return lsdyna
        if ending in (".dat", ".msh") and not ("GRID" in upper or "BEGIN BULK" in upper or "CHEXA" in upper):
            return abaqus if "*NODE" in upper or "*HEADING" in upper else None
    return by_vtk if ending in ENDINGS else READERS.get(ending)
