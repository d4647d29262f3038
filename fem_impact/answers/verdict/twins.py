"""A scene beside its twin: the same contact under a rod that cannot vibrate, at any inclination."""

from dataclasses import replace
from math import cos, hypot, sin

from fem_impact.case.case import Case
from fem_impact.case.effects.registry import NAMES, with_prerequisites
from fem_impact.scene.types import Scene

VIBRATION = "vibration"
UNFELT = "contact-heating"
"""It watches the motion, which does not feel it: the twin has no need of it."""


def twins(scene: Scene) -> tuple[Scene, Scene]:
    """Return the scene with a rod that vibrates, and the same scene with one that cannot.

    Both have the effects that the scene calls for; vibration is in the first one even where the scene would
    leave it out as small, because its size is the question. No field is kept of either, and the heat of the
    contact is followed in the first one alone.

    Raises
    ------
    SceneError
        A spin lifts the contact point off the barrier.
    """
    on = {*Case(scene).active, VIBRATION}
    free = tuple(name for name in NAMES if name in on)
    stiff = tuple(with_prerequisites([name for name in free if name not in (VIBRATION, UNFELT)]))
    plain = replace(scene, measured=None, save=replace(scene.save, frames=0))
    return replace(plain, effects=free), replace(plain, effects=stiff)


def inclined(scene: Scene, angle: float) -> Scene:
    """Return the scene at another inclination, rad: rod, velocity and fall are turned together.

    The spin stays, and so does how the rod stands to the vertical where the barrier's slope is stated.

    Raises
    ------
    SceneError
        The turned velocity points away from the barrier.
    """
    impact = scene.impact
    speed, way = hypot(impact.v_n, impact.v_t), angle + impact.beside
    slope = None if impact.slope is None else impact.slope + angle - impact.angle
    v_n, v_t = -speed * cos(way), -speed * sin(way)
    turned = replace(impact, angle=angle, v_n=v_n, v_t=v_t, height=None, speed=None, slope=slope)
    return replace(scene, impact=turned, measured=None)
