"""Cost of one scene: its models and levels are run, stored and judged; written as JSON, CSV and tables."""

import json
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import asdict, dataclass, replace
from math import inf
from pathlib import Path
from typing import Any

from fem_impact.answers.cost.judge import Judged, SettingKind, elements_of, front, judged_levels, judged_model
from fem_impact.answers.refine.extrapolate import QuantityLimit, quantity_limits
from fem_impact.answers.refine.quantities import FLOORS, QUANTITIES
from fem_impact.answers.refine.work import Levels, LevelsJob
from fem_impact.answers.simulate import refused_by
from fem_impact.case.case import Case
from fem_impact.errors import RunError
from fem_impact.files.atomic import directory_lock, write_text
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.job import STORE, Failure, Job, Store, Work
from fem_impact.jobs.run import run_jobs, stored_results
from fem_impact.outcome.record import Outcome, installed_versions, utc_now
from fem_impact.progress import ProgressMeter
from fem_impact.scene.shipped import replace_all
from fem_impact.scene.types import Scene, to_dict
from fem_impact.tables.table import Cell, Column, Table

SCHEMA = "fem-impact/cost/6"
FINER = 1  # levels beyond those of the default run
PLACES: Mapping[int, SettingKind] = {1: "levels", 2: "two places"}
"""Places of the barrier's grid at which levels run."""
VARIANTS: dict[str, dict[str, Any]] = {
    "without savings": {"accuracy.mass_scaling": 1, "accuracy.fine_zone": "even"},
    "fully integrated": {"accuracy.element": "full"},
    "mean dilatation": {"accuracy.element": "bbar"},
    "with half the default step": {"accuracy.step": 0.45},
}
"""Changes of the default run, whose effect on its numbers is measured, beside that of `STIFF`."""
STIFF = "without vibration"
CostRuns = Mapping[str, "Outcome | Levels | Failure"]


@dataclass(frozen=True, slots=True)
class CostStudy:
    """What accuracy costs for one scene.

    Attributes
    ----------
    scene : Scene
    limits : of each quantity, those of the finest levels, at two places where these tell any
    levels : by number of places, as they ran
    settings : judged, in order of processor time
    failures : jobs without a result, with the reason
    runs : results by the name of the job
    """

    scene: Scene
    limits: dict[str, QuantityLimit]
    levels: dict[int, Levels]
    settings: list[Judged]
    failures: list[dict[str, str]]
    runs: CostRuns

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "schema": SCHEMA,
            "created_utc": utc_now(),
            "versions": installed_versions(),
            "scene": to_dict(self.scene),
            "quantities": {
                quantity.name: {"unit": quantity.unit, **asdict(limit)}
                for quantity in QUANTITIES
                if (limit := self.limits.get(quantity.name))
            },
            "settings": [asdict(setting) for setting in self.settings],
            "failures": self.failures,
        }


def jobs_of(scene: Scene, finer: int, budget_s: float) -> list[Work[Outcome | Levels]]:
    """Return models, levels at one place and at two, and, without a budget, variants of the default run.

    A model that refuses the scene is left out.
    """
    scene = replace_all(scene, {"save.frames": 0})
    scene = replace(scene, accuracy=replace(scene.accuracy, target=None, offsets=None))
    jobs: list[Work[Outcome | Levels]] = [
        Job(f"{scene.id}: {fidelity}", scene, fidelity)
        for fidelity in ("rigid", "modal")
        if not refused_by(scene, fidelity)
    ]
    for places, kind in PLACES.items():
        at = replace(scene, accuracy=replace(scene.accuracy, offsets=places))
        jobs.append(LevelsJob(f"{scene.id}: {kind}", at, finer, budget_s=budget_s))
    if budget_s == inf:
        active = Case(scene).active
        stiff = [name for name in active if name != "vibration"]
        variants = VARIANTS | ({STIFF: {"effects": stiff}} if "vibration" in active else {})
        changed = {name: replace_all(scene, changes) for name, changes in variants.items()}
        jobs += [LevelsJob(f"{scene.id}: {name}", variant) for name, variant in changed.items()]
    return jobs


