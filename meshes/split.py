"""Splitting cells 2 x 2 x 2 with shared nodes, and the places of the new nodes.

The 27 nodes of a split cell stand in the order 8 corners, 12 edge middles, 6 face centres, 1 centre.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from meshes.common import BoolArray, FloatArray, IntArray
from meshes.hexmesh import CORNERS, EDGES, FACES, SKIN, HexMesh, face_keys, match_faces

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

#: Moves points (k, 3), m, onto the exact surface, each in the middle of its parents (k, c, 3), m.
Snap = Callable[[FloatArray, FloatArray], FloatArray]


def edge_keys(pairs: IntArray) -> IntArray:
    """(...) keys of edges from their two nodes, the same for both senses."""
    return np.asarray((pairs.min(axis=-1) << 31) | pairs.max(axis=-1))


class KeyMap:
    """Node by edge or face key; only added to, so that later splits reuse nodes."""

    def __init__(self) -> None:
        self.keys: IntArray = np.empty(0, np.int64)
        self.nodes: IntArray = np.empty(0, np.int64)

    def find(self, keys: IntArray) -> IntArray:
        """Nodes of keys of any shape, -1 where unknown."""
        if not len(self.keys):
            return np.full(keys.shape, -1, np.int64)
        at = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        return np.where(self.keys[at] == keys, self.nodes[at], -1)

    def add(self, keys: IntArray, start: int) -> IntArray:
        """Give the unknown keys numbers from `start`; return the flat index at which each first stands."""
        fresh, first = np.unique(keys, return_index=True)
        new = self.find(fresh) < 0
        fresh, first = fresh[new], first[new]
        keys_all = np.concatenate([self.keys, fresh])
        nodes_all = np.concatenate([self.nodes, start + np.arange(len(fresh))])
        order = np.argsort(keys_all, kind="stable")
        self.keys, self.nodes = keys_all[order], nodes_all[order]
        return first


@dataclass(frozen=True, slots=True)
class Birth:
    """New nodes of one kind, made together: consecutive numbers from `start`, and their parents.

    Attributes
    ----------
    start : int
    corners : (k, c) int64
        2 ends of an edge, 4 corners of a face, 8 corners of a cell.
    mids : (k, e) int64
        Middles of the edges: 0, 4, 12.
    centres : (k, f) int64
        Centres of the faces: 0, 0, 6.
    """

    start: int
    corners: IntArray
    mids: IntArray
    centres: IntArray

    @property
    def nodes(self) -> IntArray:
        """(k,) numbers of the new nodes."""
        return self.start + np.arange(len(self.corners))

    def middle(self, points: FloatArray) -> FloatArray:
        """(k, 3) transfinite middles: the curvature of the surface fades into the inside."""
        corner = points[self.corners].mean(axis=1)
        if not self.mids.shape[1]:
            return np.asarray(corner)
        mid = points[self.mids].mean(axis=1)
        if not self.centres.shape[1]:
            return np.asarray(2.0 * mid - corner)
        return np.asarray(3.0 * points[self.centres].mean(axis=1) - 3.0 * mid + corner)


@dataclass(slots=True)
class Forest:
    """The mesh while it is refined: its unsplit cells (leaves), and all edges and faces that were split.

    ``root`` (m,) is the cell of the mesh in which each leaf lies.
    """

    points: FloatArray
    cells: IntArray
    level: IntArray
    tags: npt.NDArray[np.int8]
    frozen: BoolArray
    root: IntArray
    snap: Snap | None
    edges: KeyMap = field(default_factory=KeyMap)
    quads: KeyMap = field(default_factory=KeyMap)
    births: list[Birth] = field(default_factory=list)

    @classmethod
    def plant(cls, mesh: HexMesh, snap: Snap | None, frozen: BoolArray) -> "Forest":
        """Start from an unrefined mesh."""
        tags = match_faces(mesh)
        level, root = mesh.level.astype(np.int64), np.arange(len(mesh.cells))
        return cls(mesh.points.copy(), mesh.cells, level, tags, frozen, root, snap)

    def known_mids(self) -> IntArray:
        """(m, 18) nodes in the middle of each leaf's 12 edges and 6 faces, -1 where there is none yet."""
        mids = self.edges.find(edge_keys(self.cells[:, EDGES]))
        faces = self.cells[:, FACES]
        keys = face_keys(faces.reshape(-1, 4)).reshape(len(self.cells), 6)
        return np.concatenate([mids, self.quads.find(keys)], axis=1)

    def split(self, marked: BoolArray) -> None:
        """Replace the marked leaves by eight children each; the other leaves come first, in their order."""
        if not marked.any():
            return
        parents = self.cells[marked]
        first_birth = len(self.births)
        pairs, faces = parents[:, EDGES].reshape(-1, 2), parents[:, FACES].reshape(-1, 4)
        none = np.empty((len(pairs), 0), np.int64)
        mids = self._middles(self.edges, edge_keys(pairs), pairs, none).reshape(-1, 12)
        around = mids[:, FACE_EDGES].reshape(-1, 4)
        centres = self._middles(self.quads, face_keys(faces), faces, around).reshape(-1, 6)
        birth = Birth(len(self.points), parents, mids, centres)
        self._grow(birth)
        nodes = np.concatenate([parents, mids, centres, birth.nodes[:, None]], axis=1)  # (k, 27)
        tags = np.where(CHILD_KEEPS_FACE[None], self.tags[marked][:, None, :], np.int8(-1))
        self.cells = np.concatenate([self.cells[~marked], nodes[:, CHILDREN].reshape(-1, 8)])
        self.level = np.concatenate([self.level[~marked], np.repeat(self.level[marked] + 1, 8)])
        self.root = np.concatenate([self.root[~marked], np.repeat(self.root[marked], 8)])
        self.tags = np.concatenate([self.tags[~marked], tags.reshape(-1, 6)])
        self.frozen = np.concatenate([self.frozen[~marked], np.zeros(8 * len(parents), np.bool_)])
        self.place_all(np.zeros(len(self.points), np.bool_), first_birth)

    def place_all(self, hanging: BoolArray, first: int = 0) -> None:
        """Place the nodes of all births from `first` on, in their order.

        Hanging ones lie on the coarse face, free ones of the skin on the exact surface.
        """
        points, skin = self.points, np.zeros(len(self.points), np.bool_)
        skin[self.cells[:, FACES][self.tags == SKIN]] = True
        for birth in self.births[first:]:
            nodes = birth.nodes
            flat = points[birth.corners].mean(axis=1)
            points[nodes] = np.where(hanging[nodes, None], flat, birth.middle(points))
            moves = skin[nodes] & ~hanging[nodes]
            if self.snap is not None and moves.any():
                points[nodes[moves]] = self.snap(points[nodes[moves]], points[birth.corners[moves]])

    def _middles(self, known: KeyMap, keys: IntArray, corners: IntArray, mids: IntArray) -> IntArray:
        """(k,) nodes in the middle of edges or faces of those keys, made where they are not known."""
        first = known.add(keys, len(self.points))
        self._grow(Birth(len(self.points), corners[first], mids[first], np.empty((len(first), 0), np.int64)))
        return known.find(keys)

    def _grow(self, birth: Birth) -> None:
        self.births.append(birth)
        self.points = np.concatenate([self.points, np.zeros((len(birth.corners), 3))])
