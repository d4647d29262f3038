"""The step follows the elements as they deform, and a run that cannot go on says where and why."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fem_impact.errors import RunError
from fem_impact.solid.model import Model
from fem_impact.solid.stable import gradient_squares
from fem_impact.solid.state import State

Array = NDArray[np.float64]

SMALLEST = 0.02  # of the first step: below it the elements are crushed beyond use


@dataclass(slots=True)
class StepGuard:
    """Sets the next step from the present shape of the yielding elements.

    Attributes
    ----------
    places : (m, 8, 3) unknowns of the yielding elements
    limit : (m,) stable step of each one's body at the start, s; square : (m,) its gradient number then
    smallest : smallest step so far, s
    """

    model: Model
    every: int = 100
    places: NDArray[np.int64] = field(init=False)
    limit: Array = field(init=False)
    square: Array = field(init=False)
    smallest: float = field(init=False)

    def __post_init__(self) -> None:
        zones = [zone.places() for zone in self.model.zones]
        self.places = np.concatenate(zones) if zones else np.zeros((0, 8, 3), dtype=np.int64)
        steps = [np.full(zone.count, self.model.steps[zone.body]) for zone in self.model.zones]
        self.limit = np.concatenate([*steps, np.zeros(0)])
        self.square = gradient_squares(self.model.start[0], self.places)
        self.smallest = self.model.step

    def observe(self, state: State) -> bool:
        """Shorten or restore the step; refuse to go on with a folded element."""
        if not np.isfinite(state.v @ state.v):
            raise RunError(f"The motion is not finite at {state.time * 1e6:.2f} us, step {state.step}.")
        if len(self.places):
            self._follow(state)
        return False

    def _follow(self, state: State) -> None:
        now = gradient_squares(state.x, self.places)
        if not np.isfinite(now).all():
            worst = state.x[self.places[int(np.flatnonzero(~np.isfinite(now))[0])]].mean(axis=0) * 1e3
            raise RunError(
                f"An element folded at {state.time * 1e6:.2f} us, step {state.step}, near t, b, n = "
                f"{worst[0]:.2f}, {worst[1]:.2f}, {worst[2]:.2f} mm. "
                "Use a coarser accuracy.tip_size or a lower speed."
            )
        # as if the whole body were squeezed like the element: no element alone does worse
        allowed = float((self.limit * np.sqrt(self.square / now)).min())
        state.dt_next = min(self.model.step, allowed)
        self.smallest = min(self.smallest, state.dt_next)
        if state.dt_next < SMALLEST * self.model.step:
            raise RunError(
                f"Elements are crushed to under {SMALLEST:g} of their step at {state.time * 1e6:.2f} us."
            )
