"""Ablation: results with the effects that a scene chooses beside those with all on; cost of each effect.

The thirteen measured sets and a designed set of others (short and long, slow and fast, low and high angle,
hard and soft) run twice, with ``auto`` and with all effects; a few run again with one effect changed.
"""

from dataclasses import replace

from fem_impact import Case, Outcome, Scene, known, load, replace_all
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.case.cells import widest_tip_size
from fem_impact.case.choose import all_effects
from fem_impact.case.effects.registry import BARRIERS, NAMES
from fem_impact.evidence.data import read_stated, scene_keys
from fem_impact.evidence.studies.declared import DeclaredSweep, Runs
from fem_impact.outcome.keys import or_none
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.tables.table import Cell, Table

TIP = 0.8e-3  # m, tip size: coarse, the same for both runs of a pair
WITHIN_E, WITHIN_VIB, LEAST_VIB = 0.02, 0.1, 1e-4  # accepted changes: of e, of E_vib, of E_0
COST_COLUMNS = ("run", "CPU, of auto", "a step, of auto", "change of e", "change of E_vib/E_0")
COSTED = ("t5b", "t3-machined", "t6-17")  # scenes that run with single effects changed
PAIR = ("auto", "everything")


DESIGNED = {name: scene_keys(stated) for name, stated in read_stated("studies/data/designed.toml").items()}
"""Changed keys of t5b."""


def all_on(scene: Scene) -> Scene:
    """Return the scene with all effects on that it can have."""
    impossible = _impossible(scene)
    return replace(
        scene, effects=tuple(name for name in all_effects(scene.effects) if name not in impossible)
    )


def _impossible(scene: Scene) -> set[str]:
    """Return the effects of which the scene does not state what they are about."""
    viscous = scene.projectile.material.loss_factor or scene.barrier.material.loss_factor
    has = {
        "machined-skin": bool(scene.projectile.material.skin or scene.barrier.material.skin),
        "contact-loss": bool(viscous),
        "plate-bending": scene.barrier.bends,
    }
    return {name for name, possible in has.items() if not possible}


def row(name: str, auto: Outcome, whole: Outcome) -> list[Cell]:
    """Return a row of the ablation table: ``auto`` beside all effects; vibration that is off counts as 0."""
    e, e_all = (known(run.restitution.edge.e) for run in (auto, whole))
    vib, vib_all = _vibration(auto), _vibration(whole)
    same_e = abs(e - e_all) <= WITHIN_E * abs(e_all)
    same_vib = abs(vib - vib_all) <= max(WITHIN_VIB * vib_all, LEAST_VIB)
    on, on_all = auto.provenance.effects, whole.provenance.effects
    off = [effect for effect in NAMES if effect in on_all and effect not in on]
    cost = auto.cost.cpu / whole.cost.cpu if whole.cost.cpu else None
    changes = [e_all, e - e_all, vib_all, vib - vib_all, cost]
    return [name, ", ".join(off) or "none", *changes, "within" if same_e and same_vib else "beyond"]


def cost_row(name: str, run: Outcome, base: Outcome) -> list[Cell]:
    """Return a row of the cost table: times over those of ``auto``, changes of e and E_vib/E_0."""
    e, e_base = (known(r.restitution.edge.e) for r in (run, base))
    times = [r.cost.cpu / steps if (steps := known(r.cost.steps)) else 0.0 for r in (run, base)]
    return [
        *(name, run.cost.cpu / base.cost.cpu if base.cost.cpu else None),
        times[0] / times[1] if times[1] else None,
        *(e - e_base, _vibration(run) - _vibration(base)),
    ]


def _vibration(run: Outcome) -> float:
    """Return E_vib/E_0; 0 for a rod that cannot vibrate."""
    return or_none(run.energy.vibration) or 0.0


def _scenes(request: Request) -> dict[str, Scene]:
    """Return the requested scenes by name, with ``auto`` effects.

    Their tip size is `TIP`, or the largest that their contact allows if that is less.
    """
    scenes = {name: load(name) for name in MEASURED_SETS}
    scenes |= {name: replace_all(load("t5b"), changes) for name, changes in DESIGNED.items()}
    wanted = request.ids or (("t5b", "stiff-barrier", "stub-on-lead") if request.quick else tuple(scenes))
    coarse = {}
    for name in wanted:
        # a contact that the coarse mesh does not resolve is the same in both runs of a pair
        keep = {"effects": "auto", "save.frames": 0, "accuracy.unresolved": "report"}
        scene = replace_all(scenes[name], keep)
        size = min(TIP, widest_tip_size(Case.of(scene, "modal").bodies))
        coarse[name] = replace_all(scene, {"accuracy.tip_size": f"{size * 1e3:.2g} mm"})
    return coarse


def _variants(name: str, scene: Scene) -> dict[str, tuple[Scene, str]]:
    """Return the scene with ``auto`` and with all effects; of `COSTED` also with each effect changed."""
    variants = {"auto": scene, "everything": all_on(scene)}
    for choice in Case(scene).choices if name in COSTED else ():
        if choice.name in _impossible(scene) or (choice.name in BARRIERS and choice.on):
            continue
        mark, word = ("-", "without") if choice.on else ("", "with")
        variants[f"{word}-{choice.name}"] = replace(scene, effects=("auto", f"{mark}{choice.name}"))
    return {variant: (changed, "solid") for variant, changed in variants.items()}


def _report(runs: Runs) -> StudyReport:
    """Return where ``auto`` differs from all effects, and what each effect costs."""
    rows = [row(name, r["auto"], r["everything"]) for name, r in runs.items() if {*PAIR} <= set(r)]
    costs = [
        cost_row(f"{name}-{variant}", run, finished["auto"])
        for name, finished in runs.items()
        if "auto" in finished
        for variant, run in finished.items()
        if variant not in PAIR
    ]
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
            "With the effects that the program chooses, "
            f"{len(rows) - len(beyond)} of {len(rows)} scenes give what all effects on give, within {limits}"
            + (f"; beyond: {', '.join(beyond)}" if beyond else "")
            + f". {len(cheaper)} take less processor time."
        ],
        sheets=[
            Sheet("ablation", "Auto beside everything on, on the same coarse mesh.", Table.of(columns, rows)),
            Sheet(
                "costs",
                "One effect changed: time and time a step over those of auto; changes of e and E_vib.",
                Table.of(COST_COLUMNS, costs),
            ),
        ],
        assumptions=[
            f"Tips of {TIP * 1e3:g} mm, less under a smaller contact: differences count here, not values."
        ],
    )


_SWEEP = DeclaredSweep(_scenes, _variants, _report)
plan, conclude = _SWEEP.plan, _SWEEP.conclude
