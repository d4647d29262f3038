"""Large rotation: the linear part of the rod is linear in a frame that turns with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.effects.slots import Effect, Harm, ModelSpec, bodies_of, quick_impact
from fem_impact.physics.beam import bending_period
from fem_impact.physics.contact import contact_estimate, normal_share

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return the estimated angle turned during the impact, rad: tau at the mean spin, T1 at the last one.

    A second contact comes about a bending period after the first.
    """
    before, after = scene.impact.omega, quick_impact(scene).Omega
    turned = 0.5 * abs(before + after) * contact_estimate(bodies_of(scene)).duration
    return turned + abs(after) * bending_period(scene)


def harm(scene: Scene) -> Harm:
    """Return the error of E_vib by the turned direction of forces, a share 2 theta of it, and that of e."""
    changed = min(2 * number(scene), 1.0) * quick_impact(scene).E_vib
    return Harm(min(changed / normal_share(bodies_of(scene)), 1.0), changed)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Let the frame of the linear part turn with the rod."""
    spec.turning_frame = True


EFFECT = Effect(
    "large-rotation",
    "The rod's linear part is computed in a frame that turns with it.",
    "Rotations are taken as small: modes keep the directions that they had at the start.",
    "theta, angle turned until the impact is over, rad",
    0.01,
    "small-strain kinematics: forces on the modes point theta beside their direction, so E_vib is off by "
    "2 theta, a fifth of the 10 % that it may be, for theta is known to a factor of two; arms by theta^2/2",
    number,
    fill,
    harm,
)
