"""One impact by modes and a local contact law."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, sin, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.fem.kernels import compiled_before
from fem_impact.modal.march import integrate_impact
from fem_impact.modal.motion import (
    AT,
    MOST_CONTACTS,
    MOST_ROWS,
    NOTHING,
    SUM,
    Bounds,
    ModalEnd,
    Modes,
    Start,
)
from fem_impact.modal.rod import ModalRod, modal_rod
from fem_impact.physics.beam import horizon
from fem_impact.physics.contact import fall
from fem_impact.physics.contact_law import ContactLaw, contact_law
from fem_impact.physics.flow_law import FlowLaw, flow_law
from fem_impact.progress import Progress, compiling, setting_up

STEPS = 1000  # over the estimated contact
COMPILE = 6  # s, about, once
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
    plate : work on a plate that bends, J; ``barrier`` : what the motion of a free barrier holds, J
    V_bn, V_bt, Omega_b : velocity of the barrier, m/s, as seen from where it was before, and its spin, rad/s
    away : (n, t) rod's mass centre from the barrier's at the end, m
    fallen : what gravity added to these and to the vibration, J
    energies : (k,) vibration of each mode, J
    contacts : (m, 4) start, end, s, impulses along n and t, N s
    force : largest normal force, N
    finished, reason : whether the impact is over, and why the march ended
    separated : whether the tip had left the barrier for good, or until another point struck
    record : (m, 16) what moved over time, see `fem_impact.modal.motion`; no rows where none was wanted
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
    stored: float
    plate: float
    barrier: float
    V_bn: float
    V_bt: float
    Omega_b: float
    away: tuple[float, float]
    residual: float
    fallen: float
    contacts: Array
    force: float
    finished: bool
    separated: bool
    reason: str
    record: Array
    step: float
    steps: int
    wall: float
    cpu: float

    @property
    def vibration(self) -> float:
        """Return the energy of all modes, J."""
        return float(self.energies.sum())


def solve(
    case: Case,
    progress: Callable[[Progress], None] | None = None,
    recorded: bool = False,
    step: float = 1.0,
) -> ModalResult:
    """Compute an impact; the modes of a new rod are computed first, and a first run says that it compiles.

    Where it is ``recorded``, the result holds what moved over time. ``step`` is the time step over the usual.
    """
    if progress is not None:
        progress(setting_up(case.max_time, case.scene.id))
        if not compiled_before("march.integrate_impact"):
            progress(compiling(case.max_time, COMPILE))
    rod, law = (
        modal_rod(case.bodies, case.slots.vibrating),
        contact_law(case.contact, case.slots.contact_loss),
    )
    flow = flow_law(case.contact, case.slots.rod_law, case.slots.barrier_law)
    contacts = np.zeros((MOST_CONTACTS, 4))
    start, modes = _start(case, rod), Modes(rod.omega, rod.along_t, rod.along_n)
    E_0 = _kinetic(rod, start.v_n, start.v_t, start.omega)
    widest = reach(law, flow, E_0)
    fastest = max([*rod.omega, contact_rate(law, flow, start, modes, widest)])
    dt = step * min(case.estimate.duration / STEPS, FASTEST / fastest)
    bounds = Bounds(dt, horizon(case.scene.projectile), case.max_time, widest)
    # compiles, or fetches what was compiled before, so that times are times of the impact
    record = np.zeros((MOST_ROWS if recorded else 0, 16))
    integrate_impact(start, law, flow, modes, rod.others, bounds._replace(horizon=0.0), contacts, record[:0])
    wall, cpu = time.perf_counter(), time.process_time()
    end = integrate_impact(start, law, flow, modes, rod.others, bounds, contacts, record)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    return _result(case, rod, end, E_0, contacts, bounds, record, (wall, cpu))


def _result(
    case: Case,
    rod: ModalRod,
    end: ModalEnd,
    E_0: float,
    contacts: Array,
    bounds: Bounds,
    record: Array,
    took: tuple[float, float],
) -> ModalResult:
    """Return the result of a march that ``took`` wall and processor time, s."""
    scene, motion, tally = case.scene, end.motion.rigid[:3], end.tally
    energies = 0.5 * (end.motion.rate**2 + (rod.omega * end.motion.q) ** 2)
    skin, friction = tally[SUM.shear] + tally[SUM.friction], tally[SUM.friction]
    plastic = tally[SUM.flow] + tally[SUM.shear]
    base_n, base_t, base_spin = end.motion.rigid[[AT.V_bn, AT.V_bt, AT.Omega_b]]
    barrier = 0.5 * (scene.barrier.mass or 0.0) * float(base_n**2 + base_t**2)
    barrier += 0.5 * (scene.barrier.inertia or 0.0) * float(base_spin**2)
    given = barrier + tally[SUM.plate]
    spent = (
        _kinetic(rod, *motion)
        + energies.sum()
        + friction
        + plastic
        + tally[SUM.viscous]
        + sum(end.held)
        + given
    )
    fell = fall(case.slots.gravity, scene.impact.angle, end.time, contacts[: end.touches, :2])
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
        skin=skin,
        viscous=tally[SUM.viscous],
        stored=sum(end.held),
        plate=tally[SUM.plate],
        barrier=barrier,
        V_bn=base_n,
        V_bt=base_t,
        Omega_b=base_spin,
        away=(float(end.motion.rigid[AT.away_n]), float(end.motion.rigid[AT.away_t])),
        residual=E_0 + tally[SUM.gravity] - spent,
        fallen=tally[SUM.gravity] + kinetic - _kinetic(rod, *motion),
        contacts=contacts[: end.touches],
        force=tally[SUM.force],
        finished=end.over,
        separated=end.over or (end.struck != NOTHING and not any(end.held)),
        reason=_reason(rod, end, bounds),
        record=record[: end.rows],
        step=bounds.step,
        steps=end.steps,
        wall=took[0],
        cpu=took[1],
    )


def _reason(rod: ModalRod, end: ModalEnd, bounds: Bounds) -> str:
    """Return why the march ended, as a sentence."""
    if end.over:
        return f"The rod does not touch again within the next {bounds.horizon * 1e3:.3g} ms of free flight."
    if end.struck == NOTHING:
        return f"Reached max_time = {bounds.latest * 1e3:g} ms before the last separation."
    when = f"{end.wait * 1e6:.3g} us later" if end.wait else f"at {end.time * 1e6:.4g} us"
    return (
        f"The rod's {rod.names[end.struck]} strikes {when}, and the reduced model follows one point of its "
        "tip: this is the motion before."
    )


def reach(law: ContactLaw, flow: FlowLaw, energy: float) -> float:
    """Return the half length, m, of a contact that has taken up an energy, J, along t."""
    if not flow.yields:
        return float(np.sqrt(law.R) * (2.5 * energy / law.stiffness) ** 0.2)
    depth = np.sqrt(energy / (np.pi * law.limit * law.R))
    return float(np.sqrt(2 * flow.R1 * depth))


def contact_rate(law: ContactLaw, flow: FlowLaw, start: Start, modes: Modes, widest: float) -> float:
    """Return a bound, rad/s, of how fast the struck point swings on a contact of half length ``widest``, m.

    The tip of a thin rod gives way to its many modes as if it were light; on a contact that grows wide under
    the weight of the whole rod it swings faster than any of them.
    """
    inverse_mass = 2 * (1 / start.mass + start.inverse_barrier_mass)
    inverse_mass += start.inverse_barrier_inertia * (start.centre_depth**2 + start.centre_offset**2)
    inverse_mass += (start.centre_t**2 + (start.centre_n - start.radius) ** 2) / (start.mass * start.k2)
    inverse_mass += float(np.sum(modes.along_t**2 + modes.along_n**2))
    if flow.yields:
        stiffness = 2 * widest * max(flow.normal, flow.shear)
    else:
        stiffness = widest * max(1.5 * law.stiffness / sqrt(law.R), law.shear)
    return sqrt(stiffness * inverse_mass)


def _start(case: Case, rod: ModalRod) -> Start:
    g, impact = case.slots.gravity or 0.0, case.scene.relative
    struck = case.scene.barrier
    return Start(
        rod.mass,
        rod.k2,
        rod.centre_t,
        rod.centre_n,
        rod.radius,
        impact.v_t,
        impact.v_n,
        impact.omega,
        -g * sin(impact.angle),
        -g * cos(impact.angle),
        1 / struck.mass if struck.mass else 0.0,
        1 / case.slots.plate if case.slots.plate else 0.0,
        1 / struck.inertia if struck.inertia else 0.0,
        struck.centre_depth or 0.0,
        struck.centre_offset,
    )


def _kinetic(rod: ModalRod, V_n: float, V_t: float, Omega: float) -> float:
    return 0.5 * rod.mass * (V_n**2 + V_t**2 + rod.k2 * Omega**2)
