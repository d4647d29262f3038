"""The half y >= 0 of a whole body whose cells lie across the plane y = 0: layers of hexahedra, tetrahedra."""

import numpy as np

from meshes.common import BoolArray, FloatArray, IntArray, MeshError
from meshes.hexmesh import CORNERS, EDGES
from meshes.split import edge_keys

ALONG_Y = np.array([0.0, 1.0, 0.0])
"""Normal of the plane of symmetry of a body."""

# of the mean length of the edges at a node of tetrahedra: at least so far from the plane it is moved along y,
# so that none of the cells that are cut is thin; by symmetry the surface there runs along y
CLEAR = 0.3
LEFT = 0.2  # of the volume of a tetrahedron, that it must keep
ROUNDS = 40
KEPT = 0.01  # of the volume, that cutting may change
ALIKE = 0.05  # of their mean, by which volumes and moments of both sides of a symmetric body may differ
THREE = np.array([[0, 1, 2, 3], [1, 2, 3, 4], [2, 3, 4, 5]])  # tetrahedra of a wedge
EIGHT = np.array(  # tetrahedra about the middles of the edges of one, four at its corners
    [[0, 4, 6, 7], [1, 5, 4, 8], [2, 6, 5, 9], [3, 7, 9, 8]]
    + [[4, 9, a, b] for a, b in ((5, 6), (6, 7), (7, 8), (8, 5))]
)
SIX = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])


def halved_layer(points: FloatArray, cells: IntArray) -> tuple[FloatArray, IntArray, BoolArray] | None:
    """Return nodes and hexahedra of the half y >= 0, and the mask of the cells that are in it.

    A cell across the plane has one face on its one side and the opposite one on its other side, and is cut
    between them; None where one has not.
    """
    y, crossing = points[cells][:, :, 1], np.flatnonzero(across(points[:, 1], cells, 0.0))
    found = np.full(len(crossing), -1)
    for axis in range(3):
        low = CORNERS[:, axis] == 0
        one, other = y[crossing][:, low], y[crossing][:, ~low]
        apart = ((one < 0).all(axis=1) & (other > 0).all(axis=1)) | (
            (one > 0).all(axis=1) & (other < 0).all(axis=1)
        )
        found[apart] = axis
    if (found < 0).any():
        return None
    made = cells.copy()
    edges = np.concatenate(
        [cells[crossing[found == axis]][:, EDGES[_along(axis)]].reshape(-1, 2) for axis in range(3)]
    )
    keys, first = np.unique(edge_keys(edges), return_index=True)
    places = _crossings(points, edges[first])
    for axis in range(3):
        here = crossing[found == axis]
        for a, b in EDGES[_along(axis)]:
            node = len(points) + np.searchsorted(keys, edge_keys(cells[here][:, [a, b]]))
            for corner in (a, b):
                below = points[cells[here, corner], 1] < 0.0
                made[here[below], corner] = node[below]
    return np.concatenate([points, places]), made, y.max(axis=1) > 0.0


def from_images(places: FloatArray, normal: FloatArray, at: float = 0.0) -> FloatArray:
    """Return how far from the nearest place, m, (n,), the mirror image of each of the ``places`` (n, 3) lies.

    The mirror has a ``normal`` (3,) of length 1, along which it lies ``at``, m.
    """
    from scipy.spatial import cKDTree  # here: every command imports this room, few read such a mesh

    image = places - 2.0 * (places @ normal - at)[:, None] * normal
    return np.asarray(cKDTree(places).query(image)[0])


