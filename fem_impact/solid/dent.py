"""The dent in a meshed barrier, under the surface around it."""

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.solid.contact.patch import Patch


def border(patch: Patch) -> Ints:
    """Return the nodes (m,) of a skin's border, without those inside it on the plane of motion."""
    edge = patch.neighbours < 0
    ends = np.concatenate([patch.quads[edge], np.roll(patch.quads, -1, axis=1)[edge]])
    return np.setdiff1d(ends, np.flatnonzero(patch.mirrored))


def sunk(patch: Patch, around: Ints, x: Array) -> Array:
    """Return how far each node (k,) of a skin lies below the plane through its border ``around``, m.

    That plane follows a barrier that moved, bent or turned. ``x`` are the positions of all unknowns, m.
    """
    t, heights = x[patch.places[:, 0]], x[patch.places[:, 2]]
    # the skin is a mirror image of itself: its border has no slope across the plane of motion
    middle, level = t[around].mean(), heights[around].mean()
    slope = (t[around] - middle) @ (heights[around] - level) / ((t[around] - middle) ** 2).sum()
    return np.asarray(slope * (t - middle) + level - heights)


def dent(patch: Patch, x: Array) -> tuple[float, float]:
    """Return the depth, m, and the volume, m3, of the dent in a barrier's skin, of the whole barrier.

    A lip above the surface around it does not count.

    Parameters
    ----------
    patch : skin of the half model that may touch
    x : positions of all unknowns, m
    """
    deep = np.maximum(sunk(patch, border(patch), x), 0.0)
    a, b, c, d = x[patch.places][patch.quads][:, :, :2].transpose(1, 0, 2)
    (t1, b1), (t2, b2) = (c - a).T, (d - b).T
    area = 0.5 * np.abs(t1 * b2 - b1 * t2)
    return float(deep.max()), 2 * float(area @ deep[patch.quads].mean(axis=1))
