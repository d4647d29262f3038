"""The uncertain inputs of a measured set: their ranges, where these come from, and what they change."""

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
from fem_impact.study.compare import MEASURED, UNSEEN, Row
from rigid.experiments import MeasuredSet

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


ANGLE = radians(0.5)
CONTACT = 0.5e-3  # m
TRACKING = 0.02
YIELD = (1.0, 1.5)
BACKING = (0.5, 1.0)
LEVELS = 5  # tip radii: the modes of each are computed once


@dataclass(frozen=True, slots=True)
class UncertainInput:
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


UNCERTAIN_INPUTS = (
    UncertainInput(
        "friction", "f over the interval of the surface state, with that interval's sources", True, _friction
    ),
    UncertainInput(
        "angle", f"angle of the rod +- {degrees(ANGLE):g} degrees (assumed: nothing is stated)", True, _angle
    ),
    UncertainInput(
        "yield",
        f"yield and ultimate stress of both steels times {YIELD[0]:g} to {YIELD[1]:g} (tensile tests "
        "against hardness)",
        False,
        _yield,
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
        _backing,
    ),
)


def sample_values(scene: Scene, measured: MeasuredSet, unit: np.ndarray, tests: bool) -> np.ndarray:
    """Return inputs (n, d) for a sample (n, d) of the unit cube.

    With ``tests`` the inputs that are one unknown value for all tests stay as the scene states them.
    """
    low, high = np.array([i.span(scene, measured) for i in UNCERTAIN_INPUTS]).T
    steps = unit.copy()
    at = [i.name for i in UNCERTAIN_INPUTS].index("contact point")
    steps[:, at] = (np.floor(unit[:, at] * LEVELS) + 0.5) / LEVELS
    values: np.ndarray = low + (high - low) * steps
    fixed = np.array([tests and not i.varies for i in UNCERTAIN_INPUTS])
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


CHANGED = ("e", "mu", "Omega", "E_ln/E_0", "E_lt/E_0", "E_r/E_0", "vibration/E_0", "friction/E_0")
SHOWN = {q.name: q.key for q in (*MEASURED, *UNSEEN) if q.name in CHANGED}
"""Keys of what the changed inputs are judged by."""
STRONGER = 1.5  # hardness and tensile test of the two steels bound the yield stress within this factor
WIDER = 1.5


@dataclass(frozen=True, slots=True)
class InputChange:
    """An uncertain input: its name, what it is changed to, in words, and the changed keys of a scene."""

    name: str
    words: str
    changes: Callable[[Scene], dict[str, Any]]


def strengths(scene: Scene, factor: float) -> dict[str, Any]:
    """Return the changed keys of a scene whose steels have so many times the yield and ultimate stress."""
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
# the same run read with other lever arms of the impulse: no run of its own
ARMS = {"arms-edge": "arms of the tip's edge radius", "arms-impulse": "arms of the impulse"}
WORDS = {i.name: i.words for i in INPUT_CHANGES} | ARMS


def sensitivity_jobs(coarse: Job, out: Path) -> dict[str, Job]:
    """Return the coarser job with each input changed, by the input's name."""
    scenes = {i.name: replace_all(coarse.scene, i.changes(coarse.scene)) for i in INPUT_CHANGES}
    names = {name: f"{coarse.name}-{name}" for name in scenes}
    return {name: Job(names[name], scene, out=out / names[name]) for name, scene in scenes.items()}


def sensitivity_rows(coarse: Outcome | Failure, changed: Mapping[str, Outcome | Failure]) -> list[Row]:
    """Return one row an input and quantity: set, input, quantity, base and changed value."""
    if not isinstance(coarse, Outcome):
        return []
    runs = {name: run for name, run in changed.items() if isinstance(run, Outcome)}
    rows = [
        _row(coarse, name, words, key.of(run)) for name, run in runs.items() for words, key in SHOWN.items()
    ]
    arms = {"arms-edge": coarse.restitution.edge, "arms-impulse": coarse.restitution.impulse}
    return rows + [
        _row(coarse, name, words, value)
        for name, read in arms.items()
        for words, value in (("e", read.e), ("E_ln/E_0", read.E_ln), ("E_lt/E_0", read.E_lt))
    ]


def _row(coarse: Outcome, name: str, quantity: str, changed: Num) -> Row:
    return {
        "set": coarse.provenance.scene_id,
        "input": name,
        "quantity": quantity,
        "base": known(SHOWN[quantity].of(coarse)),
        "changed": known(changed),
    }


def explanations(comparison: Iterable[Row], sensitivities: Iterable[Row]) -> list[Row]:
    """Return, for each quantity outside its 95 % interval, what share of the miss each input makes up.

    A share of 1 brings the model to the measured mean; one below 0 takes it further away. Inputs that reach
    the interval could explain the miss, since they may lie anywhere up to what they were changed to. The
    change is that of the coarser mesh, carried over to the model's value.
    """
    found: dict[tuple[str, str], dict[str, float]] = {}
    for row in sensitivities:
        change = row["changed"] - row["base"]
        found.setdefault((row["set"], row["quantity"]), {})[row["input"]] = change
    measured = [row for row in comparison if row["measured_mean"] is not None]
    outside = [row for row in measured if row["verdict"] != "inside"]
    return [
        _explanation(row, found[key]) for row in outside if (key := (row["set"], row["quantity"])) in found
    ]


def _explanation(row: Row, changes: Mapping[str, float]) -> Row:
    model, mean = row["model"], row["measured_mean"]
    edge = row["measured_low"] if model < row["measured_low"] else row["measured_high"]
    shares = {name: change / (mean - model) for name, change in changes.items()}
    enough = (edge - model) / (mean - model)
    return {
        "set": row["set"],
        "quantity": row["quantity"],
        "model": model,
        "measured_mean": mean,
        "shares": shares,
        "could": [name for name, share in shares.items() if share >= enough],
    }
