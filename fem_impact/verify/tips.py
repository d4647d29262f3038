"""Round tips striking along their axis: fine zone, run, reading of the contact."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log2

import numpy as np
from numpy.typing import NDArray

from fem_impact.modes import RigidMotion
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.verify.bodies import rigid_of
from fem_impact.verify.watch import Force, Until
from meshes import Zone

__all__ = ["Strike", "contact_zone", "levels_for_radius", "run_strike"]

Array = NDArray[np.float64]

REACH = 1.3  # half-width of the fine zone over the contact radius
SMOOTHING = 0.05  # window of the peak force over the contact time


@dataclass(frozen=True, slots=True)
class Strike:
    """End of a strike: peak force, N; contact time, s; number of touches; rigid motion; energy above E_0."""

    force: float
    duration: float
    motion: RigidMotion
    most: float
    state: State


def contact_zone(radius: float, depth: float) -> Zone:
    """Return the fine zone around the pole at the origin for a contact radius, m."""
    half = REACH * radius
    return Zone(np.zeros(3), np.eye(3), np.array([-half, 0.0, -depth]), np.array([half, half, depth]))


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
    return Strike(peak, stop - start, rigid_of(model, state), energy.most, state)
