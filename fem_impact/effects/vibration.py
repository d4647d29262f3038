"""Elastic vibration of the rod: waves and bending.

Off is the limit of a rod that is rigid but for its contact: the nose, about the first half diameter with the
whole contact in it, deforms (and yields) as before, and the slices behind it become one rigid body.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.effects.slots import Effect, ModelSpec, bodies_of
from fem_impact.physics.beam import bending_period, stretching_period
from fem_impact.physics.contact import contact_estimate

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return the longest period that the blow can excite over the contact time."""
    periods = [stretching_period(scene), *([bending_period(scene)] if scene.impact.angle > 0 else [])]
    return max(periods) / contact_estimate(bodies_of(scene)).duration


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Let the body behind the nose deform."""
    spec.vibrating = True


EFFECT = Effect(
    "vibration",
    "The rod is elastic: longitudinal and bending waves take energy that rigid theory cannot see.",
    "The rod is rigid behind its nose, which alone deforms.",
    "T1/tau, longest period of the rod over contact time",
    0.1,
    "a half-sine pulse leaves ((2 tau/T1)^2 - 1)^-2 of the energy that a blow gives, 1e-4 at T1/tau = 0.2; "
    "a yielding contact lets go in about half its time",
    number,
    fill,
)
