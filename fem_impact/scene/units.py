"""Quantities with units: read ``"240 mm"`` exactly, write it back exactly, refuse what is ambiguous."""

import math
import re
import tomllib
from dataclasses import dataclass
from decimal import Decimal
from functools import cache, lru_cache
from importlib.resources import files
from typing import Any

from fem_impact.errors import SceneError, UsageError, did_you_mean

_NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(\D.*)?", re.DOTALL)
_LONGEST = 64
SPELLINGS = {"³": "3", "^3": "3", "²": "2", "^2": "2", "°": "deg", "µ": "u", "μ": "u"}


def spelt(symbol: str) -> str:
    """Return the symbol of a unit without spaces, its usual spellings as one.

    Examples
    --------
    >>> spelt("N/mm²"), spelt("°/s"), spelt("kg / m^3")
    ('N/mm2', 'deg/s', 'kg/m3')
    """
    bare = "".join(symbol.split())
    for other, letter in SPELLINGS.items():
        bare = bare.replace(other, letter)
    return bare


@dataclass(frozen=True, slots=True)
class Unit:
    """One unit: ``value_SI = number * 10**power * factor + offset``; factor is 1 for every decimal unit."""

    symbol: str
    power: int = 0
    factor: float = 1.0
    offset: float = 0.0

    def to_si(self, number: str) -> float:
        """Convert decimal text to SI, rounding once, so that writing and reading are exact."""
        return float(Decimal(number).scaleb(self.power)) * self.factor + self.offset


@dataclass(frozen=True, slots=True)
class Dimension:
    """A physical dimension: its accepted units (first is SI), the suffix of SI keys, an example.

    Of ``others``, units that are not accepted, it says what one is; of a temperature x, what x of them are.
    """

    name: str
    suffix: str
    written: str
    example: str
    units: tuple[Unit, ...]
    others: tuple[tuple[str, str], ...]

    def hint(self, symbol: str) -> str:
        """Return what a unit that is not accepted is, or which accepted one it may be a slip of."""
        known = {spelt(other): value for other, value in self.others}
        if symbol not in known:
            return did_you_mean(symbol, [unit.symbol for unit in self.units], "")
        number, are = ("x", "are") if self.name == "temperature" else ("1", "is")
        return f"{number} {symbol} {are} {known[symbol]}."

    def unit(self, symbol: str) -> Unit | None:
        """Return the unit of that symbol, with or without its spaces and in its usual spellings, or None."""
        bare = spelt(symbol)
        return next((u for u in self.units if u.symbol.replace(" ", "") == bare), None)

    @property
    def symbols(self) -> str:
        """All accepted symbols as one readable list."""
        return ", ".join(u.symbol for u in self.units)


@cache
def data_tables(name: str) -> dict[str, Any]:
    """Return a TOML file of the folder ``data``."""
    text = files("fem_impact.scene").joinpath("data", *name.split("/")).read_text(encoding="utf-8")
    return tomllib.loads(text)


DIMENSIONS: dict[str, Dimension] = {
    name: Dimension(name, **{**stated, "units": tuple(Unit(*unit) for unit in stated["units"])})
    for name, stated in data_tables("units.toml").items()
}


def parse_quantity(value: Any, dimension: str, key: str, si_key: str = "") -> float:
    """Read a quantity written with its unit.

    Parameters
    ----------
    value : str
        Such as ``"240 mm"`` or ``"-2.1 m/s"``.
    dimension : str
        A name in `DIMENSIONS`.
    key : str
        Name used in messages.
    si_key : str
        Key that takes the bare number in SI, which messages propose; empty where there is none.

    Returns
    -------
    float
        The value in SI units.

    Raises
    ------
    SceneError
        For a bare number, an unknown unit, NaN, infinity or anything that is not a quantity.
    """
    dim = DIMENSIONS[dimension]
    or_si = f", or as {si_key} in SI" if si_key else ""
    remedy = f'Write it with its unit, such as "{dim.example}"{or_si}.'
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        raise SceneError(f"is a {_kind(value)}, not a {dim.name}.", key=key, value=value, remedy=remedy)
    if not isinstance(value, str):
        article = "an" if dim.name[0] in "aeiou" else "a"
        raise SceneError(f"a bare number is not {article} {dim.name}.", key=key, value=value, remedy=remedy)
    match = _QUANTITY.fullmatch(value) if len(value) <= _LONGEST else None
    if match is None:
        endless = value.strip().lower().lstrip("+-").startswith(("nan", "inf"))
        problem = "must be a finite number." if endless else f"cannot be read as {dim.name}."
        raise SceneError(problem, key=key, value=value, remedy=remedy)
    number, symbol = match[1], spelt(match[2] or "")
    if symbol.startswith(","):
        raise SceneError("has a decimal comma; write a decimal point.", key=key, value=value, remedy=remedy)
    if not symbol:
        raise SceneError("has no unit.", key=key, value=value, remedy=remedy)
    unit = dim.unit(symbol)
    if unit is None and symbol.startswith(("+-", "±", "+/-")):
        asked = "State one value; assess and validate take intervals: --uncertain impact.angle=30,50deg."
        raise SceneError("states an interval.", key=key, value=value, remedy=asked)
    if unit is None:
        unknown_unit = (
            f"{symbol[:20]!r} is not a unit of {dim.name} ({dim.symbols}). {dim.hint(symbol)}".rstrip()
        )
        raise SceneError(unknown_unit, key=key, value=value, remedy=remedy)
    if not math.isfinite(float(number)):
        raise SceneError("is too large for a number.", key=key, value=value)
    return unit.to_si(number) + 0.0 if float(number) else unit.offset


