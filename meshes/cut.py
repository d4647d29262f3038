"""The nose of a rod by itself, with points that belong to no cell in place of what lies behind."""

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from meshes.common import FloatArray
from meshes.rod import RodMesh


def without_slices(rod: RodMesh, points: FloatArray) -> RodMesh:
    """Return the rod without what lies behind its interface, which stays as the only layer of ``body_nodes``.

    Parameters
    ----------
    rod : RodMesh
        With a nose.
    points : (k, 3) float64, m
        Appended as nodes that belong to no cell.
    """
    mesh = rod.mesh
    nose = np.ones(len(mesh.cells), dtype=bool)
    nose[rod.rest_cells] = False
    kept = np.unique(mesh.cells[nose])
    new = np.full(len(mesh.points), -1, dtype=np.int64)
    new[kept] = np.arange(len(kept))
    outer = (new[mesh.faces] >= 0).all(axis=1)
    cut = replace(
        mesh,
        points=np.concatenate([mesh.points[kept], points]),
        cells=new[mesh.cells[nose]],
        level=mesh.level[nose],
        tie=sp.csr_matrix(sp.block_diag([mesh.tie[kept][:, kept], sp.identity(len(points))])),
        faces=new[mesh.faces[outer]],
        face_tag=mesh.face_tag[outer],
        region=None if mesh.region is None else mesh.region[nose],
    )
    nothing = np.zeros((0, 0), dtype=np.int64)
    layer = new[rod.interface]
    return replace(
        rod,
        mesh=cut,
        body_nodes=layer[:, None],
        body_cells=nothing,
        interface=layer,
        rest_cells=nothing.ravel(),
    )
