"""The compiled march: impulses of the contacts between exact flights of the rod and its modes.

Each step kicks with the forces at the present places and then flies exactly, gravity included, so a flight
without contact is exact for any step, and the work of a force is the trapezoidal sum of it over its path.
Any number of sites of the rod may touch at once, each with a contact of its own (`fem_impact.modal.touch`):
Hertz' with friction where nothing yields, else a `fem_impact.modal.groove`.
"""

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.kernels import allocating_kernel, inlined
from fem_impact.modal.motion import (
    AT,
    CLOCK,
    CUT,
    MOST_CONTACTS,
    NEXT,
    OVER,
    ROW,
    SITE,
    SUM,
    Bounds,
    ModalState,
    Modes,
    Sites,
    Start,
    Touched,
)
from fem_impact.modal.touch import look, meet, spent, strikes, turn_surface, unknown_site
from fem_impact.physics.contact_law import FAINT, MERGE_GAP, MERGED


@inlined
def book(contacts: Array, count: int, time: float, p_n: float, p_t: float, largest: float, gap: float) -> int:
    """Enter an impulse into the intervals of contact, joined over a ``gap``, s; return their number."""
    if abs(p_n) <= FAINT * largest:
        return count
    if (count == 0 or time - contacts[count - 1, 1] > gap) and count < MOST_CONTACTS:
        contacts[count, 0] = time
        count += 1
    contacts[count - 1, 1] = time
    contacts[count - 1, 2] += p_n
    contacts[count - 1, 3] += p_t
    return count


@inlined
def book_sites(site: Array, time: float, span: float) -> None:
    """Enter the impulses of a time, s, into the sites."""
    for s in range(len(site)):
        of = site[s]
        if of[SITE.touches] > 0.0:
            if of[SITE.impulse_n] == 0.0:
                of[SITE.start] = time
            of[SITE.end] = time
            of[SITE.impulse_n] += span * of[SITE.force_n]
            of[SITE.impulse_t] += span * of[SITE.force_t]


@inlined
def fly(
    now: ModalState, modes: Modes, turns: tuple[Array, Array], dt: float, g_t: float, g_n: float
) -> float:
    """Move on by a step of free flight; return the work of gravity, J/kg."""
    (rigid, q, rate), (cosine, sine), omega = now, turns, modes.omega
    lift = g_n * (rigid[AT.V_n] + 0.5 * dt * g_n) + g_t * (rigid[AT.V_t] + 0.5 * dt * g_t)
    rigid[AT.height] += dt * (rigid[AT.V_n] + 0.5 * dt * g_n - rigid[AT.V_bn])
    rigid[AT.along] += dt * (rigid[AT.V_t] + 0.5 * dt * g_t - rigid[AT.V_bt])
    rigid[AT.away_n] += dt * (rigid[AT.V_n] + 0.5 * dt * g_n - rigid[AT.V_bn])
    rigid[AT.away_t] += dt * (rigid[AT.V_t] + 0.5 * dt * g_t - rigid[AT.V_bt])
    rigid[AT.turn] += dt * rigid[AT.Omega]
    rigid[AT.V_n] += dt * g_n
    rigid[AT.V_t] += dt * g_t
    for i in range(len(q)):
        a, b = q[i], rate[i]
        q[i] = cosine[i] * a + sine[i] * b / omega[i]
        rate[i] = cosine[i] * b - sine[i] * omega[i] * a
    return float(dt * lift)


@inlined
def approach(now: ModalState, sites: Sites, s: int, of: Array, c: float, sn: float) -> tuple[float, float]:
    """Return velocities n, t, m/s, of a site as seen from the barrier under it."""
    rigid, rate = now.rigid, now.rate
    arm_t, arm_n = of[SITE.arm_t], of[SITE.arm_n]
    w_n = rigid[AT.V_n] - rigid[AT.Omega] * arm_t
    w_t = rigid[AT.V_t] + rigid[AT.Omega] * arm_n
    w_n -= rigid[AT.V_bn] - rigid[AT.Omega_b] * (rigid[AT.away_t] + arm_t)
    w_t -= rigid[AT.V_bt] + rigid[AT.Omega_b] * (rigid[AT.away_n] + arm_n)
    for i in range(len(rate)):
        w_n += (c * sites.along_n[s, i] - sn * sites.along_t[s, i]) * rate[i]
        w_t += (c * sites.along_t[s, i] + sn * sites.along_n[s, i]) * rate[i]
    return w_n, w_t


