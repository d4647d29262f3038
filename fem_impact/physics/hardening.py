"""Isotropic hardening laws of the J2 material."""

from __future__ import annotations

from dataclasses import dataclass
from math import log, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem_impact.physics.contact import ContactBodies, contact_estimate, principal_radii

C, SLOWEST = 0.022, 1.0  # -, 1/s: Johnson and Cook's rate factor of mild steel, see `fem_impact.effects.rate`


@dataclass(frozen=True, slots=True)
class RateFactor:
    """Factor 1 + C ln(rate / slowest) of the flow stress for plastic strain rates above ``slowest``, 1/s.

    Johnson & Cook 1985, doi:10.1016/0013-7944(85)90052-9, eq 1, without its thermal softening.
    """

    C: float
    slowest: float = 1.0


@dataclass(frozen=True, slots=True)
class Hardening:
    """Flow stress sigma(eps_p) = yield_stress (1 + slope eps_p)^exponent, times a rate factor if any.

    ``exponent = 1`` is linear hardening with modulus ``yield_stress * slope``; ``slope = 0`` is
    perfect plasticity.
    """

    yield_stress: float
    slope: float
    exponent: float
    rate: RateFactor | None = None

    def __post_init__(self) -> None:
        if not self.yield_stress > 0:
            raise ValueError(f"Yield stress must be positive, got {self.yield_stress} Pa.")
        if self.slope < 0 or self.exponent < 0:
            raise ValueError("A softening material has no unique answer on any mesh: slope, exponent >= 0.")

    def flow_stress(self, plastic_strain: ArrayLike) -> NDArray[np.float64]:
        """Return the flow stress, Pa, at equivalent plastic strains of any shape."""
        strain = np.asarray(plastic_strain, dtype=np.float64)
        return np.asarray(self.yield_stress * (1 + self.slope * strain) ** self.exponent)


def linear_hardening(yield_stress: float, modulus: float) -> Hardening:
    """Return linear hardening with the plastic ``modulus`` d sigma / d eps_p, Pa."""
    return Hardening(yield_stress, modulus / yield_stress, 1.0)


def _nominal_strength_ratio(n: float, stiffness: float) -> float:
    """Return ultimate (nominal) over yield stress of the power law that leaves the elastic line.

    Considere: necking starts where d sigma / d eps = sigma, i.e. at total strain n; the nominal
    stress is the true one times exp(-plastic strain).
    """
    return float((stiffness * n) ** n * np.exp(-(n - 1 / stiffness)))


def power_hardening(E: float, yield_stress: float, ultimate_stress: float) -> Hardening:
    """Return the power law through yield point, elastic slope and nominal ultimate stress.

    sigma = sigma_y (1 + E eps_p / sigma_y)^n; its only parameter n follows from the ultimate stress at the
    onset of necking (Considere's construction).

    Raises
    ------
    ValueError
        If the ultimate stress is below yield or more than any n <= 0.5 can give.

    Examples
    --------
    >>> print(round(power_hardening(219e9, 546e6, 592e6).exponent, 3))
    0.043
    """
    stiffness, ratio = E / yield_stress, ultimate_stress / yield_stress
    high = 0.5
    if not 1 <= ratio <= _nominal_strength_ratio(high, stiffness):
        raise ValueError(
            f"Ultimate stress {ultimate_stress:g} Pa must lie between the yield stress {yield_stress:g} Pa "
            f"and {_nominal_strength_ratio(high, stiffness):.2f} times it."
        )
    n = _necking_strain(stiffness, ratio, high) if ratio > 1 else 0.0
    return Hardening(yield_stress, stiffness if n else 0.0, n)


def _necking_strain(stiffness: float, ratio: float, high: float) -> float:
    """Return the n below ``high`` that gives a strength ratio, by Newton's method on its logarithm.

    The logarithm is convex and increases with n above 1/stiffness, where the necking strain exceeds the
    elastic range, so that Newton's steps from above decrease to the root.
    """
    n = high
    while (step := np.log(_nominal_strength_ratio(n, stiffness) / ratio) / np.log(stiffness * n)) > 0:
        n -= step
    return n


def strain_rate(bodies: ContactBodies) -> float:
    """Return the strain rate of the indentation, 1/s: 0.2 a/R (Tabor 1951) gained in half the contact."""
    size, (R1, R2) = contact_estimate(bodies), principal_radii(bodies.scene)
    return 0.2 * sqrt(size.a_t * size.a_b / (R1 * R2)) / (0.5 * size.duration)


def rate_gain(bodies: ContactBodies) -> float:
    """Return the relative gain of the flow stress at the strain rate of the indentation."""
    return C * log(max(strain_rate(bodies) / SLOWEST, 1.0))