def parse_share(value: Any, key: str) -> float:
    """Read a share written in per cent, such as ``"2 %"``, above 0 and at most 100 %.

    Examples
    --------
    >>> parse_share("2 %", "accuracy")
    0.02
    """
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) and len(value) <= _LONGEST else None
    per_cent = match is not None and (match[2] or "").strip() == "%" and 0 < float(match[1]) <= 100
    share = float(Decimal(match[1]).scaleb(-2)) if match and per_cent else 0.0
    if not 0.0 < share <= 1.0:
        raise SceneError(
            "must be a share in per cent, above 0 and at most 100 %.",
            key=key,
            value=value,
            remedy='Write it like "2 %".',
        )
    return share


def parse_number(value: Any, key: str) -> float:
    """Read a bare number: a dimensionless value, or the value of a key that names its SI unit."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SceneError(
            f"is a {_kind(value)}, not a number.", key=key, value=value, remedy="Write a plain number."
        )
    try:
        return float(value)
    except OverflowError:
        raise SceneError("is too large.", key=key, value="an integer of many digits") from None


def parse_change(value: Any, key: str) -> float:
    """Read a dimensionless number, or its text, which may be in per cent.

    Examples
    --------
    >>> parse_change(0.05, "within"), parse_change("0.05", "within"), parse_change("5 %", "within")
    (0.05, 0.05, 0.05)
    """
    if not isinstance(value, str):
        return parse_number(value, key)
    text = value.strip()
    try:
        return float(text.removesuffix("%")) / (100.0 if text.endswith("%") else 1.0)
    except ValueError:
        remedy = 'Write one such as 0.05 or "5 %".'
        raise SceneError("is not a number.", key=key, value=value, remedy=remedy) from None


@lru_cache(maxsize=4096)  # a sweep writes the same materials for every case
def format_quantity(value: float, dimension: str, symbol: str = "") -> str:
    """Write an SI value with a unit, so that `parse_quantity` gives back the very same float.

    Examples
    --------
    >>> format_quantity(0.019, "length"), format_quantity(0.019, "length", "um")
    ('19 mm', '19000 um')
    """
    dim = DIMENSIONS[dimension]
    unit = dim.unit(symbol or dim.written) or dim.units[0]
    if unit.factor == 1.0:
        return f"{_digits(Decimal(repr(value)).scaleb(-unit.power).normalize())} {unit.symbol}"
    texts = (f"{value / unit.factor:.{digits}g}" for digits in range(1, 18))
    exact = next((text for text in texts if unit.to_si(text) == value), "")
    return f"{_digits(Decimal(exact))} {unit.symbol}" if exact else f"{value!r} {dim.units[0].symbol}"


def _digits(number: Decimal) -> str:
    """Write everyday sizes without an exponent."""
    return f"{number:f}" if -7 < number.adjusted() < 9 else f"{number}"


def _kind(value: Any) -> str:
    names = {
        bool: "true/false value",
        str: "text",
        list: "list",
        dict: "table",
        int: "number",
        float: "number",
    }
    return names.get(type(value), type(value).__name__)


_EXAMPLES = {
    "--diameter": "19 mm",
    "--height": "0.82 m",
    "--angle": "45 deg",
    "--tip-radius": "3 mm",
    "--budget": "30 s",
}
"""Example value of an option, for messages; of others that of their dimension."""


def option_quantity(text: str, dimension: str, option: str) -> float:
    """Read an option that carries a unit, such as ``--length "240 mm"``; return its SI value."""
    try:
        return parse_quantity(text, dimension, option)
    except SceneError as error:
        example = _EXAMPLES.get(option, DIMENSIONS[dimension].example)
        remedy = f'Write it with its unit, such as {option} "{example}".'
        raise UsageError(error.problem, key=option, value=text, remedy=remedy) from None
