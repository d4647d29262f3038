"""Losses carried over from the measured sets, largest losses over mu <= mu_c, bounds of friction heat."""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from fem_impact.answers.verdict.drop import DENSITY, RodDropInput, sets_of
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
from rigid.experiments import MeasuredSet
from rigid.inputs import Floats

STEPS = 9
"""Values of e and of d_c that are searched in a `Range`."""

FRICTION = np.concatenate([np.linspace(0.0, 1.5, 601), np.geomspace(1.6, 50.0, 20)])
"""Coulomb coefficients that are searched for the largest friction work; above 50 it stays constant."""


@dataclass(frozen=True, slots=True)
class Range:
    """Ranges of the quantities of a case that are not known.

    Attributes
    ----------
    e : tuple of float
        Least and largest restitution.
    d_c : tuple of float
        Least and largest arm of the impulse, m.
    """

    e: tuple[float, float]
    d_c: tuple[float, float]

    def grid(self, case: RodDropInput) -> tuple[Floats, dict[str, Any]]:
        """Return restitutions (9, 1) and arms with d_c (9,)."""
        return np.linspace(*self.e, STEPS)[:, None], case.body(np.linspace(*self.d_c, STEPS))


class Largest(NamedTuple):
    """A largest loss, fraction of E_0, with its mu and e."""

    share: float
    mu: float
    e: float


class Worst(NamedTuple):
    """Largest losses over 0 <= mu <= mu_c and a `Range`."""

    total: Largest
    tangential: Largest
    mu_c: float


def worst_losses(case: RodDropInput, known: Range) -> Worst | None:
    """Return the largest total and the largest tangential loss; None where a critical ratio is negative."""
    v_n, v_t = case.velocity
    e, body = known.grid(case)
    limit = critical_ratio(v_n, v_t, e=e, **body)
    if (limit < 0).any():
        return None
    worst, given = (
        worst_case(v_n, v_t, e=e, **body, mass=2.0 / case.speed**2),
        np.broadcast_to(e, limit.shape),
    )

    def largest(loss: Floats, mu: Floats) -> Largest:
        at = np.unravel_index(int(loss.argmax()), loss.shape)
        return Largest(*(float(values[at]) for values in (loss, mu, given)))

    total, tangential = (worst.total, worst.mu_total), (worst.tangential, worst.mu_tangential)
    return Worst(largest(*total), largest(*tangential), float(limit.max()))


def sliding_heat(case: RodDropInput, known: Range) -> float:
    """Return the largest friction work of a rigid rod over all Coulomb coefficients, fraction of E_0.

    Sliding, sticking and reverse sliding are resolved in the impulse domain with energetic restitution. The
    relative error of the maximum over `FRICTION` is below 1e-3.
    """
    e, body = known.grid(case)
    path = sliding_path(*case.velocity, e=e, f=FRICTION[:, None, None], **body)
    work = -(path.tangential_work[0] + path.tangential_work[1])
    return float(work.max()) / (0.5 * case.speed**2)


def upper_bound_loss(case: RodDropInput, known: Range) -> float:
    """Return the largest loss of the first impact for any friction and restitution, fraction of E_0."""
    body = case.body(np.linspace(*known.d_c, 2001))
    return float(pinned_loss(*case.velocity, **body, mass=2.0 / case.speed**2).max())


@dataclass(frozen=True, slots=True)
class CarriedTests:
    """Results of n tests that are carried over to another case, (n,) float64 each.

    Attributes
    ----------
    e : float64
        Restitution at the centre of the impulse, not below 0.
    friction : float64
        Impulse ratio while sliding.
    excess : float64
        Impulse ratio over the critical one, at least 1.
    offset : float64
        Distance from the geometric contact point to the centre of the impulse, over the rod's length.
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

    @property
    def total(self) -> Floats:
        """Normal and tangential loss."""
        return self.E_ln + self.E_lt

    @property
    def E_r(self) -> Floats:
        """Energy kept as rigid motion; with e_m = -1 it and the losses add up to E_0."""
        return 1.0 - self.total


def _own(s: MeasuredSet) -> CarriedTests:
    """Return the `CarriedTests` of a set, with the arms of its rod's real geometry."""
    rod = Projectile(s.length, s.diameter, s.tip, s.tip_radius, DENSITY)
    arms = rod.arms(s.alpha)
    centre = impulse_centre(**s.motion, d_d=arms.d_d, k2=rod.k2)
    e = restitution(s.motion["v_n"], s.motion["V_n"], s.motion["Omega"], centre.d_c)
    e = np.maximum(e, 0.0)
    mu = impulse_ratio(*(s.motion[name] for name in ("v_n", "v_t", "V_n", "V_t")))
    body: dict[str, Any] = {"d_c": centre.d_c, "d_d": arms.d_d, "k2": rod.k2}
    excess = np.maximum(mu / critical_ratio(s.motion["v_n"], s.motion["v_t"], e=e, **body), 1.0)
    return CarriedTests(e, mu, excess, (centre.d_c - arms.d_c) / s.length)


def measured_on(surface: str) -> dict[str, CarriedTests]:
    """Return the `CarriedTests` of every set on one surface, by its id.

    Where mu exceeds mu_c the tip did not slide throughout: its friction is at least the mean of the others.
    """
    tests = {s.id: _own(s) for s in sets_of(surface)}
    slid = np.concatenate([t.friction[t.excess == 1.0] for t in tests.values()]).mean()
    return {
        id: replace(t, friction=np.where(t.excess > 1.0, np.maximum(t.friction, slid), t.friction))
        for id, t in tests.items()
    }


def carry(tests: CarriedTests, case: RodDropInput) -> Carried:
    """Predict the losses of a case from each test (Eq 23-25 with e_m = -1)."""
    v_n, v_t = case.velocity
    body = case.body(case.arms.d_c + tests.offset * case.rod.length)
    limit = critical_ratio(v_n, v_t, e=tests.e, **body)
    mu = np.clip(tests.excess * limit, -tests.friction, tests.friction)
    mass = 2.0 / case.speed**2  # so that losses are fractions of E_0
    lost = predicted_losses(v_n, v_t, e=tests.e, mu=mu, mass=mass, **body)
    return Carried(*lost, mu, limit)
