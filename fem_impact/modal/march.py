"""The compiled march: impulses of the contact between exact flights of the rod and its modes.

Each step kicks with the force at the present place and then flies exactly, gravity included, so a flight
without contact is exact for any step, and the work of a force is the trapezoidal sum of it over its path.
A contact that does not yield is Hertz' with friction; one that yields is a `fem_impact.modal.groove`.
"""

from __future__ import annotations

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.kernels import allocating_kernel, inlined
from fem_impact.modal.groove import Groove, meets, move_apart, slide, smooth, stored_energy
from fem_impact.modal.motion import (
    AT,
    LOOK,
    MOST_CONTACTS,
    NOTHING,
    ROW,
    SPRINGS,
    SUM,
    TIP,
    Bounds,
    ModalEnd,
    ModalState,
    Modes,
    Others,
    Springs,
    Start,
)
from fem_impact.physics.contact_law import FAINT, MERGE_GAP, ContactLaw
from fem_impact.physics.flow_law import FlowLaw


@inlined
def press(depth: float, rate: float, law: ContactLaw) -> tuple[float, float, float]:
    """Return the normal force, N, contact radius, m, and the part of the force that is viscous, N.

    The whole is Hertz' and the viscous one at a ``rate`` of the depth, m/s, or 0 where that would pull.
    """
    if depth <= 0.0:
        return 0.0, 0.0, 0.0
    elastic = law.stiffness * depth**1.5
    viscous = max(1.5 * law.stiffness * law.lag * np.sqrt(depth) * rate, -elastic) if law.lag > 0.0 else 0.0
    return elastic + viscous, np.sqrt(law.R * depth), viscous


@allocating_kernel
def springs_over(radius: float) -> Springs:
    """Return springs over a contact radius, m, in even steps of area: close at the rim, where slip begins."""
    edge = radius * np.sqrt(np.linspace(0.0, 1.0, SPRINGS + 1))
    return Springs(0.5 * (edge[1:] + edge[:-1]), 2 * np.diff(edge), np.zeros(SPRINGS))


@inlined
def grip(springs: Springs, moved: float, F: float, a: float, law: ContactLaw) -> float:
    """Move the contact's tangential springs by ``moved``, m, and return their force, N.

    A row of springs, each bound to its share f q(x) of Coulomb's limit, maps the Cattaneo-Mindlin contact of
    round bodies with its history exactly (Popov & Hess 2015, doi:10.1007/978-3-642-53876-6); springs beyond
    the contact radius ``a`` are free of force.
    """
    place, width, shift = springs
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
def stored(depth: float, springs: Springs, law: ContactLaw) -> tuple[float, float]:
    """Return the energies, J, that the contact holds: Hertz', and that of its springs."""
    total, F = 0.0, law.stiffness * max(depth, 0.0) ** 1.5
    for i in range(len(springs.shift)):
        total += springs.width[i] * springs.shift[i] ** 2
    return 0.4 * F * depth, 0.25 * law.shear * total


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
def reach_to(
    now: ModalState, t: float, n: float, along_t: Array, along_n: Array
) -> tuple[float, float, float, float]:
    """Return cosine and sine of the rod's turn, and the arm (t, n), m, from its mass centre to a point."""
    c, s = np.cos(now.rigid[AT.turn]), np.sin(now.rigid[AT.turn])
    for i in range(len(now.q)):
        t += along_t[i] * now.q[i]
        n += along_n[i] * now.q[i]
    return c, s, c * t + s * n, c * n - s * t


@inlined
def strikes(now: ModalState, others: Others) -> int:
    """Return the place of a point that strikes beside the followed one, or `NOTHING`."""
    for i in range(len(others.t)):
        arm_n = reach_to(now, others.t[i], others.n[i], others.along_t[i], others.along_n[i])[3]
        if now.rigid[AT.height] + arm_n - others.radius[i] < 0.0:
            return i
    return NOTHING


