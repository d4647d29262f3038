"""Heat of sliding at the contact: flash temperatures of half-spaces under a heat source.

A patch of radius a takes the flux q for a short time. Three closed forms bound the rise of its surface:

    one-dimensional, from the flux history     T(t) = integral q(s) / sqrt(pi (t - s)) ds / sqrt(k rho c)
    steady, resting source                     T = q a / k
    steady, moving at V                        T = 2 q a / (k sqrt(pi (1.273 + Pe))),  Pe = V a / (2 kappa)

(Carslaw & Jaeger, Conduction of Heat in Solids, 2nd ed, 2.9 and 10.5; Jaeger 1942; the last is the fit of
Tian & Kennedy 1994, doi:10.1115/1.2927035, between slow and fast sources.) A resting source gives the largest
rise and lateral conduction only lowers it, so the least of the three is an upper estimate for the patch. The
heat is divided so that both surfaces have the same temperature (Blok), 1/T = 1/T_rod + 1/T_barrier with T_i
for all heat in body i. The motion does not depend on the heat.
"""

from dataclasses import dataclass
from math import inf, isinf, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.arrays import Array
from fem_impact.physics.contact import ContactPair
from fem_impact.physics.hardening import KGF_PER_MM2, rate_gain, strain_rate
from fem_impact.physics.indentation import FACES
from fem_impact.scene.material import Material

HARDNESS = 3.0  # hardness over ultimate stress: largest mean pressure on an asperity of the softer body
VICKERS = KGF_PER_MM2 / FACES  # Pa, mean pressure on the projected area of the print over Vickers' number
COOLING = np.geomspace(1e-3, 1e6, 181)  # times after the heating, over its length, at which a patch cools
ASSUMPTIONS = (
    "every touching spot carries the hardness of the softer body: three times its ultimate stress, or its "
    "stated Vickers hardness if that is more, times what strain rate and skin add",
    "it slides at the sum of the tip's tangential speed and its normal speed, or the computed one if that is "
    "higher, for three contact times, or the first period of bending or the computed time if that is longer",
    "all heat stays in the one body that is heated more, and none leaves sideways or to the air",
    "the properties are those at room temperature; melting, chemical heat and grit are left out",
)


@dataclass(frozen=True, slots=True)
class Half:
    """A half-space: conductivity k, W/(m K), and volumetric heat capacity rho c, J/(m3 K)."""

    conductivity: float
    capacity: float

    @property
    def diffusivity(self) -> float:
        """Return kappa, m2/s."""
        return self.conductivity / self.capacity

    @property
    def effusivity(self) -> float:
        """Return sqrt(k rho c), W s^0.5/(m2 K)."""
        return sqrt(self.conductivity * self.capacity)


def moving_rise(q: ArrayLike, a: ArrayLike, V: ArrayLike, body: Half) -> Array:
    """Return the largest steady rise, K, under a round source of flux q, W/m2, radius a, m, speed V, m/s."""
    q, a = np.asarray(q), np.asarray(a)
    peclet = np.asarray(V) * a / (2 * body.diffusivity)
    return np.asarray(2 * q * a / (body.conductivity * np.sqrt(pi * (1.273 + peclet))))


def short_rise(t: ArrayLike, q: ArrayLike, body: Half) -> Array:
    """Return the rise, K, at times t (n,), s, under fluxes q (n - 1,), W/m2, constant between them."""
    t, q = np.asarray(t, dtype=np.float64), np.asarray(q, dtype=np.float64)
    since = np.sqrt(np.maximum(t[:, None] - t[None, :], 0.0))
    return np.asarray((since[:, :-1] - since[:, 1:]) @ q * 2 / (sqrt(pi) * body.effusivity))


@dataclass(frozen=True, slots=True)
class Flash:
    """Rise of the patch, K, at the times t, s, and after the last of them, `COOLING`."""

    t: Array
    rise: Array
    cooling: Array

    @property
    def peak(self) -> float:
        """Return the highest rise, K."""
        return float(self.rise.max(initial=0.0))

    def time_above(self, rise: float) -> float:
        """Return how long the rise is above a given one, s, until the patch has cooled."""
        t, all_rises = _cooled(self.t), np.concatenate([self.rise, self.cooling])
        low, high = (of(all_rises[1:], all_rises[:-1]) for of in (np.minimum, np.maximum))
        above = np.where(low > rise, 1.0, 0.0)
        crosses = (low <= rise) & (high > rise)
        above[crosses] = ((high - rise) / np.where(crosses, high - low, 1.0))[crosses]
        return float(np.diff(t) @ above)


