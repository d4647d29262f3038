"""When is the impact over? When nothing in the exact free flight to come can touch again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_impact.modes import Flight, RigidMotion
from fem_impact.solid.contact import SurfaceContact
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import RodView
from fem_impact.solid.state import State

Array = NDArray[np.float64]

HORIZON = 4e-3  # s, the camera's window: 40 frames at 10 kHz
SAMPLES = 2000
QUIET = 3e-6  # s without touch before it is worth asking


@dataclass(slots=True)
class Separation:
    """Stops the run at the last separation.

    The rod must have left the crater (its lowest node is above the barrier's highest) and its free
    flight, rigid drift plus all modes, must keep it there for the horizon.
    """

    model: Model
    view: RodView
    limit: float
    every: int = 100
    reason: str = ""
    finished: bool = False

    def observe(self, state: State) -> bool:
        """Return True when the impact is over or the time is up."""
        if state.time >= self.limit:
            self.reason = (
                f"Reached max_time = {self.limit * 1e3:g} ms before the last separation was certain."
            )
            return True
        book = self.model.book
        if not book.intervals or book.touching or state.time - book.last_touch < QUIET:
            return False
        top = self._top(state)
        if state.x[self.view.tip[:, 2]].min() <= top or not self._stays_away(state, top):
            return False
        self.finished = True
        self.reason = f"The free flight of the next {HORIZON * 1e3:g} ms has no further contact."
        return True

    def _top(self, state: State) -> float:
        contact = self.model.impulses[-1]
        if isinstance(contact, SurfaceContact):
            return max(0.0, float(state.x[contact.barrier.places[:, 2]].max()))
        return 0.0

    def _stays_away(self, state: State, top: float) -> bool:
        motion, ahead = self.view.rigid(state), self.view.flight(state, self.model)
        t = np.linspace(0.0, HORIZON, SAMPLES)
        return bool(flight_heights(state.x[self.view.tip], self.view.tip[:, 2], motion, ahead, t).min() > top)


def flight_heights(x: Array, rows: NDArray[np.int64], motion: RigidMotion, ahead: Flight, t: Array) -> Array:
    """Return heights n (k, times), m, of nodes at x (k, 3) in free flight after times t, s."""
    arm = x - motion.centre
    turned = np.outer(arm[:, 2], np.cos(motion.Omega * t)) - np.outer(arm[:, 0], np.sin(motion.Omega * t))
    shake = ahead.displacement(rows, t) - ahead.displacement(rows, np.zeros(1))
    return np.asarray(motion.centre[2] + motion.V_n * t + turned + shake)
