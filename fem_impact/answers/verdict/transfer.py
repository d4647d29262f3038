"""Measured tests carried over to one dropped rod: losses, worst case, bound of friction heat, limits."""

from dataclasses import asdict
from typing import Any

import numpy as np
from scipy.special import stdtrit

from fem_impact.answers.verdict.bounds import (
    CarriedTests,
    Range,
    carry,
    measured_on,
    sliding_heat,
    upper_bound_loss,
    worst_losses,
)
from fem_impact.answers.verdict.drop import RodDropInput, outside_of, unmeasured, weights_of
from fem_impact.outcome.limitation import limitations
from rigid import LIMIT, LIMIT_MM, Errors, behaves_rigidly, in_millimetres
from rigid.inputs import Floats

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
    return {
        "case": _case_entry(case, energy),
        "basis": {
            "weights": weights,
            "tests": sum(counts[name] for name in weights),
            "all_sets": list(counts),
            "all_tests": sum(counts.values()),
        },
        "losses": {name: {**s, "mean_J": s["mean"] * energy} for name, s in shares.items()},
        "mu_c": {"mean": float(mu_c.mean()), "low": float(mu_c.min()), "high": float(mu_c.max())},
        "range": {"e": list(known.e), "d_c_m": list(known.d_c), "measured": not outside_of(case)},
        "worst_case": _worst(case, known, energy),
        "friction_heat": _heat(case, known, energy),
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


def _case_entry(case: RodDropInput, energy: float) -> dict[str, Any]:
    rod, (v_n, v_t), arms = case.rod, case.velocity, case.arms
    sizes = {f"{name}_m": getattr(rod, name) for name in ("length", "diameter", "tip_radius")}
    motion = {"v_n_m_per_s": v_n, "v_t_m_per_s": v_t, "E_0_J": energy}
    return {
        **sizes,
        "tip": rod.tip,
        "surface": case.surface,
        "height_m": case.height,
        "angle_rad": case.alpha,
        "mass_kg": rod.mass,
        **motion,
        "d_c_m": float(arms.d_c),
        "d_d_m": float(arms.d_d),
    }


def _worst(case: RodDropInput, known: Range, energy: float) -> dict[str, Any]:
    worst = worst_losses(case, known)
    if worst is None:
        return {"total": None, "tangential": None, "reason": TURNING}
    entries = {
        name: {"over_E_0": loss.share, "J": loss.share * energy, "mu": loss.mu, "e": loss.e}
        for name, loss in (("total", worst.total), ("tangential", worst.tangential))
    }
    return {**entries, "mu_c_largest": worst.mu_c, "reason": None}


def _heat(case: RodDropInput, known: Range, energy: float) -> dict[str, Any]:
    """Return the upper bound of friction heat, and the lower one of a rigid rod with Coulomb friction."""
    certain = upper_bound_loss(case, known)
    worst = worst_losses(case, known)
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
