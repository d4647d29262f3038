"""The mesh of hexahedra that all builders make, its making from plain cells, and the tables of a cell."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from meshes.common import FloatArray, IntArray, MeshError

#: (8, 3) corner places in the unit cube, in VTK order.
CORNERS: IntArray = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=np.int64
)

#: (12, 2) corners at the ends of each edge.
EDGES: IntArray = np.array(
    [[0, 1], [3, 2], [4, 5], [7, 6], [0, 3], [1, 2], [4, 7], [5, 6], [0, 4], [1, 5], [3, 7], [2, 6]],
    dtype=np.int64,
)

#: (6, 4) corners of the faces x-, x+, y-, y+, z-, z+, turning about the outward normal.
FACES: IntArray = np.array(
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 3, 2, 1], [4, 5, 6, 7]], dtype=np.int64
)

#: (8, 3) corners reached from each corner along x, y and z.
NEIGHBOURS: IntArray = (
    ((CORNERS[:, None] ^ np.eye(3, dtype=np.int64))[:, :, None] == CORNERS).all(axis=-1).argmax(axis=-1)
)

#: Corners of a cell that is inside out, such as a mirror image, in the order in which it is not.
TURNED = [4, 5, 6, 7, 0, 1, 2, 3]

SKIN = 0
SYMMETRY = 1
OUTER = 2


@dataclass(frozen=True, slots=True)
class HexMesh:
    """A mesh of trilinear hexahedra, locally refined with ties at the level changes.

    Attributes
    ----------
    points : (n, 3) float64, m
        All nodes, hanging ones included.
    cells : (m, 8) int64
        Nodes in VTK hexahedron order, positive volume.
    level : (m,) int8
        Refinement level, 0 for a base cell.
    tie : (n, n) csr_matrix
        Row i holds the weights of node i in the free nodes (identity for a free node); rows sum to 1.
    faces : (k, 4) int64
        Outer faces, outward normal by the right-hand rule.
    face_tag : (k,) int8
        SKIN, SYMMETRY (plane y = b = 0) or OUTER (artificial boundary of a block).
    region : (m,) int64 or None
        Number of the cell of a user's mesh in which each lies; None: it is not one.
    """

    points: FloatArray
    cells: IntArray
    level: npt.NDArray[np.int8]
    tie: sp.csr_matrix
    faces: IntArray
    face_tag: npt.NDArray[np.int8]
    region: IntArray | None = None

    @property
    def is_hanging(self) -> npt.NDArray[np.bool_]:
        """(n,) True where a node is tied to others."""
        return np.asarray(self.tie.diagonal() == 0.0)

    @property
    def free_skin(self) -> IntArray:
        """(k,) nodes of the SKIN that are not tied to others."""
        skin = np.unique(self.faces_with(SKIN))
        return np.asarray(skin[~self.is_hanging[skin]])

    @property
    def finest(self) -> npt.NDArray[np.bool_]:
        """(m,) bool: cells split most often, all where none is split."""
        return np.asarray(self.level == self.level.max())

    def faces_with(self, tag: int) -> IntArray:
        """(k', 4) outer faces of one tag."""
        return np.asarray(self.faces[self.face_tag == tag])


def face_keys(quads: IntArray) -> IntArray:
    """(k,) keys of quadrilaterals from lowest and opposite node: the same for every rotation and sense."""
    first = quads.argmin(axis=1)
    rows = np.arange(len(quads))
    return np.asarray((quads[rows, first] << 31) | quads[rows, (first + 2) % 4])


def outer_faces(cells: IntArray) -> tuple[IntArray, IntArray]:
    """Cell and local face of every face that only one cell has.

    Returns
    -------
    owner, local : (k,) int64
    """
    keys = face_keys(cells[:, FACES].reshape(-1, 4))
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    place = np.sort(first[count == 1])
    return place // 6, place % 6


def outer_quads(cells: IntArray) -> IntArray:
    """(k, 4) nodes of the faces that only one cell has, as `FACES` turn."""
    owner, local = outer_faces(cells)
    return np.asarray(cells[owner[:, None], FACES[local]])


def quad_normals(corners: FloatArray) -> FloatArray:
    """(k, 3) normals of quads with corners (k, 4, 3), each as long as twice its area."""
    return np.asarray(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]))


def match_faces(mesh: HexMesh) -> npt.NDArray[np.int8]:
    """(m, 6) tag of every face of every cell, -1 inside."""
    keys = face_keys(mesh.cells[:, FACES].reshape(-1, 4))
    known = face_keys(mesh.faces)
    order = np.argsort(known)
    at = np.minimum(np.searchsorted(known[order], keys), len(known) - 1)
    outer = known[order][at] == keys
    return np.where(outer, mesh.face_tag[order][at], -1).astype(np.int8).reshape(-1, 6)


def owners(mesh: HexMesh) -> IntArray:
    """(k,) the cell of each outer face."""
    keys = face_keys(mesh.cells[:, FACES].reshape(-1, 4))
    order = np.argsort(keys)
    return np.asarray(order[np.searchsorted(keys[order], face_keys(mesh.faces))] // 6)


def half_body_tags(corners: FloatArray) -> IntArray:
    """(k,) tags of outer faces with corners (k, 4, 3) of a half body: SYMMETRY at y = 0, SKIN elsewhere."""
    return np.where((corners[:, :, 1] == 0.0).all(axis=1), SYMMETRY, SKIN)


def from_cells(points: FloatArray, cells: IntArray, tag: Callable[[FloatArray], IntArray]) -> HexMesh:
    """Make an unrefined mesh with its outer faces and their tags.

    Parameters
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64
    tag : callable
        From the corners of the outer faces, (k, 4, 3), to their tags, (k,).

    Raises
    ------
    MeshError
        If a cell names a node that does not exist.
    """
    if cells.min() < 0 or cells.max() >= len(points):
        raise MeshError(f"cells name node {cells.max()} but there are {len(points)}: check the numbering")
    quads = outer_quads(cells)
    tags = np.asarray(tag(points[quads]), dtype=np.int8)
    tie = sp.identity(len(points), format="csr")
    return HexMesh(points, cells, np.zeros(len(cells), np.int8), sp.csr_matrix(tie), quads, tags)
