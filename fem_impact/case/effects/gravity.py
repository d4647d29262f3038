"""Gravity on the rod during the impact."""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

from fem_impact.case.effects.slots import Effect, ModelSpec, bodies_of
from fem_impact.physics.beam import bending_period
from fem_impact.physics.contact import contact_estimate
from rigid import GRAVITY

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return g (tau + T1) over the impact speed; a second contact comes about T1 after the first."""
    duration = contact_estimate(bodies_of(scene)).duration + bending_period(scene)
    return GRAVITY * duration / hypot(scene.relative.v_n, scene.relative.v_t)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Set the acceleration."""
    spec.gravity = GRAVITY


EFFECT = Effect(
    "gravity",
    "Gravity pulls the rod down while it touches and flies; its potential is an account of its own.",
    "No gravity during the impact.",
    "g (tau + T1)/v",
    0.005,
    "speed gained by falling while the impact lasts: e moves by about as much, a quarter of 2 %",
    number,
    fill,
)
