"""Coulomb friction between rod and barrier."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.effects.slots import Effect, ModelSpec

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return f. It matters in an upright impact too: friction restrains the radial spread of the tip."""
    return scene.surface.friction


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
    fill,
)
