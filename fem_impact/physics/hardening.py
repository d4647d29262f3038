"""Isotropic hardening laws of the J2 material."""

from dataclasses import dataclass, replace
from itertools import pairwise
from math import log, log1p, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.arrays import Array
from fem_impact.physics.contact import ContactEstimate
from fem_impact.scene.fields import SkinShape
from fem_impact.scene.material import JohnsonCookRate, Material

TABOR, TABOR_STRAIN = 3.0, 0.08  # hardness over the flow stress at this plastic strain
KGF_PER_MM2 = 9.80665e6  # Pa


class JohnsonCook(NamedTuple):
    """Factor 1 + C ln(rate / slowest) of the flow stress for plastic strain rates above ``slowest``, 1/s.

    Johnson & Cook 1985, doi:10.1016/0013-7944(85)90052-9, eq 1, without its thermal softening.
    """

    C: float
    slowest: float = 1.0

    def factor(self, rate: float) -> float:
        """Return the factor at a plastic strain rate, 1/s."""
        return 1 + self.C * log(max(rate / self.slowest, 1.0))


class CowperSymonds(NamedTuple):
    """Factor 1 + (rate / D)^(1/q) of the flow stress; D in 1/s."""

    D: float
    q: float

    def factor(self, rate: float) -> float:
        """Return the factor at a plastic strain rate, 1/s."""
        return float(1 + (rate / self.D) ** (1 / self.q))


RateLaw = JohnsonCook | CowperSymonds


def rate_law(metal: Material) -> RateLaw | None:
    """Return the law of a metal's factor over the strengths that it states, None without data.

    The factor of Johnson and Cook is taken at the rate of the tests that gave the strengths: both are values
    of one line in ln(rate), so that it starts from 1 there and its slope is C over the line's value there.
    """
    rate = metal.rate
    if isinstance(rate, JohnsonCookRate):
        return JohnsonCook(rate.C / (1 + rate.C * log(rate.tested / rate.reference)), rate.tested)
    return CowperSymonds(rate.D, rate.q) if rate else None


@dataclass(frozen=True, slots=True)
class Skin:
    """A hardened layer under a surface.

    Attributes
    ----------
    depth : m, of a layer of even strength; of an exponential one, where 1/e of the gain is left
    factor : of the flow stress at the surface
    shape : of the gain over the depth under the surface
    """

    depth: float
    factor: float
    shape: SkinShape = "even"

    def mean(self, top: ArrayLike, bottom: ArrayLike) -> Array:
        """Return the mean factor between depths under the surface, m, of one shape."""
        over, under = np.asarray(top) / self.depth, np.asarray(bottom) / self.depth
        gain = np.minimum(under, 1) - np.minimum(over, 1)
        if self.shape == "exponential":
            gain = np.exp(-over) - np.exp(-under)
        return np.asarray(1 + (self.factor - 1) * gain / np.maximum(under - over, 1e-9))


class PowerLaw(NamedTuple):
    """The numbers of `Hardening` as compiled code reads them; Pa, -, -."""

    yield_stress: float
    slope: float
    exponent: float


class Pieces(NamedTuple):
    """Points (k,) of `TabulatedHardening` as compiled code reads them: plastic strain, and stress in Pa."""

    strain: Array
    stress: Array


FlowCurve = PowerLaw | Pieces


@dataclass(frozen=True, slots=True)
class Hardening:
    """Flow stress sigma(eps_p) = yield_stress (1 + slope eps_p)^exponent, times a rate factor if any.

    ``exponent = 1`` is linear hardening with modulus ``yield_stress * slope``; ``slope = 0`` is
    perfect plasticity.
    """

    yield_stress: float
    slope: float
    exponent: float
    rate: RateLaw | None = None

    def __post_init__(self) -> None:
        if not self.yield_stress > 0:
            raise ValueError(f"Yield stress must be positive, got {self.yield_stress} Pa.")
        if self.slope < 0 or self.exponent < 0:
            raise ValueError("A softening material has no unique answer on any mesh: slope, exponent >= 0.")

    def flow_stress(self, plastic_strain: ArrayLike) -> Array:
        """Return the flow stress, Pa, at equivalent plastic strains of any shape."""
        strain = np.asarray(plastic_strain, dtype=np.float64)
        return np.asarray(self.yield_stress * (1 + self.slope * strain) ** self.exponent)

    @property
    def curve(self) -> PowerLaw:
        """The numbers that compiled code reads."""
        return PowerLaw(self.yield_stress, self.slope, self.exponent)

    @property
    def power(self) -> "Hardening":
        """The power law that stands for this curve: itself."""
        return self

    def times(self, factor: float) -> "Hardening":
        """Return the law with so many times the flow stress."""
        return replace(self, yield_stress=factor * self.yield_stress)


