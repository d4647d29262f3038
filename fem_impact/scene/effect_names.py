"""The effects a scene can name, in the order in which they are written."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from fem_impact.errors import SceneError

__all__ = ["BARRIERS", "NAMES", "check_effects"]

BARRIERS = ("barrier-rigid", "barrier-elastic", "barrier-elastoplastic")
NAMES = ("vibration", "friction", "rod-plasticity", *BARRIERS, "gravity", "large-rotation")
_REMEDY = f"Name the effects that the scene needs, out of: {', '.join(NAMES)}."


def check_effects(effects: object) -> tuple[str, ...]:
    """Return the named effects in their written order.

    Raises
    ------
    SceneError
        For ``"auto"``, an unknown or repeated name, no barrier or two, or no vibration.
    """
    names = _as_names(effects)
    for name in names:
        _check_known(name)
    if len(set(names)) < len(names):
        raise SceneError("names an effect twice.", key="effects", value=list(names))
    _check_barrier([name for name in names if name in BARRIERS])
    if "vibration" not in names:
        raise SceneError(
            'leaves out "vibration": a rod that cannot vibrate (the rigid limit) is not available yet.',
            key="effects",
            value=list(names),
            remedy='Add "vibration".',
        )
    return tuple(name for name in NAMES if name in names)


def _as_names(effects: object) -> tuple[str, ...]:
    if effects == "auto":
        raise SceneError(
            "choosing the effects automatically is not available yet.",
            key="effects",
            value="auto",
            remedy=_REMEDY,
        )
    if isinstance(effects, (str, bytes)) or not isinstance(effects, Iterable):
        raise SceneError("must be a list of names.", key="effects", value=effects, remedy=_REMEDY)
    return tuple(effects)


def _check_known(name: object) -> None:
    if name in NAMES:
        return
    near = get_close_matches(str(name), NAMES, 1)
    hint = f'Did you mean "{near[0]}"?' if near else _REMEDY
    raise SceneError("is not an effect.", key="effects", value=name, remedy=hint)


def _check_barrier(barriers: list[str]) -> None:
    if len(barriers) != 1:
        raise SceneError(
            f"names {len(barriers)} barriers and needs exactly one.",
            key="effects",
            value=barriers,
            remedy=f"Choose one of {', '.join(BARRIERS)}.",
        )
