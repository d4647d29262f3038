"""All numbers of a scene, which data/numbers.toml states: meaning, dimension, bounds, default and source."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any, Literal

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
