"""Which part of a body a mesh is: all of it, its half, quarter or eighth; and its half y >= 0."""

from dataclasses import dataclass, replace

import numpy as np

from meshes.common import BoolArray, FloatArray, IntArray, MeshError
from meshes.gauss import SHAPES, jacobians_of
from meshes.halving import halved_layer
from meshes.hexmesh import FACES, outer_faces

PARTS = ("whole", "half", "quarter", "eighth")  # by the number of planes of symmetry in which it was cut
NEAR = 1e-5  # of the largest diameter: nodes so near to a plane of symmetry lie on it
ORDER = (1, 0, 2)  # planes y = 0, x = 0, z = 0, as a part is taken to be cut
TURNED = [4, 5, 6, 7, 0, 1, 2, 3]  # corners of a hexahedron whose mirror image has a positive volume
ROUND = 0.1  # by how much second moments of a round or square section may differ
RADIAL = 0.15  # sine between normal of a facet and radius, up to which a body counts as turned about its axis
SLABS = 20  # over the length, in which sections are looked at


@dataclass(frozen=True, slots=True)
class Part:
    """Cells of a body whose tip points to -z.

    Attributes
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64
    origin : (m, 8) int64, for each corner of each cell 8 times the cell as read that it is one of, and which
    told : sentences about what was done
    assumed : which of `PARTS` it was taken as though nothing is stated, "" of all of a body
    """

    points: FloatArray
    cells: IntArray
    origin: IntArray
    told: tuple[str, ...] = ()
    assumed: str = ""

    @property
    def near(self) -> float:
        """Return how near, m, to a plane nodes lie on it."""
        return NEAR * float(np.ptp(self.points[:, :2], axis=0).max())

    def tell(self, sentence: str) -> "Part":
        """Return the part with one more sentence."""
        return replace(self, told=(*self.told, sentence))


def half_of(part: Part, stated: str | None, ends: bool = False) -> Part:
    """Return the half y >= 0 of the body that a mesh is a part of.

    Parameters
    ----------
    part : Part
    stated : str or None
        One of `PARTS`; None where it is to be found.
    ends : bool
        Whether a half or a quarter may have been cut in z = 0, on which most meshes only stand.

    Raises
    ------
    MeshError
        If it is not certain which part it is, or it is not what is stated, or the body is not symmetric.
    """
    part, flat = _snapped(part)
    planes = _stated(part, flat, stated, ends) if stated else _found(part, flat)
    if not planes:
        return _cut(part if _crosses(part) else _centred(part))
    name = PARTS[len(planes)]
    where = " and ".join(f"{'xyz'[axis]} = 0" for axis in sorted(planes))
    if 2 in planes:
        part = _doubled(part, 2)
    if 1 not in planes and 0 in planes:
        # a half that was cut in x = 0 turned about z, so that it is cut in y = 0
        sign = 1.0 if part.points[:, 0].max() > 0.0 else -1.0
        x, y, z = part.points.T
        turned = replace(part, points=np.stack([-sign * y, sign * x, z], axis=1))
        part = turned.tell("it is turned about z by 90 deg, its plane x = 0 to y = 0")
    elif 0 in planes:
        part = _doubled(part, 0)
    if 0 in planes or 1 in planes:
        half = _on_positive_side(part)
    else:
        half = _cut(part if _crosses(part) else _centred(part))
    half = replace(half, assumed="" if stated else name)
    return half.tell(
        f"the mesh is taken as a {name} of a body that is symmetric about {where}".replace("a e", "an e")
    )


def at_planes(
    points: FloatArray, used: IntArray, planes: tuple[tuple[int, float], ...]
) -> tuple[FloatArray, str]:
    """Return points (n, 3) of which stated planes are those through the origin, and which of `PARTS` it is.

    Along the other axes the body, of the points ``used``, stands beside the origin: no face of it is a plane
    of symmetry there.
    """
    corners = points[used]
    shift = corners.min(axis=0) - np.ptp(corners, axis=0).max()
    for axis, place in planes:
        shift[axis] = place
    return points - shift, PARTS[len(planes)]


