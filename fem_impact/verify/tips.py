"""Round tips striking along their axis: fine zone, run, reading of the contact."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log2

import numpy as np
from numpy.typing import NDArray

import meshes
from fem_impact.modes import RigidMotion
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.verify.bodies import rigid_of
from fem_impact.verify.watch import Force, Until
from meshes import HexMesh, Zone

__all__ = ["Strike", "block_under", "contact_zone", "levels_for_radius", "run_strike"]

Array = NDArray[np.float64]

MARGIN = 16.0  # the block reaches so many contact radii beyond its fine zone; 8 are 0.3 % too soft
REACH = 1.3  # half-width of the fine zone over the contact radius
SMOOTHING = 0.05  # window of the peak force over the contact time


@dataclass(frozen=True, slots=True)
class Strike:
    """End of a strike.

    Attributes
    ----------
    force, duration : largest force, N; contact time, s
    motion : rigid motion after it
    radiated, closing : energy that left through the block's boundary, and that closing nodes lost, J
    most : largest energy on the way over E_0
    """

    force: float
    duration: float
    motion: RigidMotion
    radiated: float
    closing: float
    most: float
    state: State

    def kept(self, speed: float) -> float:
        """Return the energy of the rebound and what was radiated over that of the approach at ``speed``."""
        return (self.motion.kinetic + self.radiated) / (0.5 * self.motion.mass * speed**2)


def contact_zone(radius: float, depth: float) -> Zone:
    """Return the fine zone around the pole at the origin for a contact radius, m."""
    half = REACH * radius
    return Zone(np.zeros(3), np.eye(3), np.array([-half, 0.0, -depth]), np.array([half, half, depth]))


def block_under(radius: float, base: float, levels: int, slide: float = 0.0) -> HexMesh:
    """Return a block whose cells of edge ``base`` are split as often as the tip's, for a contact radius.

    The tip moves on by ``slide``, m, towards -t while it touches.
    """
    half, around = REACH * radius, max(MARGIN * radius, 2 * base)
    low, high = np.array([-half - slide, 0.0, -radius]), np.array([half, half, 0.0])
    zone = Zone(np.zeros(3), np.eye(3), low, high)
    low, high = low - around, high + around
    low[1] = high[2] = 0.0
    return meshes.block(low, high, base, zone=zone, levels=levels)


def levels_for_radius(base: float, radius: float, cells: float) -> int:
    """Return how often cells of edge ``base`` are split to have so many over the contact radius."""
    return max(0, ceil(log2(base * cells / radius) - 0.1))


def run_strike(model: Model, end: float, expected: float) -> Strike:
    """March until ``end`` s and read the contact."""
    state, force = model.initial_state(), Force(model)
    energy = Until(model.ledger(), end, every=20)
    march(model, state, [force, energy])
    start, stop = force.span
    peak = force.peak(SMOOTHING * expected)
    spent = energy.ledger.sample(state)
    motion = rigid_of(model, state)
    return Strike(peak, stop - start, motion, spent["radiated"], spent["closing"], energy.most, state)
