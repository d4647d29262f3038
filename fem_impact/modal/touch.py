"""Where each site of the rod is, whether it touches, and with which force: the contact side of a step."""

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.kernels import inlined
from fem_impact.fem.sliding import factor_at
from fem_impact.modal.flat import LAW, flat_energy, flat_meets, press_flat
from fem_impact.modal.groove import AT as IN_GROOVE
from fem_impact.modal.groove import WORK, Groove, meets, move_apart, slide, stored_energy
from fem_impact.modal.hertz import grip, press, stored
from fem_impact.modal.motion import AT, CLOCK, SITE, ModalState, Modes, Sites, Springs, Start, Touched
from fem_impact.modal.tip import Flank, Tip
from fem_impact.physics.contact_law import ContactLaw, FlowLaw

OWN, LAID = 1.0, 2.0  # what a site that is known has: a law of its own, or that of a flat part
LOOK = 8  # most steps between looks at a site while another one touches
MARGIN = 0.5  # share of its gap that a site may close unseen while another one touches


@inlined
def law_of(held: Touched, s: int, rubs: float = 1.0) -> ContactLaw:
    """Return the law of a site that does not yield, its friction times ``rubs``."""
    v = held.law[s]
    return ContactLaw(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], rubs * v[8], v[9])


@inlined
def flow_of(held: Touched, s: int, rubs: float = 1.0) -> FlowLaw:
    """Return the law of a site that yields, its friction times ``rubs``."""
    v = held.flow[s]
    shape, own = (v[0], v[1], v[2], v[3], v[4], v[5], v[6]), (v[7], v[8], v[9], v[10])
    return FlowLaw(*shape, *own, rubs * v[11], v[12] > 0.0, v[13] > 0.0, v[14], v[15], v[16])


@inlined
def groove_of(held: Touched, s: int) -> Groove:
    """Return the groove of a site."""
    cells = held.depth[s], held.normal[s], held.sheared[s]
    v = held.tip[s]
    tip = Tip(v[0], Flank(v[1], v[2], v[3]), Flank(v[4], v[5], v[6]))
    return Groove(*cells, held.state[s], held.works[s], tip, held.size[s])


@inlined
def springs_of(held: Touched, s: int) -> Springs:
    """Return the tangential springs of a site."""
    return Springs(held.place[s], held.width[s], held.shift[s])


@inlined
def locate(now: ModalState, sites: Sites, s: int, c: float, sn: float) -> tuple[float, float, float, float]:
    """Return arm t, n, m, from the mass centre to what is lowest of a site, its depth and its place, m.

    ``c`` and ``sn`` are cosine and sine of the rod's turn. The depth is that in a barrier that does not turn.
    """
    turn = now.rigid[AT.turn]
    turn -= 2 * np.pi * np.floor((turn - sites.base) / (2 * np.pi))
    first, last = sites.begin[s], sites.begin[s + 1] - 1
    turned = min(max(turn, sites.low[first]), sites.high[last])
    a = first
    while a < last and sites.high[a] < turned:
        a += 1
    t, n, r = sites.t[a], sites.n[a], sites.radius[a]
    for i in range(len(now.q)):
        t += sites.along_t[s, i] * now.q[i]
        n += sites.along_n[s, i] * now.q[i]
    lean = turned - turn
    up, aside = r * np.cos(lean), r * np.sin(lean)
    arm_t, arm_n = c * t + sn * n, c * n - sn * t
    depth = up - now.rigid[AT.height] - arm_n
    place = now.rigid[AT.along] + arm_t + aside - sites.offset[a] - r * turned
    return arm_t + aside, arm_n - up, depth, place


@inlined
def seen(now: ModalState, sites: Sites, of: Array, s: int, c: float, sn: float) -> tuple[float, float, float]:
    """Return the length of a site's arm, its depth in the surface under it and its place, m; the arm is kept.

    ``of`` is the site's row, see `SiteIndex`.
    """
    of[SITE.arm_t], of[SITE.arm_n], depth, place = locate(now, sites, s, c, sn)
    arm = np.hypot(of[SITE.arm_t], of[SITE.arm_n])
    return arm, depth + of[SITE.sunk_n], place - of[SITE.sunk_t]


@inlined
def fastest(now: ModalState, modes: Modes, sites: Sites, s: int, arm: float) -> float:
    """Return a bound of the speed, m/s, at which a site with an ``arm``, m, may come in free flight."""
    rigid = now.rigid
    speed = abs(rigid[AT.V_n] - rigid[AT.V_bn]) + abs(rigid[AT.Omega]) * arm
    speed += abs(rigid[AT.Omega_b]) * (arm + np.hypot(rigid[AT.away_n], rigid[AT.away_t]))
    for i in range(len(now.q)):
        swing = np.sqrt(now.rate[i] ** 2 + (modes.omega[i] * now.q[i]) ** 2)
        speed += np.hypot(sites.along_t[s, i], sites.along_n[s, i]) * swing
    return float(speed)