def _snapped(part: Part) -> tuple[Part, set[int]]:
    """Put nodes near x, y or z = 0 there, where the body lies on one side of it; return these planes."""
    points, near, flat = part.points.copy(), part.near, set[int]()
    owner, local = outer_faces(part.cells)
    quads = part.cells[owner[:, None], FACES[local]]
    for axis in range(3):
        at = points[:, axis]
        if at.min() < -near and at.max() > near and axis != 1:
            continue
        at[np.abs(at) < near] = 0.0
        if (at.min() >= 0.0 or at.max() <= 0.0) and (at[quads] == 0.0).all(axis=1).any():
            flat.add(axis)
    return replace(part, points=points), flat


def _stated(part: Part, flat: set[int], stated: str, ends: bool) -> tuple[int, ...]:
    """Return the planes in which a part of the stated kind was cut."""
    count = PARTS.index(stated)
    may = ORDER if ends or count == 3 else ORDER[:2]
    there = [axis for axis in may if axis in flat]
    if len(there) < count:
        none = "none of x = 0, y = 0 and z = 0" if len(may) == 3 else "none of x = 0 and y = 0"
        planes = " and ".join(f"{'xyz'[axis]} = 0" for axis in there) or none
        raise MeshError(
            f'is stated as mesh_symmetry = "{stated}", which is cut in {count} '
            f"plane{'s' * (count > 1)} of symmetry, but it has flat faces on {planes} alone, with all of it "
            f"on one side. State what it is, or where it was cut: {_example(part)}."
        )
    return tuple(there[:count])


def _example(part: Part) -> str:
    return f'mesh_symmetry = "y = {1e3 * float(part.points[:, 1].min()):.6g} mm", for example'


def _found(part: Part, flat: set[int]) -> tuple[int, ...]:
    """Return the planes in which a part was cut, where the shape leaves no doubt."""
    there = tuple(axis for axis in ORDER[:2] if axis in flat)
    if not there and _crosses(part):
        return ()
    if there and _is_turned(part, there):
        return there
    if there == (1,) and _is_round(part):
        return there
    if not there and _is_turned(_centred(part), ()):
        return ()
    choices = [()] + [there[:k] for k in range(1, len(there) + 1)]
    sizes = [f'"{PARTS[len(planes)]}" (a body of {size_text(part, planes)})' for planes in choices]
    where = " and ".join(f"{'xyz'[axis]} = 0" for axis in sorted(there))
    if not there:
        raise MeshError(
            "lies beside y = 0 without a flat face on it: it is not certain what part of the body it is. "
            f"State mesh_symmetry = {sizes[0]}, or where it was cut: {_example(part)}."
        )
    raise MeshError(
        f"has flat faces on {where} and lies on one side of them: it is not certain what part of the body it "
        f"is. State mesh_symmetry = {', '.join(sizes[:-1])} or {sizes[-1]}."
    )


def _crosses(part: Part) -> bool:
    y = part.points[:, 1]
    return bool(y.min() < 0.0 < y.max())


def _centred(part: Part) -> Part:
    """Return a whole body moved so that y = 0 halves its width."""
    y = part.points[:, 1]
    middle = 0.5 * float(y.min() + y.max())
    points = part.points - np.array([0.0, middle, 0.0])
    points[np.abs(points[:, 1]) < part.near, 1] = 0.0
    return replace(part, points=points).tell(f"its plane of symmetry is taken at y = {1e3 * middle:.6g} mm")


def _gauss(part: Part) -> tuple[FloatArray, FloatArray]:
    """Return weights (k,), m3, and places (k, 3), m, of the Gauss points of all cells."""
    weight = np.linalg.det(jacobians_of(part.points, part.cells)).ravel()
    return weight, np.einsum("qa,mai->mqi", SHAPES, part.points[part.cells]).reshape(-1, 3)


def _is_turned(part: Part, planes: tuple[int, ...]) -> bool:
    """Return whether the body that the planes complete is turned about an axis along z, facets apart."""
    weight, place = _gauss(part)
    centre = (weight @ place / weight.sum())[:2]
    centre[[axis for axis in planes if axis < 2]] = 0.0
    owner, local = outer_faces(part.cells)
    corners = part.points[part.cells[owner[:, None], FACES[local]]]
    for axis in planes:
        corners = corners[~(corners[:, :, axis] == 0.0).all(axis=1)]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    area = np.linalg.norm(normal, axis=1)
    radius = corners.mean(axis=1)[:, :2] - centre
    away = np.linalg.norm(radius, axis=1)
    across = np.abs(radius[:, 0] * normal[:, 1] - radius[:, 1] * normal[:, 0]) / np.maximum(away, 1e-300)
    return bool((across <= RADIAL * area).all())


