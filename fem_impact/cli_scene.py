"""The commands that compute nothing: ``scenes`` and ``check``."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from typing import Any

from fem_impact.cli_changes import changed_scene
from fem_impact.cli_parser import Options
from fem_impact.cli_print import print_json, print_table
from fem_impact.outcome import EffectChoice, keys_of
from fem_impact.scene import BARRIERS, DEFAULTS, Scene, load, shipped, source_of, validity
from fem_impact.wrap import wrapped

__all__ = ["check", "scenes"]


def scenes(options: Options) -> int:
    """List the shipped scenes."""
    rows: list[Any] = [_listed(load(name)) for name in shipped()]
    if options.json:
        print_json({"scenes": rows})
    else:
        print_table(rows, ("id", "speed", "title"))
    return 0


def check(options: Options) -> int:
    """Print a scene's full statement: values, sources, effects and validity."""
    scene = changed_scene(options.scene, options.changes)
    statement = _statement(scene)
    if options.json:
        print_json(statement)
    else:
        sys.stdout.write(_readable(scene, statement))
    return 0


def _listed(scene: Scene) -> dict[str, Any]:
    speed = math.hypot(scene.impact.v_n, scene.impact.v_t)
    return {
        "id": scene.id,
        "title": scene.title,
        "speed": f"{speed:.2f} m/s",
        "measured": scene.measured,
        "digest": scene.digest(),
    }


def _statement(scene: Scene) -> dict[str, Any]:
    from fem_impact.effects import choices, neglected
    from fem_impact.estimates import coarse_tip

    return {
        "scene": scene.to_dict(),
        "digest": scene.digest(),
        "sources": _sources(scene),
        "defaults": [{"key": d.key, "value": d.value, "source": d.source} for d in DEFAULTS],
        "effects": [_flat(choice.told(choice.share)) for choice in choices(scene)],
        "validity": list(validity(scene)),
        "warnings": [*neglected(scene), *coarse_tip(scene)],
    }


def _flat(choice: EffectChoice) -> dict[str, Any]:
    return {key.name: key.of(choice) for key in keys_of(EffectChoice)}


def _sources(scene: Scene) -> dict[str, str]:
    """Return where each material value and the friction come from, by dotted key."""
    bodies = {"projectile": scene.projectile.material, "barrier": scene.barrier.material}
    keys = ("E", "nu", "rho", "yield_stress", "ultimate_stress")
    found = {
        f"{body}.material.{key}": source_of(steel.name, key) for body, steel in bodies.items() for key in keys
    }
    return found | {"surface.friction": scene.surface.source}


def _readable(scene: Scene, statement: dict[str, Any]) -> str:
    from fem_impact.effects import choices

    lines = [scene.to_toml().rstrip(), "", "Sources"]
    lines += _wrapped(f"{key}: {source}" for key, source in statement["sources"].items())
    lines += ["", "Values used where a scene does not state them"]
    lines += _wrapped(f"{d['key']} = {d['value']}: {d['source']}" for d in statement["defaults"])
    lines += ["", "Effects"]
    lines += [line for choice in choices(scene) for line in _effect_lines(choice.told(choice.share))]
    lines += _wrapped(f"warning: {sentence}" for sentence in statement["warnings"])
    lines += ["", "Validity"]
    inside = "inside the measured range of speed, angle, rod, steels and surfaces"
    lines += _wrapped(statement["validity"] or [inside])
    return "\n".join([*lines, "", "The scene is valid; its digest:", statement["digest"]]) + "\n"


def _wrapped(sentences: Iterable[str]) -> list[str]:
    return [line for sentence in sentences for line in wrapped(sentence, "  ")]


def _effect_lines(effect: EffectChoice) -> list[str]:
    number = "not finite" if effect.number is None else f"{effect.number:.2g}"
    verdict = f"{'on ' if effect.on else 'off'} {effect.name}{' (forced)' if effect.forced else ''}"
    decided = f"{effect.measure}: {number}, threshold {effect.threshold:g}"
    told = [decided, _harm(effect), _time(effect)]
    decision = wrapped("; ".join(words for words in told if words), " " * 8, "")
    return [*wrapped(f"{verdict}: {effect.sentence}", "  ", " " * 4), *decision]


def _harm(effect: EffectChoice) -> str:
    """Return what leaving it out changes; nothing for a barrier beside the one in use."""
    if effect.name in BARRIERS and not effect.on:
        return ""
    return (
        f"leaving it out changes e by about {effect.change_of_e:.1g}, "
        f"E_vib by {effect.change_of_vibration:.1g} of E_0"
    )


def _time(effect: EffectChoice) -> str:
    if effect.share is None:
        return ""
    share = "under 1" if effect.share < 0.005 else f"about {100 * effect.share:.0f}"
    return f"it takes {share} % of the run time"