def _cooled(t: Array) -> Array:
    """Return times of heating and, after them, of cooling, s."""
    return np.concatenate([t, t[-1] + np.ptp(t) * COOLING])


def flash(t: Array, q: Array, a: Array, V: Array, rod: Half, barrier: Half) -> Flash:
    """Return the flash temperature of a patch.

    Parameters
    ----------
    t : (n,) s; q, a, V : (n - 1,) flux W/m2, patch radius m and sliding speed m/s between the times
    rod, barrier : the source rests on the rod and moves over the barrier
    """
    still, cools = np.zeros_like(V), np.zeros_like(COOLING)
    t, q, a, V, still = (_cooled(t), *(np.concatenate([one, cools]) for one in (q, a, V, still)))
    steady = (moving_rise(q, a, v, body) for v, body in ((still, rod), (V, barrier)))
    so_far = (np.concatenate([[0.0], np.maximum.accumulate(rise)]) for rise in steady)
    short = (short_rise(t, q, body) for body in (rod, barrier))
    return _shared(t, *map(np.minimum, short, so_far))


def _shared(t: Array, resting: Array, moving: Array) -> Flash:
    """Return the rise of a patch whose flux both bodies share, by the rise that each alone would have, K.

    The last of the times are those of `COOLING`.
    """
    total, heated = resting + moving, len(t) - len(COOLING)
    rise = np.divide(resting * moving, total, out=np.zeros_like(total), where=total > 0)
    return Flash(t[:heated], rise[:heated], rise[heated:])


Halves = tuple[Half, Half]
"""The thermal half-spaces of rod and barrier."""


def expected_rise(pair: ContactPair, friction: float, halves: Halves) -> float:
    """Return the rise, K, of the estimated contact at its mean pressure and half its largest speed."""
    speed = 0.5 * pair.most_sliding
    return steady_flash(pair, friction * pair.estimate.pressure * speed, speed, halves).peak


def steady_flash(pair: ContactPair, q: float, speed: float, halves: Halves) -> Flash:
    """Return the flash of the estimated contact under an even flux, W/m2, that moves at a speed, m/s.

    The short-time rise under an even flux is 2 q sqrt(t / pi) over the effusivity, less that since its end.
    """
    size, speeds = pair.estimate, (0.0, speed)
    t = _cooled(np.linspace(0.0, size.duration, 101))
    roots = np.sqrt(t / pi) - np.sqrt(np.maximum(t - size.duration, 0.0) / pi)
    short = (2 * q * roots / body.effusivity for body in halves)
    steady = (moving_rise(q, size.radius, v, body) for v, body in zip(speeds, halves, strict=True))
    return _shared(t, *map(np.minimum, short, steady))


def closed_form(pair: ContactPair, friction_work: float, halves: Halves) -> tuple[Flash, float, float, float]:
    """Return flash, power, W, flux, W/m2, and patch, m2, of the estimated contact.

    The friction work, J, is spread evenly over its patch and its time, at half the first sliding speed.
    """
    size = pair.estimate
    patch, power = pi * size.a_t * size.a_b, friction_work / size.duration
    flash = steady_flash(pair, power / patch, 0.5 * abs(pair.sliding), halves)
    return flash, power, power / patch, patch


def flash_bound(
    pair: ContactPair, friction: float, halves: Halves, seconds: float = 0.0, fastest: float = 0.0
) -> float:
    """Return a rise, K, that no spot of the contact exceeds under the ``ASSUMPTIONS``.

    ``seconds`` and ``fastest``, m/s, are the least time and sliding speed that count. It is infinite between
    two bodies that never yield: no hardness limits the pressure of a spot.
    """
    rate = strain_rate(pair.estimate)
    softer = min(_hardness(metal, rate) for metal in (pair.rod, pair.barrier))
    if not friction or isinf(softer):
        return inf if friction else 0.0
    # what the impact turns of the normal speed counts, too
    speed = max(abs(pair.sliding) + pair.approach, pair.most_sliding, fastest)
    q, t = friction * softer * speed, max(3 * pair.estimate.duration, seconds)
    return max(float(short_rise([0.0, t], [q], body)[-1]) for body in halves)


def _hardness(metal: Material, rate: float) -> float:
    """Return the mean pressure, Pa, that a spot of a body bears at most at a strain rate, 1/s."""
    tensile = HARDNESS * metal.ultimate_stress
    stated = VICKERS * (metal.hardness or 0.0)
    slow = stated if isinf(tensile) and stated else max(tensile, stated)
    return slow * (1 + rate_gain(metal, rate)) * (metal.skin.factor if metal.skin else 1.0)