@inlined
def fly(
    now: ModalState, omega: Array, turns: tuple[Array, Array], dt: float, g_t: float, g_n: float
) -> float:
    """Move on by a step of free flight; return the work of gravity, J/kg."""
    (rigid, q, rate), (cosine, sine) = now, turns
    lift = g_n * (rigid[AT.V_n] + 0.5 * dt * g_n) + g_t * (rigid[AT.V_t] + 0.5 * dt * g_t)
    rigid[AT.height] += dt * (rigid[AT.V_n] + 0.5 * dt * g_n - rigid[AT.surface_n])
    rigid[AT.along] += dt * (rigid[AT.V_t] + 0.5 * dt * g_t - rigid[AT.surface_t])
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
def push(
    now: ModalState,
    start: Start,
    modes: Modes,
    arm: tuple[float, float, float, float],
    p_n: float,
    p_t: float,
    tally: Array,
) -> None:
    """Change the motion by an impulse at the followed point, N s, and book its work on both bodies."""
    (c, s, arm_t, arm_n), (rigid, _, rate) = arm, now
    inverse_mass, inverse_inertia = start.inverse_barrier_mass, start.inverse_barrier_inertia
    w_n, w_t = rigid[AT.V_n] - rigid[AT.Omega] * arm_t, rigid[AT.V_t] + rigid[AT.Omega] * arm_n
    # arm from the barrier's mass centre to the same point
    lever_t, lever_n = rigid[AT.away_t] + arm_t, rigid[AT.away_n] + arm_n
    turned = inverse_inertia * (lever_t * p_n - lever_n * p_t)
    w_n -= 2 * (rigid[AT.V_bn] - rigid[AT.Omega_b] * lever_t) - p_n * inverse_mass - turned * lever_t
    w_t -= 2 * (rigid[AT.V_bt] + rigid[AT.Omega_b] * lever_n) - p_t * inverse_mass + turned * lever_n
    rigid[AT.V_bn] -= p_n * inverse_mass
    rigid[AT.V_bt] -= p_t * inverse_mass
    rigid[AT.Omega_b] += turned
    rigid[AT.surface_n] = rigid[AT.V_bn] - rigid[AT.Omega_b] * lever_t
    rigid[AT.surface_t] = rigid[AT.V_bt] + rigid[AT.Omega_b] * lever_n
    rigid[AT.V_n] += p_n / start.mass
    rigid[AT.V_t] += p_t / start.mass
    rigid[AT.Omega] += (arm_n * p_t - arm_t * p_n) / (start.mass * start.k2)
    w_n += rigid[AT.V_n] - rigid[AT.Omega] * arm_t
    w_t += rigid[AT.V_t] + rigid[AT.Omega] * arm_n
    for i in range(len(rate)):
        on_n = c * modes.along_n[i] - s * modes.along_t[i]
        on_t = c * modes.along_t[i] + s * modes.along_n[i]
        gained = on_n * p_n + on_t * p_t
        w_n += on_n * (2 * rate[i] + gained)
        w_t += on_t * (2 * rate[i] + gained)
        rate[i] += gained
    tally[SUM.work_n] += 0.5 * p_n * w_n
    tally[SUM.work_t] += 0.5 * p_t * w_t


@inlined
def followed(
    now: ModalState, start: Start, modes: Modes
) -> tuple[tuple[float, float, float, float], float, float]:
    """Return the arm of the followed point as `push` takes it, its depth and its place along t, m."""
    c, s, arm_t, arm_n = reach_to(now, start.centre_t, start.centre_n, modes.along_t, modes.along_n)
    place = now.rigid[AT.along] + arm_t - start.centre_t - start.radius * now.rigid[AT.turn]
    return (c, s, arm_t, arm_n - start.radius), start.radius - now.rigid[AT.height] - arm_n, place


