"""The time loop: leapfrog with contact impulses. It knows lists of items and observers, nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from fem_impact.solid.helper import COLLECT, FIND, Helper
from fem_impact.solid.items import Force
from fem_impact.solid.kernels import kernel
from fem_impact.solid.model import Model
from fem_impact.solid.state import State


class Observer(Protocol):
    """Looks at the state after the forces are known and before the kick; may stop the run."""

    every: int

    def observe(self, state: State) -> bool:
        """Return True to stop."""
        ...


@kernel
def add_product(y, a, b, c):  # type: ignore[no-untyped-def]
    """Add a b c to y in one pass, without temporaries."""
    for i in range(len(y)):
        y[i] += a * b[i] * c[i]


@kernel
def add_multiple(y, a, b):  # type: ignore[no-untyped-def]
    """Add a b to y in one pass."""
    for i in range(len(y)):
        y[i] += a * b[i]


def evaluate(model: Model, state: State, helper: Helper | None = None) -> None:
    """Set the forces of the present positions.

    A ``helper`` shares the work. No number is a sum of what two threads found, so results are the same to the
    last bit whoever did it.
    """
    if helper is None:
        find(model.forces, state)
        collect(model.forces, state)
    else:
        helper.begin(FIND, state.dt)
        find(helper.finds, state)
        helper.finish()
        helper.begin(COLLECT, state.dt)
        collect(helper.collects, state)
        helper.finish()
    model.hanging.collect(state.force)


def find(forces: Sequence[Force], state: State) -> None:
    """Find forces, and clear the sum that they will be added to."""
    state.force[:] = 0.0
    for force in forces:
        force.find(state)


def collect(forces: Sequence[Force], state: State) -> None:
    """Add up what was found."""
    for force in forces:
        force.collect(state)


def advance(model: Model, state: State) -> None:
    """Kick, resolve impulses, drift; forces must be up to date."""
    state.kick = 0.5 * (state.dt + state.dt_next)
    add_product(state.v, state.kick, model.inverse_mass, state.force)
    for item in model.impulses:
        item.resolve(state)
    model.hanging.expand(state.v)
    add_multiple(state.x, state.dt_next, state.v)
    state.dt = state.dt_next
    state.time += state.dt
    state.step += 1


def march(model: Model, state: State, observers: Sequence[Observer], helper: Helper | None = None) -> None:
    """Step until an observer says stop.

    Velocities stand half a step behind positions, so the first kick from the given start velocity is
    a half one (no step has led to the start).
    """
    while True:
        evaluate(model, state, helper)
        if any([o.observe(state) for o in observers if state.step % o.every == 0]):
            return
        advance(model, state)
