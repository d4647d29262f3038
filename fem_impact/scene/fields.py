"""All numbers of a scene, from data/numbers.toml: meaning, dimension, bounds, default, source; and checks."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any, Literal

from fem_impact.errors import SceneError
from fem_impact.scene.parameter import Parameter

_STATED = tomllib.loads(files("fem_impact.scene").joinpath("data/numbers.toml").read_text(encoding="utf-8"))


def _numbers(tables: Mapping[str, Any]) -> tuple[Parameter, ...]:
    return tuple(Parameter(key, **{"dimension": "", **table}) for key, table in tables.items())


PROJECTILE, TUBE, POINT, SHAPE, MATERIAL, SKIN = (
    _numbers(_STATED[section]) for section in ("projectile", "tube", "point", "shape", "material", "skin")
)
SURFACE, SLIDING, TOP, BARRIER, LAYER, ACCURACY, SAVE, HEATING, STRIKES = (
    _numbers(_STATED[section])
    for section in (
        *("surface", "sliding", "top", "barrier", "layer", "accuracy", "save", "heating", "strikes"),
    )
)
ANGLE, V_N, V_T, OMEGA, HEIGHT, SLOPE, SPEED = _numbers(_STATED["impact"])
IMPACT = (ANGLE, V_N, V_T, OMEGA)  # as seen from the barrier
MOTION = (ANGLE, replace(V_N, low=-500.0, high=500.0, remedy=""), V_T, OMEGA)
TIP_SIZE = ACCURACY[0]
LEVELS = int(_STATED["accuracy"]["levels"]["default"])
MESH = ("tip_size", "across", "grid_shift")  # keys of accuracy that a target replaces
PLASTIC_STRAIN, FLOW_STRESS = _numbers(_STATED["flow_point"])
FLOWS = {law: _numbers(tables) for law, tables in _STATED["flow"].items()} | {"table": ()}
RATES = {law: _numbers(tables) for law, tables in _STATED["rate"].items()}
Element = Literal["incompatible", "full", "bbar"]  # linear operator of cells that cannot yield
YieldingElement = Literal["bbar", "full"]  # element of cells that may yield
FineZone = Literal["graded", "even"]  # finest cells right under the contact alone, or all over the fine zone
Support = Literal["backed", "infinite"]  # of a plate: bonded to a base, or free underneath and wide
Boundary = Literal["half-space", "fixed"]  # of a meshed barrier's outer faces
Unresolved = Literal["withhold", "report"]  # what becomes of numbers that the mesh does not resolve
TargetOf = Literal["e", "mu", "Omega", "E_vib", "E_lt", "E_ln", "plastic", "friction"]  # a wanted error alone
Fields = Literal["shown", "all"]  # that a run keeps
SkinShape = Literal["even", "exponential"]  # of the gain of flow stress over the depth under the surface
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


def check_id(value: Any, key: str) -> str:
    """Return an identifier that is safe as the name of a directory."""
    if not isinstance(value, str) or not _ID.fullmatch(value):
        raise SceneError(
            "is not an identifier: it names the directory of the results.",
            key=key,
            value=value,
            remedy='Use small letters, digits and hyphens, such as "my-rod-45".',
        )
    return value


def check_names(value: Any, key: str) -> tuple[str, ...]:
    """Return a list of names, or the one word "auto", as a tuple; what they name is the plan's business."""
    names = (value,) if value == "auto" else value
    listed = isinstance(names, (list, tuple)) and all(isinstance(name, str) for name in names)
    if not listed:
        raise SceneError('must be "auto" or a list of names.', key=key, value=value)
    return tuple(check_text(name, key, 60) for name in names)


def check_choice(value: Any, choices: tuple[str, ...], key: str, other: str = "") -> str:
    """Return one of a few words; ``other`` says what else may stand there."""
    if value not in choices:
        quoted = [f'"{choice}"' for choice in choices]
        either = " or ".join([", ".join(quoted[:-1]), quoted[-1], *([other] if other else [])])
        raise SceneError("is not a choice.", key=key, value=value, remedy=f"Use {either}.")
    return str(value)