FITTED = 0.2
"""Largest strain of an indentation, 0.2 a/R (Tabor 1951), up to which a power law is fitted to a table."""


@dataclass(frozen=True, slots=True)
class TabulatedHardening:
    """Flow stress, straight between points (plastic strain, Pa), flat behind the last; times a rate factor.

    ``points`` begin at a plastic strain of 0, with the yield stress; strains grow, stresses do not fall.
    """

    points: tuple[tuple[float, float], ...]
    rate: RateLaw | None = None

    def __post_init__(self) -> None:
        (first, least), *_ = self.points
        steps = list(pairwise(self.points))
        if len(self.points) < 2 or first != 0 or not least > 0 or any(b[0] <= a[0] for a, b in steps):
            raise ValueError("A table of the flow stress needs two points or more, strains growing from 0.")
        if any(b[1] < a[1] for a, b in steps):
            raise ValueError("A softening material has no unique answer on any mesh: stresses must not fall.")

    @property
    def yield_stress(self) -> float:
        """Flow stress, Pa, without plastic strain."""
        return self.points[0][1]

    def times(self, factor: float) -> "TabulatedHardening":
        """Return the law with so many times the flow stress."""
        return replace(self, points=tuple((strain, factor * stress) for strain, stress in self.points))

    @property
    def curve(self) -> Pieces:
        """The points that compiled code reads."""
        strain, stress = np.array(self.points).T
        return Pieces(np.ascontiguousarray(strain), np.ascontiguousarray(stress))

    def flow_stress(self, plastic_strain: ArrayLike) -> Array:
        """Return the flow stress, Pa, at equivalent plastic strains of any shape."""
        return np.asarray(np.interp(np.asarray(plastic_strain, dtype=np.float64), *self.curve))

    @property
    def power(self) -> Hardening:
        """The power law with the same yield stress that is nearest to the curve up to `FITTED`."""
        strain = np.linspace(0.0, FITTED, 101)[1:]
        gain = np.log(self.flow_stress(strain) / self.yield_stress)

        def fitted(slope: float) -> tuple[float, float]:
            base = np.log1p(slope * strain)
            n = float(base @ gain / (base @ base))
            return float(np.sum((n * base - gain) ** 2)), n

        slope = min(np.geomspace(1e-2, 1e6, 161), key=lambda one: fitted(one)[0])
        return Hardening(self.yield_stress, float(slope), fitted(slope)[1], self.rate)


HardeningLaw = Hardening | TabulatedHardening


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
            f"Ultimate stress {ultimate_stress / 1e6:g} MPa must lie between the yield stress "
            f"{yield_stress / 1e6:g} MPa and {_nominal_strength_ratio(high, stiffness):.2f} times it."
        )
    n = _necking_strain(stiffness, ratio, high) if ratio > 1 else 0.0
    return Hardening(yield_stress, stiffness if n else 0.0, n)


def hardness_hardening(E: float, yield_stress: float, hardness: float) -> Hardening:
    """Return the power law through yield point, elastic slope and the flow stress of Vickers' number HV.

    Raises
    ------
    ValueError
        If that flow stress is not above the yield stress.

    Examples
    --------
    >>> print(round(float(hardness_hardening(206e9, 320e6, 163).flow_stress(0.08)) / 1e6))
    533
    """
    flow = tabor_stress(hardness)
    if flow <= yield_stress:
        raise ValueError(
            f"HV {hardness:g} stands for a flow stress of {flow / 1e6:.0f} MPa at {TABOR_STRAIN:.0%} plastic "
            f"strain, not above the yield stress, {yield_stress / 1e6:g} MPa."
        )
    slope = E / yield_stress
    return Hardening(yield_stress, slope, log(flow / yield_stress) / log1p(slope * TABOR_STRAIN))


