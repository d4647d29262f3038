"""Cells of any kind as hexahedra: tetrahedra and wedges, straight or curved, split about their middles.

Each corner of a cell takes a hexahedron, between the middles of its three edges, those of its three faces
and that of the cell. Cells that share a face share the hexahedra's faces on it: a conforming mesh stays one.
"""

from dataclasses import dataclass

import numpy as np

from meshes.common import BoolArray, FloatArray, IntArray, MeshError
from meshes.gauss import jacobians_of
from meshes.hexmesh import CORNERS, FACES, TURNED
from meshes.reading.stored import counted
from meshes.split import edge_keys


@dataclass(frozen=True, slots=True)
class _Kind:
    """A cell of which three edges meet at each corner.

    Attributes
    ----------
    edges : pairs of corners, in the order of the middle nodes
    faces : corners of each face, three or four, in order around it
    places : of the corners, in a cell with positive volume
    """

    name: str
    edges: tuple[tuple[int, int], ...]
    faces: tuple[tuple[int, ...], ...]
    places: IntArray

    @property
    def corners(self) -> int:
        return len(self.places)

    def around(self, corner: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Return the edges at a corner, right-handed, and the faces between first and second, and on."""
        ends = {k: a + b - corner for k, (a, b) in enumerate(self.edges) if corner in (a, b)}
        x, y, z = ends
        axes = [self.places[ends[k]] - self.places[corner] for k in (x, y, z)]
        if np.linalg.det(np.array(axes, dtype=np.float64)) < 0:
            y, z = z, y
        pairs = ((x, y), (y, z), (z, x))
        faces = tuple(
            next(k for k, face in enumerate(self.faces) if {corner, ends[a], ends[b]} <= set(face))
            for a, b in pairs
        )
        return (x, y, z), faces


TETRA = _Kind(
    "tetra",
    ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    ((0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
)
WEDGE = _Kind(
    "wedge",
    ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
    ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]),
)
HEXAHEDRON = _Kind(
    "hexahedron",
    (*((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)), *((0, 4), (1, 5), (2, 6), (3, 7))),
    tuple(tuple(int(corner) for corner in face) for face in FACES),
    CORNERS,
)
KINDS = {kind.name: kind for kind in (TETRA, WEDGE, HEXAHEDRON)}
# Shape functions of the middle of a quadratic cell or face: of a corner, and of the middle of an edge; those
# of a wedge's edges between its ends differ
MIDDLES = {"tetra": (-1 / 8, (1 / 4,) * 6), "hexahedron": (-1 / 4, (1 / 4,) * 12)}
MIDDLES["wedge"] = (-2 / 9, (2 / 9,) * 6 + (1 / 3,) * 3)
FACE_MIDDLES = {3: (-1 / 9, 4 / 9), 4: (-1 / 4, 1 / 2)}


@dataclass(frozen=True, slots=True)
class Hexahedra:
    """Hexahedra of a body.

    Attributes
    ----------
    points : (n, 3) float64
    cells : (m, 8) int64, VTK order
    parent : (m,) int64, the cell of the file in which each lies
    told : sentences about what was done
    """

    points: FloatArray
    cells: IntArray
    parent: IntArray
    told: tuple[str, ...]


def as_hexahedra(points: FloatArray, blocks: tuple[tuple[str, IntArray], ...]) -> Hexahedra:
    """Return the hexahedra of cells of all kinds, those that are inside out put right.

    Parameters
    ----------
    points : (n, 3) float64
    blocks : pairs of a kind and its cells, see `StoredMesh`

    Raises
    ------
    MeshError
        If a cell is a pyramid, or corners of a cell fall together.
    """
    starts = np.cumsum([0, *(len(cells) for _, cells in blocks)]).tolist()
    groups = [_group(block, at) for at, block in zip(starts, blocks, strict=False)]
    told: list[str] = []
    if all(kind is HEXAHEDRON and cells.shape[1] == 8 for kind, cells, _ in groups):
        made = groups
    else:
        points, made = _split(points, groups)
        names = sorted({kind.name for kind, _, _ in groups})
        count = sum(len(cells) for _, cells, _ in groups)
        told.append(
            f"{counted(count, 'cell')} ({', '.join(names)}) split about the middles into "
            f"{sum(len(cells) for _, cells, _ in made)} hexahedra"
        )
    cells, parent = (np.concatenate([part[k] for part in made]) for k in (1, 2))
    kinds = list(KINDS.values())
    of = np.repeat([kinds.index(kind) for kind, _, _ in made], [len(part) for _, part, _ in made])
    outside_in = (np.linalg.det(jacobians_of(points, cells)) < 0.0).all(axis=1)
    parts, bad = (np.bincount(parent[here], minlength=parent.max() + 1) for here in (..., outside_in))
    turned = (parts == bad)[parent]  # a cell of the file whose parts are all inside out is numbered so
    cells[turned] = cells[turned][:, TURNED]
    wrong = turned & _at_odds(cells) & (of == kinds.index(HEXAHEDRON))
    cells[wrong] = cells[wrong][:, TURNED]  # it lies in its neighbours: refused as folded
    turned &= ~wrong
    for number, kind in enumerate(kinds):
        own = np.bincount(parent[(of == number) & turned]) > 0
        if own.any():
            every = turned[of == number].all()
            whole = f"each {kind.name}" if every else counted(int(own.sum()), kind.name)
            told.append(f"the order of the nodes of {whole} is turned round")
    return Hexahedra(points, cells, parent, tuple(told))


def _at_odds(cells: IntArray) -> BoolArray:
    """Return the mask (m,) of hexahedra that share a face with another which goes round it the same way.

    Cells on both sides of a face go round it in opposite ways; else one lies in the other.
    """
    faces = cells[:, FACES].reshape(-1, 4)
    first = faces.argmin(axis=1)[:, None]
    around = np.take_along_axis(faces, (first + np.arange(4)) % 4, axis=1)
    ways = np.unique(around, axis=0, return_inverse=True, return_counts=True)
    return np.asarray((ways[2][ways[1].ravel()] > 1).reshape(-1, 6).any(axis=1))


def _group(block: tuple[str, IntArray], first: int) -> tuple[_Kind, IntArray, IntArray]:
    """Return kind, cells and numbers of a block; see `meshes.fallen` for hexahedra of another kind."""
    name, cells = block
    if name.startswith("pyramid"):
        raise MeshError(
            f"holds {counted(len(cells), 'pyramid')}, which cannot be split into hexahedra. Mesh the body "
            "with hexahedra, wedges or tetrahedra alone."
        )
    kind = next(kind for kind in KINDS.values() if name.startswith(kind.name))
    fallen = int((np.diff(np.sort(cells[:, : kind.corners], axis=1), axis=1) == 0).any(axis=1).sum())
    if fallen:
        raise MeshError(
            f"holds {counted(fallen, f'cell of type {kind.name}')} whose corners fall together to no wedge "
            "and no tetrahedron. Mesh the body with hexahedra, wedges or tetrahedra alone."
        )
    return kind, cells, first + np.arange(len(cells))


def _split(
    points: FloatArray, groups: list[tuple[_Kind, IntArray, IntArray]]
) -> tuple[FloatArray, list[tuple[_Kind, IntArray, IntArray]]]:
    """Return points with the middles of edges, faces and cells, and the hexahedra about them, by group."""
    pairs = [cells[:, np.array(kind.edges)] for kind, cells, _ in groups]
    edges, edge_at = np.unique(np.concatenate([edge_keys(p).ravel() for p in pairs]), return_inverse=True)
    ends = np.stack([edges >> 31, edges & ((1 << 31) - 1)], axis=1)
    middles = 0.5 * points[ends].sum(axis=1)
    own = np.cumsum([0, *(p.shape[0] * p.shape[1] for p in pairs)])
    at = [edge_at[low:high].reshape(p.shape[:2]) for low, high, p in zip(own, own[1:], pairs, strict=False)]
    for (kind, cells, _), here in zip(groups, at, strict=True):
        count = len(kind.edges)
        if cells.shape[1] >= kind.corners + count:  # curved: the file's own middles
            own_middles = cells[:, kind.corners : kind.corners + count]
            given = own_middles >= 0
            middles[here[given]] = points[own_middles[given]]
    first_edge, first_face = len(points), len(points) + len(edges)
    faces = [
        _faces(points, middles, kind, cells, here) for (kind, cells, _), here in zip(groups, at, strict=True)
    ]
    keys, places = (np.concatenate(part) for part in zip(*faces, strict=True))
    _, first, face_at = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    face_points = places[first]
    of_group = np.split(first_face + face_at.reshape(-1), np.cumsum([len(keys) for keys, _ in faces])[:-1])
    first_cell = first_face + len(face_points)
    made, centres, begin = [], [], 0
    for (kind, cells, numbers), here, face in zip(groups, at, of_group, strict=True):
        corner, edge = MIDDLES[kind.name]
        centre = corner * points[cells[:, : kind.corners]].sum(axis=1)
        centre += np.einsum("e,mei->mi", np.array(edge), middles[here])
        centres.append(centre)
        number = first_cell + begin + np.arange(len(cells))
        begin += len(cells)
        at_faces = face.reshape(len(cells), len(kind.faces))
        parts = []
        for k in range(kind.corners):
            (x, y, z), (xy, yz, zx) = kind.around(k)
            mids = first_edge + here
            nodes = (
                *(cells[:, k], mids[:, x], at_faces[:, xy], mids[:, y]),
                *(mids[:, z], at_faces[:, zx], number, at_faces[:, yz]),
            )
            parts.append(np.stack(nodes, axis=1))
        made.append((kind, np.stack(parts, axis=1).reshape(-1, 8), np.repeat(numbers, kind.corners)))
    return np.concatenate([points, middles, face_points, *centres]), made


def _faces(
    points: FloatArray, middles: FloatArray, kind: _Kind, cells: IntArray, edges: IntArray
) -> tuple[IntArray, FloatArray]:
    """Return the corners (k, 4), sorted, of all faces of cells, cell by cell, and their middles (k, 3).

    The middle is the file's own where a cell has nodes in its faces, else that of corners and ``edges``.
    """
    keys, places = [], []
    own = points[cells[:, kind.corners + len(kind.edges) :]]
    for face in kind.faces:
        around = [
            next(k for k, edge in enumerate(kind.edges) if set(edge) == {a, b})
            for a, b in zip(face, (*face[1:], face[0]), strict=True)
        ]
        corner, edge = FACE_MIDDLES[len(face)]
        nodes = np.sort(cells[:, list(face)], axis=1)
        keys.append(np.pad(nodes, ((0, 0), (0, 4 - len(face))), constant_values=-1))
        place = corner * points[cells[:, list(face)]].sum(axis=1)
        place += edge * middles[edges[:, around]].sum(axis=1)
        if own.shape[1]:
            near = np.linalg.norm(own - place[:, None], axis=2).argmin(axis=1)
            place = own[np.arange(len(cells)), near]
        places.append(place)
    return np.stack(keys, axis=1).reshape(-1, 4), np.stack(places, axis=1).reshape(-1, 3)
