"""Measured tests carried over to one dropped rod: losses, worst case, bound of friction heat, limits."""

from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.special import stdtrit

from fem_impact.answers.verdict.dropped import (
    DENSITY,
    RodDropInput,
    outside_of,
    sets_of,
    unmeasured,
    weights_of,
)
from fem_impact.outcome.groups import limitations
from rigid import (
    LIMIT,
    LIMIT_MM,
    Errors,
    Projectile,
    behaves_rigidly,
    critical_ratio,
    impulse_centre,
    impulse_ratio,
    in_millimetres,
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
    worst = worst_case(v_n, v_t, e=e, **body, mass=2.0 / case.speed**2)
    given = np.broadcast_to(e, limit.shape)

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


CONTACT = Errors().contact
"""Error of the contact point, m."""

ASSUMPTIONS = (
    "first impact only: the rod keeps the rest of its energy and strikes again",
    "all that the rod's rigid motion can lose is counted as friction heat, though part of it is plastic "
    "work, vibration and waves",
    "the impulse acts within the stated range of arms; for that range no friction, restitution, reversal or "
    "repeated contact can take more",
    "kinetic energy only: no chemical heat (pyrophoric metal, thermite), no work of gravity during contact",
    "energy, not temperature: area and duration of the contact are not known to rigid theory",
)
"""Assumptions of the upper bound of friction heat."""

TURNING = (
    "at this angle the mass centre stands nearly above the contact: the tip can turn up the slope by itself, "
    "and no critical ratio limits the search; take the bound that holds whatever happens"
)
"""Reason why a worst case over mu <= mu_c does not exist."""

NOT_ATTRIBUTED = (
    "of E_0: the whole loss. E_lt and E_ln are works of two components of the impulse; how much of "
    "them is friction heat, plastic work, vibration or waves, rigid-body velocities do not tell "
    "(their closure tests only mass, inertia and e_m = -1). A finite-element run does: fem-impact run"
)

_NAMES = ("total", "E_lt", "E_ln", "E_r")
"""Fractions of E_0 that are reported."""


def transfer(case: RodDropInput) -> dict[str, Any]:
    """Assess the first impact of a dropped rod with the measured coefficients of its surface.

    Parameters
    ----------
    case : RodDropInput
        Rod, height, angle and surface.

    Returns
    -------
    dict
        Plain JSON: case, basis, losses with intervals, worst case, friction heat with assumptions, the share
        that cannot be attributed, slenderness, limitations.
    """
    tests = measured_on(case.surface)
    weights = weights_of(case)
    energy = 0.5 * case.rod.mass * case.speed**2
    carried = {name: carry(t, case) for name, t in tests.items()}
    known = _range(case, tests, weights)
    counts = {name: t.e.size for name, t in tests.items()}
    shares = {
        share: _share({name: getattr(c, share) for name, c in carried.items()}, weights) for share in _NAMES
    }
    mu_c = np.concatenate([carried[name].mu_c for name in weights])
    worst = worst_losses(case, known)
    rod, (v_n, v_t) = case.rod, case.velocity
    return {
        "case": {
            "length_m": rod.length,
            "diameter_m": rod.diameter,
            "tip_radius_m": rod.tip_radius,
            "tip": rod.tip,
            "surface": case.surface,
            "height_m": case.height,
            "angle_rad": case.alpha,
            "mass_kg": rod.mass,
            "v_n_m_per_s": v_n,
            "v_t_m_per_s": v_t,
            "E_0_J": energy,
            "d_c_m": float(case.arms.d_c),
            "d_d_m": float(case.arms.d_d),
        },
        "basis": {
            "weights": weights,
            "tests": sum(counts[name] for name in weights),
            "all_sets": list(counts),
            "all_tests": sum(counts.values()),
        },
        "losses": {name: {**s, "mean_J": s["mean"] * energy} for name, s in shares.items()},
        "mu_c": {"mean": float(mu_c.mean()), "low": float(mu_c.min()), "high": float(mu_c.max())},
        "range": {"e": list(known.e), "d_c_m": list(known.d_c), "measured": not outside_of(case)},
        "worst_case": _worst(worst, energy),
        "friction_heat": _heat(case, known, worst, energy),
        "not_attributed": {
            **{name: shares["total"][name] for name in ("mean", "low", "high")},
            "sentence": NOT_ATTRIBUTED,
        },
        "slenderness": _slenderness(case),
        "limitations": [asdict(one) for one in limitations("range", *unmeasured(case))],
    }


def _share(values: dict[str, Floats], weights: dict[str, float]) -> dict[str, float]:
    """Return mean, 95 % prediction interval of one impact, and the extremes over all tests of the surface.

    The variance is the weighted sum of the variances within the sets and between their means.
    """
    means = {name: float(values[name].mean()) for name in weights}
    mean = sum(w * means[name] for name, w in weights.items())
    variance = sum(
        w * (float(values[name].var(ddof=1)) * (1 + 1 / values[name].size) + (means[name] - mean) ** 2)
        for name, w in weights.items()
    )
    tests = values[max(weights, key=lambda name: weights[name])].size
    half = float(stdtrit(tests - 1, 0.975)) * variance**0.5
    ends = min(0.0, mean), max(1.0, mean)
    low, high = (float(np.clip(mean + sign * half, *ends)) for sign in (-1, 1))
    together = np.concatenate(list(values.values()))
    extremes = {"all_low": float(together.min()), "all_high": float(together.max())}
    return {"mean": mean, "low": low, "high": high, **extremes}


def _range(case: RodDropInput, tests: dict[str, CarriedTests], weights: dict[str, float]) -> Range:
    """Return the ranges of e and d_c over the tests of this surface; outside the measured cases all e."""
    outside = bool(outside_of(case))
    e = np.concatenate([t.e for t in tests.values()])
    spread = 2.0 * max(float(t.e.std(ddof=1)) for t in tests.values())
    measured = max(0.0, float(e.min()) - spread), min(1.0, float(e.max()) + spread)
    offsets = [t.offset for name, t in tests.items() if outside or name in weights]
    offset = np.concatenate(offsets) * case.rod.length
    arm = float(case.arms.d_c)
    d_c = arm + min(0.0, float(offset.min())) - CONTACT, arm + max(0.0, float(offset.max())) + CONTACT
    return Range((0.0, 1.0) if outside else measured, d_c)


def _worst(worst: Worst | None, energy: float) -> dict[str, Any]:
    if worst is None:
        return {"total": None, "tangential": None, "reason": TURNING}
    entries = {
        name: {"over_E_0": loss.share, "J": loss.share * energy, "mu": loss.mu, "e": loss.e}
        for name, loss in (("total", worst.total), ("tangential", worst.tangential))
    }
    return {**entries, "mu_c_largest": worst.mu_c, "reason": None}


def _heat(case: RodDropInput, known: Range, worst: Worst | None, energy: float) -> dict[str, Any]:
    """Return the upper bound of friction heat, and the lower one of a rigid rod with Coulomb friction."""
    certain = upper_bound_loss(case, known)
    rigid = max(sliding_heat(case, known), worst.tangential.share if worst else 0.0)
    return {
        "upper_bound_over_E_0": certain,
        "upper_bound_J": certain * energy,
        "assumptions": list(ASSUMPTIONS),
        "rigid_rod_over_E_0": rigid,
        "rigid_rod_J": rigid * energy,
        "rigid_rod_assumption": (
            "a rigid rod touching at one point, Coulomb friction of any size or any constant ratio up to "
            "mu_c; a rod that bends can rub more"
        ),
    }


def _slenderness(case: RodDropInput) -> dict[str, Any]:
    gamma, meets = case.rod.gamma, bool(behaves_rigidly(case.rod.gamma))
    verdict = (
        "met: dropped steel bars this stout rebounded as rigid bodies"
        if meets
        else "not met: bending of the rod changes its rebound and takes energy that the coefficients hide"
    )
    return {
        "gamma_per_m0_3815": gamma,
        "limit_per_m0_3815": LIMIT,
        "gamma_per_mm0_3815": float(in_millimetres(gamma)),
        "limit_per_mm0_3815": LIMIT_MM,
        "met": meets,
        "verdict": verdict,
        "meaning": (
            "the limit was found for bars that rebound elastically; a tip that yields lengthens the "
            "contact, and the rod then vibrates less: gamma alone decides nothing about a yielding tip"
        ),
    }
