"""The step follows the elements as they deform, and a run that cannot go on says where and why."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fem_impact.errors import RunError
from fem_impact.solid.hexmodes import reference_gradients
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.solid.yielding_kernel import CORNERS

Array = NDArray[np.float64]

SMALLEST = 0.02  # of the first step: below it the elements are crushed beyond use


REFERENCE = reference_gradients(CORNERS)


def gradient_squares(x: Array) -> Array:
    """Return max over Gauss points of sum |grad N|^2 (m,), 1/m2, of elements (m, 8, 3); nan if folded.

    An element's largest frequency grows like the square root of this number.
    """
    J = np.einsum("qai,maj->mqij", REFERENCE, x)
    det = np.linalg.det(J)
    folded = (det <= 0).any(axis=1) | ~np.isfinite(det).all(axis=1)
    J[folded] = np.eye(3)
    gradient = np.einsum("qai,mqji->mqaj", REFERENCE, np.linalg.inv(J))
    return np.where(folded, np.nan, (gradient**2).sum(axis=(2, 3)).max(axis=1))


@dataclass(slots=True)
class StepGuard:
    """Sets the next step from the present shape of the yielding elements.

    Attributes
    ----------
    limit : (m,) stable step of each yielding element at the start, s; square : its gradient number
    """

    model: Model
    every: int = 100
    places: NDArray[np.int64] = field(init=False)
    square: Array = field(init=False)
    smallest: float = field(init=False)

    def __post_init__(self) -> None:
        zones = [zone.places() for zone in self.model.zones]
        self.places = np.concatenate(zones) if zones else np.zeros((0, 8, 3), dtype=np.int64)
        self.square = gradient_squares(self.model.start[0][self.places])
        self.smallest = self.model.step

    def observe(self, state: State) -> bool:
        """Shorten or restore the step; refuse to go on with a folded element."""
        if not np.isfinite(state.v @ state.v):
            raise RunError(f"The motion is not finite at {state.time * 1e6:.2f} us, step {state.step}.")
        if len(self.places):
            self._follow(state)
        return False

    def _follow(self, state: State) -> None:
        now = gradient_squares(state.x[self.places])
        if not np.isfinite(now).all():
            worst = state.x[self.places[int(np.flatnonzero(~np.isfinite(now))[0])]].mean(axis=0) * 1e3
            raise RunError(
                f"An element folded at {state.time * 1e6:.2f} us, step {state.step}, near t, b, n = "
                f"{worst[0]:.2f}, {worst[1]:.2f}, {worst[2]:.2f} mm. "
                "Use a coarser accuracy.tip_size or a lower speed."
            )
        # every element is held to the worst element's step at the start: simple and safe
        state.dt_next = self.model.step * min(1.0, float(np.sqrt(self.square.max() / now.max())))
        self.smallest = min(self.smallest, state.dt_next)
        if state.dt_next < SMALLEST * self.model.step:
            raise RunError(
                f"Elements are crushed to under {SMALLEST:g} of their step at {state.time * 1e6:.2f} us."
            )
