"""Elastic vibration of the rod: waves and bending.

Without it the rod is rigid except for its nose: the nose, about the first half diameter with the whole
contact in it, still deforms (and yields), and the slices behind it are one rigid body. A body shorter than
wide, or a mesh of the user's own no longer than wide, is all nose: it always vibrates.
"""

from math import inf

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import Effect, ModelSpec


def number(bodies: Bodies) -> float:
    """Return the longest period that the impact can excite over the contact time.

    A body no longer than wide has no part behind its nose that could be rigid.
    """
    rod = bodies.rod
    if rod.is_short or (rod.own_mesh is not None and rod.length <= rod.diameter):
        return inf
    longest = bodies.stretching_period
    if bodies.scene.impact.angle != 0:
        longest = max(longest, bodies.bending_period, bodies.ovalling_period)
    return longest / bodies.estimate.duration


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Let the body behind the nose deform."""
    spec.vibrating = True


EFFECT = Effect(
    "vibration",
    "The rod is elastic: longitudinal and bending waves take energy, which rigid theory leaves out.",
    "The rod is rigid behind its nose, which alone deforms.",
    "longest period that the impact excites in the rod, over the contact time",
    0.1,
    "a half-sine pulse leaves ((2 tau/T1)^2 - 1)^-2 of the energy that a blow gives, 1e-4 at 0.2; "
    "a yielding contact lets go in about half its time",
    number,
    fill,
    fidelities=("modal", "solid"),
)
