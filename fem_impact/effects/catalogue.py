"""All effects, in the order in which a scene names them and in which they fill a model."""

from __future__ import annotations

from fem_impact.effects import (
    barrier,
    damping,
    friction,
    gravity,
    heating,
    plasticity,
    radiation,
    rate,
    rotation,
    vibration,
)
from fem_impact.effects.spec import Effect

__all__ = ["EFFECTS"]

EFFECTS: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        vibration.EFFECT,
        friction.EFFECT,
        plasticity.EFFECT,
        barrier.RIGID,
        barrier.ELASTIC,
        barrier.ELASTOPLASTIC,
        rate.EFFECT,
        radiation.EFFECT,
        gravity.EFFECT,
        rotation.EFFECT,
        damping.EFFECT,
        heating.EFFECT,
    )
}
