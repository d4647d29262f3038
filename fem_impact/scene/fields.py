"""A number of a scene, how it is read and written; all of them as data/numbers.toml states them; checks."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from fem_impact.errors import SceneError
from fem_impact.scene.units import DIMENSIONS, data_tables, format_quantity, parse_number, parse_quantity


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
            shown = value
            if not self.whole:  # in three digits, or as many as leave it outside the bounds
                text, _, unit = str(self.write(number)).partition(" ")
                scale = number / float(text) if number else 1.0
                shorter = (f"{float(text):.{digits}g}" for digits in range(3, 17))
                outside = next((s for s in shorter if not self.allows(float(s) * scale)), text)
                shown = Shown(f"{outside} {unit}".rstrip())
            problem = f"({self.meaning}) must be {self.bounds}."
            raise SceneError(problem, key=self.key, value=shown, remedy=self.remedy)
        return int(number) if self.whole else number + 0.0

    def read(self, value: float | str) -> float:
        """Return a checked value in SI from a number in SI, or from text with or without a unit."""
        try:
            number = float(value)
        except (TypeError, ValueError):
            if not self.dimension:
                raise SceneError("is not a number.", key=self.key, value=value) from None
            number = parse_quantity(value, self.dimension, self.key, self.si_key)
        return float(self.checked(number))


class Shown:
    """A value shown in a message without quotes, unit and all."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text


_STATED = data_tables("numbers.toml")


def _numbers(tables: Mapping[str, Any]) -> tuple[Parameter, ...]:
    return tuple(Parameter(key, **{"dimension": "", **table}) for key, table in tables.items())


PROJECTILE, TUBE, POINT, SHAPE, MATERIAL, SKIN = (
    _numbers(_STATED[section]) for section in ("projectile", "tube", "point", "shape", "material", "skin")
)
SURFACE, SLIDING, TOP, BARRIER, LAYER = (
    _numbers(_STATED[section]) for section in ("surface", "sliding", "top", "barrier", "layer")
)
ACCURACY, SAVE, HEATING, STRIKES = (
    _numbers(_STATED[section]) for section in ("accuracy", "save", "heating", "strikes")
)
ANGLE, V_N, V_T, OMEGA, HEIGHT, SLOPE, SPEED = _numbers(_STATED["impact"])
IMPACT = (ANGLE, V_N, V_T, OMEGA)  # as seen from the barrier
MOTION = (ANGLE, replace(V_N, low=-500.0, high=500.0, remedy=""), V_T, OMEGA)
TIP_SIZE = ACCURACY[0]
LEVELS, MOST_LEVELS = (int(_STATED["accuracy"]["levels"][key]) for key in ("default", "high"))
MESH = ("tip_size", "across", "grid_shift")  # keys of accuracy that a target replaces
PLASTIC_STRAIN, FLOW_STRESS = _numbers(_STATED["flow_point"])
FLOWS = {law: _numbers(tables) for law, tables in _STATED["flow"].items()} | {"table": ()}
RATES = {law: _numbers(tables) for law, tables in _STATED["rate"].items()}
Element = Literal["incompatible", "full", "bbar"]  # linear operator of cells that cannot yield
YieldingElement = Literal["bbar", "full"]  # element of cells that may yield
# finest cells right under the contact alone, or all over the fine zone, or flat enough for a hardened skin
FineZone = Literal["graded", "even", "skin"]
Support = Literal["backed", "infinite"]  # of a plate: bonded to a base, or free underneath and wide
Boundary = Literal["half-space", "fixed"]  # of a meshed barrier's outer faces
Unresolved = Literal["withhold", "report"]  # what becomes of numbers that the mesh does not resolve
TargetOf = Literal["e", "mu", "Omega", "E_vib", "E_lt", "E_ln", "plastic", "friction"]  # a wanted error alone
Fields = Literal["shown", "all"]  # that a run keeps
SkinShape = Literal["even", "exponential"]  # of the gain of flow stress over the depth under the surface
SurfaceState = Literal["machined", "contaminated", "cleaned", "pair", "custom"]  # what friction is known of
FlowLaw = Literal["tensile", "hardness"]  # what the power law of hardening passes through beside yield


@dataclass(frozen=True, slots=True)
class Default:
    """A value used when a scene does not state it, with where it comes from."""

    key: str
    value: Any
    source: str


DEFAULTS: tuple[Default, ...] = (
    *(
        Default(f"{section}.{f.key}", f.derived if f.default is None else f.write(f.default), f.source)
        for section, fields in (
            ("impact", IMPACT),
            ("accuracy", ACCURACY),
            ("save", SAVE),
            ("heating", HEATING),
            ("strikes", STRIKES),
        )
        for f in fields
        if f.default is not None or f.derived
    ),
    Default(
        "accuracy.element",
        "incompatible",
        "chosen for this package: on t5b other elements change e by less than .001",
    ),
)


_ID = re.compile(r"[a-z0-9](?:[a-z0-9-]{0,62}[a-z0-9])?")


def check_numbers(part: object, parameters: tuple[Parameter, ...]) -> None:
    """Check every number of a frozen dataclass against its table and store it as int or float."""
    for parameter in parameters:
        value = getattr(part, parameter.key)
        if value is not None or not parameter.derived:
            object.__setattr__(part, parameter.key, parameter.checked(value))


def check_text(value: Any, key: str, longest: int = 300) -> str:
    """Return printable text of a sensible length."""
    if not isinstance(value, str):
        raise SceneError("must be text.", key=key, value=value, remedy='Write it in quotes, "like this".')
    if not value.isprintable() or len(value) > longest:
        raise SceneError(
            f"must be one line of printable text, at most {longest} characters.", key=key, value=value
        )
    return value


def check_id(value: Any) -> None:
    """Refuse an ``id`` that is not safe as the name of a directory."""
    if not isinstance(value, str) or not _ID.fullmatch(value):
        raise SceneError(
            "is not an identifier: it names the directory of the results.",
            key="id",
            value=value,
            remedy='Use small letters, digits and hyphens, such as "my-rod-45".',
        )


def check_names(value: Any) -> tuple[str, ...]:
    """Return names of effects, a list or "auto", as a tuple; what they name is the case's business."""
    names = (value,) if value == "auto" else value
    if not isinstance(names, (list, tuple)) or not all(isinstance(name, str) for name in names):
        raise SceneError('must be "auto" or a list of names.', key="effects", value=value)
    return tuple(check_text(name, "effects", 60) for name in names)


def check_choice(value: Any, choices: tuple[str, ...], key: str, other: str = "") -> str:
    """Return one of a few words; ``other`` says what else may stand there."""
    if value not in choices:
        quoted = [f'"{choice}"' for choice in choices]
        either = " or ".join([", ".join(quoted[:-1]), quoted[-1], *([other] if other else [])])
        raise SceneError("is not a choice.", key=key, value=value, remedy=f"Use {either}.")
    return str(value)