@inlined
def ahead(
    now: ModalState,
    start: Start,
    modes: Modes,
    others: Others,
    turns: tuple[Array, Array],
    bounds: Bounds,
    law: ContactLaw,
    flow: FlowLaw,
    groove: Groove,
    depth: float,
) -> tuple[int, int]:
    """Fly on from a depth, m, until something strikes or to the horizon; return the steps and what strikes.

    A viscous contact that has parted is no strike as its dent swells behind it. Gravity has no part in that:
    a rod that falls back strikes anew.
    """
    steps = 0
    while steps * bounds.step < bounds.horizon:
        fly(now, modes.omega, turns, bounds.step, 0.0, 0.0)
        steps += 1
        before = depth
        _, depth, place = followed(now, start, modes)
        swelling = press(depth, (depth - before) / bounds.step, law)[0] <= 0.0
        if meets(groove, depth, place, flow) if flow.yields else not swelling:
            return steps, TIP
        if steps % LOOK == 0:
            struck = strikes(now, others)
            if struck != NOTHING:
                return steps, struck
    return steps, NOTHING


@inlined
def meet(
    law: ContactLaw,
    flow: FlowLaw,
    springs: Springs,
    groove: Groove,
    depth: float,
    rate: float,
    place: float,
    moved: float,
) -> tuple[float, float]:
    """Return normal and tangential force, N, at a depth and place, m, of a tip that has ``moved``, m.

    ``rate``, m/s, is that of the depth. The first is 0 where nothing touches, and below 0 where friction on
    a steep flank holds a leaving tip.
    """
    if flow.yields:
        return slide(groove, depth, place, flow)
    F, a, _ = press(depth, rate, law)
    return (F, -grip(springs, moved, F, a, law)) if F > 0.0 else (0.0, 0.0)


@allocating_kernel
def enter(
    row: Array,
    now: ModalState,
    start: Start,
    modes: Modes,
    arm: tuple[float, float, float, float],
    p: tuple[float, float],
    tally: Array,
) -> tuple[float, float]:
    """Fill a row of the record with the motion half an impulse (n, t), N s, further; return works n, t, J.

    The velocities are then those of the time of the places, and the energies add up.
    """
    mid, works = ModalState(now.rigid.copy(), now.q, now.rate.copy()), tally.copy()
    push(mid, start, modes, arm, 0.5 * p[0], 0.5 * p[1], works)
    V_n, V_t, spin = mid.rigid[AT.V_n], mid.rigid[AT.V_t], mid.rigid[AT.Omega]
    row[ROW.V_n], row[ROW.V_t], row[ROW.Omega] = V_n, V_t, spin
    row[ROW.rigid] = 0.5 * start.mass * (V_n**2 + V_t**2 + start.k2 * spin**2)
    row[ROW.vibration], row[ROW.strain] = 0.5 * np.sum(mid.rate**2), 0.5 * np.sum((modes.omega * mid.q) ** 2)
    if start.inverse_barrier_mass > 0.0:
        row[ROW.barrier] = 0.5 * (mid.rigid[AT.V_bn] ** 2 + mid.rigid[AT.V_bt] ** 2)
        row[ROW.barrier] /= start.inverse_barrier_mass
    if start.inverse_barrier_inertia > 0.0:
        row[ROW.barrier] += 0.5 * mid.rigid[AT.Omega_b] ** 2 / start.inverse_barrier_inertia
    row[ROW.plate], row[ROW.gravity] = tally[SUM.plate], tally[SUM.gravity]
    return works[SUM.work_n], works[SUM.work_t]


