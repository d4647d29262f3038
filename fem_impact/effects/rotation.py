"""Large rotation: the linear part of the rod is linear in a frame that turns with it."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, Harm, ModelSpec
from fem_impact.effects.vibration import bending_period
from fem_impact.estimates import (
    arms,
    contact_estimate,
    effective_mass,
    normal_share,
    projectile,
    start_energy,
)

if TYPE_CHECKING:
    from fem_impact.scene import Scene


def _lasting(scene: Scene) -> float:
    """Return tau + T1, s: a second contact comes about a bending period later."""
    return contact_estimate(scene).duration + bending_period(scene)


def angle_turned(scene: Scene) -> float:
    """Return the largest angle turned until the impact is over, rad: Omega without friction or loss."""
    rod = projectile(scene)
    d_c, _ = arms(scene)
    Omega = 2 * effective_mass(scene) * abs(scene.impact.v_n) * d_c / (rod.mass * rod.k2)
    return float((abs(Omega) + abs(scene.impact.omega)) * _lasting(scene))


def number(scene: Scene) -> float:
    """Return the strain energy that the turned rod would seem to have over E_0.

    Small strains of a rotation are cos(theta) - 1, about -theta^2/2, along both axes of its plane, and no
    shear: (lambda + mu) theta^4 / 2 a volume.
    """
    return _false_share(scene, angle_turned(scene))


def _false_share(scene: Scene, theta: float) -> float:
    rod, steel = projectile(scene), scene.projectile.material
    stiffness = steel.E / (2 * (1 + steel.nu) * (1 - 2 * steel.nu))
    return float(stiffness * theta**4 / 2 * rod.mass / rod.density / start_energy(scene))


def expected_angle(scene: Scene) -> float:
    """Return about the angle turned until the impact is over, rad, at the mean spin of the rigid impact."""
    import rigid
    from fem_impact.contact_law import contact_law, restitution

    rod, (d_c, d_d), impact = projectile(scene), arms(scene), scene.impact
    e = restitution(contact_law(scene), effective_mass(scene), abs(impact.v_n + d_c * impact.omega))
    f = scene.surface.friction if "friction" in scene.active else 0.0
    strike = partial(rigid.sliding_path, impact.v_n, impact.v_t, omega=impact.omega, d_c=d_c, d_d=d_d)
    _, _, Omega = strike(e=e, f=f, k2=rod.k2).motion
    return 0.5 * float(impact.omega + Omega) * _lasting(scene)


def harm(scene: Scene) -> Harm:
    """Return the false energy at the end of the impact as vibration, and as restitution lost."""
    false = min(_false_share(scene, expected_angle(scene)), 1.0)
    return Harm(min(false / normal_share(scene), 1.0), false)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Take the turning frame."""
    spec.turning_frame = True


EFFECT = Effect(
    "large-rotation",
    "The rod's linear part is computed in a frame that turns with it.",
    "Rotations are taken as small: theta^2/2 of false strain.",
    "(lambda + mu) theta^4/2 per E_0, false strain energy at theta = Omega (tau + T1)",
    1e-5,
    "small-strain kinematics of a turned body; a tenth of the 1e-4 of E_0 that E_vib may be off",
    number,
    harm,
    fill,
)
