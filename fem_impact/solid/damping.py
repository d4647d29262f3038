"""Material damping of the rod's lowest free modes, as viscous damping of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from fem_impact.modes import RodModes
from fem_impact.solid.frame import FixedFrame, TurningFrame
from fem_impact.solid.state import State

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

PHASE = 0.3  # of the highest mode between two applications, rad


@dataclass(slots=True)
class ModalDamping:
    """Takes from each mode's velocity what damping with the loss factor takes: q' falls by exp(-eta omega t).

    A mode's energy then decays like exp(-eta omega t). Rigid motion is no mode and keeps its momentum.

    Attributes
    ----------
    modes : in the reference position; weighted : (modes, n), their shapes times mass
    frame : of the rod's linear part, for its angle
    places : (k, 3) int64, unknowns of the rod's free nodes
    loss : loss factor eta; every : steps between two applications
    taken : energy, J, of the half model; last : time of the last application, s
    """

    effect: ClassVar[str] = "material-damping"
    accounts: ClassVar[tuple[str, ...]] = ("damping",)
    moving: ClassVar[tuple[str, ...]] = ("taken", "last")
    modes: RodModes
    weighted: Array
    frame: FixedFrame | TurningFrame
    inverse_mass: Array
    places: Ints
    loss: float
    every: int
    taken: float = 0.0
    last: float = 0.0

    @classmethod
    def of(
        cls,
        modes: RodModes,
        frame: FixedFrame | TurningFrame,
        inverse_mass: Array,
        places: Ints,
        loss: float,
        step: float,
    ) -> ModalDamping:
        """Apply often enough for the highest mode, at steps of ``step``, s."""
        every = max(1, int(PHASE / modes.omega[-1] / step))
        weighted = np.ascontiguousarray(modes.shape.T * modes.mass)
        return cls(modes, weighted, frame, inverse_mass, places, loss, every)

    def resolve(self, state: State) -> None:
        """Damp and book the work with the mean of old and new velocity."""
        n = len(self.modes.mass)
        kicked = self._turned(state.v[:n], -self.frame.angle)
        pushed = self._turned(self.inverse_mass * state.force[:n], -self.frame.angle)
        q = self.weighted @ kicked
        old = q - state.kick * (self.weighted @ pushed)
        lost = q * -np.expm1(-self.loss * self.modes.omega * (state.time - self.last))
        self.last = state.time
        self.taken += 0.5 * float(lost @ (old + q - lost))
        state.v[:n] -= self._turned(self.modes.shape @ lost, self.frame.angle)

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the energy taken so far."""
        return (self.taken,)

    def _turned(self, v: Array, angle: float) -> Array:
        """Return a vector of the rod turned from t towards n."""
        result, (t, n) = v.copy(), (self.places[:, 0], self.places[:, 2])
        result[t] = np.cos(angle) * v[t] - np.sin(angle) * v[n]
        result[n] = np.cos(angle) * v[n] + np.sin(angle) * v[t]
        return result
