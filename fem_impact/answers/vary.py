"""Values of a sweep: lists and ranges with units, and the scenes that all their combinations make."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import product
from pathlib import Path
from typing import Any

from fem_impact.errors import FemImpactError, SceneError, UsageError
from fem_impact.scene.read import read_tables
from fem_impact.scene.shipped import named, plain_value, replace_all
from fem_impact.scene.types import Scene
from fem_impact.scene.units import DIMENSIONS

MOST = 100_000
"""Largest number of cases of one sweep."""

MOST_DIGITS = 6
"""Most digits of a step that is proposed."""

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*(?<!\.)\.\.(?!\.)\s*({_NUMBER})\s*:\s*({_NUMBER})\s*(\S.*)?")
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(\S.*)?")
_EXAMPLE = "Write --vary impact.angle=15..60:5deg, or --vary projectile.length=0.2,0.4,0.8m."
_TABLE = '--vary \'projectile.material={name = "mine", E = "70 GPa", nu = 0.33, rho = "2700 kg/m3"}\''
OPEN, CLOSE = "[{", "]}"


@dataclass(frozen=True, slots=True)
class Variation:
    """One combination of values: its name, the values by key as stated, and its scene or why it has none."""

    name: str
    values: Mapping[str, Any]
    scene: Scene | None
    refused: str = ""


def read_vary(text: str) -> tuple[str, list[Any]]:
    """Return key and values of one ``key=values``: a list, or a range ``first..last:step``, with its unit.

    A value of a list may be a table or a list in TOML, or ``@FILE``, the table that a TOML file holds.

    Raises
    ------
    UsageError
        The text is of neither form, the range has no step towards its end, or there is no such file.
    SceneError
        The file cannot be read as TOML.

    Examples
    --------
    >>> read_vary("impact.angle=15..30:5deg")
    ('impact.angle', ['15 deg', '20 deg', '25 deg', '30 deg'])
    >>> read_vary("projectile.length=0.2,0.4m")
    ('projectile.length', ['0.2 m', '0.4 m'])
    >>> read_vary('barrier.material=rod-steel,{name = "mine", E = "70 GPa"}')
    ('barrier.material', ['rod-steel', {'name': 'mine', 'E': '70 GPa'}])
    """
    key, equals, listed = text.partition("=")
    if not equals or not key.strip() or not listed.strip():
        raise UsageError("is not of the form key=values.", key="--vary", value=text, remedy=_EXAMPLE)
    match = _RANGE.fullmatch(listed)
    if match is None and re.match(rf"\s*{_NUMBER}[^,]*\.\.", listed):
        problem = "is no range: that is first..last:step, with one unit at its end."
        raise UsageError(problem, key="--vary", value=text, remedy=_EXAMPLE)
    return key.strip(), _steps(match, text) if match else _listed(listed)


def _steps(match: re.Match[str], text: str) -> list[Any]:
    first, last, step = (Decimal(part) for part in match.group(1, 2, 3))
    if step == 0 or (last - first) / step < 0 or (last - first) / step >= MOST:
        problem = "has no step that leads from its first to its last value."
        raise UsageError(problem, key="--vary", value=text, remedy=_EXAMPLE)
    count = int((last - first) / step)
    if first + count * step != last:
        raise _no_step(match, text, count)
    return [_with_unit(f"{first + at * step:f}", match[4]) for at in range(count + 1)]


def _no_step(match: re.Match[str], text: str, count: int) -> UsageError:
    """Return the refusal of a range whose steps do not meet its end, with the nearest ranges that do."""
    first, last, step = (Decimal(part) for part in match.group(1, 2, 3))
    near = [number for number in (count, count + 1) if number]
    pairs = [(first + number * step, step) for number in near]
    pairs += [(last, (last - first) / number) for number in near]
    ranges = [
        f"{match[1]}..{end.normalize():f}:{by.normalize():f}{match[4] or ''}"
        for end, by in pairs
        if len(by.normalize().as_tuple().digits) <= MOST_DIGITS
    ]
    problem = "does not come to its last value in whole steps."
    return UsageError(problem, key="--vary", value=text, remedy=f"Write {' or '.join(ranges)}.")


def _listed(text: str) -> list[Any]:
    """Return the values of a list; a unit after the last one is that of those before without one."""
    parts = [part.strip() for part in _split(text)]
    last = _QUANTITY.fullmatch(parts[-1])
    unit = last[2] if last else None
    return [_value(part, unit) for part in parts]


def _split(text: str) -> Iterator[str]:
    """Yield what stands between the commas outside brackets, braces and quotes."""
    depth, quote, begin = 0, "", 0
    for at, letter in enumerate(text):
        if quote or letter in "\"'":
            quote = "" if letter == quote else quote or letter
        elif letter == "," and depth == 0:
            yield text[begin:at]
            begin = at + 1
        else:
            depth += (letter in OPEN) - (letter in CLOSE)
    yield text[begin:]


def _value(text: str, unit: str | None) -> Any:
    if text.startswith("@"):
        return read_tables(Path(text[1:]))
    if text.startswith(tuple(OPEN)):
        try:
            return tomllib.loads(f"value = {text}")["value"]
        except tomllib.TOMLDecodeError as error:
            remedy = f"Write it as TOML in one pair of quotes, such as {_TABLE}."
            problem = f"is no table or list in TOML ({error})."
            raise UsageError(problem, key="--vary", value=text, remedy=remedy) from None
    match = _QUANTITY.fullmatch(text)
    if match is None:
        return text.strip("\"'")
    return _with_unit(match[1], match[2] or unit)


def _with_unit(number: str, unit: str | None) -> Any:
    return f"{number} {unit.strip()}" if unit else tomllib.loads(f"value = {_plain(number)}")["value"]


def _plain(number: str) -> str:
    """Return a number as TOML writes it: with digits on both sides of its point."""
    whole, point, rest = number.partition(".")
    return f"{whole or '0'}.{rest or '0'}" if point else number


def listed(vary: Mapping[str, Iterable[Any]]) -> dict[str, list[Any]]:
    """Return values by key as lists of plain values, arrays of numpy and columns of pandas too.

    Raises
    ------
    UsageError
        One is a text, or no list at all.
    """
    found = {}
    for key, values in vary.items():
        if isinstance(values, str | Mapping) or not isinstance(values, Iterable):
            remedy = "Give a list, such as ['15 deg', '30 deg']."
            raise UsageError("is one value, not a list of them.", key=key, value=values, remedy=remedy)
        found[key] = plain_value(list(values))
    return found


def cases(scene: Scene, vary: Mapping[str, Iterable[Any]]) -> list[Variation]:
    """Return the scenes of all combinations, the last key changing fastest; a refused one says why.

    Raises
    ------
    SceneError, UsageError
        Nothing varies, there are too many combinations, or each of them is refused.
    """
    by_key = listed(vary)
    _check(by_key)
    every = list(_made(scene, by_key))
    if all(case.scene is None for case in every):
        which = "The only combination" if len(every) == 1 else f"Each of the {len(every)} combinations"
        raise SceneError(f"{which} is refused: {every[0].refused}", key="vary")
    return every


def _check(vary: Mapping[str, Sequence[Any]]) -> None:
    if not vary or not all(vary.values()):
        raise UsageError(
            "names no values.", key="vary", remedy='Give some, as {"impact.angle": ["15 deg", "30 deg"]}.'
        )
    count = 1
    for values in vary.values():
        count *= len(values)
    if count > MOST:
        remedy = f"Give at most {MOST}, or several sweeps."
        raise UsageError(f"makes {count} combinations.", key="vary", remedy=remedy)


def _made(scene: Scene, vary: Mapping[str, Sequence[Any]]) -> Iterator[Variation]:
    for number, values in enumerate(product(*vary.values()), 1):
        by_key = dict(zip(vary, values, strict=True))
        try:
            yield Variation(f"case-{number:05d}", by_key, replace_all(scene, by_key, source=""))
        except FemImpactError as error:
            yield Variation(f"case-{number:05d}", by_key, None, str(error))


def measure(value: Any) -> tuple[float | str, str]:
    """Return number and unit of a stated value, a text and no unit where it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return named(value), ""
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if isinstance(value, str):
        return (float(match[1]), (match[2] or "").strip()) if match else (value, "")
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
