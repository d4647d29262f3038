"""The rigid fidelity: impulses of a rigid rod along its sliding path, restitution by Thornton's law."""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial
from math import isinf
from typing import TYPE_CHECKING

import rigid
from fem_impact.outcome.groups import Contact, Energy, Heat, Markers, RunCost
from fem_impact.outcome.keys import Unknown, known, unknown
from fem_impact.outcome.record import Outcome
from fem_impact.physics.contact import ContactBodies, approach, arms, effective_mass, projectile
from fem_impact.physics.contact_law import contact_law
from fem_impact.physics.contact_law import restitution as thornton
from fem_impact.physics.flash import closed_form
from fem_impact.run.common import heat, motion, plastic_shares, provenance, restitution, validity
from fem_impact.run.doubts import doubts

if TYPE_CHECKING:
    from fem_impact.plan.plan import Plan


UNKNOWN = "a rigid rod in an impact without duration does not know it"
WITHOUT = (
    *("vibration", "rate-hardening", "machined-skin", "radiation", "gravity", "large-rotation"),
    "material-damping",
)
ASSUMPTIONS = (
    "The rod is rigid, the contact one point of its tip, and the impact takes no time.",
    "The impulse ratio follows from the sliding path with Coulomb's f: no ploughing, no tangential give.",
)


def rigid_outcome(plan: Plan) -> Outcome:
    """Return the outcome by rigid impulse-momentum theory; what the theory does not give is unknown."""
    scene, rod = plan.scene, projectile(plan.scene)
    e, source = _normal_restitution(plan.bodies)
    path, wall, cpu = _timed_path(plan.bodies, e)
    V_n, V_t, Omega = (float(velocity) for velocity in path.motion)
    moved, energy = motion(plan, V_n, V_t, Omega, rod.mass, rod.k2), _energy(plan.bodies, path, rod)
    origin, coefficients = provenance(plan, Unknown(UNKNOWN), WITHOUT), restitution(scene, moved)
    warnings = doubts(origin, moved, coefficients, energy)
    return Outcome(
        provenance=origin,
        validity=validity(
            plan,
            True,
            "A rigid impact is over at once.",
            V_n,
            UNKNOWN,
            assumptions=(source, *ASSUMPTIONS),
            warnings=warnings,
        ),
        motion=moved,
        restitution=coefficients,
        energy=energy,
        contact=Contact(
            intervals=Unknown(UNKNOWN), peak_force=Unknown(UNKNOWN), markers=unknown(Markers, UNKNOWN)
        ),
        heat=_heat(plan, known(energy.friction) * energy.E_0),
        cost=replace(unknown(RunCost, UNKNOWN), wall=wall, cpu=cpu),
    )


def _timed_path(bodies: ContactBodies, e: float) -> tuple[rigid.SlidingPath, float, float]:
    """Return the impact of energetic restitution e, and its wall and processor time, s."""
    rod, impact, (d_c, d_d) = projectile(bodies.scene), bodies.scene.impact, arms(bodies.scene)
    moving = partial(rigid.sliding_path, impact.v_n, impact.v_t, omega=impact.omega)
    impulse = partial(moving, e=e, f=bodies.f, d_c=d_c, d_d=d_d, k2=rod.k2)
    impulse()  # a first call is slow: the second is timed
    wall, cpu = time.perf_counter(), time.process_time()
    path = impulse()
    return path, time.perf_counter() - wall, time.process_time() - cpu


def _heat(plan: Plan, friction_work: float) -> Heat:
    if not plan.slots.heat:
        return unknown(Heat, UNKNOWN)
    return heat(plan.bodies, *closed_form(plan.bodies, friction_work), Unknown(UNKNOWN))


def _normal_restitution(bodies: ContactBodies) -> tuple[float, str]:
    """Return the energetic restitution and the sentence that names its source."""
    scene = bodies.scene
    if scene.restitution is not None:
        return scene.restitution, f"Restitution {scene.restitution:g} (energetic) is the scene's own."
    law = contact_law(bodies)
    if isinf(law.limit):
        return 1.0, "Restitution 1: no body of the scene may yield, and Hertz' contact loses nothing."
    e = thornton(law, effective_mass(bodies), approach(scene))
    return e, (
        f"Restitution {e:.3f} (energetic) by Thornton's law (1997, doi:10.1115/1.2787319) with the limiting "
        f"pressure {law.limit / 1e6:.0f} MPa, 2.8 times the softer yield stress."
    )


def _energy(bodies: ContactBodies, path: rigid.SlidingPath, rod: rigid.Projectile) -> Energy:
    impact = bodies.scene.impact
    start = rigid.kinetic_energy(impact.v_n, impact.v_t, impact.omega, mass=rod.mass, k2=rod.k2)
    end = rigid.kinetic_energy(*path.motion, mass=rod.mass, k2=rod.k2)
    normal, tangential = (rod.mass * sum(w) for w in (path.normal_work, path.tangential_work))
    plastic_rod, plastic_barrier = plastic_shares(bodies, float(-normal / start))
    return replace(
        unknown(Energy, UNKNOWN),
        E_0=float(start),
        rigid=float(end / start),
        friction=float(-tangential / start),
        plastic_rod=plastic_rod,
        plastic_barrier=plastic_barrier,
        residual=float((start + normal + tangential - end) / start),
    )
