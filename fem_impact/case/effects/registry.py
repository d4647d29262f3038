"""All effects, in the order in which a scene names them and in which they fill a model."""

import tomllib
from collections.abc import Sequence
from importlib.resources import files
from typing import Any

from fem_impact.case.effects import (
    barrier,
    damping,
    friction,
    gravity,
    heating,
    loss,
    plasticity,
    plate,
    radiation,
    rate,
    rotation,
    skin,
    vibration,
)
from fem_impact.case.effects.slots import Effect
from fem_impact.errors import SceneError, did_you_mean
from fem_impact.plugins import added, wrong

_COMPUTED = {
    "vibration": (vibration.number, vibration.fill),
    "friction": (friction.number, friction.fill),
    "rod-plasticity": (plasticity.number, plasticity.fill),
    "barrier-rigid": (barrier.compliance_share, barrier.fill_rigid),
    "barrier-elastic": (barrier.compliance_share, barrier.fill_elastic),
    "barrier-elastoplastic": (barrier.yield_ratio, barrier.fill_elastoplastic),
    "rate-hardening": (rate.number, rate.fill),
    "machined-skin": (skin.number, skin.fill),
    "radiation": (radiation.number, radiation.fill),
    "plate-bending": (plate.number, plate.fill),
    "gravity": (gravity.number, gravity.fill),
    "large-rotation": (rotation.number, rotation.fill),
    "material-damping": (damping.number, damping.fill),
    "contact-loss": (loss.number, loss.fill),
    "contact-heating": (heating.number, heating.fill),
}
"""The number that decides each effect, and what it fills; its words and threshold: data/effects.toml."""
_STATED = tomllib.loads(files("fem_impact.case").joinpath("data/effects.toml").read_text(encoding="utf-8"))


def _shipped(name: str) -> Effect:
    stated: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in _STATED[name].items()
    }
    number, fill = _COMPUTED[name]
    return Effect(name, number=number, fill=fill, **stated)


EFFECTS = {name: _shipped(name) for name in _COMPUTED}

ADDED = added("effects", EFFECTS)
"""Effects of other packages, which are in force in the scenes alone that name them."""

for _name, _effect in ADDED.items():
    if not isinstance(_effect, Effect) or _effect.name != _name:
        raise wrong(_name, "effects", "is no Effect of that name.")
    EFFECTS[_name] = _effect

AUTO = "auto"
NAMES = tuple(EFFECTS)
BARRIERS = ("barrier-rigid", "barrier-elastic", "barrier-elastoplastic")  # by strength
_REMEDY = (
    f'Write "auto", ["auto", "NAME", "-NAME"], or the list of all effects wanted, out of: {", ".join(NAMES)}.'
)


def with_prerequisites(names: Sequence[str]) -> list[str]:
    """Drop effects whose prerequisite (`Effect.needs`) is absent."""
    return [name for name in names if not EFFECTS[name].needs or set(names) & set(EFFECTS[name].needs)]


def is_wanted(name: str, stated: Sequence[str]) -> bool:
    """Return whether a scene names an effect, or leaves it to its number."""
    return name in stated or (AUTO in stated and f"-{name}" not in stated)


def check_effects(names: Sequence[str]) -> None:
    """Refuse what a scene states of its effects.

    Raises
    ------
    SceneError
        For an unknown or repeated name, no barrier or two, or an effect without what it needs.
    """
    auto = AUTO in names
    allowed = (*NAMES, *((AUTO, *(f"-{n}" for n in NAMES if n not in BARRIERS)) if auto else ()))
    for name in names:
        if name in allowed:
            continue
        hint = did_you_mean(name, allowed, _REMEDY)
        if not auto and name.removeprefix("-") in NAMES:
            hint = f'Only a list with "auto" leaves effects out: write ["auto", "{name}"].'
        if name.removeprefix("-") in BARRIERS:
            hint = "There is always a barrier: name the one wanted."
        raise SceneError("is not an effect.", key="effects", value=name, remedy=hint)
    plain = [name.removeprefix("-") for name in names]
    if len(set(plain)) < len(plain):
        raise SceneError("names an effect twice.", key="effects", value=list(names))
    barriers = [name for name in names if name in BARRIERS]
    if len(barriers) > 1 or not (barriers or auto):
        raise SceneError(
            f"names {len(barriers)} barriers and needs exactly one.",
            key="effects",
            value=list(names),
            remedy=f"Choose one of {', '.join(BARRIERS)}.",
        )
    # refuse a named effect whose prerequisites are switched off, or not named in a list without auto
    off = [n for n in NAMES if f"-{n}" in names or (barriers and n in BARRIERS and n not in barriers)]
    for name, needs in ((effect.name, effect.needs) for effect in EFFECTS.values() if effect.needs):
        missing = [n for n in needs if (n in off if auto else n not in names)]
        if name in names and len(missing) == len(needs):
            raise SceneError(
                f'names "{name}", which means nothing without {" or ".join(needs)}.',
                key="effects",
                value=list(names),
                remedy=f'Leave out "{name}", or add {" or ".join(needs)}.',
            )
