"""A straight part of the outline that lands all at once: a row of cells between the two sites at its ends.

Each cell is an elastic spring (Popov & Hess 2015, doi:10.1007/978-3-642-53876-6) on a bed that flows, with a
tangential spring that slips. A face of radius a has the stiffness E* a metre of its width, together that of a
flat punch, 2 a E*; a side that lies down has pi/4 E* a metre (Popov 2010, Contact Mechanics and Friction,
chapter 5). The barrier's part of that spring has a dashpot beside it, which stands for the waves it sends
away: rho V of the area that is pressed, V = 3.4 c_s / (pi (1 - nu)) being Lysmer's velocity (Lysmer & Richart
1966, J. Soil Mech. Found. Div. 92, 65; for any shape Gazetas 1991,
doi:10.1061/(ASCE)0733-9410(1991)117:9(1363)); the rod's part stands in series with both.
The cells are those of the rod and take their dents along. What presses a cell is between the
depths of both sites, by its share of the way; its force acts on them by the same shares, so that force,
moment and work are those of the cell.
"""

from math import sqrt
from typing import NamedTuple, Self

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.kernels import inlined

CELLS = 48
MOST = 6  # flat parts of one impact


class FlatIndex(NamedTuple):
    """Where each constant of a flat part stands in its row (10,) of `Flats.law`.

    Stiffness of a cell of the rod, of the barrier under it, and along t, N/m; impedance of the barrier, Pa
    s/m; hardness and shear strength of its surface, Pa; friction; width of a cell, m; growth of a cell's
    squared half width with its dent, m; whether it is there.
    """

    rod: int = 0
    barrier: int = 1
    shear: int = 2
    impedance: int = 3
    hardness: int = 4
    skin: int = 5
    friction: int = 6
    size: int = 7
    widens: int = 8
    known: int = 9


LAW = FlatIndex()


class Flats(NamedTuple):
    """Straight parts that have landed, up to `MOST`.

    Attributes
    ----------
    ends : (f, 2) sites at both ends
    law : (f, 10) see `FlatIndex`
    share : (f, CELLS) of the way from the first site to the second
    base, inner : (f, CELLS) squared half width of a cell without a dent, m2, and that of a bore, m
    dent, normal, sunk : (f, CELLS) m, normal force, N, elastic sinking of the barrier under a cell, m
    shift, deepest : (f, CELLS) of the tangential spring, m, most depth, m
    works : (f, 4) normal flow, shear flow, friction, waves in the barrier, J
    """

    ends: Ints
    law: Array
    share: Array
    base: Array
    inner: Array
    dent: Array
    normal: Array
    sunk: Array
    shift: Array
    deepest: Array
    works: Array

    @classmethod
    def none(cls) -> Self:
        """Return room for flat parts."""

        def cells() -> Array:
            return np.zeros((MOST, CELLS))

        rows = cells(), cells(), cells(), cells(), cells(), cells(), cells(), cells()
        return cls(np.zeros((MOST, 2), np.int64), np.zeros((MOST, len(LAW))), *rows, np.zeros((MOST, 4)))


@inlined
def press_flat(
    flats: Flats, f: int, depth: tuple[float, float], moved: tuple[float, float], rubs: float, dt: float
) -> tuple[float, float, float, float]:
    """Press a flat part to the depths of its ends and move them, m; return their forces n, n, t, t, N.

    Its friction counts times ``rubs``; ``dt`` is the step, s.
    """
    law, works = flats.law[f], flats.works[f]
    k, k_b, k_t, size = law[LAW.rod], law[LAW.barrier], law[LAW.shear], law[LAW.size]
    N_a, N_b, T_a, T_b = 0.0, 0.0, 0.0, 0.0
    for c in range(CELLS):
        to = flats.share[f, c]
        D, way = (1 - to) * depth[0] + to * depth[1], (1 - to) * moved[0] + to * moved[1]
        before, q_before, shift = flats.dent[f, c], flats.normal[f, c], flats.shift[f, c]
        sank, waves_before = flats.sunk[f, c], q_before - k_b * flats.sunk[f, c]
        if D <= before:
            works[2] += 0.5 * k_t * shift**2
            works[3] += 0.5 * k_b * sank**2  # what it keeps as the rod leaves swings away
            flats.normal[f, c], flats.sunk[f, c], flats.shift[f, c] = 0.0, 0.0, 0.0
            continue
        sunk = before + 0.5 * (D - before)  # an elastic dent is as wide as one that stays of half its depth
        wide = 2 * size * (sqrt(flats.base[f, c] + law[LAW.widens] * sunk) - flats.inner[f, c])
        bears, lags = wide * law[LAW.hardness], wide * law[LAW.impedance] / dt
        sinks = (k * (D - before) + lags * sank) / (k + k_b + lags)
        q = k * (D - before - sinks)
        if not 0.0 <= q <= bears:
            q = min(max(q, 0.0), bears)
            sinks = (q + lags * sank) / (k_b + lags)
            flats.dent[f, c] = max(before, D - sinks - q / k) if q > 0.0 else before
        flats.sunk[f, c] = sinks
        works[3] += 0.5 * (waves_before + q - k_b * sinks) * (sinks - sank)
        works[0] += 0.5 * (q_before + q) * (flats.dent[f, c] - before)
        rubbed, sheared = rubs * law[LAW.friction] * q, wide * law[LAW.skin]
        trial, limit = k_t * (shift + way), min(rubbed, sheared)
        T = min(max(trial, -limit), limit)
        works[2 if rubbed <= sheared else 1] += 0.5 * (k_t * shift + T) * (trial - T) / k_t
        flats.normal[f, c], flats.shift[f, c] = q, T / k_t
        flats.deepest[f, c] = max(flats.deepest[f, c], D)
        N_a += (1 - to) * q
        N_b += to * q
        T_a -= (1 - to) * T
        T_b -= to * T
    return N_a, N_b, T_a, T_b


@inlined
def flat_meets(flats: Flats, f: int, depth: tuple[float, float]) -> bool:
    """Return whether any cell of a flat part touches at the depths of its ends, m."""
    for c in range(CELLS):
        to = flats.share[f, c]
        if (1 - to) * depth[0] + to * depth[1] > flats.dent[f, c]:
            return True
    return False


@inlined
def flat_energy(flats: Flats, f: int) -> tuple[float, float]:
    """Return the elastic energies, J, of a flat part's normal and tangential springs."""
    normal, tangential, law = 0.0, 0.0, flats.law[f]
    for c in range(CELLS):
        normal += flats.normal[f, c] ** 2 / law[LAW.rod] + law[LAW.barrier] * flats.sunk[f, c] ** 2
        tangential += flats.shift[f, c] ** 2
    return 0.5 * normal, 0.5 * law[LAW.shear] * tangential
