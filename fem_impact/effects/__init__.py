"""Effects as items: each has a file, a number that says whether it matters, and slots that it fills."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.effects import barrier, friction, gravity, plasticity, rotation, vibration
from fem_impact.effects.spec import Effect, ModelSpec

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["EFFECTS", "Effect", "ModelSpec", "describe", "specify"]

EFFECTS: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        vibration.EFFECT,
        friction.EFFECT,
        plasticity.EFFECT,
        barrier.RIGID,
        barrier.ELASTIC,
        barrier.ELASTOPLASTIC,
        gravity.EFFECT,
        rotation.EFFECT,
    )
}


def specify(scene: Scene) -> ModelSpec:
    """Return the model slots filled by the effects that the scene names."""
    spec = ModelSpec()
    for name in scene.effects:
        EFFECTS[name].fill(scene, spec)
    return spec


def describe(scene: Scene) -> list[tuple[str, bool, str, float, str]]:
    """Return (name, on, measure, number, sentence) of every effect for a scene."""
    rows = []
    for name, effect in EFFECTS.items():
        on = name in scene.effects
        rows.append(
            (name, on, effect.measure, effect.number(scene), effect.sentence if on else effect.absence)
        )
    return rows
