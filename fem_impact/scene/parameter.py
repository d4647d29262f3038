"""What a stated number is: its meaning, dimension, bounds, default and source; how it is read and written."""

import math
from dataclasses import dataclass
from typing import Any

from fem_impact.errors import SceneError
from fem_impact.scene.units import DIMENSIONS, format_quantity, parse_number, parse_quantity


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number that a user states: of a scene, or of a problem of the verification.

    Attributes
    ----------
    key, meaning : its name and what it is
    dimension : a name in `DIMENSIONS`, empty for a pure number
    low, high : bounds in SI units; ``low_open``, ``high_open``: the bound itself is outside
    whole, even : only whole, only even numbers
    default : SI value where none is stated, None where one must be; source : where it comes from
    derived : how a value that may be left out follows from the rest of the scene
    remedy : what to do about a value outside the bounds
    unit : in which the value is written, that of its dimension unless stated
    """

    key: str
    meaning: str
    dimension: str
    low: float
    high: float
    low_open: bool = False
    high_open: bool = False
    whole: bool = False
    even: bool = False
    default: float | None = None
    derived: str = ""
    source: str = ""
    remedy: str = ""
    unit: str = ""

    @property
    def si_unit(self) -> str:
        """The SI unit, ``1`` for a pure number."""
        return DIMENSIONS[self.dimension].units[0].symbol if self.dimension else "1"

    @property
    def si_key(self) -> str:
        """The key that takes a bare SI number, such as ``length_m``; empty for a pure number."""
        return f"{self.key}_{DIMENSIONS[self.dimension].suffix}" if self.dimension else ""

    def write(self, value: float) -> str | int | float:
        """Return the value as a scene file writes it, with its unit."""
        if self.dimension:
            return format_quantity(value, self.dimension, self.unit)
        return int(value) if self.whole else value

    def allows(self, value: float) -> bool:
        """Say whether a value lies within the bounds (NaN and infinity never do)."""
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return above and below

    @property
    def bounds(self) -> str:
        """The allowed range in words and units."""
        low, high = self.write(self.low), self.write(self.high)
        first = f"above {low}" if self.low_open else f"at least {low}"
        return f"{first} and {'below' if self.high_open else 'at most'} {high}"

    def checked(self, value: Any) -> float | int:
        """Return an SI value as int or float.

        Raises
        ------
        SceneError
            If it is no number, not finite, out of bounds, or not whole or even where it must be.
        """
        number = parse_number(value, self.key)
        if not math.isfinite(number):
            raise SceneError("must be a finite number.", key=self.key, value=value)
        if self.whole and number != int(number):
            raise SceneError(f"({self.meaning}) must be a whole number.", key=self.key, value=value)
        if self.even and number % 2:
            raise SceneError(f"({self.meaning}) must be an even number.", key=self.key, value=value)
        if not self.allows(number):
            shown = value if self.whole else _Shown(self._refused(number))
            problem = f"({self.meaning}) must be {self.bounds}."
            raise SceneError(problem, key=self.key, value=shown, remedy=self.remedy)
        return int(number) if self.whole else number + 0.0

    def _refused(self, number: float) -> str:
        """Return a value outside the bounds in three digits, or as many as leave it outside."""
        text, _, unit = str(self.write(number)).partition(" ")
        scale = number / float(text) if number else 1.0
        shorter = (f"{float(text):.{digits}g}" for digits in range(3, 17))
        return f"{next((s for s in shorter if not self.allows(float(s) * scale)), text)} {unit}".rstrip()

    def read(self, value: float | str) -> float:
        """Return a checked value in SI from a number in SI, or from text with or without a unit."""
        try:
            number = float(value)
        except (TypeError, ValueError):
            if not self.dimension:
                raise SceneError("is not a number.", key=self.key, value=value) from None
            number = parse_quantity(value, self.dimension, self.key)
        return float(self.checked(number))


class _Shown:
    """A value shown in a message without quotes, unit and all."""

    def __init__(self, text: object) -> None:
        self.text = text

    def __repr__(self) -> str:
        return str(self.text)
