"""The command ``cost``: what accuracy costs in time for a scene, or for all scenes of the paper."""

from __future__ import annotations

import json
import sys
from contextlib import closing
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.commands.common import changed_scene, checked_out, print_json
from fem_impact.commands.options import Options
from fem_impact.commands.terminal import chosen_meter
from fem_impact.errors import RunError, SceneError, UsageError
from fem_impact.tables.text import wrapped

if TYPE_CHECKING:
    from fem_impact.cost.measure import CostStudy
    from fem_impact.cost.settings import Mesh
    from fem_impact.scene.types import Scene


PAPER = "paper"


def cost(options: Options) -> int:
    """Run a scene with all settings and report errors, costs and the cheapest sufficient setting."""
    from fem_impact.cost.quantities import chosen
    from fem_impact.plan.limits import require_turned
    from fem_impact.scene.units import option_quantity

    asked = [name.strip() for name in options.of.split(",") if name.strip()]
    target = _share(options.target) if options.target else None
    budget = option_quantity(options.budget, "time", "--budget") if options.budget else None
    if options.scene == PAPER and (target or budget):
        remedy = "Leave them out, or name one scene."
        raise UsageError("are about one scene.", key="--target, --budget", remedy=remedy)
    if options.scene == PAPER:
        return _paper(options, chosen(asked))
    scene = changed_scene(options.scene, options.changes)
    require_turned(scene, "a ladder of costs")
    names, family = chosen(asked, scene), _family(scene, options.finest)
    out = checked_out(options.out or Path("results") / "cost" / scene.id)
    from fem_impact.cost.document import text_table, write_cost
    from fem_impact.cost.judge import advice, pair_sentence
    from fem_impact.files.lock import directory_lock

    with directory_lock(out):
        study = _measured(scene, out, options, family, budget or inf)
        write_cost(study, out, names)
    answers = [*_left_out(scene, family, study, budget), *advice(study.settings, names, target, budget)]
    if target is not None:
        answers.append(pair_sentence(study.settings, study.quantities, names, target))
    if options.json:
        print_json({**study.to_dict(), "advice": answers})
    else:
        lines = [line for answer in answers for line in wrapped(answer)]
        lines += [f"all quantities: {out / 'cost.txt'}", f"results: {out}"]
        sys.stdout.write("\n".join([text_table(study, names), "", *lines]) + "\n")
    return RunError.exit_code if study.failures else 0


def _share(text: str) -> float:
    """Read the error that ``--target`` allows."""
    from fem_impact.scene.units import parse_share

    try:
        return parse_share(text, "--target")
    except SceneError as error:
        raise UsageError(error.problem, key="--target", value=text, remedy=error.remedy) from None


def _family(scene: Scene, finest: str) -> list[Mesh]:
    """Return the meshes whose tip elements are at least ``finest`` in size."""
    from fem_impact.cost.settings import FAMILY
    from fem_impact.scene.units import option_quantity

    least = option_quantity(finest, "length", "--finest") if finest else 0.0
    sizes = [mesh.sizes(scene)[0] for mesh in FAMILY]
    if least > sizes[1]:
        raise UsageError(
            "leaves fewer than two meshes.",
            key="--finest",
            value=finest,
            remedy=f"Give at most {1e3 * sizes[1]:.3g} mm.",
        )
    return [mesh for mesh, size in zip(FAMILY, sizes, strict=True) if size >= least]


def _measured(
    scene: Scene, out: Path, options: Options, family: list[Mesh], budget: float = inf
) -> CostStudy:
    """Run all settings, or with ``--stored`` read those that have run."""
    from fem_impact.cost.measure import judge_stored, measure

    with closing(chosen_meter(options)) as meter:
        if options.stored:
            return judge_stored(scene, out, meter, family)
        return measure(scene, out, meter, family, budget_s=budget)


def _left_out(scene: Scene, family: list[Mesh], study: CostStudy, budget: float | None) -> list[str]:
    """Return a sentence that names the settings that the budget left out."""
    from fem_impact.cost.settings import ladder

    done = {one.name for one in study.settings} | {failure["setting"] for failure in study.failures}
    missing = [setting.name for setting in ladder(scene, family) if setting.name not in done]
    return [f"Not run within {budget:.3g} s: {', '.join(missing)}."] if budget and missing else []


def _paper(options: Options, names: tuple[str, ...]) -> int:
    """Measure all sets of the paper, one store each, and write summary.json."""
    from fem_impact.cost.document import summary_markdown, write_cost
    from fem_impact.cost.to_target import summarise
    from fem_impact.files.atomic import write_text
    from fem_impact.files.lock import directory_lock
    from fem_impact.scene.types import MEASURED_SETS

    scenes = {name: changed_scene(name, options.changes) for name in MEASURED_SETS}
    families = {name: _family(scene, options.finest) for name, scene in scenes.items()}
    out = checked_out(options.out or Path("results") / "cost" / PAPER)
    costs: dict[str, CostStudy] = {}
    with directory_lock(out):
        for name, scene in scenes.items():
            costs[name] = _measured(scene, out / name, options, families[name])
            write_cost(costs[name], out / name, names)
        document = summarise(costs)
        write_text(out / "summary.json", json.dumps(document, indent=1, allow_nan=False) + "\n")
        write_text(out / "summary.md", summary_markdown(document))
    if options.json:
        print_json(document)
    else:
        sys.stdout.write(f"results: {out}\nsummary: {out / 'summary.json'}\n")
    return RunError.exit_code if any(cost.failures for cost in costs.values()) else 0
