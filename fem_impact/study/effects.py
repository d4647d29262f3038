"""Ablation: what the scene's own choice of effects leaves out, beside everything on; and what effects cost.

The thirteen measured sets and a designed set of others (short and long, slow and fast, low and high angle,
hard and soft) run twice, with ``auto`` and with all effects; a few run again with one effect changed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from fem_impact.effects.registry import BARRIERS, EFFECTS, NAMES
from fem_impact.effects.slots import Harm, quick_impact
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.physics.beam_impact import BeamImpact
from fem_impact.plan.choose import choices, everything, resolved
from fem_impact.plan.limits import widest_tip_size
from fem_impact.plan.plan import plan as plan_of
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.study.document import Request, Sheet, StudyReport, StudyResult, publish
from fem_impact.tables.table import Cell, Table

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter
    from fem_impact.scene.types import Scene


TIP = 0.8e-3  # m; coarse: both runs of a pair share it
WITHIN_E, WITHIN_VIB, LEAST_VIB = 0.02, 0.1, 1e-4  # of e, of E_vib, of E_0
COST_COLUMNS = (
    *("run", "CPU, of auto", "a step, of auto"),
    *("change of e", "e expected", "change of E_vib/E_0", "E_vib/E_0 expected"),
)
BESIDE_COLUMNS = ("scene", "e", "e expected", "E_vib/E_0", "E_vib/E_0 expected", "found over expected")
COSTED = ("t5b", "t3-machined", "t6-17")
BASE = "t5b"


def _speed(v: float) -> dict[str, Any]:
    return {"impact.v_n": f"{-v} m/s", "impact.v_t": f"{-v} m/s"}


def _yield(body: str, stress: float) -> dict[str, Any]:
    return {f"{body}.material.{key}": f"{stress} MPa" for key in ("yield_stress", "ultimate_stress")}


DESIGNED: Mapping[str, Mapping[str, Any]] = {
    "short-slow": {"projectile.length": "40 mm", **_speed(0.2)},
    "short-fast": {"projectile.length": "40 mm", **_speed(8.0)},
    "long-slow": {"projectile.length": "200 mm", **_speed(0.2)},
    "long-fast": {"projectile.length": "200 mm", **_speed(8.0)},
    "low-angle": {"impact.angle": "5 deg"},
    "high-angle": {"impact.angle": "75 deg"},
    "axial": {"impact.angle": "0 deg", "impact.v_t": "0 m/s", "projectile.tip": "A"},
    "slippery": {"surface.friction": 0.0},
    "soft-plate": _yield("barrier", 80.0),
    "hard-steels": {**_yield("projectile", 3000.0), **_yield("barrier", 3000.0)},
    "stiff-barrier": {
        "projectile.material.E": "70 GPa",
        "barrier.material.E": "10000 GPa",
        **_yield("barrier", 90000.0),
    },
    "plastic-rod": {
        "projectile.material.E": "3 GPa",
        "projectile.material.nu": 0.35,
        "projectile.material.rho": "1180 kg/m3",
        **_yield("projectile", 70.0),
    },
    "stub-on-lead": {"projectile.length": "30 mm", **_speed(0.2), **_yield("barrier", 10.0)},
    "hard-gentle": {**_speed(0.05), **_yield("projectile", 3000.0), **_yield("barrier", 3000.0)},
}


def plan(request: Request, results: Results) -> list[Job]:
    """Return both runs of every scene, and those with one effect changed."""
    jobs = []
    for name, scene in _scenes(request).items():
        jobs += [Job(f"{name}-auto", scene), Job(f"{name}-everything", everything(scene))]
        if name in COSTED:
            jobs += [Job(f"{name}{change}", replace(scene, effects=e)) for change, e in _changes(scene)]
    return jobs


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Tell where auto differs from everything on, and what each effect costs."""
    scenes = _scenes(request)
    pairs = {name: (results[f"{name}-auto"], results[f"{name}-everything"]) for name in scenes}
    rows = [
        row(name, auto, whole)
        for name, (auto, whole) in pairs.items()
        if isinstance(auto, Outcome) and isinstance(whole, Outcome)
    ]
    costs = [
        cost_row(f"{name}{change}", run, base, told(scene, effects))
        for name, scene in scenes.items()
        if name in COSTED and isinstance(base := results[f"{name}-auto"], Outcome)
        for change, effects in _changes(scene)
        if isinstance(run := results[f"{name}{change}"], Outcome)
    ]
    beside = [
        expected_row(name, whole, quick_impact(everything(scenes[name])))
        for name, (_, whole) in pairs.items()
        if isinstance(whole, Outcome)
    ]
    return publish(_study_report(rows, costs, beside), request, results)


def row(name: str, auto: Outcome, whole: Outcome) -> list[Cell]:
    """Return one line of the ablation table: what auto changes; vibration that is off counts as none."""
    e, e_all = (known(run.restitution.edge.e) for run in (auto, whole))
    vib, vib_all = _vibration(auto), _vibration(whole)
    same = abs(e - e_all) <= WITHIN_E * abs(e_all) and _near(vib, vib_all)
    on, on_all = auto.provenance.effects, whole.provenance.effects
    off = [effect for effect in NAMES if effect in on_all and effect not in on]
    cost = auto.cost.cpu / whole.cost.cpu if whole.cost.cpu else None
    changes = [e_all, e - e_all, vib_all, vib - vib_all, cost]
    return [name, ", ".join(off) or "none", *changes, "within" if same else "beyond"]