@inlined
def push(
    now: ModalState, start: Start, sites: Sites, s: int, of: Array, c: float, sn: float, span: float
) -> None:
    """Change the motion by the impulse of a site's force over a ``span``, s.

    ``c`` and ``sn`` are cosine and sine of the rod's turn.
    """
    rigid, rate = now.rigid, now.rate
    p_n, p_t, arm_t, arm_n = span * of[SITE.force_n], span * of[SITE.force_t], of[SITE.arm_t], of[SITE.arm_n]
    lever_t, lever_n = rigid[AT.away_t] + arm_t, rigid[AT.away_n] + arm_n  # from the barrier's mass centre
    rigid[AT.V_bn] -= p_n * start.inverse_barrier_mass
    rigid[AT.V_bt] -= p_t * start.inverse_barrier_mass
    rigid[AT.Omega_b] += start.inverse_barrier_inertia * (lever_t * p_n - lever_n * p_t)
    rigid[AT.V_n] += p_n / start.mass
    rigid[AT.V_t] += p_t / start.mass
    rigid[AT.Omega] += (arm_n * p_t - arm_t * p_n) / (start.mass * start.k2)
    for i in range(len(rate)):
        rate[i] += (c * sites.along_n[s, i] - sn * sites.along_t[s, i]) * p_n
        rate[i] += (c * sites.along_t[s, i] + sn * sites.along_n[s, i]) * p_t


@inlined
def exert(now: ModalState, start: Start, sites: Sites, site: Array, span: float, work_t: Array) -> float:
    """Change the motion by all forces over a ``span``, s; return their work along n, J.

    That along t is added to ``work_t`` (s,), J. Both are those of the mean velocity of all impulses.
    """
    c, sn, work_n = np.cos(now.rigid[AT.turn]), np.sin(now.rigid[AT.turn]), 0.0
    for after in range(2):
        for s in range(len(site)):
            of = site[s]
            if of[SITE.touches] > 0.0:
                w_n, w_t = approach(now, sites, s, of, c, sn)
                work_n += 0.5 * span * of[SITE.force_n] * w_n
                work_t[s] += 0.5 * span * of[SITE.force_t] * w_t
        if after == 0:
            for s in range(len(site)):
                if site[s, SITE.touches] > 0.0:
                    push(now, start, sites, s, site[s], c, sn, span)
    return float(work_n)


@allocating_kernel
def ahead(
    now: ModalState, modes: Modes, sites: Sites, held: Touched, clock: Array, start: Start, bounds: Bounds
) -> tuple[float, int]:
    """Return the steps of free flight until a site strikes, and which, or -1 if none does within the horizon.

    Gravity has no part in that: a rod that falls back strikes anew.
    """
    flight, site = ModalState(now.rigid.copy(), now.q.copy(), now.rate.copy()), held.site.copy()
    site[:, SITE.wake] = 0.0
    still = clock.copy()
    dt, steps = bounds.step, 0.0
    turns = np.cos(modes.omega * dt), np.sin(modes.omega * dt)
    while steps * dt < bounds.horizon:
        rests = np.floor(max(1.0, site[:, SITE.wake].min() - steps))
        far = rests * dt
        if rests == 1.0:
            fly(flight, modes, turns, dt, 0.0, 0.0)
        else:
            fly(flight, modes, (np.cos(modes.omega * far), np.sin(modes.omega * far)), far, 0.0, 0.0)
        turn_surface(start, flight, site, still, far)
        steps += rests
        struck = strikes(flight, modes, sites, held, site, steps, dt)
        if struck >= 0:
            return steps, struck
    return steps, -1


@allocating_kernel
def enter(
    row: Array,
    now: ModalState,
    start: Start,
    modes: Modes,
    sites: Sites,
    held: Touched,
    dt: float,
    tally: Array,
) -> None:
    """Fill a row of the record with the motion half an impulse further.

    The velocities are then those of the time of the places, and the energies add up.
    """
    mid, work_t = ModalState(now.rigid.copy(), now.q, now.rate.copy()), held.work_t.copy()
    exert(mid, start, sites, held.site, 0.5 * dt, work_t)
    V_n, V_t, spin = mid.rigid[AT.V_n], mid.rigid[AT.V_t], mid.rigid[AT.Omega]
    row[ROW.V_n], row[ROW.V_t], row[ROW.Omega] = V_n, V_t, spin
    row[ROW.rigid] = 0.5 * start.mass * (V_n**2 + V_t**2 + start.k2 * spin**2)
    row[ROW.vibration], row[ROW.strain] = 0.5 * np.sum(mid.rate**2), 0.5 * np.sum((modes.omega * mid.q) ** 2)
    if start.inverse_barrier_mass > 0.0:
        row[ROW.barrier] = 0.5 * (mid.rigid[AT.V_bn] ** 2 + mid.rigid[AT.V_bt] ** 2)
        row[ROW.barrier] /= start.inverse_barrier_mass
    if start.inverse_barrier_inertia > 0.0:
        row[ROW.barrier] += 0.5 * mid.rigid[AT.Omega_b] ** 2 / start.inverse_barrier_inertia
    row[ROW.plate], row[ROW.gravity], row[ROW.viscous] = (
        tally[SUM.plate],
        tally[SUM.gravity],
        tally[SUM.viscous],
    )
    row[ROW.waves] = held.flats.works[:, 3].sum()
    row[ROW.plastic], row[ROW.friction], held_n, held_t = spent(held, work_t)
    row[ROW.contact] = held_n + held_t


