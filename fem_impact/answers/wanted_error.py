"""Simulate to a stated error: the cheapest setting by the measured costs of the nearest scene, and its runs.

The costs were measured with `fem_impact.answers.cost.measure` and ship with the package
(`fem_impact.case.measured`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from itertools import chain, islice
from math import hypot, inf, log, sqrt
from typing import Any

from fem_impact.answers.cost.judge import Judged, cheapest, worst
from fem_impact.answers.cost.measure import CostStudy
from fem_impact.answers.refine.budget import below, side_by_side
from fem_impact.answers.refine.extrapolate import Placed, mesh_means, stated_limits
from fem_impact.answers.refine.levels import Mesh, placed
from fem_impact.answers.refine.loop import ALONE, OwnLadder, achieved_error
from fem_impact.answers.refine.quantities import TARGETED
from fem_impact.answers.refine.times import longest_s, wall_seconds
from fem_impact.case.case import Case
from fem_impact.case.measured import summary, yardsticks
from fem_impact.errors import SceneError
from fem_impact.files.lock import directory_lock
from fem_impact.options import RunOptions
from fem_impact.outcome.record import Outcome
from fem_impact.run import simulate as run
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
BUDGET = 120.0  # s of wall time, unless stated, for a scene whose like was not measured


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
    def meshes(self) -> list[Mesh]:
        """Return the meshes to run, the finest first."""
        return [Mesh(**mesh) for mesh in self.setting.meshes]

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
    strength = (steel.yield_stress, steel.ultimate_stress / steel.yield_stress) if strong else (1.0, 1.0)
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


def settle(
    scene: Scene, fidelity: str | None = None, workers: int = 1, budget_s: float | None = None
) -> ChosenSetting | OwnLadder:
    """Return the stored setting that meets the scene's target, or a ladder of its own where there is none.

    A stored setting that takes longer than a stated ``budget_s``, s of wall time, gives way to such a ladder.

    Raises
    ------
    SceneError
        The fidelity that is asked for does not know the quantities of a target.
    """
    try:
        chosen = choose_setting(scene, fidelity, workers)
        if budget_s is None or chosen.expected_wall_s <= budget_s:
            return chosen
        took = plain(chosen.expected_wall_s, 2)
        reason = f"{chosen.setting.name}, measured on {chosen.like}, takes about {took} s."
    except NotMeasured as missing:
        if fidelity not in (None, "solid"):
            raise
        reason = missing.problem
    return OwnLadder.of(scene, BUDGET if budget_s is None else budget_s, workers, reason)


def simulate(
    scene: Scene,
    fidelity: str | None = None,
    options: RunOptions = RunOptions(),
    workers: int = 1,
    budget_s: float | None = None,
    chosen: ChosenSetting | OwnLadder | None = None,
) -> Outcome:
    """Compute an impact: on the mesh that its scene gives, or as measured costs choose for a stated error.

    A chosen setting runs each mesh at its places of the barrier's grid. The result is the outcome of the
    finest mesh at the first place, with the limits of several meshes, or the means of one, in its
    ``validity``. Files of the other runs stand below ``options.out``. With two or more ``workers`` a second
    process does half of the runs. Where no stored setting serves, meshes of the scene's own are run for about
    ``budget_s``, s (`BUDGET` unless stated), and the outcome says what they reached. ``chosen`` is what
    `settle` returned for this scene, where the caller has asked already.

    Raises
    ------
    UsageError, SceneError, OutputPathError, ResultError, RunError
        As `fem_impact.run.simulate.simulate` and `settle`.
    """
    if scene.accuracy.target is None:
        return run.simulate(scene, fidelity or "solid", options)
    chosen = chosen or settle(scene, fidelity, workers, budget_s)
    with nullcontext() if options.out is None else directory_lock(options.out):
        if isinstance(chosen, OwnLadder):
            return chosen.simulate(options, workers)
        meshes, wall_s = _runs(scene, chosen, options, workers)
        outcome = _stated(chosen, wall_s, meshes)
        if options.out is not None:
            outcome.write(options.out / "outcome.json")  # once more: it states its accuracy now
    return outcome


def _runs(
    scene: Scene, chosen: ChosenSetting, options: RunOptions, workers: int
) -> tuple[list[Placed], float]:
    """Return the runs on each mesh of a chosen setting, or one of a reduced model, and their wall time, s.

    The first run writes to ``options.out`` itself and reports its progress.
    """
    alone = [replace(scene, accuracy=replace(scene.accuracy, target=None))]  # a reduced model has no mesh
    groups = [placed(scene, mesh, chosen.setting.places) for mesh in chosen.meshes] or [alone]
    scenes = list(chain.from_iterable(groups))
    own = [options, *(below(options, at) for at in range(1, len(scenes)))]
    done = side_by_side(scenes, chosen.setting.fidelity, own, workers)
    runs, wall_s = iter(done), longest_s([wall_seconds(run) for run in done], workers)
    return [list(islice(runs, len(group))) for group in groups], wall_s


def _stated(chosen: ChosenSetting, wall_s: float, meshes: Sequence[Placed]) -> Outcome:
    """Return the first outcome with target, expected and achieved error and time in its validity."""
    first, several = meshes[0][0], len(meshes) > 1
    means = mesh_means(meshes[0]) if chosen.meshes else ALONE
    limits, bands = stated_limits(meshes) if several else (means, ALONE)
    stated = replace(
        first.validity,
        accuracy_target=chosen.target,
        accuracy_setting=chosen.setting.name,
        expected_error=chosen.expected_error,
        expected_wall=chosen.expected_wall_s,
        achieved_wall=wall_s,
        achieved_error=achieved_error(meshes) if several else ALONE,
        mesh_limit=limits,
        mesh_band=bands,
    )
    return replace(first, validity=stated)