def tabor_stress(hardness: float) -> float:
    """Return the flow stress, Pa, at `TABOR_STRAIN` that Vickers' number HV stands for.

    H = `TABOR` sigma with H the force over the area of the pyramid's faces, HV kgf/mm2 (Pavlina & Van Tyne
    2008, doi:10.1007/s11665-008-9225-5, after Tabor).
    """
    return hardness * KGF_PER_MM2 / TABOR


def _necking_strain(stiffness: float, ratio: float, high: float) -> float:
    """Return the n below ``high`` that gives a strength ratio, by Newton's method on its logarithm.

    The logarithm is convex and increases with n above 1/stiffness, where the necking strain exceeds the
    elastic range, so that Newton's steps from above decrease to the root.
    """
    n = high
    while (step := np.log(_nominal_strength_ratio(n, stiffness) / ratio) / np.log(stiffness * n)) > 0:
        n -= step
    return n


def strain_rate(size: ContactEstimate) -> float:
    """Return the strain rate of an indentation, 1/s: 0.2 a/R (Tabor 1951) gained in half the contact."""
    return 0.2 * sqrt(size.a_t * size.a_b / (size.R1 * size.R2)) / (0.5 * size.duration)


def rate_factor(law: RateLaw | None, rate: float) -> float:
    """Return the factor of the flow stress at a strain rate, 1/s; 1 without a law."""
    return law.factor(rate) if law else 1.0


def rate_gain(metal: Material, rate: float) -> float:
    """Return the relative gain of a metal's flow stress at a strain rate, 1/s; 0 without data."""
    return rate_factor(rate_law(metal), rate) - 1


PROOF_STRAIN = 0.002  # plastic strain of the proof stress through which Ramberg and Osgood's law goes
ELASTIC_STRAIN = 1e-4  # plastic strain at which it counts as yielding: it has no yield point of its own
FIRST, LAST, POINTS = 1e-4, 5.0, 60  # plastic strains of a table of Johnson and Cook's law, and their number


def ramberg_osgood(proof_stress: float, n: float) -> Hardening:
    """Return sigma = proof_stress (p / .002)^(1/n), p plastic strain, Pa; it begins to flow at p = .0001.

    There the curve is shifted to its yield point: strains are `ELASTIC_STRAIN` too small, the proof stress
    is met.

    Examples
    --------
    >>> law = ramberg_osgood(276e6, 20.0)
    >>> print(round(float(law.flow_stress(0.002)) / 1e6), round(float(law.flow_stress(0.1)) / 1e6))
    276 335
    """
    start = proof_stress * (1 + PROOF_STRAIN / ELASTIC_STRAIN) ** (-1 / n)
    return Hardening(start, 1 / ELASTIC_STRAIN, 1 / n)


def johnson_cook(
    A: float, B: float, n: float, heat: float = 0.0, span: float = 1.0, m: float = 1.0
) -> TabulatedHardening:
    """Return sigma = (A + B p^n) (1 - T*^m), Pa, of a material that keeps the heat of its flow.

    Johnson & Cook 1985, doi:10.1016/0013-7944(85)90052-9, eq 1 at the slowest rate. T* is the rise of the
    temperature over the ``span`` from there to melting, K, and grows by ``heat`` (K/Pa: the share of the
    work that is heat over density and heat capacity) times sigma dp. Where the curve would fall it is held:
    softening has no unique answer on any mesh.

    Examples
    --------
    >>> print(round(float(johnson_cook(90e6, 292e6, 0.31).flow_stress(0.5)) / 1e6))
    325
    """
    strain = np.concatenate([[0.0], np.geomspace(FIRST, LAST, POINTS)])
    cold = A + B * strain**n
    stress, rise = cold.copy(), 0.0
    for k in range(1, len(strain)):
        step = strain[k] - strain[k - 1]
        rise += heat * stress[k - 1] * step
        stress[k] = cold[k] * (1 - min(rise / span, 1.0) ** m)
    held = np.maximum.accumulate(stress)
    return TabulatedHardening(tuple(zip(strain.tolist(), held.tolist(), strict=True)))
