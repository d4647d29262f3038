"""Large rotation: the linear part of the rod is linear in a frame that turns with it."""

from __future__ import annotations

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


def angle_turned(scene: Scene) -> float:
    """Return the angle turned until the impact is over, Omega (tau + T1), rad.

    Omega is that of an elastic frictionless impact; a second contact comes about a bending period later.
    """
    rod = projectile(scene)
    d_c, _ = arms(scene)
    Omega = 2 * effective_mass(scene) * abs(scene.impact.v_n) * d_c / (rod.mass * rod.k2)
    lasting = contact_estimate(scene).duration + bending_period(scene)
    return float((abs(Omega) + abs(scene.impact.omega)) * lasting)


def number(scene: Scene) -> float:
    """Return the strain energy that a turned rod seems to have over E_0.

    Small strains of a rotation are cos(theta) - 1, about -theta^2/2, along both axes of its plane, and no
    shear: (lambda + mu) theta^4 / 2 a volume.
    """
    rod, steel = projectile(scene), scene.projectile.material
    stiffness = steel.E / (2 * (1 + steel.nu) * (1 - 2 * steel.nu))
    false = stiffness * angle_turned(scene) ** 4 / 2 * rod.mass / rod.density
    return float(false / start_energy(scene))


def harm(scene: Scene) -> Harm:
    """Return the false energy as vibration, and as restitution lost."""
    false = min(number(scene), 1.0)
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
