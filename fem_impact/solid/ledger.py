"""The energy ledger: accounts, their doubling from the half to the whole model, and the residual.

At a sample, positions stand at time n and velocities half a step before, so the kinetic energy that
belongs to the positions is v . M v / 2 + dt v . f / 2: for a linear model leapfrog keeps its sum with
the strain energy exactly, and every impulse changes it by the impulse times the mean velocity.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fem_impact.arrays import Array
from fem_impact.solid.state import Item, State

# the accounts of all ledgers, 0 where the effect is off; items may add others
ACCOUNTS = (
    "kinetic_rod",
    "strain_rod",
    "plastic_rod",
    "kinetic_barrier",
    "strain_barrier",
    "plastic_barrier",
    "friction",
    "contact_dissipation",
    "radiated",
    "damping",
    "gravity",
)
HALVES = 2.0  # the mesh is half of the symmetric model


@dataclass(slots=True)
class Ledger:
    """Energies of the whole rod and barrier since the start, J.

    Attributes
    ----------
    mass : (size,) lumped masses, kg, of the half model (0 where nothing may move)
    rod : the rod's part of the flat vectors
    items : all items, with their accounts
    names : names of all accounts, those of `ACCOUNTS` first
    start : E_0, J; worst : largest residual so far, J
    """

    mass: Array
    rod: slice
    items: Sequence[Item]
    names: tuple[str, ...] = field(init=False)
    start: float = 0.0
    worst: float = 0.0

    def __post_init__(self) -> None:
        of_items = (name for item in self.items for name in item.accounts)
        self.names = tuple(dict.fromkeys((*ACCOUNTS, *of_items)))

    def sample(self, state: State) -> dict[str, float]:
        """Return all accounts (missing effects are 0) and the residual, J."""
        totals = dict.fromkeys(self.names, 0.0)
        whole = self._kinetic(state, slice(None))
        totals["kinetic_rod"] = self._kinetic(state, self.rod)
        totals["kinetic_barrier"] = whole - totals["kinetic_rod"]
        for item in self.items:
            for name, value in zip(item.accounts, item.energies(state), strict=True):
                totals[name] += value
        totals = {name: HALVES * value for name, value in totals.items()}
        total = sum(totals.values())
        if state.step == 0:
            self.start = total
        totals["residual"] = self.start - total
        self.worst = max(self.worst, abs(totals["residual"]))
        return totals

    def _kinetic(self, state: State, part: slice) -> float:
        """Return the kinetic energy, J, of a part of the half model at the time of the positions."""
        v, mass = state.v[part], self.mass[part]
        force = np.where(mass > 0, state.force[part], 0.0)
        return 0.5 * float(v @ (mass * v)) + 0.5 * state.dt * float(v @ force)
