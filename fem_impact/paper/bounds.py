"""The worst that can happen: largest losses over mu <= mu_c, and bounds of the friction heat."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_impact.paper.case import Case
from rigid import critical_ratio, pinned_loss, sliding_path, worst_case
from rigid.arrays import Floats

__all__ = ["Range", "Worst", "largest_loss_whatever", "sliding_heat", "worst_losses"]

STEPS = 9
FRICTION = np.concatenate([np.linspace(0.0, 1.5, 601), np.geomspace(1.6, 50.0, 20)])
"""Coulomb coefficients that are searched for the most friction work; beyond 50 nothing changes."""


@dataclass(frozen=True, slots=True)
class Range:
    """What is not known of the case.

    Attributes
    ----------
    e : tuple of float
        Least and largest restitution.
    d_c : tuple of float
        Least and largest arm of the impulse, m.
    """

    e: tuple[float, float]
    d_c: tuple[float, float]

    def grid(self, case: Case) -> tuple[Floats, dict[str, Any]]:
        """Return restitutions (9, 1) and arms with d_c (9,)."""
        e, d_c = np.linspace(*self.e, STEPS)[:, None], np.linspace(*self.d_c, STEPS)
        return e, {"d_c": d_c, "d_d": float(case.arms.d_d), "k2": case.rod.k2}


@dataclass(frozen=True, slots=True)
class Worst:
    """Largest losses over 0 <= mu <= mu_c and a `Range`, as fractions of E_0, each with its mu and e."""

    total: float
    mu_total: float
    e_total: float
    tangential: float
    mu_tangential: float
    e_tangential: float
    mu_c_largest: float


def worst_losses(case: Case, known: Range) -> Worst | None:
    """Search the largest total and the largest tangential loss; None where the tip turns by itself."""
    v_n, v_t = case.velocity
    e, body = known.grid(case)
    limit = critical_ratio(v_n, v_t, e=e, **body)
    if (limit < 0).any():
        return None
    found = worst_case(v_n, v_t, e=e, **body, mass=2.0 / case.speed**2)
    at, slid = (np.unravel_index(int(x.argmax()), x.shape) for x in (found.total, found.tangential))
    given = np.broadcast_to(e, limit.shape)
    total = float(found.total[at]), float(found.mu_total[at]), float(given[at])
    tangential = float(found.tangential[slid]), float(found.mu_tangential[slid]), float(given[slid])
    return Worst(*total, *tangential, float(limit.max()))


def sliding_heat(case: Case, known: Range) -> float:
    """Largest friction work of a rigid rod, fraction of E_0, for any Coulomb friction, reversal included.

    Sliding, sticking and reverse sliding are resolved in the impulse domain with energetic restitution; the
    largest work over the friction is found to a thousandth of itself.
    """
    v_n, v_t = case.velocity
    e, body = known.grid(case)
    path = sliding_path(v_n, v_t, e=e, f=FRICTION[:, None, None], **body)
    work = -(path.tangential_work[0] + path.tangential_work[1])
    return float(work.max()) / (0.5 * case.speed**2)


def largest_loss_whatever(case: Case, known: Range) -> float:
    """Largest loss of the first impact, fraction of E_0, whatever friction and restitution do."""
    v_n, v_t = case.velocity
    arms: dict[str, Any] = {"d_c": np.linspace(*known.d_c, 2001), "d_d": case.arms.d_d, "k2": case.rod.k2}
    return float(pinned_loss(v_n, v_t, **arms, mass=2.0 / case.speed**2).max())
