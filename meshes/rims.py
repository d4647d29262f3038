"""The rounded rim of a disc as its coarse cells hold it: an edge or a chamfer in place of the rounding."""

import numpy as np

from meshes.common import FloatArray
from meshes.surface import CORNER

AXIAL = np.deg2rad(89.99)  # steeper than this from the radial direction, a rounding has come to the side
LARGE = 1.5  # cells across a rounding from which on two chamfers follow it


def without_roundings(line: FloatArray, pitch: float) -> FloatArray:
    """Return the outline (k, 2) (rho, z), m, of a body with two flat faces, its rims without roundings.

    It is ``line`` itself where no rim is round. A rounding that is larger than a cell, ``pitch`` m wide,
    becomes a chamfer, or two, whose ends lie on it; a smaller one an edge, as a chamfer would be a row of
    slivers.
    """
    new = line
    for _ in range(2):  # the rim of the face at the tip, then that of the tail, both as it were a tip
        new = _sharp(new, pitch)
        new = np.stack([new[::-1, 0], new[-1, 1] - new[::-1, 1]], axis=1)
    return line if len(new) == len(line) else new


def _sharp(line: FloatArray, pitch: float) -> FloatArray:
    """Return the outline without the rounding at the edge of the face at z = 0, if there is one."""
    first = int(np.flatnonzero(line[:, 1] <= 0.0)[-1])
    rho, z = np.diff(line[first:], axis=0).T
    angle = np.concatenate([[0.0], np.arctan2(z, rho)])  # of the face, then of all steps behind it
    smooth = (np.abs(np.diff(angle)) < CORNER) & (angle[1:] < AXIAL)
    count = int(np.argmin(np.append(smooth, False)))
    if count < 2:
        return line
    rounding = line[first : first + count + 1]
    size = float(np.linalg.norm(rounding[-1] - rounding[0]))
    middle = int(np.searchsorted(angle[1 : count + 1], 0.5 * angle[count]))
    kept = rounding[[0, -1] if size < LARGE * pitch else [0, middle, -1]]
    if size < pitch:
        kept = np.array([[rounding[-1, 0], 0.0]])
    return np.concatenate([line[:first], kept, line[first + count + 1 :]])
