"""The step follows the elements as they deform, and a run that cannot go on says where and why."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from fem_impact.errors import RunError
from fem_impact.solid.model import Model
from fem_impact.solid.stable import gradient_squares
from fem_impact.solid.state import State

Array = NDArray[np.float64]

SMALLEST = 0.02  # of the first step: below it the elements are crushed beyond use
REMEDY = "Use a coarser accuracy.tip_size or a lower speed."


@dataclass(slots=True)
class StepGuard:
    """Sets the next step from the present shape of the yielding elements.

    Attributes
    ----------
    places : (m, 8, 3) unknowns of the yielding elements
    limit : (m,) stable step of each one's body at the start, s; square : (m,) its gradient number then
    smallest : smallest step so far, s
    """

    moving: ClassVar[tuple[str, ...]] = ("smallest",)
    model: Model
    every: int = 100
    places: NDArray[np.int64] = field(init=False)
    limit: Array = field(init=False)
    square: Array = field(init=False)
    smallest: float = field(init=False)
    reason: str = ""

    def __post_init__(self) -> None:
        zones = [zone.places() for zone in self.model.zones]
        self.places = np.concatenate(zones) if zones else np.zeros((0, 8, 3), dtype=np.int64)
        steps = [np.full(zone.count, self.model.steps[zone.body]) for zone in self.model.zones]
        self.limit = np.concatenate([*steps, np.zeros(0)])
        self.square = gradient_squares(self.model.start[0], self.places)
        self.smallest = self.model.step

    def observe(self, state: State) -> bool:
        """Shorten or restore the step; stop at a folded or crushed element."""
        if not np.isfinite(state.v @ state.v):
            raise RunError(self._not_finite(state))
        if len(self.places):
            self._follow(state)
        return bool(self.reason)

    def _follow(self, state: State) -> None:
        now = gradient_squares(state.x, self.places)
        folded = ~np.isfinite(now)
        if folded.any():
            self.reason = f"An element folded {self._where(state, int(np.argmax(folded)))} {REMEDY}"
            return
        # as if the whole body were squeezed like the element: no element alone does worse
        allowed = float((self.limit * np.sqrt(self.square / now)).min())
        state.dt_next = min(self.model.step, allowed)
        self.smallest = min(self.smallest, state.dt_next)
        if state.dt_next < SMALLEST * self.model.step:
            place = self._where(state, int(np.argmax(now)))
            self.reason = f"An element was crushed to under {SMALLEST:g} of its step {place} {REMEDY}"

    def _where(self, state: State, element: int) -> str:
        return when_and_where(state, state.x[self.places[element]].mean(axis=0))

    def _not_finite(self, state: State) -> str:
        layout = self.model.layout
        nodes = np.concatenate([layout.rod, layout.barrier])
        first = int(np.argmax(~np.isfinite(state.v[nodes]).all(axis=1)))
        place = when_and_where(state, self.model.start[0][nodes[first]])
        return f"The motion is not finite {place} What was computed before is kept. {REMEDY}"


def when_and_where(state: State, place: Array) -> str:
    """Return words for the present time and a place (t, b, n), m."""
    t, b, n = place * 1e3
    return f"at {state.time * 1e6:.2f} us, step {state.step}, near t, b, n = {t:.2f}, {b:.2f}, {n:.2f} mm."
