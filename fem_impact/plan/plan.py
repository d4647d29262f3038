"""Effects as items: each has a file, a number that says whether it matters, and slots that it fills."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.effects.registry import EFFECTS
from fem_impact.effects.slots import ModelSpec

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene

__all__ = ["specify"]


def specify(scene: Scene) -> ModelSpec:
    """Return the model slots filled by the effects of a scene."""
    spec = ModelSpec()
    for name in scene.active:
        EFFECTS[name].fill(scene, spec)
    return spec
