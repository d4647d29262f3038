"""Measured tests carried over to another rod, angle and speed.

What is carried of each test is e and mu and the distance of the centre of its impulse from the geometric
contact point (as a share of the rod's length), with e taken at that centre, where e_m = -1. For the test's
own rod, angle and speed this gives back its motion exactly, and unlike e_m it stays well conditioned
at every angle.

The impulse ratio is that of sliding friction, but at most the critical one. A test whose tip stopped and slid
back had a ratio beyond its critical one: it carries that excess, and as friction the mean of those
tests on the same surface that did slide.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fem_impact.paper.case import Case, sets_of
from fem_impact.paper.options import DENSITY
from rigid import Projectile, critical_ratio, impulse_centre, impulse_ratio, predicted_losses, restitution
from rigid.arrays import Floats
from rigid.experiments import MeasuredSet

__all__ = ["Carried", "Tests", "carry", "measured_on"]


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


def carry(tests: Tests, case: Case) -> Carried:
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
