"""Single tests as seen from the barrier, and what follows from their velocities."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from fem_impact.arrays import Array
from fem_impact.scene.barrier import Barrier
from rigid import Arms, coefficients, impulse_ratio, kinetic_energy, losses

TURNING = (
    "The barrier turns: e, e_m and the losses of single tests are not worked out, since its motion after "
    "the impact is not in their file."
)


@dataclass(frozen=True, slots=True)
class SeenTests:
    """Single tests relative to the barrier: velocities by name, with the spin omega before, ``(n,)`` each.

    Attributes
    ----------
    motion : relative to the barrier as it moves before and after the impact, m/s and rad/s
    mass, k2 : kg, m2, of the equivalent body that strikes a massive barrier
    E_0, E_r : J, energy of the projectile before, and of its rigid motion after the impact, both as seen from
        the barrier before
    turns : whether the barrier turns, so that its velocity at the contact after the impact is not known
    """

    motion: Mapping[str, Array]
    mass: float
    k2: float
    E_0: Array
    E_r: Array
    turns: bool = False

    @classmethod
    def of(
        cls, stated: Mapping[str, Array], mass: float, k2: float, omega: float, barrier: Barrier | None
    ) -> Self:
        """Return tests of a body (kg, m2) that move over the ground as ``stated``, ``(n,)`` each.

        ``omega``, rad/s, is the spin before where they state none. What a free barrier has gained follows
        from momentum. None of a barrier stands for a massive one at rest.
        """
        v_bn, v_bt = (barrier.v_n, barrier.v_t) if barrier else (0.0, 0.0)
        ratio = mass / barrier.mass if barrier and barrier.mass else 0.0
        shift = {"v_n": v_bn, "v_t": v_bt, "V_n": v_bn, "V_t": v_bt}
        spins = {"omega": np.full_like(stated["v_n"], omega)}
        before = {**spins, **stated, **{name: stated[name] - own for name, own in shift.items()}}
        body = {"mass": mass, "k2": k2}
        gained = {f"V_{axis}": ratio * (stated[f"V_{axis}"] - stated[f"v_{axis}"]) for axis in "nt"}
        return cls(
            motion={**before, **{name: before[name] + more for name, more in gained.items()}},
            mass=mass / (1 + ratio),
            k2=k2 * (1 + ratio),
            E_0=kinetic_energy(before["v_n"], before["v_t"], before["omega"], **body),
            E_r=kinetic_energy(before["V_n"], before["V_t"], before["Omega"], **body),
            turns=bool(barrier and barrier.inertia),
        )

    def columns(self, arms: Arms) -> dict[str, Array]:
        """Return e, mu, e_m and the losses and the energy kept over E_0, ``(n,)`` each, with arms in m.

        On a barrier that turns these are mu and the energy kept. Raises ImpactError of a test that is no
        impact.
        """
        kept = {"E_r_over_E_0": self.E_r / self.E_0}
        if self.turns:
            return {
                "mu": impulse_ratio(*(self.motion[name] for name in ("v_n", "v_t", "V_n", "V_t"))),
                **kept,
            }
        numbers = {**arms._asdict(), "k2": self.k2}
        lost = losses(**self.motion, **numbers, mass=self.mass)
        shares = {"E_ln_over_E_0": lost.E_ln / self.E_0, "E_lt_over_E_0": lost.E_lt / self.E_0}
        return {**coefficients(**self.motion, **numbers)._asdict(), **shares, **kept}
