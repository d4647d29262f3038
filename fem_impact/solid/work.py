"""Who does what of a step: one thread all, or the first the rod and the contact, the second the barrier.

Whatever a body's forces are added up from is added by one thread, in one order, so not a bit depends on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.calls import call_of
from fem_impact.solid.items import Force
from fem_impact.solid.kernels import kernel
from fem_impact.solid.sparse import Hanging

if TYPE_CHECKING:
    from fem_impact.solid.model import Model

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Work:
    """What one thread does.

    Attributes
    ----------
    finds, collects : forces, in the order in which they are added
    gathered, expanded : ties whose forces, or values, it hands on
    cleared, kicked, drifted : (k, 2) runs of unknowns whose forces it clears, and which it kicks and moves
    """

    finds: Sequence[Force]
    collects: Sequence[Force]
    gathered: Hanging
    expanded: Hanging
    cleared: Ints
    kicked: Ints
    drifted: Ints


def whole(forces: Sequence[Force], hanging: Hanging, size: int) -> Work:
    """Return the work of a thread that is alone."""
    everything = np.array([[0, size]])
    return Work(forces, forces, hanging, hanging, everything, everything, everything)


def split(model: Model) -> tuple[Work, Work]:
    """Return the work of the first thread and of a second; both find what yields, block by block.

    The second moves the barrier while the first resolves the last impulse, the contact.
    """
    rod, moved = ~_of_barrier(model), touched(model)
    kicked, ties = moved.copy(), model.hanging
    for item in model.impulses:
        kicked[item.places] = True
    kicked[ties.rows(moved[ties.slaves[:, 0]]).masters] = True
    return _share(model, "rod", rod, moved, kicked), _share(model, "barrier", ~rod, ~moved, ~kicked)


def touched(model: Model) -> Bools:
    """Return the unknowns of the rod and all that the last impulse can change."""
    mask = ~_of_barrier(model)
    mask[model.impulses[-1].places] = True
    mask[model.hanging.slaves[model.hanging.follow(mask)]] = True
    return mask


def _of_barrier(model: Model) -> Bools:
    mask = np.zeros(model.layout.size, dtype=bool)
    mask[model.layout.barrier] = True
    return mask


def _share(model: Model, body: str, own: Bools, moved: Bools, kicked: Bools) -> Work:
    forces = [force for force in model.forces if force.body == body]
    others = [zone for zone in model.zones if zone.body != body]
    ties, slaves = model.hanging, model.hanging.slaves[:, 0]
    gathered, expanded = ties.rows(own[slaves]), ties.rows(moved[slaves])
    return Work([*forces, *others], forces, gathered, expanded, runs(own), runs(kicked), runs(moved))


def runs(mask: Bools) -> Ints:
    """Return (k, 2) the runs of True."""
    return np.flatnonzero(np.diff(mask, prepend=False, append=False)).reshape(-1, 2)


@kernel
def clear(force, runs):  # type: ignore[no-untyped-def]
    """Set forces to zero."""
    for r in range(len(runs)):
        force[runs[r, 0] : runs[r, 1]] = 0.0


@kernel
def kick(v, times, inverse_mass, force, runs):  # type: ignore[no-untyped-def]
    """Add what forces change of the velocities in the second of two ``times``, in one pass."""
    by = times[1]
    for r in range(len(runs)):
        for i in range(runs[r, 0], runs[r, 1]):
            v[i] += by * inverse_mass[i] * force[i]


@kernel
def drift(x, times, v, runs):  # type: ignore[no-untyped-def]
    """Add to positions what velocities do in the first of two ``times``, in one pass."""
    step = times[0]
    for r in range(len(runs)):
        for i in range(runs[r, 0], runs[r, 1]):
            x[i] += step * v[i]


Clearing = call_of(clear, "Clearing")
Kick = call_of(kick, "Kick")
Drift = call_of(drift, "Drift")
