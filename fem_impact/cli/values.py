"""Values of ``--vary`` and ``--uncertain``: lists and ranges with units, tables and files."""

import re
import tomllib
from collections.abc import Iterable, Iterator
from decimal import Decimal
from pathlib import Path
from typing import Any

from fem_impact.answers.vary import MOST, NUMBER, quantity
from fem_impact.cli.scene_options import names_material
from fem_impact.errors import SceneError, UsageError
from fem_impact.scene.library import material
from fem_impact.scene.read import read_tables
from fem_impact.scene.shipped import bare

MOST_DIGITS = 6
"""Most digits of a step that is proposed."""

_RANGE = re.compile(rf"\s*({NUMBER})\s*(?<!\.)\.\.(?!\.)\s*({NUMBER})\s*:\s*({NUMBER})\s*(\S.*)?")
_EXAMPLE = "Write impact.angle=15..60:5deg, or projectile.length=0.2,0.4,0.8m."
_TABLE = '\'projectile.material={name = "mine", E = "70 GPa", nu = 0.33, rho = "2700 kg/m3"}\''
OPEN, CLOSE = "[{", "]}"


def read_values(text: str) -> tuple[str, list[Any]]:
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
    >>> read_values("impact.angle=15..30:5deg")
    ('impact.angle', ['15 deg', '20 deg', '25 deg', '30 deg'])
    >>> read_values("projectile.length=0.2,0.4m")
    ('projectile.length', ['0.2 m', '0.4 m'])
    >>> read_values('barrier.material=rod-steel,{name = "mine", E = "70 GPa"}')
    ('barrier.material', ['rod-steel', {'name': 'mine', 'E': '70 GPa'}])
    """
    key, equals, listed = text.partition("=")
    if not equals or not key.strip() or not listed.strip():
        raise UsageError("is not of the form key=values.", key=f'"{text}"', remedy=_EXAMPLE)
    match = _RANGE.fullmatch(listed)
    if match is None and re.match(rf"\s*{NUMBER}[^,]*(\.\.|:)", listed):
        problem = "is no range: that is first..last:step, with one unit at its end."
        raise UsageError(problem, key=f'"{text}"', remedy=_EXAMPLE)
    key = key.strip()
    if match:
        return key, _steps(match, text)
    parts = [part.strip() for part in _split(listed)]
    _, unit = quantity(parts[-1]) or ("", "")  # which is that of those before without one
    named = names_material(key)  # a number is another name of a shipped one then, such as 4340
    return key, [_name(part, key) if named and quantity(part) else _value(part, unit) for part in parts]


def read_all(texts: Iterable[str], option: str) -> dict[str, list[Any]]:
    """Return the values of a repeated option, by key; a key given twice is refused (UsageError)."""
    values = dict[str, list[Any]]()
    for key, listed in map(read_values, texts):
        if bare(key) in map(bare, values):
            remedy = "Give it once, with all its values."
            raise UsageError("is given twice.", key=option, value=key, remedy=remedy)
        values[key] = listed
    return values


def _steps(match: re.Match[str], text: str) -> list[Any]:
    first, last, step = (Decimal(part) for part in match.group(1, 2, 3))
    if step == 0 or (last - first) / step < 0 or (last - first) / step >= MOST:
        problem = "has no step that leads from its first to its last value."
        raise UsageError(problem, key=f'"{text}"', remedy=_EXAMPLE)
    count = int((last - first) / step)
    if first + count * step == last:
        return [_with_unit(f"{first + at * step:f}", match[4]) for at in range(count + 1)]
    # the nearest ranges whose steps meet their end
    near = [number for number in (count, count + 1) if number]
    pairs = [(first + number * step, step) for number in near]
    pairs += [(last, (last - first) / number) for number in near]
    ranges = [
        f"{match[1]}..{end.normalize():f}:{by.normalize():f}{match[4] or ''}"
        for end, by in pairs
        if len(by.normalize().as_tuple().digits) <= MOST_DIGITS
    ]
    problem = "does not come to its last value in whole steps."
    raise UsageError(problem, key=f'"{text}"', remedy=f"Write {' or '.join(ranges)}.")


def _name(number: str, key: str) -> str:
    """Return the shipped material that has a number as a name."""
    try:
        return material(number).name
    except SceneError as error:
        raise error.under(key) from None


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
            raise UsageError(problem, key=f'"{text}"', remedy=remedy) from None
    found = quantity(text)
    if found is None:
        return text.strip("\"'")
    return _with_unit(found[0], found[1] or unit)


def _with_unit(number: str, unit: str | None) -> Any:
    if unit:
        return f"{number} {unit.strip()}"
    return float(number) if {*number.lower()} & {".", "e"} else int(number)
