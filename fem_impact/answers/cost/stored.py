"""The cheapest setting that met a wanted error on the nearest scene whose cost was measured and stored.

The costs were measured with `fem_impact.answers.cost.measure` and ship with the package
(`fem_impact.case.measured`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot, inf, log, sqrt
from typing import Any

from fem_impact.answers.cost.judge import Judged, cheapest, worst
from fem_impact.answers.cost.measure import CostStudy
from fem_impact.answers.refine.levels import MeshLevel
from fem_impact.answers.refine.quantities import TARGETED
from fem_impact.case.case import Case
from fem_impact.case.effects.plasticity import strength_of
from fem_impact.case.measured import summary, yardsticks
from fem_impact.errors import SceneError
from fem_impact.scene.material import Material
from fem_impact.scene.read import read_dict
from fem_impact.scene.types import Scene
from fem_impact.tables.text import plain

SUMMARY = "fem-impact/cost-summary/5"

STEEL = ("E", "rho", "yield", "ultimate over yield")
# largest differences of a scene from one whose cost was measured; of ratios and sizes, of their logarithms
NEARNESS = {
    "length over diameter": 0.1,
    "diameter": 0.3,
    "tip radius over diameter": 0.1,
    "angle (rad)": 0.05,
    "approach of the contact point": 0.25,
    "slope of that approach": 0.1,
    "spin over speed": 0.05,
    "friction f": 0.05,
    **{f"{value} of the {body}": 0.1 for body in ("rod", "barrier") for value in STEEL},
}
# keys of accuracy that change errors or times and must be the same
SAME = ("element", "yielding_element", "step", "mass_scaling", "fine_zone", "block_margin")
OTHERWISE = "Leave out --fidelity: finite elements then find their own error. Or"


class NotMeasured(SceneError):
    """No stored setting of a near scene meets the target."""


@dataclass(frozen=True, slots=True)
class ChosenSetting:
    """A chosen setting; expected error is relative, expected wall time in s on this machine."""

    target: float
    setting: Judged
    like: str
    expected_error: float
    expected_wall_s: float

    @property
    def meshes(self) -> list[MeshLevel]:
        """Return the meshes to run, the finest first."""
        return [MeshLevel(**mesh) for mesh in self.setting.meshes]

    @property
    def sentence(self) -> str:
        """Say what was chosen and why."""
        return (
            f"accuracy {100 * self.target:.3g} %: {self.setting.name}, expected error "
            f"{plain(100 * self.expected_error, 2)} % of {' and '.join(TARGETED)}, expected time "
            f"{plain(self.expected_wall_s, 2)} s (measured on {self.like})"
        )


def summarise(costs: Mapping[str, CostStudy]) -> dict[str, Any]:
    """Return the stored form of several scenes' costs, with one date and one machine for all."""
    shared = ("created_utc", "versions", "machine")
    whole = {name: cost.to_dict() for name, cost in costs.items()}
    first = next(iter(whole.values()))
    scenes = {
        name: {k: v for k, v in cost.items() if k not in (*shared, "schema")} for name, cost in whole.items()
    }
    return {"schema": SUMMARY, **{key: first[key] for key in shared}, "scenes": scenes}


def _features(case: Case) -> dict[str, float]:
    scene, pair = case.scene, case.contact
    rod, impact = scene.projectile, scene.impact
    speed, radius = hypot(impact.v_n, impact.v_t), sqrt(pair.body.k2)
    return {
        "length over diameter": log(rod.length / rod.diameter),
        "diameter": log(rod.diameter),
        "tip radius over diameter": log(max(rod.tip_radius / rod.diameter, 1e-3)),
        "angle (rad)": impact.angle,
        "approach of the contact point": log(pair.approach),
        "slope of that approach": pair.sliding / pair.approach,
        "spin over speed": impact.omega * radius / speed,
        "friction f": pair.f,
        **_steel("rod", rod.material, pair.rod_yields),
        **_steel("barrier", scene.barrier.material, pair.barrier_yields),
    }


