"""The rigid fidelity: impulses of a rigid rod along its sliding path, restitution by Thornton's law."""

import time
from dataclasses import replace
from functools import partial
from math import isinf
from typing import NamedTuple

import rigid
from fem_impact.case.case import Case
from fem_impact.case.effects.heating import halves, why_off
from fem_impact.outcome.groups import Energy, Heat, Markers, RodMotion, RunCost, limitations
from fem_impact.outcome.keys import Num, Unknown, known, unknown
from fem_impact.outcome.record import Outcome
from fem_impact.physics.contact import ContactPair
from fem_impact.physics.contact_law import contact_law
from fem_impact.physics.contact_law import restitution as thornton
from fem_impact.physics.flash import closed_form
from fem_impact.physics.viscous import viscous_restitution
from fem_impact.run.assemble import ImpactEnd, Reduction
from fem_impact.run.common import MASSIVE, after, flow_omitted, plastic_shares
from fem_impact.run.heated import heat, open_melting

STIFF_PLATE = "Bending of the plate, which takes energy and lowers e, is left out."
MEAN_HEAT = (
    "Heat by closed form, from the mean friction power of the estimated contact: in seven scenes its flash "
    "temperature rise was 0.3 to 1.3 times that of finite elements. Where vibration, or the give of a "
    "contact that sticks here, lets the tip slide, friction takes far more than rigid theory knows, and the "
    "temperature is higher."
)
UNKNOWN = "a rigid body in an impact without duration does not know it"
UNASSIGNED = Unknown("what a stated restitution loses is not assigned to a body that does not yield")
CRUSHED = "the edge that touches is crushed, which rigid theory does not follow; finite elements do"
ASSUMPTIONS = (
    "The rod is rigid, the contact one point of its tip, and the impact takes no time.",
    "The impulse ratio follows from the sliding path with Coulomb's f: no ploughing, no elastic shear.",
)


def rigid_outcome(case: Case) -> Outcome:
    """Return the outcome by rigid impulse-momentum theory; what the theory does not give is unknown."""
    rod, pair = case.bodies.body, case.contact
    loss, (d_c, d_d), (_, k2) = normal_loss(case, pair), pair.arms, pair.reduced
    over = case.slots.friction_over_speed
    resolve = partial(rigid.path_over_speed, over=over) if over else rigid.sliding_path
    wall, cpu = time.perf_counter(), time.process_time()
    path = resolve(pair.v_n, pair.v_t, omega=pair.omega, e=loss.e, f=pair.f, d_c=d_c, d_d=d_d, k2=k2)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    V_n, V_t, Omega = (float(velocity) for velocity in path.motion)
    # the velocity, m/s, that a free barrier gains where V_n, V_t is the rod's relative to it
    before, struck = case.scene.relative, case.scene.barrier.mass
    share = 0.0 if struck is None else rod.mass / (rod.mass + struck)
    base = -share * (V_n - before.v_n), -share * (V_t - before.v_t)
    reduction = Reduction.of(
        case,
        ImpactEnd(
            V_n=V_n + base[0],
            V_t=V_t + base[1],
            Omega=Omega,
            mass=rod.mass,
            k2=rod.k2,
            base=base,
            leaving=V_n,
            contacts=None,
            missing=0.0,
            finished=True,
            reason="A rigid impact is over at once.",
        ),
    )
    energy = _energy(case, path, loss, reduction.motion, base)
    thermal = replace(unknown(Heat, why_off(case.bodies)), less_vibration=Unknown(UNKNOWN))
    crushed = _sharp(case)
    if case.slots.heat:
        friction_work = known(energy.friction) * energy.E_0
        closed = closed_form(pair, friction_work, halves(case.bodies))
        thermal = open_melting(heat(case, *closed, Unknown(UNKNOWN)))  # see MEAN_HEAT
        if crushed:
            open_still = dict.fromkeys(("rise", "temperature", "time_above_ignition"), Unknown(CRUSHED))
            thermal = replace(thermal, **open_still)
    plate = [STIFF_PLATE] if case.slots.plate else []
    heated = [MEAN_HEAT] if case.slots.heat and not crushed else []
    return reduction.outcome(
        energy,
        unknown(Markers, UNKNOWN),
        thermal,
        replace(unknown(RunCost, UNKNOWN), wall=wall, cpu=cpu),
        peak_force=Unknown(UNKNOWN),
        choices=Unknown(UNKNOWN),
        unmeshed=UNKNOWN,
        limited=limitations("model", loss.source, *ASSUMPTIONS, crushed, flow_omitted(case), *plate, *heated),
    )