def measure(
    scene: Scene,
    out: Path,
    progress: ProgressMeter,
    finer: int = FINER,
    executor: Executor | None = None,
    budget_s: float = inf,
) -> CostStudy:
    """Run what is not stored in ``out`` yet, one job at a time so that times are times.

    Levels end ``finer`` ones beyond those of the default run, or where a wall time of ``budget_s``, s, would
    not hold another.

    Raises
    ------
    OutputPathError
        Another process writes to ``out``, or it cannot be written.
    RunError
        No two levels gave a result, so nothing is known of the limit.
    """
    # a process of its own for every job: its peak memory is its own
    processes = LocalProcesses(1, reuse=False) if executor is None else nullcontext(executor)
    with directory_lock(out), processes as process:
        results = run_jobs(jobs_of(scene, finer, budget_s), out / STORE, progress, process)
    return conclude(scene, results)


def judge_stored(
    scene: Scene, out: Path, progress: ProgressMeter, finer: int = FINER, budget_s: float = inf
) -> CostStudy:
    """Judge what `measure` has stored in ``out`` so far, and run nothing.

    Raises
    ------
    RunError
        As `measure`, and where nothing is stored.
    """
    with Store.open(out / STORE) as base:
        results = stored_results(base, jobs_of(scene, finer, budget_s), progress)
    if not results:
        raise RunError(
            f"{out}: holds no run of {scene.id} by this version of the program. "
            "Leave out stored=True to run its settings."
        )
    return conclude(scene, results)


def conclude(scene: Scene, results: CostRuns) -> CostStudy:
    """Judge the results; what lacks one is left out.

    Settings are in order of processor time, each with the quantities on whose Pareto front it lies.
    """
    named = {name.removeprefix(f"{scene.id}: "): result for name, result in results.items()}
    failures = [
        {"setting": name, "reason": result.reason}
        for name, result in named.items()
        if isinstance(result, Failure)
    ]
    levels = {
        n: run_levels for n, kind in PLACES.items() if isinstance(run_levels := named.get(kind), Levels)
    }
    limits_at = [limits for run_levels in levels.values() if (limits := quantity_limits(run_levels.meshes))]
    if not limits_at:
        reasons = " ".join(dict.fromkeys(failure["reason"] for failure in failures))
        raise RunError(
            f"{scene.id}: no two levels gave a result that resolves the contact. {reasons}".strip()
        )
    finest, judged = limits_at[-1], list[Judged]()
    for places, run_levels in levels.items():
        for n in range(2, len(run_levels.meshes) + 1):
            first, is_default = run_levels.meshes[:n], places == 1 and n == run_levels.default
            called = f"{n} levels to {1e3 * first[-1].size:.3g} mm" + ", two places" * (places == 2)
            judged.append(judged_levels(called, PLACES[places], first, finest, is_default))
    default = quantity_limits(levels[1].meshes[: levels[1].default]) if 1 in levels else {}
    for name, result in named.items():
        if isinstance(result, Outcome) and result.validity.finished:
            judged.append(judged_model("rigid" if name == "rigid" else "modal", result, finest))
        elif isinstance(result, Levels) and name in (*VARIANTS, STIFF):
            judged.append(judged_levels(f"default run {name}", "variant", result.meshes, default))
    fronts = {q.name: {setting.name for setting in front(judged, [q.name])} for q in QUANTITIES}
    marked = [
        replace(setting, front=[name for name, members in fronts.items() if setting.name in members])
        for setting in sorted(judged, key=lambda setting: setting.cpu_s)
    ]
    return CostStudy(scene, finest, levels, marked, failures, results)


WIDE = 400
"""Characters of a line of cost.txt, enough that no cell of its tables is wrapped."""
NAMES = tuple(quantity.name for quantity in QUANTITIES)
SCALARS = ("name", "kind", "levels", "tip_size_m", "elements", "cpu_s", "two_cores_s", "peak_memory_MB")
COLUMNS = (*SCALARS, *(f"{kind}_{name}" for kind in ("value", "error") for name in NAMES), "front")
SUMMARY = "fem-impact/cost-summary/6"
"""Schema of the stored form of several scenes' costs."""