@inlined
def rest(
    now: ModalState, modes: Modes, sites: Sites, s: int, arm: float, gap: float, dt: float, pressed: bool
) -> float:
    """Return the number of steps within which a site over a ``gap``, m, cannot touch; at least one."""
    safe = gap / (fastest(now, modes, sites, s, arm) * dt)
    return float(max(1.0, min(MARGIN * safe, LOOK) if pressed else safe))


@inlined
def unknown_site(
    now: ModalState, modes: Modes, sites: Sites, held: Touched, steps: float, dt: float, pressed: bool
) -> int:
    """Return a site without a law that touches, -1 if there is none; the others are let rest."""
    c, sn = np.cos(now.rigid[AT.turn]), np.sin(now.rigid[AT.turn])
    for s in range(len(held.site)):
        of = held.site[s]
        if of[SITE.known] > 0.0 or of[SITE.wake] > steps:
            continue
        arm, depth, _ = seen(now, sites, of, s, c, sn)
        if depth > 0.0:
            return s
        of[SITE.wake] = steps + rest(now, modes, sites, s, arm, -depth, dt, pressed)
    return -1


@inlined
def look(
    now: ModalState, modes: Modes, sites: Sites, held: Touched, steps: float, dt: float, pressed: bool
) -> None:
    """Find arm, depth, place and their changes of every site with a law that is near."""
    c, sn = np.cos(now.rigid[AT.turn]), np.sin(now.rigid[AT.turn])
    for s in range(len(held.site)):
        of = held.site[s]
        if of[SITE.known] == 0.0:
            continue
        if of[SITE.wake] > steps:
            of[SITE.awake] = 0.0
            continue
        was, before = of[SITE.depth], of[SITE.place]
        arm, depth, place = seen(now, sites, of, s, c, sn)
        of[SITE.depth], of[SITE.place] = depth, place
        if of[SITE.awake] == 0.0:
            of[SITE.awake], of[SITE.rate], of[SITE.moved] = 1.0, 0.0, 0.0
            held.state[s, IN_GROOVE.place], held.state[s, IN_GROOVE.depth] = place, depth
            continue
        of[SITE.rate], of[SITE.moved] = (depth - was) / dt, place - before
        gap = -depth - held.state[s, IN_GROOVE.top]
        if of[SITE.touches] == 0.0 and of[SITE.known] == OWN and gap > 0.0:
            of[SITE.wake] = steps + rest(now, modes, sites, s, arm, gap, dt, pressed)


@inlined
def meet(held: Touched, turn: float, dt: float) -> tuple[float, float, float]:
    """Find the forces of all sites at their places; return their sums n, t, N, and the viscous work, J.

    ``turn``, rad, is the rod's.
    """
    F_n, F_t, lost = 0.0, 0.0, 0.0
    for s in range(len(held.site)):
        of = held.site[s]
        of[SITE.force_n], of[SITE.force_t] = 0.0, 0.0
        if of[SITE.known] != OWN or of[SITE.awake] == 0.0:
            continue
        depth, place = of[SITE.depth], of[SITE.place]
        rubs = factor_at(abs(of[SITE.moved]) / dt, held.over_speed)
        if held.flow[s, 13] > 0.0:
            law_here = flow_of(held, s, rubs)
            of[SITE.force_n], of[SITE.force_t] = slide(groove_of(held, s), depth, place, law_here)
        else:
            law, dragged = law_of(held, s, rubs), of[SITE.drag]
            F, a, of[SITE.drag] = press(depth, of[SITE.rate], law)
            lost += 0.5 * (of[SITE.drag] + dragged) * of[SITE.rate] * dt
            if F > 0.0:
                of[SITE.force_n] = F
                of[SITE.force_t] = -grip(springs_of(held, s), of[SITE.moved], F, a, law)
        if of[SITE.force_n] == 0.0 and of[SITE.touches] > 0.0:
            held.shift[s, :] = 0.0
            move_apart(groove_of(held, s), depth, place)
    flats = held.flats
    for f in range(len(flats.law)):
        if flats.law[f, LAW.known] > 0.0:
            a, b = held.site[flats.ends[f, 0]], held.site[flats.ends[f, 1]]
            depths, moved = (a[SITE.depth], b[SITE.depth]), (a[SITE.moved], b[SITE.moved])
            rubs = factor_at(0.5 * abs(moved[0] + moved[1]) / dt, held.over_speed)
            N_a, N_b, T_a, T_b = press_flat(flats, f, depths, moved, rubs, dt)
            a[SITE.force_n] += N_a
            b[SITE.force_n] += N_b
            a[SITE.force_t] += T_a
            b[SITE.force_t] += T_b
    for s in range(len(held.site)):
        of = held.site[s]
        of[SITE.touches] = 1.0 if of[SITE.force_n] != 0.0 else 0.0
        of[SITE.force] = max(of[SITE.force], of[SITE.force_n])
        if of[SITE.force_n] != 0.0 and of[SITE.depth] > of[SITE.deepest]:
            of[SITE.deepest], of[SITE.turned] = of[SITE.depth], turn
        F_n += of[SITE.force_n]
        F_t += of[SITE.force_t]
    return F_n, F_t, lost


