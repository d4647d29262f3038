"""A user's own mesh: read from a file, checked, turned upright, and brought to its half y >= 0."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from meshes.common import BoolArray, FloatArray, IntArray, MeshError
from meshes.faces import file_faces, filling, lopsided, named_faces
from meshes.fallen import as_they_are
from meshes.gauss import jacobians
from meshes.halving import ALONG_Y, across, from_images, halved_diagonally, halved_tetrahedra, straight
from meshes.hexahedra import as_hexahedra
from meshes.hexmesh import SYMMETRY, HexMesh, from_cells, half_body_tags
from meshes.masses import LooseMass, loose_masses
from meshes.moments import cell_moments
from meshes.oblique import Tip, is_oblique, stood_up
from meshes.order import in_order
from meshes.reading.read import stored_mesh
from meshes.reading.stored import NODES, StoredMesh, counted, sets_named
from meshes.sound import require_sound
from meshes.symmetry import NEAR, PARTS, Frame, Part, at_planes, half_of, size_text

FARTHEST = 1e30  # of a coordinate, m: its powers that moments need are numbers
SLENDER = 2.0  # second moment along z over that along x, from which on a body has an axis
LEAN = 1.0  # deg between the axis of least inertia and z, from which on it is told
# the axes of the file, and their signs, that become x, y and z where the tip points along one of them; y
# stays the normal of the plane of symmetry where it can
TIPS: dict[str, tuple[tuple[int, float], ...]] = {
    "-z": ((0, 1.0), (1, 1.0), (2, 1.0)),
    "+z": ((0, -1.0), (1, 1.0), (2, -1.0)),
    "-x": ((2, -1.0), (1, 1.0), (0, 1.0)),
    "+x": ((2, 1.0), (1, 1.0), (0, -1.0)),
    "-y": ((2, 1.0), (0, 1.0), (1, 1.0)),
    "+y": ((2, -1.0), (0, 1.0), (1, -1.0)),
}


@dataclass(frozen=True, slots=True)
class Stated:
    """What a user says of a mesh, each None or empty where it is to be found.

    Attributes
    ----------
    symmetry : which part of the body it is, see `PARTS`
    tip : where the tip points: a key of `TIPS`, a direction in the file, "-axis" or "+axis" (see `stood_up`)
    sets : sets of the file whose cells are the body
    planes : in which it was cut, in place of ``symmetry``: axis of the file and place on it, m
    """

    symmetry: str | None = None
    tip: Tip | None = None
    sets: tuple[str, ...] = ()
    planes: tuple[tuple[int, float], ...] = ()


@dataclass(frozen=True, slots=True)
class OwnBody:
    """A user's body.

    Attributes
    ----------
    half : the half y >= 0, its tip at z = 0
    sets : by name of a set of the file, the mask (m,) of its cells
    faces : by name of a set of faces or nodes of the file, the mask (k,) of the faces of the half in it
    lopsided : names of sets of which one side of y = 0 holds more than the other
    masses : masses without volume that the file holds
    told : sentences about what the file holds and how it was taken
    assumed : as in `Part`
    """

    half: HexMesh
    sets: Mapping[str, BoolArray] = field(default_factory=dict)
    faces: Mapping[str, BoolArray] = field(default_factory=dict)
    lopsided: frozenset[str] = frozenset()
    masses: tuple[LooseMass, ...] = ()
    told: tuple[str, ...] = ()
    assumed: str = ""


def read_own(path: str | Path, unit: float = 1.0, stated: Stated | None = None) -> OwnBody:
    """Read and check a mesh of a body; see `own_body` for what is asked of it.

    Parameters
    ----------
    path : path
        Of any format that `stored_mesh` reads.
    unit : float
        Metres in one unit of the file.
    stated : Stated, optional

    Raises
    ------
    MeshError
        If the file cannot be read, holds cells that cannot be taken, or is no such body.
    """
    stated = stated or Stated()
    stored = as_they_are(stored_mesh(path))
    if len(stored.surfaces.corners):
        _require_numbered(stored.points, stored.surfaces.corners, -1)
    if not stored.blocks:
        other = (*stored.surfaces.counts(np.ones(len(stored.surfaces.kinds), bool)), *stored.ignored)
        left = f": {', '.join(other)} alone" if other else ""
        raise MeshError(f"holds no volume cells{left}. {filling(stored.points, stored.surfaces.corners)}")
    if stored.points.shape[1:] != (3,):
        raise MeshError(f"has points of {stored.points.shape[1]} coordinates: a body needs three.")
    for kind, cells in stored.blocks:
        if cells.shape[1:] != (NODES[kind],) or not len(cells):
            raise MeshError(f"is damaged: its cells of type {kind} have not {NODES[kind]} nodes each.")
        _require_numbered(stored.points, cells, -1 if NODES[kind] > 8 else 0)
    chosen = _chosen(stored, stated.sets)
    points = stored.points * unit
    of_blocks = np.split(chosen, np.cumsum([len(cells) for _, cells in stored.blocks])[:-1])
    taken = ((kind, cells[here]) for (kind, cells), here in zip(stored.blocks, of_blocks, strict=True))
    blocks = tuple((kind, cells) for kind, cells in taken if len(cells))
    used = np.concatenate([cells.ravel() for _, cells in blocks])
    masses = loose_masses(stored.masses, points, used if stated.sets else None)
    stood, frame = tuple[str, ...](), Frame()
    if stated.planes:
        points, shift = at_planes(points, used[used >= 0], stated.planes)
        stated = replace(stated, symmetry=PARTS[len(stated.planes)])
        if not is_oblique(stated.tip):
            frame = Frame(shift=shift)
    elif stated.symmetry in (None, "whole") and not is_oblique(stated.tip):
        points, frame, stood = _at_its_plane(points, np.unique(used[used >= 0]), stated.tip)
    if is_oblique(stated.tip):
        whole = as_hexahedra(points, blocks)
        points, stated, stood = _stood(whole.points, whole.cells, points, stated)
    points, blocks, of, cut = _halved(points, blocks, stated)
    made = as_hexahedra(points, blocks)
    parent = np.flatnonzero(chosen)[of[made.parent]]
    if cut:
        stated = replace(stated, symmetry="half", tip="-z" if stated.tip else None)
    names = ", ".join(f'"{name}"' for name in sorted(stored.sets)[:8])
    hint = f" Or name those that are the body: mesh_sets = [...] of {names}." if names else ""
    part = Part(made.points, made.cells, _corners(made.cells), frame=frame)
    body, origin = _own(part, stated, hint)
    files = file_faces(stored, chosen)
    of = parent[origin // 8]  # (m, 8), all corners of a cell are of one cell of the file
    every = {name: np.isin(of[:, 0], cells) for name, cells in stored.sets.items()}
    sets = {name: here for name, here in every.items() if here.any()}
    faces = named_faces(body.half, made.points, made.cells.ravel()[origin], of, files)
    left_out = (*stored.surfaces.counts(~files.bounding), *stored.ignored)
    told = (
        *((f"left out: {', '.join(left_out)}",) if left_out else ()),
        *((f"left out: {counted(int((~chosen).sum()), 'cell')} of other sets",) if not chosen.all() else ()),
        *((f"sets of faces: {', '.join(sorted(faces))}",) if faces else ()),
        *(*stood, *cut, *made.told),
        *(body.told[1:] if cut else body.told),  # what was cut here is no half in the file
    )
    dropped = np.setdiff1d(np.flatnonzero(chosen), of)
    uneven = lopsided(stored, files, _axes(made.points, stated.tip), dropped)
    return replace(body, sets=sets, faces=faces, lopsided=uneven, masses=masses, told=told)


def _at_its_plane(
    points: FloatArray, used: IntArray, tip: Tip | None
) -> tuple[FloatArray, Frame, tuple[str, ...]]:
    """Return a whole body moved to y = 0 if its ``used`` nodes are alike about the middle of its width alone.

    With it come how it lies in its file, and what is told.
    """
    turned, shift, (axis, sign) = _axes(points[used], tip), np.zeros(3), TIPS[str(tip or "-z")][1]
    y, near = turned[:, 1], NEAR * float(np.ptp(turned[:, :2], axis=0).max())
    middle = 0.5 * float(y.min() + y.max())
    if not y.min() < 0.0 < y.max() or abs(middle) <= near:
        return points, Frame(), ()
    here, there = (from_images(turned, ALONG_Y, at).max() for at in (0.0, middle))
    if not there < 2.0 * near < here:
        return points, Frame(), ()
    shift[axis] = sign * middle
    frame = Frame(shift=shift)
    return points - shift, frame, (f"its plane of symmetry is taken at {frame.plane(axis)}",)


def _corners(cells: IntArray) -> IntArray:
    """Return the `Part.origin` (m, 8) of cells as they are read."""
    return np.arange(cells.size).reshape(cells.shape)


def own_body(points: FloatArray, cells: IntArray, stated: Stated | None = None) -> OwnBody:
    """Return the half y >= 0 of a body of hexahedra, moved so that its tip stands at z = 0.

    The axis is parallel to z and the tip is the lowest end, unless stated otherwise. The mesh may be all of
    the body, with nodes on its plane of symmetry y = 0, its half, quarter or eighth with faces in the planes
    of symmetry. The centre of the volume is moved to x = 0.

    Parameters
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64
        VTK hexahedron order.
    stated : Stated, optional

    Raises
    ------
    MeshError
        If a cell is folded, the body is in parts, its surface is not closed, it does not lie along z, it is
        not symmetric about y = 0, or it is not certain which part of the body the mesh is.
    """
    stated, stood = stated or Stated(), tuple[str, ...]()
    if is_oblique(stated.tip):
        points, stated, stood = _stood(points, cells, points, stated)
    body = _own(Part(points, cells, _corners(cells)), stated, "")[0]
    return replace(body, told=(*stood, *body.told))


def _stood(
    nodes: FloatArray, cells: IntArray, points: FloatArray, stated: Stated
) -> tuple[FloatArray, Stated, tuple[str, ...]]:
    """Return points (n, 3) of an oblique body turned so that its tip points to -z, what is stated then, told.

    ``nodes`` and hexahedral ``cells`` are those of its volume. A body of which nothing is stated is whole.
    """
    assert stated.tip is not None, "the tip is stated"
    symmetry = stated.symmetry or "whole"
    turn, origin, told = stood_up(nodes, cells, stated.tip, symmetry == "whole")
    return (points - origin) @ turn.T, replace(stated, tip="-z", symmetry=symmetry), (told,)


def _chosen(stored: StoredMesh, sets: tuple[str, ...]) -> BoolArray:
    """Return the mask of the cells that are in the sets, all where none is named."""
    count = sum(len(cells) for _, cells in stored.blocks)
    if not sets:
        return np.ones(count, dtype=bool)
    chosen = np.zeros(count, dtype=bool)
    for name in sets:
        meant = sets_named(name, stored.sets)
        if len(meant) > 1:
            raise MeshError(f"has no set of cells {name!r}, but {' and '.join(meant)}: name one of them.")
        if not meant:
            known = ", ".join(sorted(stored.sets)[:12]) or "none"
            raise MeshError(f"has no set of cells {name!r}; it has {known}.")
        chosen[stored.sets[meant[0]]] = True
    return chosen


def _halved(
    points: FloatArray, blocks: tuple[tuple[str, IntArray], ...], stated: Stated
) -> tuple[FloatArray, tuple[tuple[str, IntArray], ...], IntArray, tuple[str, ...]]:
    """Return cells of a whole body cut in y = 0, or all cells; where each lies; what is told."""
    numbers = np.arange(sum(len(cells) for _, cells in blocks))
    if stated.symmetry not in (None, "whole"):
        return points, blocks, numbers, ()
    turned = _axes(points, stated.tip)
    used = np.unique(np.concatenate([cells.ravel() for _, cells in blocks]))
    near = NEAR * float(np.ptp(turned[used][:, :2], axis=0).max())
    plain = [kind for kind, _ in blocks] == ["hexahedron"]
    if plain and (edge_to_edge := halved_diagonally(turned, blocks[0][1], near)):
        wedges, crossing, kept = edge_to_edge
        places = turned.copy()
        places[np.abs(places[:, 1]) <= near, 1] = 0.0
        halves = tuple(one for one in (("hexahedron", blocks[0][1][kept]), ("wedge", wedges)) if len(one[1]))
        halved = f"{len(crossing)} cells are halved from edge to edge by the plane y = 0"
        return places, halves, np.concatenate([kept, crossing]), (halved,)
    if any(not kind.startswith("tetra") for kind, _ in blocks):
        return points, blocks, numbers, ()
    parts = [straight(cells) for _, cells in blocks]
    cells = np.concatenate([part for part, _ in parts])
    own = np.repeat(numbers, np.concatenate([np.full(len(part) // times, times) for part, times in parts]))
    y = turned[used, 1]
    if y.min() > -near or y.max() < near:
        if stated.symmetry is None:
            return points, blocks, numbers, ()
        turned = turned - np.array([0.0, 0.5 * (y.min() + y.max()), 0.0])
    cut = int(across(turned[:, 1], cells, near).sum())
    places, made, of = halved_tetrahedra(turned, cells, near)
    told = (
        f"{cut} of {len(cells)} tetrahedra lie across the plane y = 0 and are cut there"
        if cut
        else f"half of {len(cells)} tetrahedra is taken: all of the body is there, with faces on y = 0"
    )
    return places, tuple(made.items()), own[np.concatenate([of["tetra"], of["wedge"]])], (told,)


def _own(part: Part, stated: Stated, hint: str) -> tuple[OwnBody, IntArray]:
    """Return the body of hexahedra, and the `Part.origin` (m, 8) of its cells."""
    points, cells = part.points, part.cells
    _require_numbered(points, cells, 0)
    used, new = np.unique(cells, return_inverse=True)
    part = replace(part, points=points[used], cells=new.reshape(cells.shape))
    mesh = from_cells(part.points + part.frame.shift, part.cells, half_body_tags)
    require_sound(mesh, hint)
    if stated.tip:
        assert isinstance(stated.tip, str), "an oblique body stands upright by now"
        frame = replace(part.frame, axes=TIPS[stated.tip])
        part = replace(part, points=_axes(part.points, stated.tip), frame=frame)
    elif stated.symmetry is None:
        _require_upright(part, 1.0)  # what mirror images add makes it wider, not longer
    part = half_of(part, stated.symmetry, stated.planes)
    if not stated.tip:
        _require_upright(part, 2.0)
    half = from_cells(part.points, part.cells, half_body_tags)
    if not (half.face_tag == SYMMETRY).any():
        raise MeshError("has no face on the plane y = 0, its plane of symmetry. Move it there.")
    # the tip at z = 0, the centre of the volume at x = 0
    moments = cell_moments(half)
    centre = float(moments.x.sum() / moments.volume.sum())
    moved = abs(centre) > NEAR * float(np.ptp(half.points[:, 0]))
    shift = np.array([centre if moved else 0.0, 0.0, half.points[:, 2].min()])
    points, cells, corners = in_order(half.points - shift, half.cells)
    placed = from_cells(points, cells, half_body_tags)
    doubled = size_text(part, (1,))
    told = (*part.told, *_leaning(placed), f"whole body: {doubled}")
    return OwnBody(placed, told=told, assumed=part.assumed), part.origin.ravel()[corners]


def _require_numbered(points: FloatArray, cells: IntArray, least: int) -> None:
    """Refuse cells that name nodes below ``least`` or that are not there, and nodes that are nowhere."""
    there = cells.min() >= least and cells.max() < len(points)
    if not there or not (np.abs(points[cells]) < FARTHEST).all():
        raise MeshError(
            "has points that are no finite numbers, or cells that name points that are not there."
        )


def _axes(points: FloatArray, tip: Tip | None) -> FloatArray:
    """Return points (n, 3) of the file in axes in which the tip points to -z."""
    assert not isinstance(tip, tuple), "an oblique body stands upright by now"
    (x, sx), (y, sy), (z, sz) = TIPS[tip or "-z"]
    return np.asarray(points[:, [x, y, z]] * [sx, sy, sz] + 0.0)


def _require_upright(part: Part, times: float) -> None:
    """Refuse a part that does not lie along z, its width along y counted so many times."""
    extent = np.ptp(part.points, axis=0) * [1.0, times, 1.0]
    if extent[2] < (1.0 - NEAR) * extent.max():
        longest = "xyz"[int(np.argmax(extent))]
        raise MeshError(
            f"is {1e3 * extent[2]:.4g} mm long along z and {1e3 * extent.max():.4g} mm along {longest}: the "
            "axis of a projectile is z, with the tip at the lowest z. State where the tip points: "
            f'mesh_tip = "-{longest}" or "+{longest}", or "-z" for a body that is wider than long, or '
            '"-axis" or "+axis" for one that lies askew.'
        )


def _leaning(mesh: HexMesh) -> tuple[str, ...]:
    """Return a sentence where the axis of least inertia of a half body leans from z."""
    weight = np.linalg.det(jacobians(mesh)).sum(axis=1)
    place = mesh.points[mesh.cells].mean(axis=1)
    x, z = place[:, 0], place[:, 2]
    x, z = x - weight @ x / weight.sum(), z - weight @ z / weight.sum()
    lean = 0.5 * np.rad2deg(np.arctan2(2.0 * (weight @ (x * z)), weight @ (z**2) - weight @ (x**2)))
    if not LEAN <= abs(lean) <= 45.0 or weight @ z**2 < SLENDER * (weight @ x**2):
        return ()
    return (
        f"its axis of least inertia leans by {lean:.3g} deg from z towards x; of a whole body mesh_tip = "
        '"-axis" or "+axis" takes that axis',
    )