def told(scene: Scene, effects: Sequence[str]) -> Harm:
    """Return the changes of e and E_vib that are expected of a change of one effect.

    They are those of two strikes; of an effect that a strike does not hold, their sizes alone.
    """
    changed = effects[-1].removeprefix("-")
    if EFFECTS[changed].harm and changed not in BARRIERS:
        return next(choice.harm for choice in choices(scene) if choice.name == changed)
    before, after = (quick_impact(resolved(s)) for s in (scene, replace(scene, effects=tuple(effects))))
    return Harm(after.e - before.e, after.E_vib - before.E_vib)


def expected_row(name: str, whole: Outcome, told: BeamImpact) -> list[Cell]:
    """Return e and E_vib of a run beside those of a strike; vibration as found over expected."""
    e, vib = known(whole.restitution.edge.e), known(whole.energy.vibration)
    return [name, e, told.e, vib, told.E_vib, vib / told.E_vib if told.E_vib else None]


def cost_row(name: str, run: Outcome, base: Outcome, harm: Harm) -> list[Cell]:
    """Return one line of the cost table: times over those of auto, changes of e and E_vib, those expected."""
    e, e_base = (known(r.restitution.edge.e) for r in (run, base))
    times = [r.cost.cpu / steps if (steps := known(r.cost.steps)) else 0.0 for r in (run, base)]
    return [
        *(name, run.cost.cpu / base.cost.cpu if base.cost.cpu else None),
        times[0] / times[1] if times[1] else None,
        *(e - e_base, harm.e, _vibration(run) - _vibration(base), harm.E_vib),
    ]


def _vibration(run: Outcome) -> float:
    """Return E_vib over E_0; that of a rod that cannot vibrate is 0."""
    return or_none(run.energy.vibration) or 0.0


def _near(vib: float, vib_all: float) -> bool:
    return abs(vib - vib_all) <= max(WITHIN_VIB * vib_all, LEAST_VIB)


def _scenes(request: Request) -> dict[str, Scene]:
    """Return the scenes asked for, all with effects chosen by themselves and a coarse tip."""
    every = {name: load(name) for name in MEASURED_SETS}
    every |= {name: replace_all(load(BASE), changes) for name, changes in DESIGNED.items()}
    wanted = request.ids or (("t5b", "stiff-barrier", "stub-on-lead") if request.quick else tuple(every))
    return {name: _coarse(every[name]) for name in wanted}


def _coarse(scene: Scene) -> Scene:
    """Return the scene with effects chosen by themselves, on a tip as coarse as its contact allows."""
    scene = replace_all(scene, {"effects": "auto", "save.frames": 0})
    size = min(TIP, widest_tip_size(plan_of(scene, "modal").bodies))
    return replace_all(scene, {"accuracy.tip_size": f"{size * 1e3:.2g} mm"})


def _changes(scene: Scene) -> list[tuple[str, tuple[str, ...]]]:
    """Return each change of one effect: its name and the effects to state."""
    found: list[tuple[str, tuple[str, ...]]] = []
    for choice in choices(scene):
        if choice.name in BARRIERS and not choice.on:
            found.append((f"-with-{choice.name}", ("auto", choice.name)))
        elif choice.name not in BARRIERS:
            mark, word = ("-", "without") if choice.on else ("", "with")
            found.append((f"-{word}-{choice.name}", ("auto", f"{mark}{choice.name}")))
    return found


def _within(factor: float, beside: list[list[Cell]]) -> int:
    """Return how many scenes vibrate within a factor of what was expected."""
    ratios = [line[-1] for line in beside if isinstance(line[-1], float)]
    return sum(1 / factor <= ratio <= factor for ratio in ratios)


def _study_report(rows: list[list[Cell]], costs: list[list[Cell]], beside: list[list[Cell]]) -> StudyReport:
    beyond = [str(line[0]) for line in rows if line[-1] == "beyond"]
    cheaper = [line for line in rows if isinstance(line[6], float) and line[6] < 1]
    columns = (
        *("scene", "on: all but", "e, all on", "change of e", "E_vib/E_0, all on", "change of E_vib/E_0"),
        *("CPU, of all on", "verdict"),
    )
    limits = f"{WITHIN_E:.0%} of e and {WITHIN_VIB:.0%} of E_vib or {LEAST_VIB:g} of E_0"
    return StudyReport(
        study="effects",
        title="Effects chosen by the scene, beside everything on",
        findings=[
            f"{len(rows) - len(beyond)} of {len(rows)} scenes agree with everything on within {limits}.",
            f"{len(cheaper)} of {len(rows)} take less processor time.",
            *([f"Beyond: {', '.join(beyond)}."] if beyond else []),
            f"E_vib is met by a quick strike within a factor of two in {_within(2, beside)}, of three in "
            f"{_within(3, beside)} of {len(beside)} scenes.",
        ],
        sheets=[
            Sheet("ablation", "Auto beside everything on, on the same coarse mesh.", Table.of(columns, rows)),
            Sheet(
                "costs",
                "One effect changed: time and time a step over those of auto; changes of e and E_vib, and "
                "about how large `check` expects them.",
                Table.of(COST_COLUMNS, costs),
            ),
            Sheet(
                "expected",
                "Everything on beside the quick strike that `check` tells changes from.",
                Table.of(BESIDE_COLUMNS, beside),
            ),
        ],
        assumptions=[
            f"Tips of {TIP * 1e3:g} mm, less under a smaller contact: differences count here, not values."
        ],
    )
