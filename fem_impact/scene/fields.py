"""All numbers of a scene: meaning, dimension, bounds, default, source."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Literal

from fem_impact.scene.parameter import Parameter

PROJECTILE = (
    Parameter("length", "length of the rod, tip to tail", "length", 1e-3, 10.0),
    Parameter("diameter", "diameter of the rod", "length", 1e-4, 1.0),
    Parameter("tip_radius", "radius of the nose (tip A) or of the edge (tip B)", "length", 0.0, 0.5),
)
TUBE = (
    Parameter(
        "inner_diameter",
        "diameter of a straight bore from tip to tail",
        "length",
        1e-5,
        1.0,
        derived="none: it is solid, or has a bore",
    ),
)
SURFACE = (
    Parameter("friction", "Coulomb coefficient f", "", 0.0, 10.0),
    Parameter("friction_low", "lower end of the interval of f", "", 0.0, 10.0),
    Parameter("friction_high", "upper end of the interval of f", "", 0.0, 10.0),
)
TOP = (Parameter("restitution", "energetic restitution of the rigid fidelity", "", 0.0, 1.0),)
_INTO = "n points out of the barrier, so a rod that strikes it has v_n below 0."
ANGLE = Parameter(
    "angle",
    "angle between the rod's axis and the barrier's normal, above 0 where the tail leans up the slope",
    "angle",
    -math.pi / 2,
    math.pi / 2,
)
V_N = Parameter("v_n", "velocity along the normal", "speed", -500.0, -1e-6, remedy=_INTO)
V_T = Parameter("v_t", "velocity up the slope, below 0 down it", "speed", -500.0, 500.0)
OMEGA = Parameter(
    "omega",
    "angular velocity, positive turning n towards t",
    "angular speed",
    -1e4,
    1e4,
    default=0.0,
    source="a rod dropped from rest does not turn (the paper, reducing Eq. 1 to Eq. 9)",
)
IMPACT = (ANGLE, V_N, V_T, OMEGA)  # as seen from the barrier
MOTION = (ANGLE, replace(V_N, low=-500.0, high=500.0, remedy=""), V_T, OMEGA)
_GIVEN = "none: the velocities are stated in another way"
HEIGHT = Parameter(
    "height",
    "height of fall, along the rod's axis unless slope is stated",
    "length",
    1e-12,
    1e4,
    derived=_GIVEN,
    unit="m",
)
SLOPE = Parameter(
    "slope",
    "slope of the barrier, above 0 where up the slope is up; gravity acts by it",
    "angle",
    -math.pi / 2,
    math.pi / 2,
    derived="that of the angle: the rod's axis is vertical",
)
SPEED = Parameter("speed", "speed along the rod's axis", "speed", 1e-6, 500.0, derived=_GIVEN)
_EXACT = "none: it is taken as exact"
_NO_GUESS = "chosen for this package: an uncertainty that is not stated is not guessed"
STRIKES = (
    Parameter(
        "angle_error",
        "how far the angle may be off",
        "angle",
        0.0,
        math.radians(10.0),
        derived=_EXACT,
        source=_NO_GUESS,
    ),
    Parameter(
        "speed_error",
        "share by which the velocities may be off",
        "",
        0.0,
        0.5,
        derived=_EXACT,
        source=_NO_GUESS,
    ),
)
_MASSIVE = "none: the barrier is massive"
BARRIER = (
    Parameter(
        "thickness",
        'thickness of a plate; used with support = "infinite"',
        "length",
        1e-5,
        10.0,
        derived="none: a half-space",
    ),
    Parameter(
        "span",
        "shortest way across a plate struck in its middle",
        "length",
        1e-4,
        1e4,
        derived="none: no wave comes back",
    ),
    Parameter("mass", "mass of a barrier that is free to move", "mass", 1e-6, 1e9, derived=_MASSIVE),
    Parameter(
        "inertia",
        "moment of inertia of a free barrier about its mass centre, axis normal to the plane of motion",
        "inertia",
        1e-12,
        1e12,
        derived="none: the barrier does not turn",
    ),
    Parameter(
        "centre_depth",
        "depth of its mass centre below the struck surface",
        "length",
        0.0,
        1e3,
        derived="none: the barrier does not turn",
    ),
    Parameter(
        "centre_offset",
        "distance of its mass centre from the struck point, up the slope",
        "length",
        -1e3,
        1e3,
        default=0.0,
    ),
    Parameter("v_n", "velocity of the barrier along the normal", "speed", -500.0, 500.0, default=0.0),
    Parameter("v_t", "velocity of the barrier up the slope", "speed", -500.0, 500.0, default=0.0),
)
TIP_SIZE = Parameter(
    "tip_size",
    "element size at the contact",
    "length",
    1e-5,
    1e-2,
    derived="5 elements over the estimated radius of a yielding contact, 4 over that of an elastic one",
    source="chosen for this package: the two-mesh band of every result says what it costs",
)
LEVELS = 3
LAYER = (Parameter("thickness", "thickness of a layer", "length", 1e-5, 1.0),)
ACCURACY = (
    TIP_SIZE,
    replace(
        TIP_SIZE,
        key="barrier_size",
        meaning="element size of a meshed barrier at the contact",
        derived="accuracy.tip_size",
    ),
    Parameter(
        "mass_scaling",
        "largest mass of a small element over its true one; 1 leaves all masses as they are",
        "",
        1.0,
        25.0,
        default=4.0,
        source="chosen for this package",
    ),
    Parameter(
        "across",
        "cells over the diameter of the body",
        "",
        6,
        64,
        whole=True,
        even=True,
        derived="8; 16 of a hollow body whose wall is on average an eighth of its diameter or thinner",
        source="chosen for this package: of rings with walls of 1/5 to 1/12 of the diameter, the period of "
        "ovalling is 5 to 7 % too short with 8 cells and 0.4 to 1.3 % with 16, beside that with 32",
    ),
    Parameter(
        "grid_shift",
        "place of a meshed barrier's grid along t, in cells at the contact",
        "",
        0.0,
        1.0,
        high_open=True,
        default=0.0,
        source="chosen for this package: no place is better; runs at 0 and 0.5 differ by the scatter of both",
    ),
    Parameter(
        "block_margin",
        "width of the barrier block beyond its fine zone",
        "length",
        1e-5,
        0.1,
        default=6e-3,
        source="chosen for this package: springs and dampers stand for the rest; `study sets` widens it once",
    ),
    Parameter(
        "max_time",
        "latest time at which the run stops",
        "time",
        1e-6,
        1.0,
        derived="2.5 ms, or 2.8 times the bending period and the contact time where that is longer",
        source="chosen for this package: of 168 random drops none touched later (reduced model)",
    ),
    Parameter(
        "step",
        "time step over the largest stable one",
        "",
        0.01,
        0.99,
        default=0.9,
        source="chosen for this package; stable is 2 over the largest frequency of the assembled bodies",
    ),
    Parameter(
        "levels",
        "meshes of a finite-element run, each with finer cells at the contact that the one before found; "
        "1: one mesh about the estimated contact, without a band",
        "",
        1,
        6,
        whole=True,
        default=LEVELS,
        source="chosen for this package: three meshes find the contact and give each number a band",
    ),
    Parameter(
        "offsets",
        "places of a meshed barrier's grid, half a cell apart, at which each level but the first runs",
        "",
        1,
        2,
        whole=True,
        derived="1; 2 where an error is wanted",
        source="chosen for this package: two places cost twice as much, on two cores as much as one, and "
        "make bands about a third as wide",
    ),
)
Element = Literal["incompatible", "full", "bbar"]  # linear operator of cells that cannot yield
YieldingElement = Literal["bbar", "full"]  # element of cells that may yield
FineZone = Literal["graded", "even"]  # finest cells right under the contact alone, or all over the fine zone
Support = Literal["backed", "infinite"]  # of a plate: bonded to a base, or free underneath and wide
Boundary = Literal["half-space", "fixed"]  # of a meshed barrier's outer faces
Unresolved = Literal["withhold", "report"]  # what becomes of numbers that the mesh does not resolve
TargetOf = Literal["e", "mu", "Omega", "E_vib", "E_lt", "E_ln", "plastic", "friction"]  # a wanted error alone
Fields = Literal["shown", "all"]  # that a run keeps
MESH = ("tip_size", "across", "grid_shift")  # keys of accuracy that a target replaces
SAVE = (
    Parameter(
        "frames",
        "frames of the fields",
        "",
        0,
        100_000,
        whole=True,
        default=120,
        source="a film of 5 s at 24 frames a second",
    ),
    Parameter(
        "history_every",
        "steps between rows of the histories",
        "",
        1,
        1_000_000,
        whole=True,
        default=20,
        source="20 steps of about 20 ns, against 40 us of the 0.08 m rod's first bending half-period",
    ),
    Parameter(
        "strain_samples",
        "samples of the strain along the axis while a stretching wave crosses one slice of the mesh, 0: none",
        "",
        0,
        100,
        whole=True,
        default=1,
        source="chosen for this package: the mesh carries no wave shorter than some slices",
    ),
)

HEATING = (
    Parameter(
        "ignition",
        "temperature that the contact must not reach",
        "temperature",
        300.0,
        5000.0,
        default=703.15,
        source="hot spots of 430 degC and more set off secondary explosives (Bowden & Yoffe 1952)",
    ),
    Parameter(
        "ambient",
        "temperature before the impact",
        "temperature",
        1.0,
        299.0,
        default=293.15,
        source="room temperature; the bound on the contact rises by as many degrees",
    ),
    *(
        Parameter(
            *(f"{body}_{key}", f"{quantity} of the {body}", quantity, 1e-3, 1e5),
            derived=f"that of the {body}'s material",
            source="the material's; where it states none, the heat of the contact is not known",
        )
        for body in ("rod", "barrier")
        for key, quantity in (("conductivity", "conductivity"), ("heat_capacity", "heat capacity"))
    ),
    *(
        Parameter(
            *(
                f"{body}_melting",
                f"temperature at which the {body} begins to melt",
                "temperature",
                200.0,
                6000.0,
            ),
            derived=f"that of the {body}'s material, if it is a shipped one",
            source="the shipped material's; without it a temperature is told however high it is",
        )
        for body in ("rod", "barrier")
    ),
)


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