def _is_round(part: Part) -> bool:
    """Return whether sections of the body that y = 0 completes have equal moments about x and y."""
    weight, place = _gauss(part)
    x, y, z = place.T
    slab = np.minimum((SLABS * (z - z.min()) / max(float(np.ptp(z)), 1e-300)).astype(np.int64), SLABS - 1)
    mass = np.bincount(slab, weight, SLABS)
    centre = np.bincount(slab, weight * x, SLABS) / np.maximum(mass, 1e-300)
    ratio = float(weight @ (x - centre[slab]) ** 2 / (weight @ y**2))
    return abs(ratio - 1.0) < ROUND


def _doubled(part: Part, axis: int) -> Part:
    """Return a part with its mirror image in a plane, joined at the nodes on it."""
    points, count = part.points, len(part.points)
    on = points[:, axis] == 0.0
    new = np.where(on, np.arange(count), count + np.cumsum(~on) - 1)
    image = points[~on].copy()
    image[:, axis] *= -1.0
    return Part(
        np.concatenate([points, image]),
        np.concatenate([part.cells, new[part.cells][:, TURNED]]),
        np.concatenate([part.origin, part.origin[:, TURNED]]),
        part.told,
    )


def _on_positive_side(part: Part) -> Part:
    """Return a half on y >= 0, mirrored if it was given on the other side."""
    if part.points[:, 1].max() > 0.0:
        return part
    points, (cells, origin) = part.points * [1.0, -1.0, 1.0] + 0.0, (part.cells, part.origin)
    return Part(points, cells[:, TURNED], origin[:, TURNED], part.told)


def _cut(part: Part) -> Part:
    """Return the half y >= 0 of a whole body."""
    points, near = part.points, part.near
    y = points[part.cells][:, :, 1]
    across = np.flatnonzero((y.min(axis=1) < 0.0) & (y.max(axis=1) > 0.0))
    made = halved_layer(points, part.cells)
    if made is None:
        where = place_text(points[part.cells[across[0]]].mean(axis=0))
        raise MeshError(
            f"has {len(across)} cells across the plane y = 0, the first about {where}. The plane of symmetry "
            "must lie between cells: give a mesh with faces there, or the half y >= 0."
        )
    # refuse a body whose nodes or cells on both sides of y = 0 are not mirror images of each other
    from scipy.spatial import cKDTree  # here: every command imports this room, few read such a mesh

    for what, places in (("node", points), ("cell", points[part.cells].mean(axis=1))):
        away = cKDTree(places).query(places * [1.0, -1.0, 1.0])[0]
        lonely: BoolArray = away > 2.0 * near
        if lonely.any():
            raise MeshError(
                f"is not symmetric about the plane y = 0: {int(lonely.sum())} of {len(places)} {what}s have "
                f"no mirror image, the first at {place_text(places[lonely][0])}. The model holds half of a "
                "symmetric body: mirror the mesh, turn it, or give the half y >= 0."
            )
    places, cells, kept = made
    used, new = np.unique(cells[kept], return_inverse=True)
    half = Part(places[used], new.reshape(-1, 8), part.origin[kept], part.told)
    return half.tell(f"{len(across)} cells across the plane y = 0 are cut there") if len(across) else half


def size_text(part: Part, planes: tuple[int, ...] = ()) -> str:
    """Return size and volume of the body of which a part is cut in the planes."""
    times = np.array([2.0 if axis in planes else 1.0 for axis in range(3)])
    size = 1e3 * times * np.ptp(part.points, axis=0)
    volume = 1e6 * float(times.prod()) * abs(float(_gauss(part)[0].sum()))
    return f"{size[0]:.4g} x {size[1]:.4g} x {size[2]:.4g} mm, {volume:.4g} cm3"


def place_text(point: FloatArray) -> str:
    """Return a place (3,), m, in mm."""
    x, y, z = (1e3 * float(part) + 0.0 for part in point)
    return f"({x:.4g}, {y:.4g}, {z:.4g}) mm"
