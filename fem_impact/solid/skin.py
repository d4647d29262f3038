"""How much harder each Gauss point is that lies in the hardened layer of a cut surface."""

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.hexmodes import CORNERS, SIGNS
from fem_impact.physics.hardening import Skin


def strengths(cells: Ints, under: Array, skin: Skin) -> Array:
    """Return the factor of the flow stress (m, 8) at the Gauss points of ``cells`` (m, 8).

    ``under`` (n,), m, is how deep each node lies under the surface. A Gauss point stands for the part of its
    cell between its corner and the middle, and has its mean factor.
    """
    corner = [int(np.flatnonzero((SIGNS == np.sign(point)).all(axis=1))[0]) for point in CORNERS]
    ends = np.stack([under[cells[:, corner]], np.repeat(under[cells].mean(axis=1)[:, None], 8, axis=1)])
    top, bottom = ends.min(axis=0), ends.max(axis=0)
    return skin.mean(top, bottom)


def below_outline(points: Array, outline: Array) -> Array:
    """Return the distances (n,), m, of points (n, 3) from the outline (k, 2) (rho, z) of their body."""
    place = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
    start, along = outline[:-1], np.diff(outline, axis=0)
    length2 = np.maximum((along**2).sum(axis=1), 1e-30)
    share = np.clip(((place[:, None] - start) * along).sum(axis=2) / length2, 0.0, 1.0)
    away = place[:, None] - start - share[:, :, None] * along
    return np.asarray(np.linalg.norm(away, axis=2).min(axis=1))
