"""Uncertain inputs of a measured set, sampled over their ranges all at once, and the mesh they vary on."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import degrees, hypot, log, radians
from typing import Any

import numpy as np

from fem_impact import Case, Scene, replace_all
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.jobs.job import Job
from fem_impact.physics.hardening import TABOR_STRAIN, rate_gain, tabor_stress
from fem_impact.scene.library import intervals_of
from fem_impact.scene.material import JohnsonCookRate
from rigid import Errors
from rigid.experiments import MeasuredSet, measured_set

ANGLE = radians(0.5)  # half the range of the inclination (assumed)
CONTACT = Errors().contact  # m, half the range of the contact point's position
TRACKING = Errors().tracking  # relative error of a tracked speed (paper)
BACKING = (0.5, 1.0)  # times the plate's modulus
LEVELS = 5  # tip radii of the sample: few, as each needs its own modes
FAST = 1e3  # 1/s, where the intervals of the rate factor hold


@dataclass(frozen=True, slots=True)
class UncertainInput:
    """An uncertain input.

    Attributes
    ----------
    name, description : str
        Short name, and the range with its source.
    nominal : float or None
        Its value in the scene where it is one unknown value for all tests of a set; None where it can differ
        from test to test.
    span : callable
        Function of scene and measured set to the ends of the range, in SI units or as a factor.
    """

    name: str
    description: str
    nominal: float | None
    span: Callable[[Scene, MeasuredSet], tuple[float, float]]

    @property
    def varies(self) -> bool:
        """Whether it can differ from test to test of a set."""
        return self.nominal is None


def _radius(scene: Scene, _: MeasuredSet) -> tuple[float, float]:
    """Return tip radii, m, that move the contact point by `CONTACT`, at most half the radius away."""
    r, alpha = scene.projectile.tip_radius, scene.impact.angle
    turn = np.array([np.sin(alpha) - (scene.projectile.tip == "B"), 1 - np.cos(alpha)])
    half = min(CONTACT / float(np.linalg.norm(turn)), 0.5 * r, 0.5 * scene.projectile.diameter - r)
    return r - half, r + half


def _speed(_: Scene, measured: MeasuredSet) -> tuple[float, float]:
    """Return factors of the mean speed: the range of the tests, at least the tracking error."""
    speeds = np.hypot(measured.motion["v_n"], measured.motion["v_t"])
    half = max(float(np.abs(speeds / speeds.mean() - 1).max()), TRACKING)
    return 1 - half, 1 + half


UNCERTAIN_INPUTS = (
    UncertainInput(
        "friction",
        "f over the interval of the surface state, with that interval's sources",
        None,
        lambda scene, _: (scene.surface.friction_low, scene.surface.friction_high),
    ),
    UncertainInput(
        "angle",
        f"angle of the rod +- {degrees(ANGLE):g} degrees (assumed: nothing is stated)",
        None,
        lambda scene, _: (scene.impact.angle - ANGLE, scene.impact.angle + ANGLE),
    ),
    UncertainInput(
        "flow stress",
        "flow stress of both steels from their tensile tests (0) to the upper end of what their hardness "
        "stands for (1)",
        0.0,
        lambda *_: (0.0, 1.0),
    ),
    UncertainInput(
        "rate",
        "rate factor of both steels over its interval: lower end (0), nominal value (1/2), upper end (1)",
        0.5,
        lambda *_: (0.0, 1.0),
    ),
    UncertainInput(
        "contact point",
        f"tip radius, in {LEVELS} steps, such that the contact point moves by {CONTACT * 1e3:g} mm "
        "(the arms are known to about that)",
        None,
        _radius,
    ),
    UncertainInput(
        "speed",
        f"speed over the range of the set's tests, at least the {TRACKING:.0%} tracking error of the paper",
        None,
        _speed,
    ),
    UncertainInput(
        "plate clamping",
        f"modulus of the plate times {BACKING[0]:g} to {BACKING[1]:g} (assumed: a bolted plate that is "
        "not fully backed gives at most twice as much; the paper saw no movement)",
        1.0,
        lambda *_: BACKING,
    ),
)


def interval_ends(scene: Scene, measured: MeasuredSet) -> tuple[np.ndarray, np.ndarray]:
    """Return the lower and the upper ends (d,) of `UNCERTAIN_INPUTS`."""
    low, high = np.array([i.span(scene, measured) for i in UNCERTAIN_INPUTS]).T
    return low, high


def sample_values(scene: Scene, measured: MeasuredSet, unit: np.ndarray, tests: bool) -> np.ndarray:
    """Return values (n, d) of `UNCERTAIN_INPUTS` for a sample (n, d) of the unit cube.

    With ``tests``, inputs that do not vary from test to test keep their nominal value.
    """
    low, high = interval_ends(scene, measured)
    steps = unit.copy()
    at = [i.name for i in UNCERTAIN_INPUTS].index("contact point")
    steps[:, at] = (np.floor(unit[:, at] * LEVELS) + 0.5) / LEVELS
    values: np.ndarray = low + (high - low) * steps
    for i, of in enumerate(UNCERTAIN_INPUTS):
        if tests and of.nominal is not None:
            values[:, i] = of.nominal
    return values


def changes(scene: Scene, values: np.ndarray) -> dict[str, Any]:
    """Return the changed keys of a scene for values (d,) of `UNCERTAIN_INPUTS`."""
    f, angle, harder, rate, radius, speed, backing = map(float, values)
    v = hypot(scene.impact.v_n, scene.impact.v_t) * speed
    turned = np.arctan2(scene.impact.v_t, scene.impact.v_n) + (angle - scene.impact.angle)
    return {
        **hardened(scene, harder),
        **rates(scene, rate),
        "surface.friction": f,
        "impact.angle_rad": angle,
        "impact.v_n": f"{v * np.cos(turned):.9g} m/s",
        "impact.v_t": f"{v * np.sin(turned):.9g} m/s",
        "projectile.tip_radius": f"{radius * 1e3:.9g} mm",
        "barrier.material.E": f"{backing * scene.barrier.material.E / 1e9:.9g} GPa",
    }


def sample_jobs(name: str, scene: Scene, unit: np.ndarray, fidelity: str = "solid") -> list[Job]:
    """Return a run of a measured set's scene for each row of a sample (n, d) of the unit cube."""
    values = sample_values(scene, measured_set(name), unit, tests=False)
    return [
        Job(f"{name}-{at}", replace_all(scene, changes(scene, row)), fidelity)
        for at, row in enumerate(values)
    ]


