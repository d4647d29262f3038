"""Bodies that are no bodies of revolution, as half meshes of hexahedra that a user might bring.

A section in the plane (x, y), y >= 0, is made of quadrilaterals, each mapped from equal squares, and drawn
out along z from the tip at z = 0; it may be moved along x or scaled on its way.
"""

from collections.abc import Callable, Mapping, Sequence
from math import sqrt
from pathlib import Path

import numpy as np

from fem_impact.arrays import Array, Ints

Quadrilateral = Sequence[tuple[float, float]]
Sizes = Mapping[str, float]
"""Sizes of a body by name: ``width`` and ``length``, m, others as its function says."""
ACROSS, MOST_ALONG = 4, 60
"""Cells along each side of a quadrilateral of a section; most cells along a body."""


def write(body: str, sizes: Sizes, path: Path) -> None:
    """Write the half y >= 0 of a body of `BODIES`, in m, in a format that the ending of the path names."""
    import meshio

    points, cells = BODIES[body](sizes)
    meshio.write(path, meshio.Mesh(points, [("hexahedron", cells)]))


def square_bar(sizes: Sizes) -> tuple[Array, Ints]:
    """Return a bar of square section that comes down on an edge of its face."""
    return _drawn(_box(sizes["width"], sizes["width"]), sizes)


def plate(sizes: Sizes) -> tuple[Array, Ints]:
    """Return a plate that stands on its edge: ``thickness``, m, along x, ``width`` along y."""
    return _drawn(_box(sizes["thickness"], sizes["width"]), sizes)


def hexagonal_bar(sizes: Sizes) -> tuple[Array, Ints]:
    """Return a bar of hexagonal section, ``width`` over its corners, one of which comes down."""
    a = sizes["width"] / 2
    return _drawn([((-a, 0.0), (a, 0.0), (a / 2, a * sqrt(0.75)), (-a / 2, a * sqrt(0.75)))], sizes)


def corner_bar(sizes: Sizes) -> tuple[Array, Ints]:
    """Return a bar of square section that comes down on a corner of its face; ``width`` is its diagonal."""
    a = sizes["width"] / 2
    right, left = (_triangle((0.0, 0.0), *two) for two in (((a, 0.0), (0.0, a)), ((0.0, a), (-a, 0.0))))
    return _drawn([*right, *left], sizes)


def bent_bar(sizes: Sizes) -> tuple[Array, Ints]:
    """Return a square bar whose axis is a parabola in the plane of motion: ``bend``, m, at its tail."""
    bend, length = sizes["bend"], sizes["length"]

    def moved(points: Array) -> Array:
        points[:, 0] += bend * (points[:, 2] / length) ** 2
        return points

    return _drawn(_box(sizes["width"], sizes["width"]), sizes, moved)


def tapered_bar(sizes: Sizes) -> tuple[Array, Ints]:
    """Return a square bar whose width at the tip is ``share`` of that at the tail."""
    share, length = sizes["share"], sizes["length"]

    def moved(points: Array) -> Array:
        points[:, :2] *= share + (1.0 - share) * points[:, 2:] / length
        return points

    return _drawn(_box(sizes["width"], sizes["width"]), sizes, moved)


BODIES: Mapping[str, Callable[[Sizes], tuple[Array, Ints]]] = {
    "square bar": square_bar,
    "plate": plate,
    "hexagonal bar": hexagonal_bar,
    "corner bar": corner_bar,
    "bent bar": bent_bar,
    "tapered bar": tapered_bar,
}
"""Functions of the sizes to points (n, 3), m, and cells (m, 8), VTK hexahedra, of half a body, y >= 0."""


def _box(width_x: float, width_y: float) -> list[Quadrilateral]:
    x, y = width_x / 2, width_y / 2
    return [((-x, 0.0), (x, 0.0), (x, y), (-x, y))]


def _triangle(*corners: tuple[float, float]) -> list[Quadrilateral]:
    """Return the three quadrilaterals of a triangle about its centre."""
    a, b, c = (np.array(corner) for corner in corners)
    centre = (a + b + c) / 3

    def piece(at: Array, later: Array, before: Array) -> Quadrilateral:
        around = at, (at + later) / 2, centre, (at + before) / 2
        return [(float(x), float(y)) for x, y in around]

    return [piece(a, b, c), piece(b, c, a), piece(c, a, b)]


def _section(pieces: Sequence[Quadrilateral]) -> tuple[Array, Ints]:
    """Return points (n, 2) and cells (m, 4) of quadrilaterals that share whole sides."""
    n = ACROSS
    u, v = (at.ravel() for at in np.meshgrid(*2 * [np.linspace(0.0, 1.0, n + 1)], indexing="ij"))
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    points = np.concatenate([weights @ np.array(piece) for piece in pieces])
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1, 1)
    one = first + np.array([0, n + 1, n + 2, 1])
    cells = np.concatenate([one + at * len(u) for at in range(len(pieces))])
    size = np.ptp(points, axis=0).max()
    _, kept, number = np.unique(np.round(points / size, 9), axis=0, return_index=True, return_inverse=True)
    return points[kept], number.reshape(-1)[cells]


def _drawn(
    pieces: Sequence[Quadrilateral], sizes: Sizes, moved: Callable[[Array], Array] = lambda points: points
) -> tuple[Array, Ints]:
    """Return points and cells of a section drawn out along z by cells about as long as the section's."""
    flat, quads = _section(pieces)
    corners = flat[quads]
    edge = float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
    along = min(max(round(sizes["length"] / edge), 2), MOST_ALONG)
    heights = np.linspace(0.0, sizes["length"], along + 1)
    points = np.concatenate([np.column_stack([flat, np.full(len(flat), z)]) for z in heights])
    layers = [np.hstack([quads + k * len(flat), quads + (k + 1) * len(flat)]) for k in range(along)]
    return moved(points), np.concatenate(layers)