def summarise(costs: Mapping[str, CostStudy]) -> dict[str, Any]:
    """Return the stored form of several scenes' costs, with one date and the versions for all."""
    shared = ("created_utc", "versions")
    whole = {name: cost.to_dict() for name, cost in costs.items()}
    first = next(iter(whole.values()))
    scenes = {
        name: {k: v for k, v in cost.items() if k not in (*shared, "schema")} for name, cost in whole.items()
    }
    return {"schema": SUMMARY, **{key: first[key] for key in shared}, "scenes": scenes}


def write_cost(cost: CostStudy, out: Path) -> None:
    """Write cost.json, cost.csv and cost.txt."""
    write_text(out / "cost.json", json.dumps(cost.to_dict(), indent=1, allow_nan=False) + "\n")
    rows: list[list[Cell]] = []
    for setting in cost.settings:
        numbers = (values.get(name) for values in (setting.value, setting.error) for name in NAMES)
        rows.append([*(getattr(setting, key) for key in SCALARS), *numbers, " ".join(setting.front)])
    write_text(out / "cost.txt", text_table(cost) + "\n")
    write_text(out / "cost.csv", Table.of(COLUMNS, rows).csv())


COST_COLUMNS = (
    Column("setting", left=True),
    Column("cpu_s", "processor time, s", digits=3),
    Column("elements"),
    Column("peak_memory_MB", "memory, MB"),
)


def text_table(cost: CostStudy, names: Sequence[str] = NAMES) -> str:
    """Return the tables of `cost_tables` one below the other, each under its caption."""
    shown = (f"{caption}\n{table.terminal(WIDE)}" for _, caption, table in cost_tables(cost, names))
    return "\n\n".join(shown)


def cost_tables(cost: CostStudy, names: Sequence[str] = NAMES) -> list[tuple[str, str, Table]]:
    """Return name, caption and table: errors of the settings, the levels one by one, changes by variants.

    The first starts with the limit of each quantity; an asterisk marks the Pareto front of that quantity.
    Tables without rows are left out.
    """
    shown = [one for one in QUANTITIES if one.name in names and one.name in cost.limits]
    listed = [quantity.name for quantity in shown]
    columns = (*COST_COLUMNS, *map(Column, listed))
    settings = [setting for setting in cost.settings if setting.kind != "variant"]
    no_cost, limits = ("",) * (len(COST_COLUMNS) - 1), [cost.limits[name] for name in listed]
    # of each quantity, above the settings
    of_limits: list[tuple[Cell, ...]] = [
        ("unit", *no_cost, *(quantity.unit for quantity in shown)),
        ("limit", *no_cost, *(limit.value for limit in limits)),
        ("its band, %", *no_cost, *(f"{100 * limit.error:.2g}" for limit in limits)),
    ]
    of_levels: list[tuple[Cell, ...]] = [
        (
            *(places, n, f"{1e3 * level.size:.3g}", level.cpu_s, elements_of(level)),
            *(level.mean(quantity.keys) for quantity in shown),
        )
        for places, levels in cost.levels.items()
        for n, level in enumerate(levels.meshes, 1)
    ]
    tables = (
        (
            "errors",
            f"Errors in % of the quantity ({FLOORS}); of levels the band that they tell, or their distance "
            "from the limit if that is more; *: no other setting is both quicker and more accurate",
            columns,
            [*of_limits, *(_line(setting, listed) for setting in settings)],
        ),
        (
            "levels",
            "Each level: processor time of all its runs, and the means of what they gave",
            (Column("places"), Column("level"), Column("mm"), *COST_COLUMNS[1:3], *map(Column, listed)),
            of_levels,
        ),
        (
            "variants",
            "Changes of the default run, in %",
            columns,
            [_line(setting, listed) for setting in cost.settings if setting.kind == "variant"],
        ),
    )
    return [(name, caption, Table(head, tuple(rows))) for name, caption, head, rows in tables if rows]


def _line(setting: Judged, names: Sequence[str]) -> tuple[Cell, ...]:
    """Return name and cost of a setting, and its errors in per cent."""
    memory = setting.peak_memory_MB
    costs = (setting.cpu_s, setting.elements, None if memory is None else round(memory))
    shown = [
        None
        if (error := setting.error[name]) is None
        else f"{'*' if name in setting.front else ''}{100 * error:.3g}"
        for name in names
    ]
    return (setting.name, *costs, *shown)
