"""Uncertain inputs of a measured set.

`UNCERTAIN_INPUTS` are sampled over their ranges, all at once, by the validation study. `INPUT_CHANGES` are
made one at a time by the study of the sets; `sensitivity_rows` lists their changes of the results and
`explanations` compares these with the difference from the measurement.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from math import degrees, hypot, radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.jobs.job import Failure, Job
from fem_impact.outcome.keys import Num, known
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import replace_all
from fem_impact.study.compare import COMPARED, MEASURED, UNSEEN, Row
from rigid import Errors
from rigid.experiments import MeasuredSet

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


ANGLE = radians(0.5)  # half the range of the inclination (assumed)
CONTACT = Errors().contact  # m, half the range of the contact point's position
TRACKING = Errors().tracking  # relative error of a tracked speed (paper)
YIELD = (1.0, 1.5)  # times the scene's yield and ultimate stress
BACKING = (0.5, 1.0)  # times the plate's modulus
LEVELS = 5  # tip radii of the sample: few, as each needs its own modes
STRONGER = 1.5  # hardness and tensile test of the two steels bound the yield stress within this factor
WIDER = 1.5  # times the margin of the barrier's block around the fine zone
SHOWN = {
    quantity.name: quantity.key
    for quantity in (*MEASURED, *UNSEEN)
    if quantity.name in (*COMPARED, "vibration/E_0", "friction/E_0")
}
"""Quantities whose change by an input is listed: name to key."""


@dataclass(frozen=True, slots=True)
class UncertainInput:
    """An uncertain input.

    Attributes
    ----------
    name, description : str
        Short name, and the range with its source.
    varies : bool
        Whether it can differ from test to test of a set; else it is one unknown value for all of them.
    span : callable
        Function of scene and measured set to the ends of the range, in SI units or as a factor.
    """

    name: str
    description: str
    varies: bool
    span: Callable[[Scene, MeasuredSet], tuple[float, float]]


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
        True,
        lambda scene, _: (scene.surface.friction_low, scene.surface.friction_high),
    ),
    UncertainInput(
        "angle",
        f"angle of the rod +- {degrees(ANGLE):g} degrees (assumed: nothing is stated)",
        True,
        lambda scene, _: (scene.impact.angle - ANGLE, scene.impact.angle + ANGLE),
    ),
    UncertainInput(
        "yield",
        f"yield and ultimate stress of both steels times {YIELD[0]:g} to {YIELD[1]:g} (tensile tests "
        "against hardness)",
        False,
        lambda *_: YIELD,
    ),
    UncertainInput(
        "contact point",
        f"tip radius, in {LEVELS} steps, such that the contact point moves by {CONTACT * 1e3:g} mm "
        "(the arms are known to about that)",
        True,
        _radius,
    ),
    UncertainInput(
        "speed",
        f"speed over the range of the set's tests, at least the {TRACKING:.0%} tracking error of the paper",
        True,
        _speed,
    ),
    UncertainInput(
        "plate clamping",
        f"modulus of the plate times {BACKING[0]:g} to {BACKING[1]:g} (assumed: a bolted plate that is "
        "not fully backed gives at most twice as much; the paper saw no movement)",
        False,
        lambda *_: BACKING,
    ),
)


def sample_values(scene: Scene, measured: MeasuredSet, unit: np.ndarray, tests: bool) -> np.ndarray:
    """Return values (n, d) of `UNCERTAIN_INPUTS` for a sample (n, d) of the unit cube.

    With ``tests``, inputs that do not vary from test to test keep the value of the scene (factor 1).
    """
    low, high = np.array([i.span(scene, measured) for i in UNCERTAIN_INPUTS]).T
    steps = unit.copy()
    at = [i.name for i in UNCERTAIN_INPUTS].index("contact point")
    steps[:, at] = (np.floor(unit[:, at] * LEVELS) + 0.5) / LEVELS
    values: np.ndarray = low + (high - low) * steps
    fixed = np.array([tests and not i.varies for i in UNCERTAIN_INPUTS])
    values[:, fixed] = 1.0  # the inputs that do not vary are factors of the scene's value
    return values


def changes(scene: Scene, values: np.ndarray) -> dict[str, Any]:
    """Return the changed keys of a scene for values (d,) of `UNCERTAIN_INPUTS`."""
    f, angle, strength, radius, speed, backing = map(float, values)
    v = hypot(scene.impact.v_n, scene.impact.v_t) * speed
    turned = np.arctan2(scene.impact.v_t, scene.impact.v_n) + (angle - scene.impact.angle)
    return strengths(scene, strength) | {
        "surface.friction": f,
        "impact.angle_rad": angle,
        "impact.v_n": f"{v * np.cos(turned):.9g} m/s",
        "impact.v_t": f"{v * np.sin(turned):.9g} m/s",
        "projectile.tip_radius": f"{radius * 1e3:.9g} mm",
        "barrier.material.E": f"{backing * scene.barrier.material.E / 1e9:.9g} GPa",
    }


@dataclass(frozen=True, slots=True)
class InputChange:
    """A change of one uncertain input: its name, description, and the changed scene keys."""

    name: str
    description: str
    changes: Callable[[Scene], dict[str, Any]]


def strengths(scene: Scene, factor: float) -> dict[str, Any]:
    """Return the changed keys of a scene with yield and ultimate stress of both steels times a factor."""
    bodies = {"projectile": scene.projectile.material, "barrier": scene.barrier.material}
    return {
        f"{body}.material.{key}": f"{factor * getattr(steel, key) / 1e6:.9g} MPa"
        for body, steel in bodies.items()
        for key in ("yield_stress", "ultimate_stress")
    }


INPUT_CHANGES = (
    InputChange(
        "friction-low",
        "lowest friction of its interval",
        lambda s: {"surface.friction": s.surface.friction_low},
    ),
    InputChange(
        "friction-high",
        "highest friction of its interval",
        lambda s: {"surface.friction": s.surface.friction_high},
    ),
    InputChange(
        "yield",
        f"yield and ultimate stress of both steels times {STRONGER:g}",
        lambda s: strengths(s, STRONGER),
    ),
    InputChange(
        "rate", "no hardening with the strain rate", lambda s: {"effects": [*s.effects, "-rate-hardening"]}
    ),
    InputChange(
        "block",
        f"barrier block with {WIDER:g} times the margin around the fine zone",
        lambda s: {"accuracy.block_margin": f"{WIDER * s.accuracy.block_margin * 1e3:.9g} mm"},
    ),
)
# the unchanged run evaluated with other lever arms of the impulse
ARMS = {"arms-edge": "arms of the tip's edge radius", "arms-impulse": "arms of the impulse"}
DESCRIPTIONS = {i.name: i.description for i in INPUT_CHANGES} | ARMS


def sensitivity_jobs(coarse: Job, out: Path) -> dict[str, Job]:
    """Return the job of the coarser mesh with each input changed, by the change's name."""
    jobs = {}
    for change in INPUT_CHANGES:
        name, scene = f"{coarse.name}-{change.name}", coarse.scene
        jobs[change.name] = Job(name, replace_all(scene, change.changes(scene)), out=out / name)
    return jobs


