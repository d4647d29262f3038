"""The hard cases, each a scene on a coarse mesh, some with a start that no scene file can state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from fem_impact import Scene, load, replace_all

Expected = Literal["closed", "refused", "detected"]
Changes = Mapping[str, Any]

# a short rod, a coarse tip, both bodies yield
BASE: Changes = {
    "accuracy.tip_size": "0.8 mm",
    "accuracy.across": 6,
    "accuracy.max_time": "0.4 ms",
    "projectile.length": "60 mm",
    "save.frames": 0,
    "effects": ["vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "large-rotation"],
}
ELASTIC = ["vibration", "friction", "barrier-elastic", "large-rotation"]
PLANE = ["vibration", "friction", "barrier-rigid", "large-rotation"]
YIELDING_PLANE = ["vibration", "friction", "rod-plasticity", "barrier-rigid", "large-rotation"]
HEAVY = [*PLANE, "gravity"]


@dataclass(frozen=True, slots=True)
class HardCase:
    """One hard case.

    Attributes
    ----------
    difficulty : what is hard about it
    changes : of the base scene, as ``--set`` takes them
    expected : ``closed`` run, ``refused`` before the run, or trouble ``detected`` during it
    gap : height of the lowest point at the start, m
    shifted : place of the rod along t, m
    step : share of the stable step
    bounces : between two walls instead of a scene, 0 for none
    """

    name: str
    difficulty: str
    changes: Changes = field(default_factory=dict)
    expected: Expected = "closed"
    gap: float = 2e-6
    shifted: float = 0.0
    step: float = 0.9
    bounces: int = 0

    def scene(self) -> Scene:
        """Return its scene (SceneError if it is refused already here)."""
        return replace_all(
            load("t5b"), {**BASE, **self.changes, "id": f"stress-{self.name.replace('.', '-')}"}
        )


def _angle(degrees: int) -> Changes:
    """Return the changes to another angle at the velocities of t5b, which then is no fall."""
    return {"impact.angle": f"{degrees} deg", "impact.v_n": "-1.5024 m/s", "impact.v_t": "-1.4821 m/s"}


def _speed(v: float) -> Changes:
    """Return the changes to v, m/s, along either direction."""
    return {"impact.v_n": f"{-v} m/s", "impact.v_t": f"{-v} m/s"}


def _material(*bodies: str, **values: str | float) -> Changes:
    return {f"{body}.material.{key}": value for body in bodies for key, value in values.items()}


ROD, BARRIER = "projectile", "barrier"
UPRIGHT: Changes = {"impact.angle": "0 deg", "impact.v_t": "0 m/s"}
SHARP: Changes = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"}
FLANK: Changes = {**_angle(89), "accuracy.across": 8}
ROUGH: Changes = {
    "surface.friction": 2.0,
    "impact.angle": "31 deg",
    "impact.v_n": "-1e-6 m/s",
    "accuracy.max_time": "0.3 ms",
}
SHORT = {"projectile.length": "165 mm", "projectile.diameter": "162 mm", "accuracy.tip_size": "6 mm"}
THIN = {"projectile.length": "170 mm", "projectile.diameter": "6 mm", "accuracy.tip_size": "0.25 mm"}
FEW = {"accuracy.across": 6, "accuracy.tip_size": "3 mm", "projectile.length": "19 mm"}
SOFT = {"E": "210 MPa", "yield_stress": "3 MPa", "ultimate_stress": "5 MPa"}
WEAK = {"E": "10 GPa", "yield_stress": "50 MPa", "ultimate_stress": "60 MPa"}
PERFECT = {"yield_stress": "300 MPa", "ultimate_stress": "300 MPa"}
HARDENING = {"yield_stress": "100 MPa", "ultimate_stress": "2000 MPa"}
SLOW: Changes = {"accuracy.max_time": "3 ms", "effects": ELASTIC}
FAST: Changes = {"accuracy.tip_size": "1.6 mm", "accuracy.max_time": "0.2 ms"}

_CASES = (
    # angles
    *(HardCase(f"angle-{a}", f"angle {a} degrees", _angle(a)) for a in (1, 17, 60, 80)),
    HardCase("angle-85", "85 degrees: its tail strikes later, beside the plate", _angle(85), "detected"),
    HardCase("angle-89", "89 degrees: the rod's tail strikes the plane", {**FLANK, "effects": PLANE}),
    HardCase("angle-89-block", "89 degrees: its tail strikes soon, beside the plate", FLANK, "detected"),
    HardCase(
        "angle-89-coarse", "89 degrees: the polygon of the side would land first", _angle(89), "refused"
    ),
    HardCase("upright-edge", "angle 0, rounded edge, meshed block", UPRIGHT),
    HardCase("upright-round", "angle 0, round nose", {**UPRIGHT, "projectile.tip": "A"}),
    HardCase("flat-on-plane", "flat face on the rigid plane", {**UPRIGHT, **SHARP, "effects": PLANE}),
    HardCase("flat-on-block", "flat face on a meshed block", {**UPRIGHT, **SHARP}),
    HardCase("sharp-edge", "sharp edge at 45 degrees", SHARP),
    # friction
    *(HardCase(f"friction-{f:g}", f"friction {f:g}", {"surface.friction": f}) for f in (0.0, 1.5, 3.0)),
    HardCase(
        "painleve",
        "tip in contact, sliding, no normal speed, f 2, 31 degrees",
        {**ROUGH, "effects": HEAVY},
        gap=0.0,
    ),
    HardCase(
        "painleve-block",
        "the same start on an elastic block",
        {**ROUGH, "effects": [*ELASTIC, "gravity"]},
        gap=0.0,
    ),
    # rods and meshes
    HardCase("gamma-2", "gamma 2: as thick as long", {**SHORT, "projectile.tip_radius": "20 mm"}),
    HardCase("gamma-200", "gamma 200", {**THIN, "projectile.tip_radius": "1 mm"}),
    HardCase("long-rod", "rod of 1.5 m", {"projectile.length": "1.5 m", "effects": PLANE}),
    HardCase("sharp-tip", "tip radius 0.2 mm", {"projectile.tip_radius": "0.2 mm"}),
    HardCase("blunt-tip", "tip radius 9.4 mm", {"projectile.tip_radius": "9.4 mm"}),
    HardCase("slivers", "edge of 0.02 mm: sliver elements", {"projectile.tip_radius": "0.02 mm"}),
    HardCase("six-elements", "a mesh of 6 elements", {**FEW, "accuracy.across": 2}, "refused"),
    HardCase("few-elements", "the coarsest mesh that has a round section", {**FEW, "effects": PLANE}),
    HardCase(
        "many-elements",
        "the finest mesh that the time allows",
        {"accuracy.tip_size": "0.15 mm", "accuracy.across": 16, "accuracy.max_time": "2 us"},
    ),
    HardCase("spinning", "spin of 1000 rad/s into the barrier", {"impact.omega": "-1000 rad/s"}),
    HardCase("spinning-away", "spin that lifts the tip", {"impact.omega": "1000 rad/s"}, "refused"),
    # materials
    HardCase("nu-0", "Poisson's ratio 0", _material(ROD, BARRIER, nu=0.0)),
    HardCase("nu-0.499", "Poisson's ratio .499", _material(ROD, BARRIER, nu=0.499)),
    HardCase(
        "soft-barrier", "barrier 1e-3 as stiff", {**_material(BARRIER, **SOFT), "accuracy.max_time": "1 ms"}
    ),
    HardCase("soft-rod", "rod 1e-3 as stiff", {**_material(ROD, **SOFT), "accuracy.max_time": "2 ms"}),
    HardCase(
        "stiff-barrier", "barrier 1e3 as stiff", {**_material(ROD, **WEAK), **_material(BARRIER, E="1e13 Pa")}
    ),
    HardCase(
        "light-barrier",
        "barrier 1e-3 as dense",
        {**_material(ROD, rho="20000 kg/m3"), **_material(BARRIER, rho="20 kg/m3")},
    ),
    HardCase(
        "light-rod",
        "rod 1e-3 as dense",
        {**_material(ROD, rho="20 kg/m3"), **_material(BARRIER, rho="20000 kg/m3")},
    ),
    HardCase("perfectly-plastic", "no hardening", _material(ROD, BARRIER, **PERFECT)),
    HardCase("huge-hardening", "ultimate stress 20 times yield", _material(ROD, **HARDENING)),
    # speeds
    HardCase("speed-0.001", "1 mm/s", {**_speed(0.001), **SLOW}),
    HardCase("speed-0.01", "10 mm/s", {**_speed(0.01), **SLOW}),
    HardCase("speed-20", "20 m/s", _speed(20.0)),
    HardCase("speed-100", "100 m/s", {**_speed(100.0), **FAST}),
    HardCase("speed-300", "300 m/s", {**_speed(300.0), **FAST}, "refused"),
    HardCase(
        "resting",
        "resting on the plane under gravity",
        {"impact.v_n": "-1e-4 m/s", "impact.v_t": "0 m/s", "impact.angle": "0 deg", "effects": HEAVY},
        gap=0.0,
    ),
    # starts
    HardCase("node-below", "a contact node at the lowest point", {"effects": ELASTIC}),
    HardCase("between-nodes", "the lowest point half an element on", {"effects": ELASTIC}, shifted=4e-4),
    HardCase("overlap", "20 um inside the plane at the start", {"effects": PLANE}, gap=-2e-5),
    HardCase("overlap-block", "20 um inside the block at the start", {"effects": ELASTIC}, gap=-2e-5),
    HardCase("step-0.9", "0.9 of the stable step", {"effects": YIELDING_PLANE}),
    HardCase("step-1.0", "the stable step itself", {"effects": PLANE}, step=1.0),
    HardCase("step-1.1", "1.1 of the stable step", {"effects": PLANE}, "detected", step=1.1),
    HardCase("two-walls", "1000 bounces between two walls", bounces=1000),
)

CASES: dict[str, HardCase] = {case.name: case for case in _CASES}
