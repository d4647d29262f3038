"""Coulomb friction between rod and barrier."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, Harm, ModelSpec
from fem_impact.effects.vibration import vibration_share
from fem_impact.estimates import arms, projectile

if TYPE_CHECKING:
    from fem_impact.scene import Scene


def coupling(scene: Scene) -> float:
    """Return by how much f changes 1/m*, f d_c d_d / (k^2 + d_c^2) (Stronge, Impact Mechanics, 3.4)."""
    rod = projectile(scene)
    d_c, d_d = arms(scene)
    return scene.surface.friction * abs(d_c) * d_d / (rod.k2 + d_c**2)


def number(scene: Scene) -> float:
    """Return f: even an upright strike spreads under the tip, and friction holds that back."""
    return scene.surface.friction


def harm(scene: Scene) -> Harm:
    """Return the change of the effective mass as change of e, and its share of the vibration."""
    change = min(coupling(scene), 1.0)
    return Harm(change, change * vibration_share(scene))


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Set the Coulomb coefficient."""
    spec.friction = scene.surface.friction


EFFECT = Effect(
    "friction",
    "Coulomb friction acts at every contact node, with stick, slip and reversal.",
    "The contact is frictionless.",
    "f",
    0.005,
    "Coulomb's law: the impulse ratio is at most f, so mu is off by no more than the threshold",
    number,
    harm,
    fill,
)
