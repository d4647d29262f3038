"""The uncertain inputs of a measured set: their ranges, where these come from, and what they change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import degrees, hypot, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.study.sensitivity import strengths
from rigid.experiments import MeasuredSet

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["INPUTS", "Input", "changes", "sample_values"]

ANGLE = radians(0.5)
CONTACT = 0.5e-3  # m
TRACKING = 0.02
YIELD = (1.0, 1.5)
BACKING = (0.5, 1.0)
LEVELS = 5  # tip radii: the modes of each are computed once


@dataclass(frozen=True, slots=True)
class Input:
    """An uncertain input.

    Attributes
    ----------
    name, words : str
        Short name, and the range with its source.
    varies : bool
        Whether it can differ from test to test of a set; else it is one unknown value for all of them.
    span : callable
        Scene and measured set to the ends of the range.
    """

    name: str
    words: str
    varies: bool
    span: Callable[[Scene, MeasuredSet], tuple[float, float]]


def _friction(scene: Scene, _: MeasuredSet) -> tuple[float, float]:
    return scene.surface.friction_low, scene.surface.friction_high


def _angle(scene: Scene, _: MeasuredSet) -> tuple[float, float]:
    return scene.impact.angle - ANGLE, scene.impact.angle + ANGLE


def _yield(_scene: Scene, _set: MeasuredSet) -> tuple[float, float]:
    return YIELD


def _radius(scene: Scene, _: MeasuredSet) -> tuple[float, float]:
    """Return tip radii, m, that move the contact point by `CONTACT`, within half the radius."""
    r, alpha = scene.projectile.tip_radius, scene.impact.angle
    turn = np.array([np.sin(alpha) - (scene.projectile.tip == "B"), 1 - np.cos(alpha)])
    half = min(CONTACT / float(np.linalg.norm(turn)), 0.5 * r, 0.5 * scene.projectile.diameter - r)
    return r - half, r + half


def _speed(_: Scene, measured: MeasuredSet) -> tuple[float, float]:
    speeds = np.hypot(measured.motion["v_n"], measured.motion["v_t"])
    half = max(float(np.abs(speeds / speeds.mean() - 1).max()), TRACKING)
    return 1 - half, 1 + half


def _backing(_scene: Scene, _set: MeasuredSet) -> tuple[float, float]:
    return BACKING


INPUTS = (
    Input(
        "friction", "f over the interval of the surface state, with that interval's sources", True, _friction
    ),
    Input(
        "angle", f"angle of the rod +- {degrees(ANGLE):g} degrees (assumed: nothing is stated)", True, _angle
    ),
    Input(
        "yield",
        f"yield and ultimate stress of both steels times {YIELD[0]:g} to {YIELD[1]:g} (tensile tests "
        "against hardness)",
        False,
        _yield,
    ),
    Input(
        "contact point",
        f"tip radius, in {LEVELS} steps, such that the contact point moves by {CONTACT * 1e3:g} mm "
        "(the arms are known to about that)",
        True,
        _radius,
    ),
    Input(
        "speed",
        f"speed over the range of the set's tests, at least the {TRACKING:.0%} tracking error of the paper",
        True,
        _speed,
    ),
    Input(
        "plate clamping",
        f"modulus of the plate times {BACKING[0]:g} to {BACKING[1]:g} (assumed: a bolted plate that is "
        "not fully backed gives at most twice as much; the paper saw no movement)",
        False,
        _backing,
    ),
)


def sample_values(scene: Scene, measured: MeasuredSet, unit: np.ndarray, tests: bool) -> np.ndarray:
    """Return inputs (n, d) for a sample (n, d) of the unit cube.

    With ``tests`` the inputs that are one unknown value for all tests stay as the scene states them.
    """
    low, high = np.array([i.span(scene, measured) for i in INPUTS]).T
    steps = unit.copy()
    at = [i.name for i in INPUTS].index("contact point")
    steps[:, at] = (np.floor(unit[:, at] * LEVELS) + 0.5) / LEVELS
    values: np.ndarray = low + (high - low) * steps
    fixed = np.array([tests and not i.varies for i in INPUTS])
    values[:, fixed] = 1.0  # both are factors of the stated value
    return values


def changes(scene: Scene, values: np.ndarray) -> dict[str, Any]:
    """Return the changed keys of a scene for values (d,) of the inputs."""
    f, angle, strength, radius, speed, backing = map(float, values)
    before = hypot(scene.impact.v_n, scene.impact.v_t) * speed
    turned = np.arctan2(scene.impact.v_t, scene.impact.v_n) + (angle - scene.impact.angle)
    return strengths(scene, strength) | {
        "surface.friction": f,
        "impact.angle_rad": angle,
        "impact.v_n": f"{before * np.cos(turned):.9g} m/s",
        "impact.v_t": f"{before * np.sin(turned):.9g} m/s",
        "projectile.tip_radius": f"{radius * 1e3:.9g} mm",
        "barrier.material.E": f"{backing * scene.barrier.material.E / 1e9:.9g} GPa",
    }
