"""Shoulders of a turned body as hexahedra hold them: a cone in place of a sudden step of the radius."""

import numpy as np

from meshes.common import FloatArray
from meshes.surface import CORNER

STEEPEST = np.tan(np.deg2rad(75.0))  # of the radius over z between two sections
SPREAD = 0.5  # length of a cone over the step of the radius
ROOM = 0.25  # height of a row of cells beside a cone that cells make longer, over theirs


def eased(line: FloatArray, pitch: FloatArray) -> tuple[FloatArray, list[float]]:
    """Return the line (k, 2) (rho, z), m, with a cone for each shoulder, and the heights, m, of these.

    A shoulder is a step of the radius of an outline or a bore between two corners, steeper than sections of
    hexahedra can follow. Its cone is half as long as the step is high, but no shorter than the cells beside
    it, ``pitch`` (k,) m, so that it is no row of slivers. It has the same volume between straight
    neighbours; one that finds no room between them stays as it is. Faces at both ends are no shoulders.
    """
    rise, along = np.diff(line, axis=0).T
    turn = np.abs(np.diff(np.arctan2(rise, along)))
    new, cones = line.copy(), list[float]()
    for k in range(1, len(line) - 2):
        (before, low), (after, high) = line[k], line[k + 1]
        steep = abs(rise[k]) > STEEPEST * along[k] and min(turn[k - 1], turn[k]) > CORNER
        if not steep or min(before, after) <= 0.0:
            continue
        length, cell = SPREAD * abs(rise[k]), float(pitch[k : k + 2].min())
        half, room = 0.5 * max(length, cell), ROOM * cell if length < cell else 0.0
        middle = 0.5 * (low + high) - half * (after - before) / (3.0 * (after + before))  # the same volume
        ends = np.array([middle - half, middle + half])
        if new[k - 1, 1] + room < ends[0] and ends[1] + room < line[k + 2, 1]:
            radii = [
                np.interp(z, *line[at : at + 2, ::-1].T) for z, at in zip(ends, (k - 1, k + 1), strict=True)
            ]
            new[k : k + 2] = np.stack([radii, ends], axis=1)
            cones.append(float(0.5 * (low + high)))
    return new, cones
