"""The command ``cost``: what accuracy costs in time for a scene, or for all scenes of the paper."""

import json
from contextlib import closing
from math import inf
from pathlib import Path

from fem_impact.answers.cost.measure import (
    FINER,
    CostStudy,
    judge_stored,
    measure,
    summarise,
    text_table,
    write_cost,
)
from fem_impact.answers.refine.quantities import chosen
from fem_impact.answers.report import Request, StudyReport, publish
from fem_impact.cli.page import asked_page, write_study_page
from fem_impact.cli.parser import PAPER, Options, stated_budget
from fem_impact.cli.paths import checked_out
from fem_impact.cli.scene_options import asked_scene, changed_scene, command_line
from fem_impact.cli.terminal import chosen_meter, print_answer
from fem_impact.errors import RunError, SceneError, UsageError
from fem_impact.evidence.studies.cost_report import answers, paper_report, scene_report
from fem_impact.files.atomic import directory_lock, write_text
from fem_impact.pages.write import page
from fem_impact.scene.types import MEASURED_SETS, Scene
from fem_impact.scene.units import parse_share
from fem_impact.tables.text import wrapped

PAGE = "report.html"
STATED = ("target", "budget", "of", "finer")
"""Options that the page repeats."""


def cost(options: Options) -> int:
    """Run a scene with all settings and report errors, costs and the cheapest sufficient setting."""
    asked = [name.strip() for name in options.of.split(",") if name.strip()]
    try:
        target = parse_share(options.target, "--target") if options.target else None
    except SceneError as error:
        remedy = error.remedy
        raise UsageError(error.problem, key="--target", value=options.target, remedy=remedy) from None
    budget = stated_budget(options)
    if options.scene == PAPER and (target or budget):
        remedy = "Leave them out, or name one scene."
        raise UsageError("are about one scene.", key="--target, --budget", remedy=remedy)
    if options.scene == PAPER:
        return _paper(options, chosen(asked))
    scene = asked_scene(options)
    names = chosen(asked, scene)
    if options.page:
        raise UsageError("shows all sets.", key="--page", remedy="Leave it out, or run `cost paper`.")
    out = checked_out(options.out or Path("results") / "cost" / scene.id)

    with directory_lock(out):
        study = _measured(scene, out, options, budget or inf)
        notes = _write(options, study, scene_report(study, names, target, budget), out)
    advice = answers(study, names, target, budget)
    lines = [line for sentence in advice for line in wrapped(sentence)]
    paths = [f"all quantities: {out / 'cost.txt'}", f"page: {out / PAGE}", f"results: {out}"]
    text = "\n".join([*lines, "", text_table(study, names), "", *paths]) + "\n"
    print_answer(options, {**study.to_dict(), "advice": advice, "notes": notes}, text, notes)
    return RunError.exit_code if study.failures else 0


def _write(options: Options, study: CostStudy, report: StudyReport, out: Path, scene: str = "") -> list[str]:
    """Write the tables of a scene's costs and its page; return what could not be made."""
    write_cost(study, out)
    publish(report, Request(out, line=command_line(options, "cost", *STATED, scene=scene)), study.runs)
    return page(out)


def _measured(scene: Scene, out: Path, options: Options, budget: float = inf) -> CostStudy:
    """Run all settings, or with ``--stored`` read those that have run."""
    finer = int(options.finer or FINER)
    with closing(chosen_meter(options)) as meter:
        if options.stored:
            return judge_stored(scene, out, meter, finer, budget)
        return measure(scene, out, meter, finer, budget_s=budget)


def _paper(options: Options, names: tuple[str, ...]) -> int:
    """Measure all sets of the paper, one store and page each; write summary.json and a page over all."""
    stated_page = asked_page(options)
    scenes = {name: changed_scene(name, options.changes) for name in MEASURED_SETS}
    out = checked_out(options.out or Path("results") / "cost" / PAPER)
    costs: dict[str, CostStudy] = {}
    with directory_lock(out):
        for name, scene in scenes.items():
            costs[name] = _measured(scene, out / name, options)
            _write(options, costs[name], scene_report(costs[name], names), out / name, name)
        document = summarise(costs)
        write_text(out / "summary.json", json.dumps(document, indent=1, allow_nan=False) + "\n")
        runs = {name: run for cost in costs.values() for name, run in cost.runs.items()}
        line = command_line(options, "cost", *STATED)
        made = publish(paper_report(costs), Request(out, line=line), runs)
        notes = page(out)
    if stated_page:
        write_study_page(stated_page, line, made.text, out)
    lines = [line for finding in made.document["findings"] for line in wrapped(finding)]
    paths = [f"page: {out / PAGE}", f"results: {out}", f"summary: {out / 'summary.json'}"]
    print_answer(options, {**document, "notes": notes}, "\n".join([*lines, "", *paths]) + "\n", notes)
    return RunError.exit_code if any(cost.failures for cost in costs.values()) else 0
