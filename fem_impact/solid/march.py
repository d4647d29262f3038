"""The time loop: leapfrog with contact impulses. It knows lists of items and observers, nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from fem_impact.solid.helper import Helper
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.solid.work import clear, drift, kick


class Observer(Protocol):
    """Looks at the state after the forces are known and before the kick; may stop the run."""

    every: int

    def observe(self, state: State) -> bool:
        """Return True to stop."""
        ...


def evaluate(model: Model, state: State, helper: Helper | None = None) -> None:
    """Set the forces of the present positions.

    A ``helper`` shares the work. No number is a sum of what two threads found, so results are the same to the
    last bit whoever did it.
    """
    work = helper.left if helper else model.work
    if helper:
        helper.find(state)
    for force in work.finds:
        force.find(state)
    if helper:
        helper.finish()
        helper.collect()
    clear(state.force, work.cleared)
    for force in work.collects:
        force.collect(state)
    work.gathered.collect(state.force)
    if helper:
        helper.finish()


def advance(model: Model, state: State, helper: Helper | None = None) -> None:
    """Kick, resolve impulses, drift; forces must be up to date.

    A ``helper`` moves what the last impulse cannot touch, and goes on to the forces there.
    """
    work = helper.left if helper else model.work
    state.kick = 0.5 * (state.dt + state.dt_next)
    times = np.array([state.dt_next, state.kick])
    kick(state.v, times, model.inverse_mass, state.force, work.kicked)
    for item in model.impulses[:-1]:
        item.resolve(state)
    if helper:
        helper.move(times)
    for item in model.impulses[-1:]:
        item.resolve(state)
    work.expanded.expand(state.v)
    drift(state.x, times, state.v, work.drifted)
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
        advance(model, state, helper)