@inlined
def thinned(record: Array, rows: int, every: int) -> tuple[int, int]:
    """Drop every second row of a full record; return the number of rows and the steps from row to row."""
    if rows < len(record):
        return rows, every
    for i in range(rows // 2):
        for k in range(record.shape[1]):
            record[i, k] = record[2 * i, k]
    return rows // 2, 2 * every


@allocating_kernel
def march(
    start: Start,
    modes: Modes,
    sites: Sites,
    bounds: Bounds,
    now: ModalState,
    held: Touched,
    clock: Array,
    tally: Array,
    contacts: Array,
    record: Array,
) -> int:
    """Follow a rod until nothing strikes in the free flight ahead, or a site without a law touches.

    Returns `OVER`, `NEXT` or `CUT`, or the site: given its law, the march goes on where it stopped. ``now``,
    ``held``, ``clock`` (10,) and ``tally`` (5,) move. ``contacts`` (MOST_CONTACTS, 4) are filled with start,
    end, s, and impulses along n and t, N s; ``record`` (m, 17) with what moved over time; it may have none.
    """
    dt, rigid = bounds.step, now.rigid
    turns = np.cos(modes.omega * dt), np.sin(modes.omega * dt)
    gap = max(min(MERGE_GAP, MERGED * bounds.horizon), 1.5 * dt)
    while clock[CLOCK.time] - clock[CLOCK.last] < bounds.horizon:
        time, pressed = clock[CLOCK.time], clock[CLOCK.pressed] > 0.0
        new = unknown_site(now, modes, sites, held, clock[CLOCK.steps], dt, pressed)
        if new >= 0:
            return new
        look(now, modes, sites, held, clock[CLOCK.steps], dt, pressed)
        F_n, F_t, lost = meet(held, rigid[AT.turn], dt)
        tally[SUM.viscous] += lost
        touches = False
        for s in range(len(held.site)):
            touches = touches or held.site[s, SITE.touches] > 0.0
        late = touches and time > bounds.latest
        if len(record) and clock[CLOCK.steps] % clock[CLOCK.every] == 0:
            row = record[int(clock[CLOCK.rows])]
            row[ROW.time], row[ROW.force_n], row[ROW.force_t] = time, F_n, F_t
            enter(row, now, start, modes, sites, held, dt, tally)
            rows, every = thinned(record, int(clock[CLOCK.rows]) + 1, int(clock[CLOCK.every]))
            clock[CLOCK.rows], clock[CLOCK.every] = rows, every
        if touches:
            span = 0.5 * dt if late else dt  # a half brings v to the time of the places
            tally[SUM.work_n] += exert(now, start, sites, held.site, span, held.work_t)
            rigid[AT.height] += span * F_n * start.plate_mobility  # a plate sinks away under the force
            tally[SUM.plate] += span * F_n**2 * start.plate_mobility
            tally[SUM.force] = max(tally[SUM.force], F_n)
            count = int(clock[CLOCK.touches])
            count = book(contacts, count, time, span * F_n, span * F_t, dt * tally[SUM.force], gap)
            book_sites(held.site, time, span)
            clock[CLOCK.touches], clock[CLOCK.last] = count, time
        if late:
            return CUT
        if touches and not pressed:
            held.site[:, SITE.wake] = 0.0  # what rested in flight is pushed about from now on
        clock[CLOCK.pressed] = 1.0 if touches else 0.0
        if pressed and not touches:
            flown, struck = ahead(now, modes, sites, held, clock, start, bounds)
            if struck < 0:
                return OVER
            if held.site[struck, SITE.known] == 0.0 and sites.apart[struck]:
                clock[CLOCK.free] = flown * dt
                return NEXT
        tally[SUM.gravity] += start.mass * fly(now, modes, turns, dt, start.g_t, start.g_n)
        turn_surface(start, now, held.site, clock, dt)
        clock[CLOCK.time] += dt
        clock[CLOCK.steps] += 1.0
    return OVER
