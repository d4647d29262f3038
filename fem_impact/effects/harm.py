"""What leaving an effect out changes, about: two strikes, with it and without."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fem_impact.effects.spec import Harm
from fem_impact.effects.strike import Strike, strike
from fem_impact.scene.effect_names import BARRIERS, grounded

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["left_out"]


def left_out(scene: Scene, name: str) -> Harm:
    """Return how a strike changes when an effect is left out; a barrier gives way to the next weaker one."""
    barrier = name in BARRIERS
    others = [other for other in scene.active if other != name and not (barrier and other in BARRIERS)]
    weaker = [BARRIERS[BARRIERS.index(name) - 1]] if barrier else []
    whole, less = (_struck(scene, [*others, *names]) for names in ([name], weaker))
    return Harm(min(abs(less.e - whole.e), 1.0), min(abs(less.E_vib - whole.E_vib), 1.0))


def _struck(scene: Scene, effects: list[str]) -> Strike:
    return strike(replace(scene, effects=tuple(grounded(effects))))
