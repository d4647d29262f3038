"""Gravity on the rod during the impact."""

from math import hypot, sqrt

from fem_impact.case.bodies import WEAKEST, Bodies
from fem_impact.case.effects.slots import ModelSpec
from rigid import GRAVITY


def number(bodies: Bodies) -> float:
    """Return g (tau + T1) over the impact speed; a second contact comes about T1 after the first.

    Of a body that is followed it is the speed of its weakest strikes.
    """
    duration, speed = bodies.estimate.duration + bodies.bending_period, bodies.scene.relative
    slowest = 1.0 if bodies.scene.impact.most_strikes == 1 else sqrt(WEAKEST)
    return GRAVITY * duration / (slowest * hypot(speed.v_n, speed.v_t))


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the acceleration."""
    spec.gravity = GRAVITY
