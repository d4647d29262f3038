"""Coulomb friction between rod and barrier."""

from __future__ import annotations

from math import inf, tan
from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, ModelSpec

if TYPE_CHECKING:
    from fem_impact.scene import Scene


def number(scene: Scene) -> float:
    """Return f over tan(alpha): above about 2/7 to 1 the contact sticks, below it slides."""
    slope = tan(scene.impact.angle)
    return scene.surface.friction / slope if slope > 0 else inf


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Set the Coulomb coefficient."""
    spec.friction = scene.surface.friction


EFFECT = Effect(
    "friction",
    "Coulomb friction acts at every contact node, with stick, slip and reversal.",
    "The contact is frictionless.",
    "f/tan(alpha)",
    number,
    fill,
)
