"""Which part of a body a mesh is: all of it, its half, quarter or eighth; and its half y >= 0."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from meshes.common import BoolArray, FloatArray, IntArray, MeshError
from meshes.gauss import gauss_points
from meshes.halving import ALONG_Y, across, from_images, halved_layer
from meshes.hexmesh import TURNED, outer_quads, quad_normals

PARTS = ("whole", "half", "quarter", "eighth")  # by the number of planes of symmetry in which it was cut
NEAR = 1e-5  # of the largest diameter: nodes so near to a plane of symmetry lie on it
ORDER = (1, 0, 2)  # planes y = 0, x = 0, z = 0, as a part is taken to be cut
ROUND = 0.1  # by how much second moments of a round or square section may differ
RADIAL = 0.15  # sine between normal of a facet and radius, up to which a body counts as turned about its axis
SLABS = 20  # over the length, in which sections are looked at


@dataclass(frozen=True, slots=True)
class Frame:
    """How the axes of a body lie in its file, in which users are told of planes and places.

    Attributes
    ----------
    axes : axis of the file, and sign, of x, y and z
    shift : (3,) float64, m, where the origin lies in the file
    """

    axes: tuple[tuple[int, float], ...] = ((0, 1.0), (1, 1.0), (2, 1.0))
    shift: FloatArray = field(default_factory=lambda: np.zeros(3))

    def place(self, point: FloatArray) -> FloatArray:
        """Return where in the file a point (3,), m, lies."""
        found = self.shift.copy()
        for at, (axis, sign) in zip(point, self.axes, strict=True):
            found[axis] += sign * at
        return found

    def plane(self, axis: int, at: float = 0.0) -> str:
        """Return the plane at a place, m, on an axis of the body, such as "x = 3 mm", of the file."""
        (own, sign), digits = self.axes[axis], 9  # of a metre: less than that is round-off
        place = 1e3 * round(float(sign * at + self.shift[own]), digits)
        return f"{'xyz'[own]} = {f'{place:.6g} mm' if place else '0'}"

    def planes(self, axes: Iterable[int]) -> str:
        """Return the planes through the origin that are square to axes of the body."""
        return " and ".join(sorted(self.plane(axis) for axis in axes))


@dataclass(frozen=True, slots=True)
class Part:
    """Cells of a body whose tip points to -z.

    Attributes
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64
    origin : (m, 8) int64, for each corner of each cell 8 times the cell as read that it is one of, and which
    told : sentences about what was done
    frame : how it lies in its file
    assumed : which of `PARTS` it was taken as though nothing is stated, "" of all of a body
    """

    points: FloatArray
    cells: IntArray
    origin: IntArray
    told: tuple[str, ...] = ()
    frame: Frame = field(default_factory=Frame)
    assumed: str = ""

    @property
    def near(self) -> float:
        """Return how near, m, to a plane nodes lie on it."""
        return NEAR * float(np.ptp(self.points[:, :2], axis=0).max())

    def tell(self, sentence: str) -> "Part":
        """Return the part with one more sentence."""
        return replace(self, told=(*self.told, sentence))


def half_of(part: Part, stated: str | None, cuts: tuple[tuple[int, float], ...] = ()) -> Part:
    """Return the half y >= 0 of the body that a mesh is a part of.

    Parameters
    ----------
    part : Part
    stated : str or None
        One of `PARTS`; None where it is to be found.
    cuts : pairs of an axis of the file and a place on it, m
        The planes that were stated in place of a word. Only of such a half or quarter may one be z = 0, on
        which most meshes only stand.

    Raises
    ------
    MeshError
        If it is not certain which part it is, or it is not what is stated, or the body is not symmetric.
    """
    part, flat = _snapped(part)
    planes = _stated(part, flat, stated, cuts) if stated else _found(part, flat)
    if not planes:
        return _cut(part)
    name = PARTS[len(planes)]
    where = part.frame.planes(planes)
    if 2 in planes:
        part = _doubled(part, 2)
    if 1 not in planes and 0 in planes:
        # a half that was cut in x = 0 turned about z, so that it is cut in y = 0
        sign = 1.0 if part.points[:, 0].max() > 0.0 else -1.0
        x, y, z = part.points.T
        turned = replace(part, points=np.stack([-sign * y, sign * x, z], axis=1))
        part = turned.tell(f"it is turned about its axis by 90 deg, its plane {part.frame.plane(0)} to y = 0")
    elif 0 in planes:
        part = _doubled(part, 0)
    if 0 in planes or 1 in planes:
        half = part
        if part.points[:, 1].max() <= 0.0:  # given on the other side of its plane
            points = part.points * [1.0, -1.0, 1.0] + 0.0
            half = replace(part, points=points, cells=part.cells[:, TURNED], origin=part.origin[:, TURNED])
    else:
        half = _cut(part)
    half = replace(half, assumed="" if stated else name)
    return half.tell(
        f"the mesh is taken as a {name} of a body that is symmetric about {where}".replace("a e", "an e")
    )


def at_planes(
    points: FloatArray, used: IntArray, planes: tuple[tuple[int, float], ...]
) -> tuple[FloatArray, FloatArray]:
    """Return points (n, 3) of which stated planes are those through the origin, and by what they moved.

    Along the other axes the body, of the points ``used``, stands beside the origin: no face of it is a plane
    of symmetry there.
    """
    corners = points[used]
    shift = corners.min(axis=0) - np.ptp(corners, axis=0).max()
    for axis, place in planes:
        shift[axis] = place
    return points - shift, shift


def _snapped(part: Part) -> tuple[Part, set[int]]:
    """Put nodes near x, y or z = 0 there, where the body lies on one side of it; return these planes."""
    points, near, flat = part.points.copy(), part.near, set[int]()
    quads = outer_quads(part.cells)
    for axis in range(3):
        at = points[:, axis]
        if at.min() < -near and at.max() > near and axis != 1:
            continue
        at[np.abs(at) < near] = 0.0
        if (at.min() >= 0.0 or at.max() <= 0.0) and (at[quads] == 0.0).all(axis=1).any():
            flat.add(axis)
    return replace(part, points=points), flat


def _stated(part: Part, flat: set[int], stated: str, cuts: tuple[tuple[int, float], ...]) -> tuple[int, ...]:
    """Return the planes in which a part of the stated kind was cut."""
    count = PARTS.index(stated)
    may = ORDER if cuts or count == 3 else ORDER[:2]
    there = [axis for axis in may if axis in flat]
    if len(there) < count:
        planes = f"flat faces on {part.frame.planes(there)} alone"
        if not there:
            planes = "no flat face there" if cuts else f"flat faces on none of {part.frame.planes(may)}"
        own = ", ".join(f"{'xyz'[axis]} = {1e3 * place:.6g} mm" for axis, place in cuts)
        word = f'{stated}", which is cut in {count} plane{"s" * (count > 1)} of symmetry'
        what = f'{own}"' if cuts else word
        raise MeshError(
            f'is stated as mesh_symmetry = "{what}, but it has {planes}, with all of it on one side. State '
            f"what it is, or where it was cut: {_example(part)}."
        )
    return tuple(there[:count])


def _example(part: Part) -> str:
    """Return the end of the body, along y or x, with the most of its flat faces as the plane of a cut."""
    corners = part.points[outer_quads(part.cells)]
    normal = quad_normals(corners)
    most, found = 0.0, (1, float(part.points[:, 1].min()))
    for axis in ORDER[:2]:
        for end in (float(part.points[:, axis].min()), float(part.points[:, axis].max())):
            there = (np.abs(corners[:, :, axis] - end) < part.near).all(axis=1)
            if (flat := float(np.abs(normal[there, axis]).sum())) > (1.0 + NEAR) * most:
                most, found = flat, (axis, end)
    plane = part.frame.plane(*found)
    return f'mesh_symmetry = "{plane if plane.endswith("mm") else f"{plane} mm"}", for example'


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
    where = part.frame.planes(there)
    if not there:
        raise MeshError(
            f"lies beside {part.frame.plane(1)} without a flat face on it: it is not certain what part of "
            f"the body it is. State mesh_symmetry = {sizes[0]}, or where it was cut: {_example(part)}."
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
    told = f"its plane of symmetry is taken at {part.frame.plane(1, middle)}"
    frame = replace(part.frame, shift=part.frame.place(np.array([0.0, middle, 0.0])))
    return replace(part, points=points, frame=frame).tell(told)


def _gauss(part: Part) -> tuple[FloatArray, FloatArray]:
    """Return weights (k,), m3, and places (k, 3), m, of the Gauss points of all cells."""
    weight, place = gauss_points(part.points, part.cells)
    return weight.ravel(), place.reshape(-1, 3)


def _is_turned(part: Part, planes: tuple[int, ...]) -> bool:
    """Return whether the body that the planes complete is turned about an axis along z, facets apart."""
    weight, place = _gauss(part)
    centre = (weight @ place / weight.sum())[:2]
    centre[[axis for axis in planes if axis < 2]] = 0.0
    corners = part.points[outer_quads(part.cells)]
    for axis in planes:
        corners = corners[~(corners[:, :, axis] == 0.0).all(axis=1)]
    normal = quad_normals(corners)
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
    return replace(
        part,
        points=np.concatenate([points, image]),
        cells=np.concatenate([part.cells, new[part.cells][:, TURNED]]),
        origin=np.concatenate([part.origin, part.origin[:, TURNED]]),
    )


def _cut(part: Part) -> Part:
    """Return the half y >= 0 of a whole body; one that lies beside y = 0 is centred there first."""
    part = part if _crosses(part) else _centred(part)
    points, near, plane = part.points, part.near, part.frame.plane(1)
    crossing = np.flatnonzero(across(points[:, 1], part.cells, 0.0))
    made = halved_layer(points, part.cells)
    if made is None:
        where = place_text(part.frame.place(points[part.cells[crossing[0]]].mean(axis=0)))
        raise MeshError(
            f"has {len(crossing)} cells across the plane {plane}, the first about {where}. The plane of "
            "symmetry must lie between cells: give a mesh with faces there, or half of it."
        )
    # refuse a body whose nodes or cells on both sides of y = 0 are not mirror images of each other
    for what, places in (("node", points), ("cell", points[part.cells].mean(axis=1))):
        lonely: BoolArray = from_images(places, ALONG_Y) > 2.0 * near
        if lonely.any():
            raise MeshError(
                f"is not symmetric about the plane {plane}: {int(lonely.sum())} of {len(places)} {what}s "
                f"have no mirror image, the first at {place_text(part.frame.place(places[lonely][0]))}. The "
                "model holds half of a symmetric body: mirror the mesh, turn it, move its plane of symmetry "
                "there, or give half of it."
            )
    places, cells, kept = made
    used, new = np.unique(cells[kept], return_inverse=True)
    half = replace(part, points=places[used], cells=new.reshape(-1, 8), origin=part.origin[kept])
    if not len(crossing):
        return half
    return half.tell(f"{len(crossing)} cells across the plane {plane} are cut there")


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
