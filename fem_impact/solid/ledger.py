"""The energy ledger: one module owns the accounts, half-to-whole and the residual.

At a sample, positions stand at time n and velocities half a step before, so the kinetic energy that
belongs to the positions is v . M v / 2 + dt v . f / 2: for a linear model leapfrog keeps its sum with
the strain energy exactly, and every impulse changes it by the impulse times the mean velocity.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.items import Account
from fem_impact.solid.state import State

Array = NDArray[np.float64]

ACCOUNTS = (
    "kinetic_rod",
    "strain_rod",
    "plastic_rod",
    "kinetic_barrier",
    "strain_barrier",
    "plastic_barrier",
    "friction",
    "closing",
    "radiated",
    "damping",
    "gravity",
)
HALVES = 2.0  # the mesh is half of a symmetric whole


@dataclass(slots=True)
class Ledger:
    """Energies of the whole rod and barrier since the start, J.

    Attributes
    ----------
    mass : (size,) lumped masses, kg, of the half model (0 where nothing may move)
    rod : the rod's part of the flat vectors
    items : everything with accounts
    start : E_0, J
    """

    mass: Array
    rod: slice
    items: Sequence[Account]
    start: float = 0.0
    worst: float = field(default=0.0)

    def sample(self, state: State) -> dict[str, float]:
        """Return all accounts (missing effects are 0) and the residual, J."""
        totals = dict.fromkeys(ACCOUNTS, 0.0)
        whole = self._kinetic(state, slice(None))
        totals["kinetic_rod"] = self._kinetic(state, self.rod)
        totals["kinetic_barrier"] = whole - totals["kinetic_rod"]
        for item in self.items:
            for name, value in item.accounts(state).items():
                totals[name] += value
        totals = {name: HALVES * value for name, value in totals.items()}
        total = sum(totals.values())
        if state.step == 0:
            self.start = total
        totals["residual"] = self.start - total
        self.worst = max(self.worst, abs(totals["residual"]))
        return totals

    def _kinetic(self, state: State, part: slice) -> float:
        v = state.v[part]
        return 0.5 * float(v @ (self.mass[part] * v)) + 0.5 * state.dt * float(v @ self._pushed(state, part))

    def _pushed(self, state: State, part: slice) -> Array:
        return np.where(self.mass[part] > 0, state.force[part], 0.0)
