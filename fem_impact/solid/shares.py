"""Run time of each effect: the items of a model are timed one by one after the run."""

from __future__ import annotations

import timeit
from collections import defaultdict
from collections.abc import Callable
from functools import partial
from time import process_time
from typing import TYPE_CHECKING

from fem_impact.solid.frame import TurningFrame
from fem_impact.solid.state import State

if TYPE_CHECKING:
    from fem_impact.solid.heatwatch import HeatWatch
    from fem_impact.solid.model import Model


REPEATS = 5


def run_time_shares(
    model: Model, state: State, step_time: float, heat: HeatWatch | None = None
) -> dict[str, float | None]:
    """Return the share of the mean step, ``step_time`` in s, that each effect's own items take.

    A processor that is slower after the run than in it would make the items longer than their step: a step
    takes their sum at least. A share is None where the processor's clock does not resolve it. Friction and
    rate hardening have no items of their own: they are in the contact's and the zones' time. The state of
    the items is used up; call it last.
    """
    still = State(state.x.copy(), state.v.copy(), state.force.copy(), dt=0.0, kick=model.step)
    seconds: dict[str, float] = defaultdict(float)
    for force in model.forces:
        seconds[force.effect] += _shortest(partial(force.add, still))
    for item in model.impulses:
        if item is not model.contact:  # no effect, and its record must stay
            seconds[item.effect] += _shortest(partial(item.resolve, still)) / item.every
    if heat is not None:
        seconds["contact-heating"] += _shortest(partial(heat.observe, still))
    # the nose of a rigid rest turns with or without the effect
    if isinstance(model.rod.frame, TurningFrame) and model.rod_stiffness is not None:
        # the time, s, that the rod's frame takes in a step for turning
        rod, n = model.rod, len(model.rod.d)
        localising = _shortest(lambda: rod.frame.localise(still.x[:n], rod.d))
        turning = localising + _shortest(lambda: rod.frame.add_force(rod.d, rod.y, still.force[:n]))
        seconds["large-rotation"] += turning
        seconds[model.rod.effect] -= turning
    step = max(step_time, sum(time for time in seconds.values() if time > 0))
    return {effect: time / step if min(time, step_time) > 0 else None for effect, time in seconds.items()}


def _shortest(act: Callable[[], object]) -> float:
    """Return the shortest processor time, s, of a few calls."""
    return min(timeit.repeat(act, timer=process_time, number=1, repeat=REPEATS))
