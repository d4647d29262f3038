"""How far the reduced model is from the finite elements: numbers from the costs that were measured."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["beside_solid"]

COMPARED = ("e", "mu", "Omega", "E_vib")
UNITS = {"Omega": " rad/s", "E_vib": " of E_0"}
Pair = tuple[float, float]


def beside_solid(scene: Scene) -> tuple[str, ...]:
    """Return where the reduced model may not be used, as numbers; and those of the measured set itself."""
    held = _pairs()
    general = [_largest(name, held) for name in COMPARED]
    sentences = [
        f"Beside the finite elements on their finest stored mesh, over {len(held)} measured sets, it is off "
        f"by up to {', '.join(general)}: do not use it where that matters.",
    ]
    if scene.measured in held:
        own = ", ".join(
            f"{name} {a:.3g} beside {b:.3g}{UNITS.get(name, '')}"
            for name, (a, b) in held[scene.measured].items()
        )
        sentences.append(f"On {scene.measured}: {own}.")
    return tuple(sentences)


def _largest(name: str, held: dict[str, dict[str, Pair]]) -> str:
    where = max(held, key=lambda key: abs(held[key][name][0] - held[key][name][1]))
    a, b = held[where][name]
    return f"{abs(a - b):.2g}{UNITS.get(name, '')} in {name} ({where})"


@cache
def _pairs() -> dict[str, dict[str, Pair]]:
    """Return (modal, finest solid) of each quantity by set."""
    # the file is read, not its package imported: the costs stand above this model
    text = files("fem_impact").joinpath("cost", "data", "summary.json").read_text(encoding="utf-8")
    return {name: _pair(cost["settings"]) for name, cost in json.loads(text)["scenes"].items()}


def _pair(settings: list[dict[str, Any]]) -> dict[str, Pair]:
    modal = next(one for one in settings if one["kind"] == "modal")
    solid = min((one for one in settings if one["kind"] == "mesh"), key=lambda one: one["tip_size_m"])
    return {name: (modal["value"][name], solid["value"][name]) for name in COMPARED}