@inlined
def strikes(
    now: ModalState, modes: Modes, sites: Sites, held: Touched, site: Array, steps: float, dt: float
) -> int:
    """Return a site that touches in free flight, or -1; ``site`` is a copy of `Touched.site` that rests.

    A viscous contact that has parted is no strike as its dent swells behind it.
    """
    c, sn = np.cos(now.rigid[AT.turn]), np.sin(now.rigid[AT.turn])
    for s in range(len(site)):
        of = site[s]
        if of[SITE.wake] > steps:
            continue
        was = of[SITE.depth]
        arm, depth, place = seen(now, sites, of, s, c, sn)
        of[SITE.depth] = depth
        if of[SITE.known] == 0.0:
            if depth > 0.0:
                return s
        elif of[SITE.known] == LAID:
            if depth > 0.0 and flat_strikes(now, sites, held, s, c, sn):
                return s
        elif held.flow[s, 13] > 0.0:
            if meets(groove_of(held, s), depth, place, flow_of(held, s)):
                return s
        elif press(depth, (depth - was) / dt, law_of(held, s))[0] > 0.0:
            return s
        gap = -depth - held.state[s, IN_GROOVE.top]
        if gap > 0.0:
            of[SITE.wake] = steps + rest(now, modes, sites, s, arm, gap, dt, False)
    return -1


@inlined
def flat_strikes(now: ModalState, sites: Sites, held: Touched, s: int, c: float, sn: float) -> bool:
    """Return whether a flat part with an end at a site touches in free flight."""
    flats = held.flats
    for f in range(len(flats.law)):
        a, b = flats.ends[f]
        if flats.law[f, LAW.known] > 0.0 and (s == a or s == b):
            near = locate(now, sites, a, c, sn)[2] + held.site[a, SITE.sunk_n]
            far = locate(now, sites, b, c, sn)[2] + held.site[b, SITE.sunk_n]
            if flat_meets(flats, f, (near, far)):
                return True
    return False


@inlined
def spent(held: Touched, work_t: Array) -> tuple[float, float, float, float]:
    """Return plastic work and friction, J, of all sites, and what their contacts hold along n and t, J.

    ``work_t`` (s,), J, is the work of each site's tangential force.
    """
    plastic, friction, held_n, held_t = 0.0, 0.0, 0.0, 0.0
    for s in range(len(held.site)):
        if held.site[s, SITE.known] != OWN:
            continue
        if held.flow[s, 13] > 0.0:
            n, t = stored_energy(groove_of(held, s), flow_of(held, s))
            plastic += held.works[s, WORK.flow] + held.works[s, WORK.shear]
            friction += held.works[s, WORK.friction]
        else:
            # the normal spring gives back what it stores by itself, the tangential ones out of friction
            n, t = stored(held.site[s, SITE.depth], springs_of(held, s), law_of(held, s))
            friction += -work_t[s] - t
        held_n += n
        held_t += t
    for f in range(len(held.flats.law)):
        if held.flats.law[f, LAW.known] > 0.0:
            n, t = flat_energy(held.flats, f)
            plastic += held.flats.works[f, WORK.flow] + held.flats.works[f, WORK.shear]
            friction += held.flats.works[f, WORK.friction]
            held_n += n
            held_t += t
    return plastic, friction, held_n, held_t


@inlined
def turn_surface(start: Start, now: ModalState, site: Array, clock: Array, dt: float) -> None:
    """Move the surface under each site as a barrier that turns does over a step, s.

    Where nothing touches it moves as where the rod touched last: it is taken as level.
    """
    if start.inverse_barrier_inertia == 0.0:
        return
    spin, most = now.rigid[AT.Omega_b], 0.0
    for s in range(len(site)):
        if abs(site[s, SITE.force_n]) > most:
            most = abs(site[s, SITE.force_n])
            clock[CLOCK.lever_t] = now.rigid[AT.away_t] + site[s, SITE.arm_t]
            clock[CLOCK.lever_n] = now.rigid[AT.away_n] + site[s, SITE.arm_n]
    for s in range(len(site)):
        lever_t, lever_n, of = clock[CLOCK.lever_t], clock[CLOCK.lever_n], site[s]
        if of[SITE.touches] > 0.0:
            lever_t = now.rigid[AT.away_t] + of[SITE.arm_t]
            lever_n = now.rigid[AT.away_n] + of[SITE.arm_n]
        of[SITE.sunk_n] -= dt * spin * lever_t
        of[SITE.sunk_t] += dt * spin * lever_n