def sensitivity_rows(coarse: Outcome | Failure, changed: Mapping[str, Outcome | Failure]) -> list[Row]:
    """Return one row per input and quantity: set, input, quantity, base and changed value."""
    if not isinstance(coarse, Outcome):
        return []
    values: list[tuple[str, str, Num]] = [
        (name, quantity, key.of(run))
        for name, run in changed.items()
        if isinstance(run, Outcome)
        for quantity, key in SHOWN.items()
    ]
    for name, arms in (("arms-edge", coarse.restitution.edge), ("arms-impulse", coarse.restitution.impulse)):
        values += [(name, "e", arms.e), (name, "E_ln/E_0", arms.E_ln), (name, "E_lt/E_0", arms.E_lt)]
    return [
        {
            "set": coarse.provenance.scene_id,
            "input": name,
            "quantity": quantity,
            "base": known(SHOWN[quantity].of(coarse)),
            "changed": known(value),
        }
        for name, quantity, value in values
    ]


def explanations(comparison: Iterable[Row], sensitivities: Iterable[Row]) -> list[Row]:
    """Return, for each quantity outside its 95 % interval, the share of the miss by each input.

    The miss is measured mean less model; an input's share is its change of the result over the miss: 1 brings
    the model to the mean, below 0 takes it further away. An input could explain the miss if its change
    reaches the interval. Changes are those of the coarser mesh, applied to the model's value.
    """
    changes_of: dict[tuple[str, str], dict[str, float]] = {}
    for row in sensitivities:
        change = row["changed"] - row["base"]
        changes_of.setdefault((row["set"], row["quantity"]), {})[row["input"]] = change
    explained = []
    for row in comparison:
        change_by_input = changes_of.get((row["set"], row["quantity"]))
        model, mean, low = row["model"], row["measured_mean"], row["measured_low"]
        if mean is None or row["verdict"] == "inside" or change_by_input is None:
            continue
        shares = {name: change / (mean - model) for name, change in change_by_input.items()}
        enough = ((low if model < low else row["measured_high"]) - model) / (mean - model)
        could = [name for name, share in shares.items() if share >= enough]
        known_values = {name: row[name] for name in ("set", "quantity", "model", "measured_mean")}
        explained.append({**known_values, "shares": shares, "could": could})
    return explained
