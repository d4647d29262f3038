"""The dent that stays in a meshed barrier."""

import numpy as np

from fem_impact.arrays import Array
from fem_impact.solid.contact.patch import Patch


def dent(patch: Patch, x: Array) -> tuple[float, float]:
    """Return the depth, m, and the volume, m3, of the dent in a barrier's skin, of the whole barrier.

    Both are below the plane through the skin's border, which follows a barrier that moved, bent or turned. A
    lip above it does not count.

    Parameters
    ----------
    patch : skin of the half model that may touch
    x : positions of all unknowns, m
    """
    points = x[patch.places]
    edge = patch.neighbours < 0
    ends = np.concatenate([patch.quads[edge], np.roll(patch.quads, -1, axis=1)[edge]])
    border = np.setdiff1d(ends, np.flatnonzero(patch.mirrored))
    # the skin is a mirror image of itself: its border has no slope across the plane of motion
    t, heights = points[:, 0], points[:, 2]
    slope, level = np.polyfit(t[border], heights[border], 1)
    sunk = np.maximum(slope * t + level - heights, 0.0)
    a, b, c, d = points[patch.quads][:, :, :2].transpose(1, 0, 2)
    (t1, b1), (t2, b2) = (c - a).T, (d - b).T
    area = 0.5 * np.abs(t1 * b2 - b1 * t2)
    return float(sunk.max()), 2 * float(area @ sunk[patch.quads].mean(axis=1))