def halved_diagonally(
    points: FloatArray, cells: IntArray, near: float
) -> tuple[IntArray, IntArray, IntArray] | None:
    """Return wedges of the half y >= 0 of hexahedra (m, 8) that the plane halves from edge to edge.

    With them come the cells that they are halves of, and those that lie in the half as they are. None where
    another cell lies across, or nodes or cells are not mirror images of each other.
    """
    y = points[cells][:, :, 1]
    crossing = np.flatnonzero(across(points[:, 1], cells, near))
    wedges = np.full((len(crossing), 6), -1)
    kept = y[crossing] > -near
    for axis in range(3):
        low = np.flatnonzero(CORNERS[:, axis] == 0)
        ends = low, np.array([_facing(k, axis) for k in low.tolist()])
        alike = (kept[:, ends[0]] == kept[:, ends[1]]).all(axis=1) & (kept[:, low].sum(axis=1) == 3)
        for row in np.flatnonzero(alike):
            three = kept[row, low]
            wedges[row] = cells[crossing[row]][np.concatenate([end[three] for end in ends])]
    if not len(crossing) or wedges.min() < 0 or (np.abs(points[wedges, 1]) <= near).sum(axis=1).min() < 4:
        return None
    used = points[np.unique(cells)]
    for places in (used, points[cells].mean(axis=1)):
        if from_images(places, ALONG_Y).max() > 2.0 * near:
            return None
    return wedges, crossing, np.flatnonzero(y.min(axis=1) >= -near)


def _facing(corner: int, axis: int) -> int:
    """Return the corner of a hexahedron at the other end of its edge along an axis."""
    there = CORNERS[corner] + np.eye(3, dtype=np.int64)[axis]
    return int(np.flatnonzero((CORNERS == there).all(axis=1))[0])


def _along(axis: int) -> BoolArray:
    """Return which edges (12,) of a hexahedron run along an axis of its unit cell."""
    return np.asarray(CORNERS[EDGES[:, 0], axis] != CORNERS[EDGES[:, 1], axis])


def _crossings(points: FloatArray, edges: IntArray) -> FloatArray:
    """Return where edges (k, 2) cross the plane y = 0, (k, 3)."""
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    share = a[:, 1] / (a[:, 1] - b[:, 1])
    places = a + share[:, None] * (b - a)
    places[:, 1] = 0.0
    return np.asarray(places)


def halved_tetrahedra(
    points: FloatArray, cells: IntArray, near: float
) -> tuple[FloatArray, dict[str, IntArray], dict[str, IntArray]]:
    """Return nodes, tetrahedra and wedges of the half y >= 0 of tetrahedra (m, 4), and the cell each lies in.

    Where no cell lies across the plane by more than `near`, m, they are those above it, uncut.

    Raises
    ------
    MeshError
        If both sides differ in volume, centre or inertia, or cells fold when nodes give way to the plane.
    """
    volume = float(np.abs(_volumes(points, cells)).sum())
    halves = [_half(points * [1.0, sign, 1.0], cells, near) for sign in (1.0, -1.0)]
    _require_alike([half[:2] for half in halves], volume)
    return halves[0]


def across(away: FloatArray, cells: IntArray, near: float) -> BoolArray:
    """Return the mask (m,) of the cells that reach to both sides of a plane by more than `near`, m.

    ``away`` (n,), m, is how far the nodes lie from it.
    """
    ends = away[cells]
    return np.asarray((ends.min(axis=1) < -near) & (ends.max(axis=1) > near))


def straight(cells: IntArray) -> tuple[IntArray, int]:
    """Return tetrahedra with straight edges, (m, 4), and how many of them a cell of the given ones makes.

    One with nodes in the middle of its edges makes eight, between these.
    """
    if cells.shape[1] == 4:
        return cells, 1
    if (cells < 0).any():
        raise MeshError(
            "has tetrahedra that lack the middles of edges. Write it of first or of second order."
        )
    return cells[:, EIGHT].reshape(-1, 4), 8