@inlined
def enter_contact(
    row: Array,
    time: float,
    force: tuple[float, float],
    held: tuple[float, float],
    works: Array,
    work_t: float,
    yields: bool,
) -> None:
    """Fill a row of the record with time, s, forces n, t, N, and energies of the contact, J."""
    row[ROW.time], row[ROW.force_n], row[ROW.force_t] = time, force[0], force[1]
    row[ROW.contact] = held[0] + held[1]
    row[ROW.plastic] = works[0] + works[1] if yields else 0.0
    row[ROW.friction] = works[2] if yields else -work_t - held[1]


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
def integrate_impact(
    start: Start,
    law: ContactLaw,
    flow: FlowLaw,
    modes: Modes,
    others: Others,
    bounds: Bounds,
    contacts: Array,
    record: Array,
) -> ModalEnd:
    """Follow a rod from first contact until nothing strikes in the free flight ahead, or another point does.

    ``contacts`` (MOST_CONTACTS, 4), zeros, are filled with start, end, s, and impulses along n and t, N s;
    ``record`` (m, 16), zeros, with what moved over time; it may have no rows.
    """
    rows, every = 0, 1
    dt, k, tally = bounds.step, len(modes.omega), np.zeros(10)
    turns = np.cos(modes.omega * dt), np.sin(modes.omega * dt)
    rigid = np.zeros(13)
    rigid[:4] = start.v_n, start.v_t, start.omega, start.radius - start.centre_n
    rigid[AT.away_n :] = rigid[AT.height] + start.centre_depth, -start.centre_t - start.centre_offset
    now = ModalState(rigid, np.zeros(k), np.zeros(k))
    springs, groove = springs_over(bounds.reach), smooth(bounds.reach)
    gap, before, pressed, wait = max(MERGE_GAP, 1.5 * dt), 0.0, False, 0.0
    time, last, steps, count, struck, late = 0.0, 0.0, 0, 0, NOTHING, False
    depth, drag, force = 0.0, 0.0, (0.0, 0.0)
    while time - last < bounds.horizon:
        was, dragged = depth, drag
        arm, depth, place = followed(now, start, modes)
        rate = (depth - was) / dt if steps else 0.0
        force = meet(law, flow, springs, groove, depth, rate, place, place - before)
        drag = press(depth, rate, law)[2]
        tally[SUM.viscous] += 0.5 * (drag + dragged) * (depth - was)
        struck = strikes(now, others) if steps % LOOK == LOOK - 1 else NOTHING
        touches = force[0] != 0.0
        late = touches and time > bounds.latest
        if len(record) and steps % every == 0:
            row = record[rows]
            work = enter(row, now, start, modes, arm, (dt * force[0], dt * force[1]), tally)
            held = stored_energy(groove, flow) if flow.yields else stored(depth, springs, law)
            enter_contact(row, time, force, held, groove.works, work[1], flow.yields)
            row[ROW.viscous] = tally[SUM.viscous]
            rows, every = thinned(record, rows + 1, every)
        if touches:
            span = 0.5 * dt if late or struck != NOTHING else dt  # a half brings v to the time of the places
            p_n, p_t = span * force[0], span * force[1]
            push(now, start, modes, arm, p_n, p_t, tally)
            rigid[AT.height] += p_n * start.plate_mobility  # a plate sinks away under the force
            tally[SUM.plate] += p_n * force[0] * start.plate_mobility
            tally[SUM.force] = max(tally[SUM.force], force[0])
            count = book(contacts, count, time, p_n, p_t, dt * tally[SUM.force], gap)
            tally[SUM.depth], last = max(tally[SUM.depth], depth), time
        else:
            springs.shift[:] = 0.0
            move_apart(groove, depth, place)
        if late or struck != NOTHING:
            break
        if pressed and not touches:
            flight = ModalState(rigid.copy(), now.q.copy(), now.rate.copy())
            flown, struck = ahead(flight, start, modes, others, turns, bounds, law, flow, groove, depth)
            steps += flown
            if struck != TIP:
                wait = flown * dt
                break
        pressed, before = touches, place
        tally[SUM.gravity] += start.mass * fly(now, modes.omega, turns, dt, start.g_t, start.g_n)
        time += dt
        steps += 1
    held = stored_energy(groove, flow) if flow.yields else stored(depth, springs, law)
    if flow.yields:
        tally[SUM.flow : SUM.friction + 1] = groove.works
    else:
        # the normal spring gives back what it stores by itself, the tangential ones out of friction
        tally[SUM.friction] = -tally[SUM.work_t] - held[1]
    over = struck in (NOTHING, TIP) and not late
    if over and law.lag > 0.0:  # the dent that is left swells without a push
        tally[SUM.viscous] += held[0]
        held = (0.0, held[1])
    return ModalEnd(now, tally, held, time, steps, count, struck, wait, over, rows)