def hardened(scene: Scene, share: float) -> dict[str, Any]:
    """Return changed keys: flow stresses ``share`` of the way from tensile test to hardness.

    The way ends at the upper end of the hardness number's interval. Both readings are power laws through the
    yield stress, so that a hardness number stands for each law between them.
    """
    changed: dict[str, Any] = {}
    for body, metal in scene.materials.items():
        tensile = hardening_of(replace(metal, law="tensile"))
        low = float(tensile.flow_stress(TABOR_STRAIN)) / tabor_stress(1.0)
        high = intervals_of(metal.name)["hardness"][1]
        keys = {"law": "hardness", "hardness": low + share * (high - low)}
        changed |= {f"{body}.material.{key}": value for key, value in keys.items()}
    return changed


def rates(scene: Scene, place: float) -> dict[str, Any]:
    """Return changed keys: C of both steels at a place in the interval of the rate factor, 1/2: nominal."""
    changed = {}
    for body, metal in scene.materials.items():
        if not isinstance(metal.rate, JohnsonCookRate):
            continue
        low, high = intervals_of(metal.name)["rate_factor"]
        gain = float(np.interp(place, (0.0, 0.5, 1.0), (low - 1, rate_gain(metal, FAST), high - 1)))
        slope = gain / log(FAST / metal.rate.tested)  # of the factor over ln(rate), from 1 at ``tested``
        C = slope / (1 - slope * log(metal.rate.tested / metal.rate.reference))
        changed[f"{body}.material.rate.C"] = C
    return changed


def one_mesh(scene: Scene) -> Scene:
    """Return a scene on one mesh about its estimated contact, with cells twice as large as advised there.

    Their sizes are stated, so that the mesh stays where inputs are changed, which differences need. What it
    does not resolve is reported all the same.
    """
    meshes = LevelMeshes(Case(scene))
    coarser = meshes.at(max(meshes.usual - 1, 0))
    accuracy = replace(coarser.accuracy, levels=1, offsets=None, unresolved="report")
    return replace(coarser, accuracy=accuracy, save=replace(coarser.save, frames=0))
