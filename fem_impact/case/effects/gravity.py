"""Gravity on the rod during the impact."""

from math import hypot

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from rigid import GRAVITY


def number(bodies: Bodies) -> float:
    """Return g (tau + T1) over the impact speed; a second contact comes about T1 after the first."""
    duration = bodies.estimate.duration + bodies.bending_period
    return GRAVITY * duration / hypot(bodies.scene.relative.v_n, bodies.scene.relative.v_t)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the acceleration."""
    spec.gravity = GRAVITY