def _half(
    points: FloatArray, cells: IntArray, near: float
) -> tuple[FloatArray, dict[str, IntArray], dict[str, IntArray]]:
    """Return nodes, cells above the plane, and the tetrahedron in which each lies."""
    if not across(points[:, 1], cells, near).any():
        uncut = np.flatnonzero(points[cells][:, :, 1].max(axis=1) > near)
        none = np.zeros((0, 6), np.int64)
        return points, {"tetra": cells[uncut], "wedge": none}, {"tetra": uncut, "wedge": none[:, 0]}
    places = _clear(points, cells)
    above = places[cells][:, :, 1] > 0.0
    count = above.sum(axis=1)
    edges = np.sort(cells[:, SIX].reshape(-1, 2), axis=1)
    crossing = (places[edges, 1] > 0.0).sum(axis=1) == 1
    keys, first = np.unique(edge_keys(edges[crossing]), return_index=True)
    cuts = _crossings(places, edges[crossing][first])

    def cut(a: IntArray, b: IntArray) -> IntArray:
        return np.asarray(len(places) + np.searchsorted(keys, edge_keys(np.stack([a, b], axis=1))))

    order = np.argsort(~above, axis=1, kind="stable")  # the corners above the plane first
    a, b, c, d = np.take_along_axis(cells, order, axis=1).T
    one, two, three = (count == k for k in (1, 2, 3))
    tips = np.stack([a, cut(a, b), cut(a, c), cut(a, d)], axis=1)[one]
    beams = np.stack([a, cut(a, c), cut(a, d), b, cut(b, c), cut(b, d)], axis=1)[two]
    stumps = np.stack([a, b, c, cut(a, d), cut(b, d), cut(c, d)], axis=1)[three]
    numbers = np.arange(len(cells))
    blocks = {"tetra": np.concatenate([cells[count == 4], tips]), "wedge": np.concatenate([beams, stumps])}
    parents = {
        "tetra": np.concatenate([numbers[count == 4], numbers[one]]),
        "wedge": np.concatenate([numbers[two], numbers[three]]),
    }
    return np.concatenate([places, cuts]), blocks, parents


def _volumes(points: FloatArray, cells: IntArray) -> FloatArray:
    x = points[cells]
    return np.asarray(np.linalg.det(x[:, 1:] - x[:, :1]) / 6.0)


def _clear(points: FloatArray, cells: IntArray) -> FloatArray:
    """Return the nodes, those near the plane moved away from it along y, so far as no cell folds."""
    pairs = cells[:, SIX].reshape(-1, 2)
    length = np.repeat(np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1), 2)
    number = np.bincount(pairs.ravel(), minlength=len(points))
    clear = CLEAR * np.bincount(pairs.ravel(), length, len(points)) / np.maximum(number, 1)
    before = _volumes(points, cells)
    for _ in range(ROUNDS):
        places, y = points.copy(), points[:, 1]
        places[:, 1] = np.where(np.abs(y) < clear, np.where(y < 0.0, -clear, clear), y)
        thin = _volumes(places, cells) * np.sign(before) < LEFT * np.abs(before)
        if not thin.any():
            return places
        clear[np.unique(cells[thin])] *= 0.7
    raise MeshError(
        f"has {int(thin.sum())} tetrahedra at the plane y = 0 that are too flat to be cut there. Mesh "
        "the half y >= 0 of the body."
    )


def _require_alike(sides: list[tuple[FloatArray, dict[str, IntArray]]], volume_before: float) -> None:
    """Refuse a body whose two sides of y = 0, one of them mirrored, differ in volume or moments.

    One whose volume (m3) has changed because its surface does not run along y at the plane is refused too.
    """
    sums = []
    for points, blocks in sides:
        wedges = blocks["wedge"][:, THREE].reshape(-1, 4)
        cells = np.concatenate([blocks["tetra"], wedges])
        volume, place = np.abs(_volumes(points, cells)), points[cells].mean(axis=1)
        sums.append([volume.sum(), *(volume @ place), *(volume @ place**2)])
    one, other = np.array(sums)
    changed = abs(float((one + other)[0]) / volume_before - 1.0)
    if changed > KEPT:
        raise MeshError(
            f"would change its volume by {100 * changed:.2g} % if its tetrahedra were cut in y = 0: they are "
            "too coarse there, or the surface does not cross it squarely. Mesh the half y >= 0."
        )
    size = np.sqrt(0.5 * (one + other)[4:] / (0.5 * (one + other)[0]))  # radii of gyration about the axes, m
    scale = 0.5 * (one + other)[0] * np.array([1.0, *size, *size**2])
    away = float((np.abs(one - other) / scale).max())
    if away > ALIKE:
        raise MeshError(
            f"is not symmetric about the plane y = 0: volume and moments of its sides differ by "
            f"{100 * away:.2g} %. The model holds half of a symmetric body: turn or move the mesh."
        )
