"""Elastic vibration of the rod: waves and bending.

Without it the rod is rigid except for its nose: the nose, about the first half diameter with the whole
contact in it, still deforms (and yields), and the slices behind it are one rigid body. A body shorter than
wide, or a mesh of the user's own no longer than wide, is all nose: it always vibrates.
"""

from math import inf

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec


def number(bodies: Bodies) -> float:
    """Return the longest period that the impact can excite over the contact time.

    A body no longer than wide has no part behind its nose that could be rigid.
    """
    rod = bodies.rod
    if rod.is_short or (rod.own_mesh is not None and rod.length <= rod.diameter):
        return inf
    longest = bodies.stretching_period
    pair = bodies.contact
    if pair.angle != 0 or pair.arms[0] != 0 or (bodies.friction and pair.sliding):  # what bends it
        longest = max(longest, bodies.bending_period, bodies.ovalling_period)
    return longest / bodies.estimate.duration


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Let the body behind the nose deform."""
    spec.vibrating = True
