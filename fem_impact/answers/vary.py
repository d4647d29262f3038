"""Values of a sweep with their units, and the scenes that all combinations make."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import Any

from fem_impact.errors import FemImpactError, SceneError, UsageError
from fem_impact.scene.shipped import named, plain_value, replace_all
from fem_impact.scene.types import Scene
from fem_impact.scene.units import DIMENSIONS

MOST = 100_000
"""Largest number of cases of one sweep."""

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
QUANTITY = re.compile(rf"\s*({NUMBER})\s*(\S.*)?")


@dataclass(frozen=True, slots=True)
class Variation:
    """One combination of values: its name, the values by key as stated, and its scene or why it has none."""

    name: str
    values: Mapping[str, Any]
    scene: Scene | None
    refused: str = ""


def listed(vary: Mapping[str, Iterable[Any]]) -> dict[str, list[Any]]:
    """Return values by key as lists of plain values, arrays of numpy and columns of pandas too.

    Raises
    ------
    UsageError
        One is a text, or no list at all.
    """
    by_key = {}
    for key, values in vary.items():
        if isinstance(values, str | Mapping) or not isinstance(values, Iterable):
            remedy = "Give a list, such as ['15 deg', '30 deg']."
            raise UsageError("is one value, not a list of them.", key=key, value=values, remedy=remedy)
        by_key[key] = plain_value(list(values))
    return by_key


def cases(scene: Scene, vary: Mapping[str, Iterable[Any]]) -> list[Variation]:
    """Return the scenes of all combinations, the last key changing fastest; a refused one says why.

    Raises
    ------
    SceneError, UsageError
        Nothing varies, there are too many combinations, or each of them is refused.
    """
    by_key, every = listed(vary), list[Variation]()
    if not by_key or not all(by_key.values()):
        remedy = 'Give some, as {"impact.angle": ["15 deg", "30 deg"]}.'
        raise UsageError("names no values.", key="vary=", remedy=remedy)
    count = prod(map(len, by_key.values()))
    if count > MOST:
        remedy = f"Give at most {MOST}, or several sweeps."
        raise UsageError(f"makes {count} combinations.", key="vary=", remedy=remedy)
    for number, values in enumerate(product(*by_key.values()), 1):
        name, changes = f"case-{number:05d}", dict(zip(by_key, values, strict=True))
        try:
            every.append(Variation(name, changes, replace_all(scene, changes, source="")))
        except FemImpactError as error:
            every.append(Variation(name, changes, None, str(error)))
    if all(case.scene is None for case in every):
        which = "The only combination" if count == 1 else f"Each of the {count} combinations"
        raise SceneError(f"{which} is refused: {every[0].refused}", key="vary=")
    return every


def quantity(text: str) -> tuple[str, str] | None:
    """Return number and unit of a text, that empty where it has none; None of a name such as 42crmo4."""
    match = QUANTITY.fullmatch(text)
    if match is None:
        return None
    unit = (match[2] or "").strip()
    is_known = unit in ("", "%") or any(kind.unit(unit) for kind in DIMENSIONS.values())
    return (match[1], unit) if is_known else None


def measure(value: Any) -> tuple[float | str, str]:
    """Return number and unit of a stated value, a text and no unit where it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return named(value), ""
    if isinstance(value, str):
        found = quantity(value)
        return (float(found[0]), found[1]) if found else (value, "")
    return float(value), ""


def in_unit(value: Any, unit: str) -> float | str:
    """Return a stated value as a number in a unit; texts stay as they are."""
    number, given = measure(value)
    if isinstance(number, str) or given == unit:
        return number
    pairs = ((kind.unit(given), kind.unit(unit)) for kind in DIMENSIONS.values())
    of, to = next(((of, to) for of, to in pairs if of and to), (None, None))
    if of is None or to is None:
        return named(value)
    return (of.to_si(repr(number)) - to.offset) / (to.to_si("1") - to.offset)
