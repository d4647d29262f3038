"""Heating of the contact by friction, computed from the motion without acting on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.effects.slots import Effect, Harm, ModelSpec, bodies_of
from fem_impact.physics.flash import expected_rise, halves, thermal

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return the expected flash temperature rise over the rise to ignition, 0 where it is not known."""
    if None in thermal(scene).values():
        return 0.0
    return expected_rise(bodies_of(scene)) / (scene.heating.ignition - scene.heating.ambient)


def harm(scene: Scene) -> Harm:
    """Return no change: heat does not act on the motion."""
    return Harm(0.0, 0.0)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Turn on the record of the contact's heat; refuse a scene without conductivity and heat capacity."""
    halves(scene)
    spec.heat = True


EFFECT = Effect(
    "contact-heating",
    "The heat of friction and the flash temperature of the contact are followed.",
    "The heat of the contact is not followed.",
    "expected flash rise over the rise to ignition",
    0.1,
    "half-space conduction (Jaeger 1942; Tian & Kennedy 1994, doi:10.1115/1.2927035), ten times as safe",
    number,
    fill,
    harm,
    needs=("friction",),
)
