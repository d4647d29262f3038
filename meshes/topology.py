"""Tables of the trilinear hexahedron in VTK order, and of its 2 x 2 x 2 split.

The 27 nodes of a split cell stand in the order 8 corners, 12 edge middles, 6 face centres, 1 centre.
"""

import numpy as np

from meshes.arrays import BoolArray, IntArray

__all__ = ["CHILDREN", "CHILD_KEEPS_FACE", "CORNERS", "EDGES", "FACES", "FACE_EDGES"]

#: (8, 3) corner places in the unit cube.
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

#: (6, 4) edges whose two ends both lie on each face.
FACE_EDGES: IntArray = np.nonzero([np.isin(EDGES, face).all(axis=1) for face in FACES])[1].reshape(6, 4)


def _children() -> IntArray:
    """(8, 8) columns of the 27 nodes that each child takes, in VTK order."""
    edges, faces = CORNERS[EDGES].sum(axis=1), CORNERS[FACES].sum(axis=1) // 2
    lattice = np.concatenate([2 * CORNERS, edges, faces, [[1, 1, 1]]])  # (27, 3) node places, 0 to 2
    places = CORNERS[:, None, :] + CORNERS[None, :, :]
    return np.asarray((places[:, :, None] == lattice).all(axis=-1).argmax(axis=-1))


CHILDREN: IntArray = _children()

#: (8, 6) True where face f of child c lies on face f of its parent.
CHILD_KEEPS_FACE: BoolArray = np.array(
    [[CORNERS[c, f // 2] == f % 2 for f in range(6)] for c in range(8)], dtype=np.bool_
)
