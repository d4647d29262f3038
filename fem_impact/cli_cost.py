"""The command ``cost``: what accuracy costs in time for a scene, or for all scenes of the paper."""

from __future__ import annotations

import json
import sys
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli_changes import changed_scene
from fem_impact.cli_meter import chosen_meter
from fem_impact.cli_out import checked_out
from fem_impact.cli_parser import Options
from fem_impact.cli_print import print_json
from fem_impact.errors import RunError, SceneError

if TYPE_CHECKING:
    from fem_impact.cost import Cost, Mesh

__all__ = ["cost"]

PAPER = "paper"


def cost(options: Options) -> int:
    """Run the ladder of settings, judge it, and name the cheapest setting that does."""
    from fem_impact.cost import chosen
    from fem_impact.scene.units import parse_quantity, parse_share

    names = chosen(name.strip() for name in options.of.split(",") if name.strip())
    target = parse_share(options.target, "--target") if options.target else None
    budget = parse_quantity(options.budget, "time", "--budget") if options.budget else None
    family = _family(options.across)
    if options.scene == PAPER:
        return _paper(options, names, family)
    scene = changed_scene(options.scene, options.changes)
    out = checked_out(options.out or Path("results") / "cost" / scene.id)
    from fem_impact.cost import advice, measure, pair_sentence, text_table, write_cost

    with closing(chosen_meter(options)) as meter:
        found = measure(scene, out, meter, family)
    write_cost(found, out, names)
    answers = advice(found.settings, names, target, budget)
    if target is not None:
        answers.append(pair_sentence(found.settings, found.quantities, names, target))
    if options.json:
        print_json({**found.to_dict(), "advice": answers})
    else:
        sys.stdout.write("\n".join([text_table(found), "", *answers, f"results: {out}"]) + "\n")
    return RunError.exit_code if found.failures else 0


def _paper(options: Options, names: tuple[str, ...], family: tuple[Mesh, ...]) -> int:
    """Measure all sets of the paper, one store each, and write summary.json."""
    from fem_impact.cost import measure, summarise, summary_markdown, write_cost
    from fem_impact.output import write_text
    from fem_impact.scene import MEASURED_SETS

    out = checked_out(options.out or Path("results") / "cost" / PAPER)
    costs: dict[str, Cost] = {}
    for name in MEASURED_SETS:
        scene = changed_scene(name, options.changes)
        with closing(chosen_meter(options)) as meter:
            costs[name] = measure(scene, out / name, meter, family)
        write_cost(costs[name], out / name, names)
    document = summarise(costs)
    write_text(out / "summary.json", json.dumps(document, indent=1, allow_nan=False) + "\n")
    write_text(out / "summary.md", summary_markdown(document))
    if options.json:
        print_json(document)
    else:
        sys.stdout.write(f"results: {out}\nsummary: {out / 'summary.json'}\n")
    return RunError.exit_code if any(cost.failures for cost in costs.values()) else 0


def _family(across: str) -> tuple[Mesh, ...]:
    """Return the meshes of the family, from coarse to fine."""
    from fem_impact.cost import FAMILY, Mesh

    if not across:
        return FAMILY
    words = [word.strip() for word in across.split(",")]
    cells = sorted({int(word) for word in words if word.isdecimal()})
    if len(cells) != len(words) or len(cells) < 2 or cells[0] < 6 or any(n % 2 for n in cells):
        raise SceneError(
            "must name two or more different even numbers of cells, at least 6.",
            key="--across",
            value=across,
            remedy="Write --across 6,8,10.",
        )
    return tuple(Mesh(n, FAMILY[0].levels) for n in cells)
