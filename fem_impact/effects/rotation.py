"""Large rotation: the linear part of the rod is linear in a frame that turns with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, ModelSpec
from fem_impact.estimates import contact_estimate, effective_mass, projectile

if TYPE_CHECKING:
    from fem_impact.scene import Scene


def number(scene: Scene) -> float:
    """Return the angle turned in a contact, Omega tau, with Omega of an elastic frictionless impact."""
    rod = projectile(scene)
    d_c, _ = rod.arms(scene.impact.angle)
    Omega = 2 * effective_mass(scene) * abs(scene.impact.v_n) * float(d_c) / (rod.mass * rod.k2)
    return float((abs(Omega) + abs(scene.impact.omega)) * contact_estimate(scene).duration)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Take the turning frame."""
    spec.turning_frame = True


EFFECT = Effect(
    "large-rotation",
    "The rod's linear part is computed in a frame that turns with it.",
    "Rotations are taken as small: theta^2/2 of false strain.",
    "Omega tau, angle turned in a contact",
    number,
    fill,
)
