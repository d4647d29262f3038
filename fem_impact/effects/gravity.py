"""Gravity on the rod during the impact."""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, ModelSpec
from fem_impact.estimates import contact_estimate

if TYPE_CHECKING:
    from fem_impact.scene import Scene

STANDARD_GRAVITY = 9.80665  # m/s2, CODATA


def number(scene: Scene) -> float:
    """Return g tau over the impact speed."""
    return STANDARD_GRAVITY * contact_estimate(scene).duration / hypot(scene.impact.v_n, scene.impact.v_t)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Set the acceleration."""
    spec.gravity = STANDARD_GRAVITY


EFFECT = Effect(
    "gravity",
    "Gravity pulls the rod down while it touches and flies; its potential is an account of its own.",
    "No gravity during the impact.",
    "g tau/v",
    number,
    fill,
)
