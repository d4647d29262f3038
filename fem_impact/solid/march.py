"""The time loop: leapfrog with contact impulses, over lists of items and observers."""

from collections.abc import Sequence
from typing import Protocol

from fem_impact.fem.kernels import kernel
from fem_impact.solid.model import Model
from fem_impact.solid.state import State


class Observer(Protocol):
    """Sees the state every ``every`` steps, after the forces are computed and before the kick."""

    every: int

    def observe(self, state: State) -> bool:
        """Return True to stop."""
        ...


def evaluate(model: Model, state: State) -> None:
    """Set the forces at the present positions."""
    state.force[:] = 0.0
    for force in model.forces:
        force.add(state)
    model.hanging.collect(state.force)


def advance(model: Model, state: State) -> None:
    """Kick, resolve impulses, drift; forces must be up to date."""
    state.kick = 0.5 * (state.dt + state.dt_next)
    kick(state.v, state.kick, model.inverse_mass, state.force)
    for item in model.impulses:
        if state.step % item.every == 0:
            item.resolve(state)
    model.hanging.expand(state.v)
    drift(state.x, state.dt_next, state.v)
    state.dt = state.dt_next
    state.time += state.dt
    state.step += 1


def march(model: Model, state: State, observers: Sequence[Observer]) -> None:
    """Step until an observer stops the run.

    Velocities stand half a step behind positions, so the first kick from the given start velocity is
    a half one (no step has led to the start).
    """
    while True:
        evaluate(model, state)
        if any([o.observe(state) for o in observers if state.step % o.every == 0]):
            return
        advance(model, state)


@kernel
def kick(v, span, inverse_mass, force):  # type: ignore[no-untyped-def]
    """Add to velocities, m/s, the change by forces, N, in the time ``span``, s, in one pass."""
    for i in range(len(v)):
        v[i] += span * inverse_mass[i] * force[i]


@kernel
def drift(x, step, v):  # type: ignore[no-untyped-def]
    """Add to positions, m, the motion with velocities, m/s, in the time ``step``, s, in one pass."""
    for i in range(len(x)):
        x[i] += step * v[i]