def _sharp(case: Case) -> str:
    """Tell where the edge that touches is sharper than the dent is deep."""
    radius, depth = case.contact.principal_radii[0], case.estimate.depth
    if "rod-plasticity" not in case.active or radius >= depth:
        return ""
    return (
        f"The edge that touches, at most {radius * 1e3:.2g} mm in radius, is sharper than the dent is deep, "
        f"{depth * 1e3:.2g} mm: it is crushed itself, of which the law of restitution knows nothing."
    )


class NormalLoss(NamedTuple):
    """Energetic restitution, and the plastic and the viscous part of the loss along the normal.

    What both parts leave of 1 is ``unassigned``; ``source`` tells where the restitution comes from.
    """

    e: float
    plastic: float
    viscous: float
    source: str

    @property
    def unassigned(self) -> float:
        """The part of the loss of which it is not known what it becomes, 0 or 1."""
        return 0.0 if self.plastic + self.viscous else 1.0


def normal_loss(case: Case, pair: ContactPair) -> NormalLoss:
    """Return the stated restitution, or Thornton's of what flows times that of a viscous contact.

    ``pair`` is how both touch: at first, or in a later strike. The loss of a stated restitution is plastic
    where a body may yield, else viscous where a loss factor acts.
    """
    restitution, loss = case.scene.restitution, case.slots.contact_loss
    if restitution is not None:
        stated = f"Restitution {restitution:g} (energetic) is the scene's own."
        if pair.yielding or restitution == 1.0:
            return NormalLoss(restitution, 1.0, 0.0, stated)
        if loss:
            return NormalLoss(restitution, 0.0, 1.0, f"{stated} No body yields: its loss is damping.")
        return NormalLoss(restitution, 0.0, 0.0, f"{stated} No body yields: its loss is assigned to none.")
    law = contact_law(pair)
    flows = not isinf(law.limit)
    plastic = thornton(law, pair.effective_mass, pair.approach) if flows else 1.0
    e = plastic * viscous_restitution(loss or 0.0)
    viscous = (plastic**2 - e**2) / (1 - e**2) if loss else 0.0
    ways = []
    if flows:
        ways.append(
            "by Thornton's law (1997, doi:10.1115/1.2787319) with the limiting "
            f"pressure {law.limit / 1e6:.0f} MPa, 2.8 times the softer yield stress"
        )
    if loss:
        ways.append(f"by the viscous loss of the contact, loss factor {loss:.3g} (Willert 2020)")
    source = f"Restitution {e:.3f} (energetic) {', and '.join(ways)}."
    if not ways:
        source = "Restitution 1: no body of the scene may yield, and Hertz' contact loses nothing."
    return NormalLoss(e, 1.0 - viscous, viscous, source)


def _energy(
    case: Case, path: rigid.SlidingPath, loss: NormalLoss, m: RodMotion, base: tuple[float, float]
) -> Energy:
    """Return the shares of E_0; the plastic ones are not known where the ``loss`` is assigned to no body."""
    before, body = case.scene.relative, {"mass": m.mass, "k2": m.k_squared}
    start = rigid.kinetic_energy(before.v_n, before.v_t, before.omega, **body)
    V_n, V_t, Omega = after(m)
    end = rigid.kinetic_energy(V_n - case.scene.barrier.v_n, V_t - case.scene.barrier.v_t, Omega, **body)
    pushed = 0.5 * (case.scene.barrier.mass or 0.0) * (base[0] ** 2 + base[1] ** 2)
    mass = case.contact.reduced[0]
    normal, tangential = (mass * sum(w) for w in (path.normal_work, path.tangential_work))
    lost = float(-normal / start)
    works: tuple[Num, Num] = plastic_shares(case, loss.plastic * lost)
    plastic_rod, plastic_barrier = (UNASSIGNED, UNASSIGNED) if loss.unassigned else works
    return replace(
        unknown(Energy, UNKNOWN),
        E_0=float(start),
        rigid=float(end / start),
        friction=float(-tangential / start),
        plastic_rod=plastic_rod,
        plastic_barrier=plastic_barrier,
        damping=loss.viscous * lost if case.slots.contact_loss else Unknown(UNKNOWN),
        barrier=MASSIVE if case.scene.barrier.mass is None else float(pushed / start),
        residual=float((start + normal + tangential - end - pushed) / start),
    )
