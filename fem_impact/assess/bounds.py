"""The worst that can happen: largest losses over mu <= mu_c, and bounds of the friction heat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fem_impact.assess.drop import DENSITY, DroppedRod, sets_of
from rigid import (
    Projectile,
    critical_ratio,
    impulse_centre,
    impulse_ratio,
    pinned_loss,
    predicted_losses,
    restitution,
    sliding_path,
    worst_case,
)
from rigid.arrays import Floats
from rigid.experiments import MeasuredSet

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

    def grid(self, case: DroppedRod) -> tuple[Floats, dict[str, Any]]:
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


def worst_losses(case: DroppedRod, known: Range) -> Worst | None:
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


def sliding_heat(case: DroppedRod, known: Range) -> float:
    """Largest friction work of a rigid rod, fraction of E_0, for any Coulomb friction, reversal included.

    Sliding, sticking and reverse sliding are resolved in the impulse domain with energetic restitution; the
    largest work over the friction is found to a thousandth of itself.
    """
    v_n, v_t = case.velocity
    e, body = known.grid(case)
    path = sliding_path(v_n, v_t, e=e, f=FRICTION[:, None, None], **body)
    work = -(path.tangential_work[0] + path.tangential_work[1])
    return float(work.max()) / (0.5 * case.speed**2)


def largest_loss_whatever(case: DroppedRod, known: Range) -> float:
    """Largest loss of the first impact, fraction of E_0, whatever friction and restitution do."""
    v_n, v_t = case.velocity
    arms: dict[str, Any] = {"d_c": np.linspace(*known.d_c, 2001), "d_d": case.arms.d_d, "k2": case.rod.k2}
    return float(pinned_loss(v_n, v_t, **arms, mass=2.0 / case.speed**2).max())


@dataclass(frozen=True, slots=True)
class Tests:
    """What is carried, (n,) float64 each.

    Attributes
    ----------
    e : float64
        Restitution at the centre of the impulse, not below 0.
    friction : float64
        Ratio while sliding.
    excess : float64
        Impulse ratio over the critical one, at least 1.
    offset : float64
        From the geometric contact point to the centre of the impulse, over the rod's length.
    """

    e: Floats
    friction: Floats
    excess: Floats
    offset: Floats


@dataclass(frozen=True, slots=True)
class Carried:
    """Losses of a case by each test, as fractions of E_0, (n,) float64 each.

    Attributes
    ----------
    E_ln, E_lt : float64
        Normal and tangential loss.
    mu, mu_c : float64
        Impulse ratio used, and the critical one.
    """

    E_ln: Floats
    E_lt: Floats
    mu: Floats
    mu_c: Floats


def _own(s: MeasuredSet) -> Tests:
    """Work out what is carried of each test of a set, with the arms of its rod's real geometry."""
    rod = Projectile(s.length, s.diameter, s.tip, s.tip_radius, DENSITY)
    arms = rod.arms(s.alpha)
    centre = impulse_centre(**s.motion, d_d=arms.d_d, k2=rod.k2)
    e = restitution(s.motion["v_n"], s.motion["V_n"], s.motion["Omega"], centre.d_c)
    e = np.maximum(e, 0.0)
    mu = impulse_ratio(*(s.motion[name] for name in ("v_n", "v_t", "V_n", "V_t")))
    body: dict[str, Any] = {"d_c": centre.d_c, "d_d": arms.d_d, "k2": rod.k2}
    excess = np.maximum(mu / critical_ratio(s.motion["v_n"], s.motion["v_t"], e=e, **body), 1.0)
    return Tests(e, mu, excess, (centre.d_c - arms.d_c) / s.length)


def measured_on(surface: str) -> dict[str, Tests]:
    """Work out what is carried of every test on one surface, by set."""
    found = {s.id: _own(s) for s in sets_of(surface)}
    slid = np.concatenate([t.friction[t.excess == 1.0] for t in found.values()]).mean()
    return {
        id: replace(t, friction=np.where(t.excess > 1.0, np.maximum(t.friction, slid), t.friction))
        for id, t in found.items()
    }


def carry(tests: Tests, case: DroppedRod) -> Carried:
    """Predict the losses of a case from each test (Eq 23-25 with e_m = -1)."""
    v_n, v_t = case.velocity
    arms = case.arms
    body: dict[str, Any] = {
        "d_c": arms.d_c + tests.offset * case.rod.length,
        "d_d": arms.d_d,
        "k2": case.rod.k2,
    }
    limit = critical_ratio(v_n, v_t, e=tests.e, **body)
    mu = np.clip(tests.excess * limit, -tests.friction, tests.friction)
    mass = 2.0 / case.speed**2  # so that losses are fractions of E_0
    lost = predicted_losses(v_n, v_t, e=tests.e, mu=mu, mass=mass, **body)
    return Carried(*lost, mu, limit)
