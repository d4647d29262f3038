"""Groups of an outcome that every fidelity fills in the same way: provenance, motion, coefficients, heat."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import rigid
from fem_impact.outcome.groups import (
    ArmCoefficients,
    EffectChoice,
    Heat,
    Provenance,
    Restitution,
    RodMotion,
    Validity,
)
from fem_impact.outcome.keys import Num, Unknown, unknown
from fem_impact.outcome.record import installed_versions, utc_now
from fem_impact.physics.contact import ContactBodies, arms, projectile
from fem_impact.physics.contact_law import softer
from fem_impact.physics.flash import Flash, flash_bound
from fem_impact.plan.plan import Plan
from fem_impact.scene.write import digest
from rigid.experiments import measured_set

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene

__all__ = ["heat", "motion", "plastic_shares", "provenance", "restitution", "validity"]


NO_TARGET = Unknown("the scene gives a mesh, not the error it allows")
NO_TABLE = "the scene repeats no measured set, so no table gives its arms"
UNDETERMINED = Unknown("the contact point does not approach, or no moment acts about the mass centre: 0 / 0")
ROUND_OFF = 1e-9  # a moment impulse over that of the normal impulse at arm d_d: below it there is none


def provenance(
    plan: Plan,
    effect_choices: tuple[EffectChoice, ...] | Unknown,
    without: Iterable[str] = (),
) -> Provenance:
    """Return where a record comes from; ``without`` are effects that the fidelity does not know."""
    scene = plan.scene
    return Provenance(
        fidelity=plan.fidelity,
        scene_id=scene.id,
        scene_title=scene.title,
        scene_digest=digest(scene),
        created_utc=utc_now(),
        versions=installed_versions(),
        effects=tuple(name for name in plan.active if name not in without),
        effect_choices=effect_choices,
    )


def validity(
    plan: Plan,
    finished: bool,
    stopped_because: str,
    meshes: str,
    assumptions: Iterable[str] = (),
    warnings: Iterable[str] = (),
) -> Validity:
    """Return how far to trust a record of one run; ``meshes`` says why it has no limit of two meshes."""
    return Validity(
        finished=finished,
        stopped_because=stopped_because,
        assumptions=tuple(assumptions),
        outside=plan.validity,
        warnings=tuple(warnings),
        accuracy_target=NO_TARGET,
        accuracy_setting=NO_TARGET,
        expected_error=NO_TARGET,
        expected_wall=NO_TARGET,
        achieved_error=NO_TARGET,
        achieved_wall=NO_TARGET,
        mesh_limit=Unknown(meshes),
        mesh_band=Unknown(meshes),
    )


def motion(plan: Plan, V_n: float, V_t: float, Omega: float, mass: float, k2: float) -> RodMotion:
    """Return motion before and after (m/s, rad/s, gravity removed) and the rod's constants (kg, m2)."""
    scene = plan.scene
    return RodMotion(
        friction=plan.bodies.f,
        alpha=scene.impact.angle,
        mass=mass,
        k_squared=k2,
        gamma=projectile(scene).gamma,
        v_n=scene.impact.v_n,
        v_t=scene.impact.v_t,
        V_n=float(V_n),
        V_t=float(V_t),
        Omega=float(Omega),
    )


def restitution(scene: Scene, motion: RodMotion) -> Restitution:
    """Return impulse ratios, and the coefficients with the three sets of arms.

    The centre of the impulse is the point at the height of the geometric contact where the moment
    impulse vanishes: d_c = (k^2 (Omega - omega) + d_d (V_t - v_t)) / (V_n - v_n), so e_m = -1.
    """
    (d_c, d_d), omega, m = arms(scene), scene.impact.omega, motion
    e = float(rigid.restitution(m.v_n, m.V_n, m.Omega, d_c, omega))
    spin = m.k_squared * (m.Omega - omega)
    centre = (spin + d_d * (m.V_t - m.v_t)) / (m.V_n - m.v_n)
    table = measured_set(scene.measured).arms if scene.measured else None
    return Restitution(
        mu=float(rigid.impulse_ratio(m.v_n, m.v_t, m.V_n, m.V_t)),
        mu_c=float(rigid.critical_ratio(m.v_n, m.v_t, e=e, d_c=d_c, d_d=d_d, k2=m.k_squared, omega=omega)),
        paper=_with_arms(float(table.d_c), float(table.d_d), omega, m)
        if table
        else unknown(ArmCoefficients, NO_TABLE),
        edge=_with_arms(d_c, d_d, omega, m),
        impulse=_with_arms(centre, d_d, omega, m),
    )


def _with_arms(d_c: float, d_d: float, omega: float, m: RodMotion) -> ArmCoefficients:
    """Return coefficients and losses with one set of arms, m."""
    velocities = (m.v_n, m.v_t, m.V_n, m.V_t, m.Omega)
    body = {"d_c": d_c, "d_d": d_d, "k2": m.k_squared, "omega": omega}
    lost = rigid.losses(*velocities, **body, mass=m.mass).fractions()
    e: Num = UNDETERMINED
    e_m: Num = UNDETERMINED
    if m.v_n + d_c * omega < 0:
        found = rigid.coefficients(*velocities, **body)
        e, moment = float(found.e), d_c * (m.V_n - m.v_n) - d_d * (m.V_t - m.v_t) + m.k_squared * omega
        if abs(moment) > ROUND_OFF * d_d * (m.V_n - m.v_n):
            e_m = float(found.e_m)
    return ArmCoefficients(d_c=d_c, d_d=d_d, e=e, e_m=e_m, E_ln=float(lost.E_ln), E_lt=float(lost.E_lt))


def plastic_shares(bodies: ContactBodies, share: float) -> tuple[float, float]:
    """Return the plastic work of rod and barrier: the law lets only the softer one yield."""
    in_rod = bodies.rod_yields and softer(bodies) == bodies.scene.projectile.material
    return (share, 0.0) if in_rod else (0.0, share)


def heat(
    bodies: ContactBodies, flash: Flash, power: float, flux: float, patch: float, less_vibration: Num
) -> Heat:
    """Return the heat of the contact: peaks of power, W, flux, W/m2, and patch, m2, of the whole contact."""
    ambient, ignition = bodies.scene.heating.ambient, bodies.scene.heating.ignition
    return Heat(
        patch=patch,
        power=power,
        flux=flux,
        rise=flash.peak,
        temperature=ambient + flash.peak,
        ignition=ignition,
        time_above_ignition=flash.time_above(ignition - ambient),
        bound=ambient + flash_bound(bodies),
        less_vibration=less_vibration,
    )
