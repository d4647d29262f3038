"""What each effect costs: the items of a model timed by themselves after the run."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, cast

import numpy as np

from fem_impact.scene import BARRIERS
from fem_impact.solid.frame import TurningFrame
from fem_impact.solid.items import Account
from fem_impact.solid.state import State

if TYPE_CHECKING:
    from fem_impact.scene import Scene
    from fem_impact.solid.damping import ModalDamping
    from fem_impact.solid.heatwatch import HeatWatch
    from fem_impact.solid.model import Model

REPEATS = 5
# classes of items, by name so that none is imported in vain, and the effect that they are; the nose is there
# without any effect
SINGLE = {
    "ElasticRod": "vibration",
    "ElasticNose": "nose",
    "RigidRest": "nose",
    "Weight": "gravity",
    "Dashpots": "radiation",
    "ModalDamping": "material-damping",
}


def run_time_shares(
    scene: Scene, model: Model, state: State, step_time: float, heat: HeatWatch | None = None
) -> dict[str, float]:
    """Return the share of the mean step, ``step_time`` in s, that each effect's own items take.

    Friction and rate hardening have no items of their own: they are in the contact's and the zones' time.
    The state of the items is used up; call it last.
    """
    still = State(state.x.copy(), state.v.copy(), state.force.copy(), dt=0.0, kick=model.step)
    shares: dict[str, float] = {}
    barrier = next(name for name in scene.active if name in BARRIERS)
    acts: list[tuple[Account, Callable[[State], None]]] = [(item, item.add) for item in model.forces]
    acts += [(item, item.resolve) for item in model.impulses if item is not model.contact]
    for item, act in acts:
        name = _effect(item, model, barrier)
        every = cast("ModalDamping", item).every if name == "material-damping" else 1
        shares[name] = shares.get(name, 0.0) + _shortest(partial(act, still)) / every / step_time
    if heat is not None:
        shares["contact-heating"] = _shortest(lambda: heat.observe(still)) / step_time
    rod = model.rod
    if isinstance(rod.frame, TurningFrame):
        n = len(rod.d)
        turning = _shortest(lambda: rod.frame.localise(still.x[:n], rod.d))
        turning += _shortest(lambda: rod.frame.add_force(rod.d, rod.y, still.force[:n]))
        shares["large-rotation"] = turning / step_time
        shares[SINGLE[type(rod).__name__]] -= turning / step_time
    return shares


def _effect(item: Account, model: Model, barrier: str) -> str:
    for zone in model.zones:
        if zone is item:
            return "rod-plasticity" if zone.body == "rod" else barrier
    return {**SINGLE, "ElasticBlock": barrier}[type(item).__name__]


def _shortest(act: Callable[[], object]) -> float:
    times = []
    for _ in range(REPEATS):
        begun = perf_counter()
        act()
        times.append(perf_counter() - begun)
    return float(np.min(times))
