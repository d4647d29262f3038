"""What a free barrier has beside its meshed block: a rigid body of all the mass and inertia left."""

from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.layers import lighter_than_block
from fem_impact.errors import SceneError
from fem_impact.scene.barrier import Barrier


class RestOfBarrier(NamedTuple):
    """Half of the rest: its mass, kg; its mass centre (t, n), m; its inertia about it, kg m2.

    The inertia is 0 where the barrier does not turn.
    """

    mass: float
    centre: Array
    inertia: float


def rest_of(barrier: Barrier, mass: Array, x: Array) -> RestOfBarrier:
    """Return what a free barrier has beside the half block with node masses, kg, at ``x``, m, both (3 k,).

    The mass centres and moments of inertia of both add up to those that are stated.

    Raises
    ------
    SceneError
        If the block alone is heavier, or needs more inertia.
    """
    block, whole = 2 * float(mass.sum()) / 3, barrier.mass or 0.0
    if whole <= block:
        raise lighter_than_block(whole, block)
    rest = 0.5 * (whole - block)
    if barrier.inertia is None:
        return RestOfBarrier(rest, np.zeros(2), 0.0)
    stated = np.array([barrier.centre_offset, -(barrier.centre_depth or 0.0)])
    m, away = mass.reshape(-1, 3)[:, 0], x.reshape(-1, 3)[:, [0, 2]] - stated
    shift = -(m @ away) / rest
    taken = float(m @ (away**2).sum(axis=1) + rest * (shift @ shift))
    if barrier.inertia <= 2 * taken:
        raise SceneError(
            f"is less than that of its meshed block with the rest of the mass in one point, {2 * taken:.3g} "
            "kg m2.",
            key="barrier.inertia",
            value=f"{barrier.inertia:.3g} kg m2",
            remedy="Give a smaller accuracy.block_margin, or the effect barrier-rigid.",
        )
    return RestOfBarrier(rest, stated + shift, 0.5 * barrier.inertia - taken)
