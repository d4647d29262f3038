"""One impact by modes and a local contact law."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from math import hypot, inf
from typing import Self

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case, before_other_end
from fem_impact.fem.kernels import compiled_before, kernel
from fem_impact.fem.sliding import speed_table
from fem_impact.modal.dents import Dent, meet
from fem_impact.modal.groove import WORK
from fem_impact.modal.landing import height_of, in_body
from fem_impact.modal.laws import give_law, set_law, start_of
from fem_impact.modal.march import march
from fem_impact.modal.motion import (
    AT,
    CLOCK,
    CUT,
    MOST_CONTACTS,
    MOST_ROWS,
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
from fem_impact.modal.pressed import pressed_sites
from fem_impact.modal.rod import ModalRod, modal_rod
from fem_impact.modal.sites import lowest_place, skin
from fem_impact.modal.touch import spent
from fem_impact.outcome.groups import ContactSite
from fem_impact.physics.contact import fall
from fem_impact.physics.contact_law import ContactLaw, FlowLaw
from fem_impact.progress import Progress, compiling, setting_up
from fem_impact.scene.sliding import SpeedTable

STEPS = 1000  # over the estimated contact
FINER = 8  # times as many where nothing takes energy: a sequence of strikes then keeps it to 1e-9
COMPILE = 6  # s, about, once
LEVEL = 1e-10  # m, above what is lowest, within which a site touches at once
LATER = 20  # of the latest time of finite elements, over which a contact of the reduced model may last
FASTEST = 0.1  # of a step, rad of the highest mode and of the struck point on its contact


@dataclass(frozen=True, slots=True)
class ModalResult:
    """The end of an impact.

    Attributes
    ----------
    V_n, V_t, Omega : after the last separation, the fall beside the impact removed, m/s, rad/s
    E_0, kinetic, friction, plastic, skin, stored, residual : J, of the whole rod; kinetic is the rigid
        motion's, skin friction and plastic work of the sheared surface, stored what the contact still holds
        elastically where the run was cut off
    viscous, waves : what a viscous contact took, and waves in the barrier under what lay flat, J
    plate : work on a plate that bends, J; ``barrier`` : what the motion of a free barrier holds, J
    V_bn, V_bt, Omega_b : velocity of the barrier, m/s, as seen from where it was before, and its spin, rad/s
    away : (n, t) rod's mass centre from the barrier's at the end, m
    fallen : what gravity added to these and to the vibration, J
    gravity : its work until the end, J
    energies : (k,) vibration of each mode, J
    contacts : (m, 4) start, end, s, impulses along n and t, N s
    force : largest normal force, N
    sites : what touched, in the order of its first touch
    laid : whether a straight part landed flat
    finished, reason : whether the impact is over, and why the march ended
    other_end : s, how much later the other end strikes, for which it ended; infinite where it did not
    last, time : motion and modes at the end, gravity in them, and its time, s
    dents, met : that it leaves, and those of the arrival that it met, in whose place they stand
    record : (m, 17) what moved over time, see `fem_impact.modal.motion`; no rows where none was wanted
    step, steps, wall, cpu : s, -, s, s
    """

    rod: ModalRod
    V_n: float
    V_t: float
    Omega: float
    E_0: float
    kinetic: float
    energies: Array
    friction: float
    plastic: float
    skin: float
    viscous: float
    waves: float
    stored: float
    plate: float
    barrier: float
    V_bn: float
    V_bt: float
    Omega_b: float
    away: tuple[float, float]
    residual: float
    fallen: float
    gravity: float
    contacts: Array
    sites: tuple[ContactSite, ...]
    laid: bool
    force: float
    finished: bool
    reason: str
    other_end: float
    last: ModalState
    time: float
    dents: tuple[Dent, ...]
    met: tuple[Dent, ...]
    record: Array
    step: float
    steps: int
    wall: float
    cpu: float

    @property
    def vibration(self) -> float:
        """Return the energy of all modes, J."""
        return float(self.energies.sum())


@dataclass(frozen=True, slots=True)
class Course:
    """An impact that is being followed: what moves, what has touched, and what was booked.

    Attributes
    ----------
    now : motion and modes; held : the contact of each site
    clock, tally : (10,), (5,) see `fem_impact.modal.motion`
    contacts : (MOST_CONTACTS, 4) start, end, s, impulses along n and t, N s, of each interval of contact
    record : (m, 17) what moved over time
    """

    now: ModalState
    held: Touched
    clock: Array
    tally: Array
    contacts: Array
    record: Array

    @classmethod
    def of(cls, sites: int, now: ModalState, rows: int = 0, over: SpeedTable | None = None) -> Self:
        """Return the course of a rod that has not touched, with a record of so many rows.

        ``over`` is the factor of friction over the sliding speed.
        """
        clock = np.zeros(len(CLOCK))
        clock[CLOCK.every] = 1.0
        tally, contacts = np.zeros(len(SUM)), np.zeros((MOST_CONTACTS, 4))
        held = Touched.nothing(sites, speed_table(over))
        return cls(now, held, clock, tally, contacts, np.zeros((rows, len(ROW))))

    def follow(self, start: Start, modes: Modes, sites: Sites, bounds: Bounds) -> int:
        """Go on until a site without a law touches, which is returned, or to an end; see `march`."""
        course = self.now, self.held, self.clock, self.tally, self.contacts, self.record
        return int(march(start, modes, sites, bounds, *course))


def drop_round(
    start: Start,
    law: ContactLaw,
    flow: FlowLaw,
    velocity: tuple[float, float, float],
    bounds: Bounds,
    radius: float,
) -> Course:
    """Return the course of a stiff body that touches with a round place, m, under its mass centre.

    ``velocity`` is its normal, m/s, tangential, m/s, and spin, rad/s, before.
    """
    sites, rigid = Sites.point(0.0, 0.0, radius), np.zeros(len(AT))
    rigid[:3], rigid[AT.height] = velocity, radius
    course = Course.of(1, ModalState(rigid, np.zeros(0), np.zeros(0)))
    v_n, v_t, omega = velocity
    set_law(course.held, 0, law, flow, 0.5 * start.mass * (v_n**2 + v_t**2 + start.k2 * omega**2))
    course.follow(start, Modes(np.zeros(0)), sites, bounds)
    return course


@dataclass(frozen=True, slots=True)
class Arrival:
    """How a rod comes to a strike.

    Attributes
    ----------
    v_n, v_t, omega : m/s, rad/s, as seen from the barrier
    turn : since the scene's attitude, rad
    q, rate : (k,) amplitudes and rates of the modes, sqrt(kg) m and sqrt(kg) m/s
    along : where the mass centre stands on the barrier, m
    dents : that earlier strikes have left
    """

    v_n: float
    v_t: float
    omega: float
    turn: float
    q: Array
    rate: Array
    along: float = 0.0
    dents: tuple[Dent, ...] = ()


def solve(
    case: Case,
    progress: Callable[[Progress], None] | None = None,
    recorded: bool = False,
    step: float = 1.0,
    arrival: Arrival | None = None,
    alone: bool = True,
) -> ModalResult:
    """Compute an impact; the modes of a new rod are computed first, and a first run says that it compiles.

    Where it is ``recorded``, the result holds what moved over time. ``step`` is the time step over the usual.
    The rod comes as its scene says, or as its ``arrival`` does, on a surface with the dents of that. The
    impact is over where nothing would touch in a free flight as long as `Case.one_impact`; ``alone``, of a
    body that is not followed on, also where the other end would strike next.
    """
    if progress is not None:
        progress(setting_up(case.max_time, case.scene.id))
        if not compiled_before("march.march"):
            progress(compiling(case.max_time, COMPILE))
    rod = modal_rod(case.bodies, case.slots.vibrating)
    start, modes = start_of(case, rod), Modes(rod.omega)
    rows, over = MOST_ROWS if recorded else 0, case.slots.friction_over_speed
    course = Course.of(len(rod.sites.along_t), _arriving(case, rod, arrival), rows, over)
    now, rate, touching = course.now, 0.0, _touching(rod, course.now)
    E_0 = _kinetic(rod, *now.rigid[:3]) + float(rod.energies(now.q, now.rate).sum())
    low_t, _ = lowest_place(rod.sites, now.rigid[AT.turn], now.q)
    slowest = float(now.rigid[AT.Omega] * low_t - now.rigid[AT.V_n])  # approach of what is lowest, m/s
    middle, places = 0.5 * case.bodies.body.length, range(len(rod.sites.along_t))
    ends = np.array([in_body(case, *skin(rod.sites, s, 0.0))[1] > middle for s in places])
    sites = rod.sites._replace(apart=ends != ends[touching[0]]) if alone else rod.sites
    along, dents = (arrival.along, arrival.dents) if arrival else (0.0, ())
    met: list[Dent] = []

    def lawful(s: int, begins: bool = False) -> float:
        swing = give_law(case, rod, now, course.held, s, E_0, slowest, begins)
        dent, again = meet(dents, start, sites, now, course.held, s, along)
        met.extend([dent] if dent else [])
        return max(swing, again)

    for s in touching:
        if not course.held.site[s, SITE.known]:
            rate = hypot(rate, lawful(s, arrival is None))
    fastest = max([*rod.omega, rate])  # 0 of a rigid rod before it touches
    loses = (
        case.contact.rod_yields or case.contact.barrier_yields or case.contact.f or case.slots.contact_loss
    )
    step = step if loses or case.scene.impact.most_strikes == 1 else step / FINER
    dt = step * min(case.estimate.duration / STEPS, FASTEST / fastest if fastest else inf)
    latest = case.max_time if case.scene.accuracy.max_time else LATER * case.max_time
    bounds = Bounds(dt, case.one_impact, latest)
    # compiles, or fetches what was compiled before, so that times are times of the impact
    course.follow(start, modes, sites, bounds._replace(horizon=0.0))
    wall, cpu = time.perf_counter(), time.process_time()
    while (touched := course.follow(start, modes, sites, bounds)) >= 0:
        rate = hypot(rate, lawful(touched))
        bounds = bounds._replace(step=min(bounds.step, step * FASTEST / rate))
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    kept = (Dent.of(course.held, s, sites, now, along) for s in places)
    left = tuple(dent for dent in kept if dent)
    return _result(case, rod, course, touched, E_0, bounds, (wall, cpu), (left, tuple(met)))


def _arriving(case: Case, rod: ModalRod, arrival: Arrival | None) -> ModalState:
    """Return the motion at the first touch."""
    rigid, k, impact, struck = np.zeros(len(AT)), len(rod.omega), case.scene.relative, case.scene.barrier
    rigid[:3] = impact.v_n, impact.v_t, impact.omega
    q, rate = np.zeros(k), np.zeros(k)
    if arrival is not None:
        rigid[:3] = arrival.v_n, arrival.v_t, arrival.omega
        rigid[AT.turn], q, rate = arrival.turn, arrival.q.copy(), arrival.rate.copy()
    _, low_n = lowest_place(rod.sites, rigid[AT.turn], q)
    rigid[AT.height] = -low_n
    d_c, d_d = case.contact.arms  # of the middle of what lands flat; a barrier turns in a first impact alone
    rigid[AT.away_n], rigid[AT.away_t] = (struck.centre_depth or 0.0) + d_d, d_c - struck.centre_offset
    return ModalState(rigid, q, rate)


def _touching(rod: ModalRod, now: ModalState) -> list[int]:
    """Return the sites that touch as a strike begins, those that are lowest, the fastest one first.

    The first one gives a part that lands flat its law.
    """
    height, Omega = float(now.rigid[AT.height]), float(now.rigid[AT.Omega])
    low = [s for s in range(len(rod.sites.along_t)) if height + height_of(rod, now, s) < LEVEL]
    return sorted(low, key=lambda s: -Omega * skin(rod.sites, s, float(now.rigid[AT.turn]))[0])


@kernel
def _spent(held: Touched, work_t: Array) -> tuple[float, float, float, float]:
    """Return `spent`, kept on disk: what is inlined would be compiled anew, 2 s, in each process."""
    return spent(held, work_t)


def _result(
    case: Case,
    rod: ModalRod,
    course: Course,
    ended: int,
    E_0: float,
    bounds: Bounds,
    took: tuple[float, float],
    dents: tuple[tuple[Dent, ...], tuple[Dent, ...]],
) -> ModalResult:
    """Return the result of a march that ``ended`` as it returned, and ``took`` wall and processor time, s.

    ``dents`` are those that it left and those that it met.
    """
    over = ended != CUT
    scene, now, tally, clock = case.scene, course.now, course.tally, course.clock
    motion, energies = now.rigid[:3], rod.energies(now.q, now.rate)
    plastic, friction, held_n, held_t = _spent(course.held, course.held.work_t)
    viscous, waves = tally[SUM.viscous], float(course.held.flats.works[:, 3].sum())
    laid = bool((course.held.flats.deepest > 0.0).any())
    if over:  # a dent that is left swells without a push, and what springs held has slipped
        viscous, waves, held_n = viscous + (not laid) * held_n, waves + laid * held_n, 0.0
    base_n, base_t, base_spin = now.rigid[[AT.V_bn, AT.V_bt, AT.Omega_b]]
    barrier = 0.5 * (scene.barrier.mass or 0.0) * float(base_n**2 + base_t**2)
    barrier += 0.5 * (scene.barrier.inertia or 0.0) * float(base_spin**2)
    parts = energies.sum(), friction, plastic, viscous, waves, held_n, held_t, barrier, tally[SUM.plate]
    contacts = course.contacts[: int(clock[CLOCK.touches])]
    fell = fall(case.slots.gravity, scene.impact.vertical, clock[CLOCK.time], contacts[:, :2])
    V_n, V_t = motion[0] + fell[0], motion[1] + fell[1]
    kinetic = _kinetic(rod, V_n, V_t, motion[2])
    return ModalResult(
        rod=rod,
        V_n=V_n,
        V_t=V_t,
        Omega=motion[2],
        E_0=E_0,
        kinetic=kinetic,
        energies=energies,
        friction=friction,
        plastic=plastic,
        skin=friction
        + float(course.held.works[:, WORK.shear].sum() + course.held.flats.works[:, WORK.shear].sum()),
        viscous=viscous,
        waves=waves,
        stored=held_n + held_t,
        plate=tally[SUM.plate],
        barrier=barrier,
        V_bn=base_n,
        V_bt=base_t,
        Omega_b=base_spin,
        away=(float(now.rigid[AT.away_n]), float(now.rigid[AT.away_t])),
        residual=E_0 + tally[SUM.gravity] - _kinetic(rod, *motion) - sum(parts),
        fallen=tally[SUM.gravity] + kinetic - _kinetic(rod, *motion),
        gravity=tally[SUM.gravity],
        contacts=contacts,
        sites=pressed_sites(case, rod, course.held),
        laid=laid,
        force=float(tally[SUM.force]),
        finished=over,
        reason=_reason(ended, bounds, float(clock[CLOCK.free])),
        other_end=float(clock[CLOCK.free]) if ended == NEXT else inf,
        last=now,
        time=float(clock[CLOCK.time]),
        dents=dents[0],
        met=dents[1],
        record=course.record[: int(clock[CLOCK.rows])],
        step=bounds.step,
        steps=int(clock[CLOCK.steps]),
        wall=took[0],
        cpu=took[1],
    )


def _reason(ended: int, bounds: Bounds, free: float) -> str:
    """Return why the march ended, as a sentence; ``free``, s, is the flight before another impact."""
    if ended == NEXT:
        return before_other_end(free)
    if ended == OVER:
        return f"The rod does not touch again within the next {bounds.horizon * 1e3:.3g} ms of free flight."
    return f"Reached max_time = {bounds.latest * 1e3:g} ms before the last separation."


def _kinetic(rod: ModalRod, V_n: float, V_t: float, Omega: float) -> float:
    return 0.5 * rod.mass * (V_n**2 + V_t**2 + rod.k2 * Omega**2)
