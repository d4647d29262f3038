"""All effects, in the order in which a scene names them and in which they fill a model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches

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
from fem_impact.effects.slots import Effect
from fem_impact.errors import SceneError

__all__ = ["AUTO", "BARRIERS", "EFFECTS", "NAMES", "NEEDS", "check_effects", "grounded"]


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

AUTO = "auto"
BARRIERS = ("barrier-rigid", "barrier-elastic", "barrier-elastoplastic")
NAMES = (
    *("vibration", "friction", "rod-plasticity", *BARRIERS, "rate-hardening", "radiation"),
    *("gravity", "large-rotation", "material-damping", "contact-heating"),
)
# an effect that means nothing unless one of these is on
NEEDS = {
    "rate-hardening": ("rod-plasticity", "barrier-elastoplastic"),
    "radiation": ("barrier-elastic", "barrier-elastoplastic"),
    "material-damping": ("vibration",),
    "contact-heating": ("friction",),
}
_REMEDY = (
    f'Write "auto", ["auto", "NAME", "-NAME"], or the list of all effects wanted, out of: {", ".join(NAMES)}.'
)


def grounded(names: Sequence[str]) -> list[str]:
    """Drop the effects that mean nothing without one that is not among them."""
    return [name for name in names if name not in NEEDS or set(names) & set(NEEDS[name])]


def check_effects(effects: object) -> tuple[str, ...]:
    """Return the stated effects in their written order: forced ones behind ``"auto"``, off ones last.

    Raises
    ------
    SceneError
        For an unknown or repeated name, no barrier or two, or an effect without what it needs.
    """
    names = _as_names(effects)
    for name in names:
        _check_known(name, AUTO in names)
    plain = [name.removeprefix("-") for name in names]
    if len(set(plain)) < len(plain):
        raise SceneError("names an effect twice.", key="effects", value=list(names))
    _check_barrier(names, AUTO in names)
    _check_needs(names)
    order = (AUTO, *NAMES, *(f"-{name}" for name in NAMES))
    return tuple(name for name in order if name in names)


def _as_names(effects: object) -> tuple[str, ...]:
    if effects == AUTO:
        return (AUTO,)
    if isinstance(effects, (str, bytes)) or not isinstance(effects, Iterable):
        raise SceneError('must be "auto" or a list of names.', key="effects", value=effects, remedy=_REMEDY)
    return tuple(effects)


def _check_known(name: object, auto: bool) -> None:
    known = (*NAMES, *((AUTO, *(f"-{n}" for n in NAMES if n not in BARRIERS)) if auto else ()))
    if name in known:
        return
    near = get_close_matches(str(name), known, 1)
    hint = f'Did you mean "{near[0]}"?' if near else _REMEDY
    if not auto and str(name).removeprefix("-") in NAMES:
        hint = f'Only a list with "auto" leaves effects out: write ["auto", "{name}"].'
    if str(name).removeprefix("-") in BARRIERS:
        hint = "There is always a barrier: name the one wanted."
    raise SceneError("is not an effect.", key="effects", value=name, remedy=hint)


def _check_barrier(names: Sequence[str], auto: bool) -> None:
    barriers = [name for name in names if name in BARRIERS]
    if len(barriers) > 1 or not (barriers or auto):
        raise SceneError(
            f"names {len(barriers)} barriers and needs exactly one.",
            key="effects",
            value=list(names),
            remedy=f"Choose one of {', '.join(BARRIERS)}.",
        )


def _check_needs(names: tuple[str, ...]) -> None:
    """Refuse a forced effect whose ground is named off, or not named in a list without auto."""
    barrier = next((name for name in names if name in BARRIERS), None)
    for name, needs in NEEDS.items():
        gone = [n for n in needs if f"-{n}" in names or (n in BARRIERS and barrier not in (None, n))]
        missing = gone if AUTO in names else [n for n in needs if n not in names]
        if name in names and len(missing) == len(needs):
            raise SceneError(
                f'names "{name}", which means nothing without {" or ".join(needs)}.',
                key="effects",
                value=list(names),
                remedy=f'Leave out "{name}", or add {" or ".join(needs)}.',
            )
