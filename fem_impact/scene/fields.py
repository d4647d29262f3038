"""Every number of a scene in one table: its meaning, dimension, bounds, default and source."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

from fem_impact.scene.units import DIMENSIONS, format_quantity

__all__ = [
    "ACCURACY",
    "DEFAULTS",
    "HEATING",
    "IMPACT",
    "MATERIAL",
    "PROJECTILE",
    "SAVE",
    "SURFACE",
    "TOP",
    "Default",
    "Field",
]


@dataclass(frozen=True, slots=True)
class Field:
    """One number of a scene; bounds and default in SI units, ``dimension`` empty for a pure number."""

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
    source: str = ""
    remedy: str = ""
    unit: str = ""

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


PROJECTILE = (
    Field("length", "length of the rod, tip to tail", "length", 1e-3, 10.0),
    Field("diameter", "diameter of the rod", "length", 1e-4, 1.0),
    Field("tip_radius", "radius of the nose (tip A) or of the edge (tip B)", "length", 0.0, 0.5),
)
MATERIAL = (
    Field("E", "Young's modulus", "stress", 1e6, 1e13, unit="GPa"),
    Field("nu", "Poisson's ratio", "", 0.0, 0.5, high_open=True),
    Field("rho", "density", "density", 10.0, 3e4),
    Field("yield_stress", "yield stress in tension", "stress", 1e3, 1e11),
    Field("ultimate_stress", "ultimate stress (engineering)", "stress", 1e3, 1e11),
)
SURFACE = (
    Field("friction", "Coulomb coefficient f", "", 0.0, 10.0),
    Field("friction_low", "lower end of the interval of f", "", 0.0, 10.0),
    Field("friction_high", "upper end of the interval of f", "", 0.0, 10.0),
)
TOP = (Field("restitution", "energetic restitution of the rigid fidelity", "", 0.0, 1.0),)
_INTO = "n points out of the barrier, so a rod that strikes it has v_n below 0."
_DOWN = "t points up the slope, so a falling rod has v_t at or below 0."
IMPACT = (
    Field(
        "angle",
        "angle between the rod's axis and the barrier's normal",
        "angle",
        0.0,
        math.pi / 2,
        high_open=True,
    ),
    Field("v_n", "velocity along the normal", "speed", -500.0, -1e-6, remedy=_INTO),
    Field("v_t", "velocity up the slope", "speed", -500.0, 0.0, remedy=_DOWN),
    Field(
        "omega",
        "angular velocity, positive turning n towards t",
        "angular speed",
        -1e4,
        1e4,
        default=0.0,
        source="a rod dropped from rest does not turn (the paper, reducing Eq. 1 to Eq. 9)",
    ),
)
ACCURACY = (
    Field(
        "tip_size",
        "element size at the contact",
        "length",
        1e-5,
        1e-2,
        default=0.35e-3,
        source="chosen for this package: the two-mesh band of every result says what it costs",
    ),
    Field(
        "across",
        "cells over the diameter of the body",
        "",
        6,
        64,
        whole=True,
        even=True,
        default=8,
        source="chosen for this package; check its cost with a second value",
    ),
    Field(
        "grid_shift",
        "place of a meshed barrier's grid along t, in cells at the contact",
        "",
        0.0,
        1.0,
        high_open=True,
        default=0.0,
        source="chosen for this package: no place is better; runs at 0 and 0.5 differ by the scatter of both",
    ),
    Field(
        "block_margin",
        "width of the barrier block beyond its fine zone",
        "length",
        1e-5,
        0.1,
        default=6e-3,
        source="chosen for this package: springs and dampers stand for the rest; `study sets` widens it once",
    ),
    Field(
        "max_time",
        "latest time at which the run stops",
        "time",
        1e-6,
        1.0,
        default=2.5e-3,
        source="chosen for this package: a second contact comes 0.3-1.0 ms after the first",
    ),
    Field(
        "step",
        "time step over the largest stable one",
        "",
        0.01,
        0.99,
        default=0.9,
        source="chosen for this package; stable is 2 over the largest frequency of the assembled bodies",
    ),
)
Element = Literal["incompatible", "full", "bbar"]  # linear operator of cells that cannot yield
Unresolved = Literal["withhold", "report"]  # what becomes of numbers that the mesh does not resolve
MESH = ("tip_size", "across", "grid_shift")  # keys of accuracy that a target replaces
SAVE = (
    Field(
        "frames",
        "frames of the fields",
        "",
        0,
        100_000,
        whole=True,
        default=120,
        source="a film of 5 s at 24 frames a second",
    ),
    Field(
        "history_every",
        "steps between rows of the histories",
        "",
        1,
        1_000_000,
        whole=True,
        default=20,
        source="20 steps of about 20 ns, against 40 us of the 0.08 m rod's first bending half-period",
    ),
)

_STEEL = "carbon steel at 20 degC, EN 1993-1-2:2005, 3.4.1"
HEATING = (
    Field(
        "ignition",
        "temperature that the contact must not reach",
        "temperature",
        300.0,
        5000.0,
        default=703.15,
        source="hot spots of 430 degC and more set off secondary explosives (Bowden & Yoffe 1952)",
    ),
    Field(
        "ambient",
        "temperature before the impact",
        "temperature",
        1.0,
        299.0,
        default=293.15,
        source="a room; the bound on the contact grows with it degree by degree",
    ),
    *(
        Field(f"{body}_{key}", f"{words} of the {body}", words, 1e-3, 1e5, default=value, source=_STEEL)
        for body in ("rod", "barrier")
        for key, words, value in (
            ("conductivity", "conductivity", 53.0),
            ("heat_capacity", "heat capacity", 440.0),
        )
    ),
)


@dataclass(frozen=True, slots=True)
class Default:
    """A value used when a scene does not state it, with where it comes from."""

    key: str
    value: Any
    source: str


_ELEMENT = Default(
    "accuracy.element",
    "incompatible",
    "chosen for this package: on t5b other elements change e by less than .001 (README)",
)
DEFAULTS: tuple[Default, ...] = (
    *(
        Default(f"{section}.{f.key}", f.write(f.default), f.source)
        for section, fields in (
            ("impact", IMPACT),
            ("accuracy", ACCURACY),
            ("save", SAVE),
            ("heating", HEATING),
        )
        for f in fields
        if f.default is not None
    ),
    _ELEMENT,
)
