"""Meshes and stored fields as objects of scikit-fem, meshio and PyVista, corners in the order of each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fem_impact.errors import UsageError
from fem_impact.fem.forms import hex_mesh
from fem_impact.files.fields import FieldFile
from meshes import HexMesh

if TYPE_CHECKING:
    import meshio
    import pyvista
    from skfem import MeshHex


def _require_cells(mesh: object) -> None:
    """Refuse what is no mesh, such as a scene (UsageError)."""
    if not (hasattr(mesh, "cells") and hasattr(mesh, "points")):
        remedy = 'Give read_fields("results/ID/fields.vtkhdf") of a run, or a mesh of the package meshes.'
        raise UsageError("has no cells.", key="mesh=", value=type(mesh).__name__, remedy=remedy)


def to_skfem(mesh: HexMesh | FieldFile) -> MeshHex:
    """Return a mesh of scikit-fem with the same numbers of nodes.

    Its corners are in another order than here: cells handed over as they are give wrong volumes in silence.
    Nodes that hang on an edge or face stay free; ``HexMesh.tie`` holds their weights.

    Examples
    --------
    >>> from meshes import block
    >>> mesh = to_skfem(block((0.0, 0.0, -3.0), (2.0, 1.0, 0.0), 0.5))
    >>> from skfem import Basis, ElementHex1
    >>> round(float(Basis(mesh, ElementHex1()).dx.sum()), 12)
    6.0
    """
    _require_cells(mesh)
    return hex_mesh(np.asarray(mesh.points, np.float64), np.asarray(mesh.cells, np.int64))


def to_meshio(mesh: HexMesh | FieldFile, frame: int | None = None) -> meshio.Mesh:
    """Return a mesh of meshio, of stored fields with those of one ``frame`` on it.

    Points of a frame stand where they are at its time, m. ``mesh.write("NAME.vtu")`` writes any format of
    meshio.

    Raises
    ------
    ResultError
        There is no such frame, or the file is damaged.
    """
    import meshio

    _require_cells(mesh)
    points, at_points, in_cells = mesh.points, {}, {}
    if isinstance(mesh, FieldFile) and frame is not None:
        at_points = {name: mesh.point_data(name, frame) for name in mesh.point_names}
        in_cells = {name: [mesh.cell_data(name, frame)] for name in mesh.cell_names}
        in_cells |= {name: [np.asarray(values)] for name, values in mesh.static.items()}
        points = points + at_points.get("displacement", 0.0)
    return meshio.Mesh(points, [("hexahedron", mesh.cells)], point_data=at_points, cell_data=in_cells)


def to_pyvista(mesh: HexMesh | FieldFile, frame: int | None = None) -> pyvista.UnstructuredGrid:
    """Return a grid of PyVista, of stored fields with those of one ``frame`` on it, as `FieldFile.grid`.

    Raises
    ------
    ResultError
        There is no such frame, or the file is damaged.
    """
    import pyvista

    _require_cells(mesh)
    if isinstance(mesh, FieldFile) and frame is not None:
        return mesh.grid(frame)
    return pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: mesh.cells}, mesh.points)
