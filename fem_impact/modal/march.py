"""The compiled march: impulses of the contact between exact flights of the modes.

Each step kicks with the force at the present place and then flies exactly, so a flight without contact
is exact for any step. All compiled code of the reduced model stands in this file: the compiler's cache
looks at one file at a time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.kernels import allocating_kernel, inlined
from fem_impact.physics.contact_law import FAINT, MERGE_GAP, ContactLaw

__all__ = ["MOST_CONTACTS", "Bounds", "Start", "drop"]


MOST_CONTACTS = 200
SPRINGS = 100


class Start(NamedTuple):
    """Rigid rod at first contact: kg, m2, m, m/s, rad/s, m/s2 along t and n."""

    mass: float
    k2: float
    centre_t: float
    centre_n: float
    radius: float
    v_t: float
    v_n: float
    omega: float
    g_t: float
    g_n: float


class Bounds(NamedTuple):
    """Step, free flight that ends an impact, latest time of touch, s; largest contact radius, m."""

    step: float
    horizon: float
    latest: float
    reach: float


@inlined
def virgin(depth: float, law: ContactLaw) -> float:
    """Force of first loading, N."""
    if depth <= law.yield_depth:
        return float(law.stiffness * depth**1.5)
    return law.yield_force + law.slope * (depth - law.yield_depth)


@inlined
def crater(peak: float, law: ContactLaw) -> tuple[float, float]:
    """Radius R_p and residual depth that a largest depth ``peak`` leaves, m."""
    if peak <= law.yield_depth:
        return law.R, 0.0
    force = virgin(peak, law)
    square = (2 * force + law.yield_force) / (2 * np.pi * law.limit)
    R_p = 4 * law.E_star / (3 * force) * square**1.5
    return R_p, peak - square / R_p


@inlined
def press(depth: float, peak: float, law: ContactLaw) -> tuple[float, float]:
    """Return normal force, N, and contact radius, m; ``peak`` is the largest depth before."""
    if depth <= 0.0:
        return 0.0, 0.0
    if depth >= peak:
        return virgin(depth, law), np.sqrt(law.R * depth)
    R_p, residual = crater(peak, law)
    if depth <= residual:
        return 0.0, 0.0
    above = depth - residual
    return 4 / 3 * law.E_star * np.sqrt(R_p) * above**1.5, np.sqrt(R_p * above)


@inlined
def grip(
    shift: Array, place: Array, width: Array, moved: float, F: float, a: float, law: ContactLaw
) -> float:
    """Move the contact's tangential springs by ``moved``, m, and return their force, N.

    A row of springs at distances ``place``, m, each bound to its share f q(x) of Coulomb's limit, maps the
    Cattaneo-Mindlin contact of round bodies with its history exactly (Popov & Hess 2015,
    doi:10.1007/978-3-642-53876-6); springs beyond the contact radius ``a`` are free of force.
    """
    stiffness, total = 0.5 * law.shear, 0.0
    load = law.friction * 0.75 * F / (a * stiffness)
    for i in range(len(place)):
        limit = load * max(0.0, 1.0 - (place[i] / a) ** 2)
        shift[i] = min(max(shift[i] + moved, -limit), limit)
        total += width[i] * shift[i]
    # the rim cuts through a spring: the sum must not exceed Coulomb's limit by its share
    most = law.friction * F
    return min(max(stiffness * total, -most), most)


@inlined
def book(contacts: Array, count: int, time: float, p_n: float, p_t: float, largest: float) -> int:
    """Enter an impulse into the intervals of contact; return their number."""
    if p_n <= FAINT * largest:
        return count
    if (count == 0 or time - contacts[count - 1, 1] > MERGE_GAP) and count < MOST_CONTACTS:
        contacts[count, 0] = time
        count += 1
    contacts[count - 1, 1] = time
    contacts[count - 1, 2] += p_n
    contacts[count - 1, 3] += p_t
    return count


@allocating_kernel
def drop(
    start: Start,
    law: ContactLaw,
    omega: Array,
    along_t: Array,
    along_n: Array,
    bounds: Bounds,
    contacts: Array,
) -> tuple[
    tuple[float, float, float],
    Array,
    Array,
    tuple[float, float, float],
    tuple[float, float],
    float,
    int,
    int,
    bool,
]:
    """Follow a rod from first contact until the free flight ahead has none.

    Parameters
    ----------
    start : Start; law : ContactLaw; bounds : Bounds
    omega, along_t, along_n : (k,) of `ModalRod`
    contacts : (MOST_CONTACTS, 4) zeros; filled with start, end, s, and impulses along n and t, N s

    Returns
    -------
    motion : V_n, V_t, Omega at the end; q, rate : (k,) modal amplitudes and their rates, sqrt(kg) m
    works : of normal force, tangential force and gravity on the rod, J
    most : largest depth, m, and force, N
    time, steps, count of contacts, whether it is over
    """
    dt, k = bounds.step, len(omega)
    cosine, sine = np.cos(omega * dt), np.sin(omega * dt)
    q, rate = np.zeros(k), np.zeros(k)
    V_n, V_t, spin, turn = start.v_n, start.v_t, start.omega, 0.0
    height, along, before = start.radius - start.centre_n, 0.0, start.centre_t
    peak, hardest, W_n, W_t, W_g = 0.0, 0.0, 0.0, 0.0, 0.0
    # even steps of area: slip begins at the rim, where the springs then lie closer together
    edge = bounds.reach * np.sqrt(np.linspace(0.0, 1.0, SPRINGS + 1))
    place, width, shift = 0.5 * (edge[1:] + edge[:-1]), 2 * np.diff(edge), np.zeros(SPRINGS)
    time, last, steps, count = 0.0, 0.0, 0, 0
    while time - last < bounds.horizon:
        c, s = np.cos(turn), np.sin(turn)
        bent_t, bent_n = start.centre_t + along_t @ q, start.centre_n + along_n @ q
        arm_t, arm_n = c * bent_t + s * bent_n, c * bent_n - s * bent_t - start.radius
        depth, place_t = -(height + arm_n), along + arm_t - start.radius * turn
        F, a = press(depth, peak, law)
        if F > 0.0:
            if time > bounds.latest:
                break
            on_n, on_t = c * along_n - s * along_t, c * along_t + s * along_n
            w_n, w_t = V_n - spin * arm_t + on_n @ rate, V_t + spin * arm_n + on_t @ rate
            p_n, p_t = dt * F, -dt * grip(shift, place, width, place_t - before, F, a, law)
            V_n += p_n / start.mass
            V_t += p_t / start.mass
            spin += (arm_n * p_t - arm_t * p_n) / (start.mass * start.k2)
            rate += on_n * p_n + on_t * p_t
            W_n += 0.5 * p_n * (w_n + V_n - spin * arm_t + on_n @ rate)
            W_t += 0.5 * p_t * (w_t + V_t + spin * arm_n + on_t @ rate)
            peak, hardest, last = max(peak, depth), max(hardest, F), time
            count = book(contacts, count, time, p_n, p_t, dt * hardest)
        else:
            shift[:] = 0.0
        before = place_t
        lift = start.g_n * (V_n + 0.5 * dt * start.g_n) + start.g_t * (V_t + 0.5 * dt * start.g_t)
        W_g += start.mass * dt * lift
        V_n += dt * start.g_n
        V_t += dt * start.g_t
        height += dt * V_n
        along += dt * V_t
        turn += dt * spin
        q, rate = cosine * q + sine * rate / omega, cosine * rate - sine * omega * q
        time += dt
        steps += 1
    over = time - last >= bounds.horizon
    return (V_n, V_t, spin), q, rate, (W_n, W_t, W_g), (peak, hardest), time, steps, count, over
