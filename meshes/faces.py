"""Outer faces of a body by the sets of its file that hold them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from meshes.common import BoolArray, FloatArray, IntArray
from meshes.hexahedra import KINDS
from meshes.hexmesh import FACES, SKIN, HexMesh, outer_faces
from meshes.reading.stored import StoredMesh

APART = 0.3  # of a set: so much more of it may lie on one side of the plane of symmetry than on the other


def filling(points: FloatArray, corners: IntArray) -> str:
    """Return how to make a body of a surface of ``corners`` (k, 4) of ``points``, and whether it is closed.

    The last corner is -1 where there are three. Points in one place are one.
    """
    if not len(corners):
        return "Give hexahedra, wedges or tetrahedra."
    node = np.unique(points, axis=0, return_inverse=True)[1].reshape(-1)
    around = node[np.where(corners < 0, corners[:, :1], corners)]
    ends = np.sort(np.stack([around, np.roll(around, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    count = np.unique(ends[ends[:, 0] < ends[:, 1]], axis=0, return_counts=True)[1]
    gaps, crossings = int((count == 1).sum()), int((count > 2).sum())
    if gaps or crossings:
        return (
            f"The surface is open: {gaps} of {len(count)} edges bound one face, {crossings} more than two. "
            "Close it, or mesh it with TetWild, which closes gaps, and save the tetrahedra as .msh."
        )
    return (
        "The surface is closed: fill it with tetrahedra, with Gmsh (Merge, Surface Loop, Volume, Mesh 3) or "
        "TetWild for example, and save them as .msh."
    )


@dataclass(frozen=True, slots=True)
class FileFaces:
    """The outer faces of the cells of a file.

    Attributes
    ----------
    owner : (q,) int64, the cell of each, counted through all blocks
    corners : (q, 4) int64, nodes around each; the last is -1 where there are three
    sets : by name of a set of faces or nodes, the mask (q,) of the faces in it
    bounding : (n,) bool, which of the file's `Surfaces` are named and one of these
    """

    owner: IntArray
    corners: IntArray
    sets: Mapping[str, BoolArray]
    bounding: BoolArray


def file_faces(stored: StoredMesh, chosen: BoolArray) -> FileFaces:
    """Return the outer faces of the chosen (m,) cells and the sets of faces and nodes that hold some of them.

    Of a file without such sets none is looked for.
    """
    if not stored.surfaces.sets and not stored.surfaces.nodes:
        nothing = np.zeros(0, np.int64)
        return FileFaces(nothing, nothing.reshape(0, 4), {}, np.zeros(len(stored.surfaces.kinds), bool))
    owners, quads, first = [np.zeros(0, np.int64)], [np.zeros((0, 4), np.int64)], 0
    for name, cells in stored.blocks:
        kind = next((kind for kind in KINDS.values() if name.startswith(kind.name)), None)
        for face in kind.faces if kind else ():
            around = cells[:, list(face)]
            quads.append(np.pad(around, ((0, 0), (0, 4 - len(face))), constant_values=-1))
            owners.append(first + np.arange(len(cells)))
        first += len(cells)
    owner, corners, surfaces = np.concatenate(owners), np.concatenate(quads), stored.surfaces
    owner, corners = owner[chosen[owner]], corners[chosen[owner]]
    # one number for all that have the same corners, in any order; those without an area are none
    keys = np.sort(np.concatenate([corners, surfaces.corners]), axis=1)
    keys[:, 1:][keys[:, 1:] == keys[:, :-1]] = -1
    keys.sort(axis=1)
    number, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)[1:]
    number = number.reshape(-1)
    of_cells = np.bincount(number[: len(owner)], minlength=len(count))
    outer = np.flatnonzero((of_cells[number[: len(owner)]] == 1) & (keys[: len(owner), 1] >= 0))
    at = np.full(len(count), -1)
    at[number[outer]] = np.arange(len(outer))
    place, sets = at[number[len(owner) :]], dict[str, BoolArray]()
    named = np.zeros(len(surfaces.kinds), dtype=bool)
    for name, faces in surfaces.sets.items():
        named[faces] = True
        sets[name] = np.isin(np.arange(len(outer)), place[faces])
    owner, corners = owner[outer], corners[outer]
    for name, nodes in surfaces.nodes.items():
        here = np.asarray(np.isin(corners, [*nodes, -1]).all(axis=1))
        sets[name] = np.asarray(here | sets.get(name, np.zeros_like(here)))
    found = {name: faces for name, faces in sets.items() if faces.any()}
    return FileFaces(owner, corners, found, named & (place >= 0))


def face_at(
    places: FloatArray, cell: IntArray, points: FloatArray, corners: IntArray, owner: IntArray
) -> IntArray:
    """Return which face of its cell each place lies on, -1 where the cell has none.

    Parameters
    ----------
    places : (k, 3) float64, m
    cell : (k,) int64
        The cell of each place.
    points : (n, 3) float64, m
    corners, owner : (q, 4), (q,) int64
        The faces and their cells; the last corner is -1 where there are three.
    """
    order = np.argsort(owner, kind="stable")
    around = points[np.where(corners < 0, corners[:, :1], corners)]
    normal = np.cross(around[:, 2] - around[:, 0], around[:, 3] - around[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    found, nearest = np.full(len(cell), -1), np.full(len(cell), np.inf)
    first, last = (np.searchsorted(owner[order], cell, side=side) for side in ("left", "right"))
    for step in range(int((last - first).max(initial=0))):
        here = np.flatnonzero(first + step < last)
        face = order[first[here] + step]
        away = np.abs(((places[here] - around[face].mean(axis=1)) * normal[face]).sum(axis=1))
        nearer = away < nearest[here]
        found[here[nearer]], nearest[here[nearer]] = face[nearer], away[nearer]
    return found


def named_faces(
    half: HexMesh, points: FloatArray, origin: IntArray, cell: IntArray, files: FileFaces
) -> dict[str, BoolArray]:
    """Return by name of a set of faces of the file the mask (k,) of the skin of the half that lies in it.

    ``origin`` (m, 8) is the node of the cells as read, of ``points``, at each corner of the half, ``cell``
    (m, 8) the cell of the file there.
    """
    owner, local = outer_faces(half.cells)
    corner = owner[:, None], FACES[local]
    at = face_at(points[origin[corner]].mean(axis=1), cell[owner, 0], points, files.corners, files.owner)
    known = (at >= 0) & (half.face_tag == SKIN)
    found = {name: known & faces[at] for name, faces in files.sets.items()}
    return {name: faces for name, faces in found.items() if faces.any()}


def lopsided(stored: StoredMesh, files: FileFaces, points: FloatArray, dropped: IntArray) -> frozenset[str]:
    """Return the names of sets that do not lie alike on both sides of the plane y = 0 of a whole body.

    Parameters
    ----------
    stored : StoredMesh
    files : FileFaces
    points : (n, 3) float64, m
        The nodes of the file, beside which others may stand, with the body upright.
    dropped : (k,) int64
        The cells of the file that lie on y < 0; none of a part of a body, which has one side.
    """
    if not len(dropped):
        return frozenset()
    y = points[:, 1]
    middle = 0.0 if y.min() < 0.0 < y.max() else 0.5 * (y.min() + y.max())

    def sides(corners: IntArray, power: int) -> FloatArray:
        """Return a measure (k,) of the sizes of cells or faces, below 0 on the side of y < 0."""
        around = points[np.where(corners < 0, corners[:, :1], corners)]
        away = (around[:, :, 1].mean(axis=1) - middle) / (1e-5 * np.ptp(y))
        return np.asarray(np.clip(away, -1.0, 1.0) * np.linalg.norm(np.ptp(around, axis=1), axis=1) ** power)

    cells = np.concatenate([sides(cells, 3) for _, cells in stored.blocks])
    faces = sides(files.corners, 2)
    measured = [(name, cells[of]) for name, of in stored.sets.items()]
    measured += [(name, faces[of]) for name, of in files.sets.items()]
    return frozenset(
        name for name, size in measured if abs(float(size.sum())) > APART * float(np.abs(size).sum())
    )
