"""One order of nodes and cells for one body, whatever file it came from."""

import numpy as np

from meshes.common import FloatArray, IntArray
from meshes.hexmesh import CORNERS, NEIGHBOURS

QUANTUM = 1e-7  # of the largest extent: coordinates that differ by less count as equal
BESIDE = 0.237  # of it, by which the steps are shifted, so that round numbers do not lie between two of them


def in_order(points: FloatArray, cells: IntArray) -> tuple[FloatArray, IntArray, IntArray]:
    """Return nodes and cells of a body in an order that follows from their places, and whence their corners.

    Nodes go from the tip to the tail, and at one height along y, then x. A cell begins with its lowest node
    and goes on to the lowest of that node's three neighbours. Cells go by their nodes. The last array
    (m, 8) is for each corner 8 times the number of its cell in ``cells``, and its number there.
    """
    step = QUANTUM * float(np.ptp(points, axis=0).max())
    x, y, z = np.floor(points / step + BESIDE).T
    order = np.lexsort((x, y, z))
    new = np.empty(len(points), dtype=np.int64)
    new[order] = np.arange(len(points))
    numbered = new[cells]
    first = numbered.argmin(axis=1)
    rows = np.arange(len(cells))
    near = NEIGHBOURS[first]
    second = numbered[rows[:, None], near].argmin(axis=1)
    corners = 8 * rows[:, None] + TURNS[first, second]
    turned = numbered.ravel()[corners]
    by_nodes = np.lexsort(turned.T[::-1])
    return points[order], turned[by_nodes], corners[by_nodes]


def _turns() -> IntArray:
    """(8, 3, 8) corners of a cell turned so that it begins with a corner and one of its three neighbours."""
    found = np.empty((8, 3, 8), dtype=np.int64)
    for corner in range(8):
        sign = 1 - 2 * CORNERS[corner]
        for axis in range(3):
            # the other two axes such that all three, as they run from the corner, are right-handed
            other, last = (axis + 1) % 3, (axis + 2) % 3
            if sign.prod() < 0:
                other, last = last, other
            for k, (a, b, c) in enumerate(CORNERS):
                place = CORNERS[corner].copy()
                for own, steps in ((axis, a), (other, b), (last, c)):
                    place[own] ^= steps
                found[corner, axis, k] = int((CORNERS == place).all(axis=1).argmax())
    return found


TURNS: IntArray = _turns()
