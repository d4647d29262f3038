"""Plastic work in the uppermost layer of the barrier, which slip at the contact cannot be told from.

Under a sticking tip the plate shears in a layer for whose thickness its material has no length: finer meshes
move work from friction into plastic work right below.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.hexmodes import CORNERS, SIGNS
from fem_impact.solid.model import Model

if TYPE_CHECKING:
    from fem_impact.solid.yielding import YieldingZone

Array = NDArray[np.float64]

DEPTH = 0.1e-3  # m
SHAPES = np.prod(1 + SIGNS[None] * CORNERS[:, None], axis=2) / 8  # (points, nodes)


def skin_share(model: Model) -> float:
    """Return the share of the barrier's plastic work that is spent above `DEPTH`; 0 where it cannot yield."""
    for zone in model.zones:
        if zone.body == "barrier":
            return _share_above(zone, -model.start[0][zone.places()][:, :, 2])
    return 0.0


def _share_above(zone: YieldingZone, nodes: Array) -> float:
    """Return the share above `DEPTH` of elements whose nodes lie ``nodes`` (m, 8), m, under the surface.

    Within an element work divides as plastic strain does; a Gauss point's is spread over half the height.
    """
    top, bottom = nodes.min(axis=1)[:, None], nodes.max(axis=1)[:, None]
    middle = 0.5 * (top + bottom)
    low = nodes @ SHAPES.T > middle
    upper_end, height = np.where(low, middle, top), 0.5 * (bottom - top)
    above = np.clip((DEPTH - upper_end) / height, 0.0, 1.0)
    strain, work = zone.spent()
    total = strain.sum(axis=1)
    parts = np.divide((above * strain).sum(axis=1), total, out=np.zeros_like(total), where=total > 0)
    return float(parts @ work / work.sum()) if work.any() else 0.0
