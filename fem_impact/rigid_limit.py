"""The rigid fidelity: one impulse along a sliding path, restitution by Thornton's law."""

from __future__ import annotations

import time
from functools import partial
from math import isinf
from typing import TYPE_CHECKING

import rigid
from fem_impact.contact_law import contact_law, restitution
from fem_impact.estimates import approach, arms, effective_mass, projectile
from fem_impact.heating import closed_form
from fem_impact.outcome import KEYS, Outcome
from fem_impact.outcome_keys import NO_TARGET, Values, coefficient_keys, motion_keys, plastic_keys, provenance

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["rigid_outcome"]

UNKNOWN = "a rigid rod in an impact without duration does not know it"
WITHOUT = ("vibration", "rate-hardening", "radiation", "gravity", "large-rotation", "material-damping")
ASSUMPTIONS = (
    "The rod is rigid, the contact one point of its tip, and the impact takes no time.",
    "The impulse ratio follows from the sliding path with Coulomb's f: no ploughing, no tangential give.",
)


def rigid_outcome(scene: Scene) -> Outcome:
    """Return the outcome by rigid impulse-momentum theory; what it cannot know is null with a reason."""
    rod, impact = projectile(scene), scene.impact
    d_c, d_d = arms(scene)
    e, source = _restitution(scene, approach(scene))
    f = scene.surface.friction if "friction" in scene.active else 0.0
    impulse = partial(
        rigid.sliding_path,
        *(impact.v_n, impact.v_t),
        e=e,
        f=f,
        d_c=d_c,
        d_d=d_d,
        k2=rod.k2,
        omega=impact.omega,
    )
    impulse()  # a first call is slow: the second is timed
    wall, cpu = time.perf_counter(), time.process_time()
    path = impulse()
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    over = "A rigid impact is over at once."
    values = provenance(scene, "rigid", True, over, (source, *ASSUMPTIONS), without=WITHOUT)
    V_n, V_t, Omega = path.motion
    values |= motion_keys(scene, float(V_n), float(V_t), float(Omega), rod.mass, rod.k2)
    coefficients, reasons = coefficient_keys(scene, values)
    values |= coefficients | _energies(scene, path, rod) | {"wall_s": wall, "cpu_s": cpu}
    if "contact-heating" in scene.active:
        values |= closed_form(scene, values["W_friction_over_E_0"] * values["E_0_J"])
    unknown = {key.name: UNKNOWN for key in KEYS if key.nullable and values.get(key.name) is None}
    return Outcome(values, unknown | NO_TARGET | reasons)


def _restitution(scene: Scene, speed: float) -> tuple[float, str]:
    """Return the energetic restitution and the sentence that names its source."""
    if scene.restitution is not None:
        return scene.restitution, f"Restitution {scene.restitution:g} (energetic) is the scene's own."
    law = contact_law(scene)
    if isinf(law.limit):
        return 1.0, "Restitution 1: no body of the scene may yield, and Hertz' contact loses nothing."
    e = restitution(law, effective_mass(scene), speed)
    return e, (
        f"Restitution {e:.3f} (energetic) by Thornton's law (1997, doi:10.1115/1.2787319) with the limiting "
        f"pressure {law.limit / 1e6:.0f} MPa, 2.8 times the softer yield stress."
    )


def _energies(scene: Scene, path: rigid.SlidingPath, rod: rigid.Projectile) -> Values:
    impact = scene.impact
    start = rigid.kinetic_energy(impact.v_n, impact.v_t, impact.omega, mass=rod.mass, k2=rod.k2)
    kept = rigid.kinetic_energy(*path.motion, mass=rod.mass, k2=rod.k2)
    normal, tangential = (rod.mass * sum(w) for w in (path.normal_work, path.tangential_work))
    return {
        "E_0_J": float(start),
        "E_r_over_E_0": float(kept / start),
        "W_friction_over_E_0": float(-tangential / start),
        "residual_over_E_0": float((start + normal + tangential - kept) / start),
        **plastic_keys(scene, float(-normal / start)),
    }