def _steel(body: str, steel: Material, yields: bool) -> dict[str, float]:
    """Return the features of a body's material; strengths do not count where it stays elastic."""
    strong = yields and steel.yields
    strength = (steel.yield_stress, strength_of(steel) / steel.yield_stress) if strong else (1.0, 1.0)
    values = (steel.E, steel.rho, *strength)
    return {f"{name} of the {body}": log(value) for name, value in zip(STEEL, values, strict=True)}


def _distance(case: Case, other_case: Case) -> tuple[float, str]:
    """Return the largest difference over the allowed one, and its name; infinite for another model."""
    scene, other = case.scene, other_case.scene
    for name, mine, others in (
        ("tip", scene.projectile.tip, other.projectile.tip),
        ("effects", case.active, other_case.active),
        *((name, getattr(scene.accuracy, name), getattr(other.accuracy, name)) for name in SAME),
        ("max_time", min(case.max_time, other_case.max_time), other_case.max_time),
    ):
        if mine != others:
            return inf, name
    a, b = _features(case), _features(other_case)
    gaps = {name: 0.0 if a[name] == b[name] else abs(a[name] - b[name]) / NEARNESS[name] for name in NEARNESS}
    name = max(gaps, key=lambda key: gaps[key])
    return gaps[name], name


def nearest(scene: Scene) -> tuple[str, float, str]:
    """Return the nearest scene with a stored cost, its distance (1 is the limit), what differs most."""
    case = Case(scene)
    distances = [
        (*_distance(case, Case(read_dict(cost["scene"], "cost summary"))), name)
        for name, cost in summary()["scenes"].items()
    ]
    distance, differs, name = min(distances)
    return name, distance, differs


def choose_setting(scene: Scene, fidelity: str | None = None, workers: int = 1) -> ChosenSetting:
    """Return the cheapest stored setting that meets ``accuracy.target`` for this scene.

    Its expected time is that of one or two ``workers``, runs at a time.

    Raises
    ------
    NotMeasured
        No stored cost is near enough, or none of its settings meets the target.
    SceneError
        The fidelity does not know the quantities of a target.
    """
    target = scene.accuracy.target
    if target is None:
        raise SceneError("gives no target.", key="accuracy", remedy='Write accuracy = "5 %".')
    name, distance, differs = nearest(scene)
    if distance > 1:
        raise _too_far(scene, name, distance, differs)
    measured = [Judged(**setting) for setting in summary()["scenes"][name]["settings"]]
    settings = [one for one in measured if fidelity in (None, one.fidelity)]
    best = cheapest(settings, TARGETED, target)
    if best is None:
        raise _not_met(scene, name, settings)
    machine = summary()["machine"]["csr_ns_per_element_step"]
    seconds = best.cpu_s if workers == 1 else best.two_cores_s
    pace = yardsticks()["csr_ns_per_element_step"] / machine
    return ChosenSetting(target, best, name, worst(best, TARGETED), seconds * pace)


def _too_far(scene: Scene, name: str, distance: float, differs: str) -> NotMeasured:
    how = "differs in" if distance == inf else f"differs by {distance:.2g} times what is allowed in"
    return NotMeasured(
        f"cannot be judged: the nearest scene with a measured cost, {name}, {how} {differs}.",
        key="accuracy",
        value=_written(scene),
        remedy=f"{OTHERWISE} state no wanted error.",
    )


def _not_met(scene: Scene, name: str, settings: list[Judged]) -> SceneError:
    quantities, whole = " and ".join(TARGETED), [one for one in settings if one.kind != "effect"]
    best = min(whole, key=lambda one: worst(one, TARGETED))
    error = worst(best, TARGETED)
    if error == inf:
        problem = f"cannot be met: the {best.fidelity} fidelity does not know {quantities}."
        return SceneError(problem, key="accuracy", value=_written(scene), remedy="Leave out --fidelity.")
    return NotMeasured(
        f"cannot be met: on {name}, the best measured setting ({best.name}, {plain(best.cpu_s, 2)} s of CPU) "
        f"is uncertain by {plain(100 * error, 2)} % in {quantities}.",
        key="accuracy",
        value=_written(scene),
        remedy=f'{OTHERWISE} allow "{100 * error + 0.5:.0f} %".',
    )


def _written(scene: Scene) -> str:
    return f"{100 * (scene.accuracy.target or 0):.3g} %"
