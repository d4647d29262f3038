"""The command ``study``: many runs, in local processes or on a cluster, and the conclusions from them."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli.page import asked_page, write_study_page
from fem_impact.cli.parser import CommandParser, Options, stated
from fem_impact.cli.paths import checked_out, told_kept
from fem_impact.cli.terminal import chosen_meter, print_answer, print_json, print_markdown, print_notes
from fem_impact.errors import RunError, SceneError, UsageError, did_you_mean
from fem_impact.evidence.data import read_stated
from fem_impact.progress import clock_text

if TYPE_CHECKING:
    from fem_impact.answers.report import Request
    from fem_impact.jobs.run import JobGroup, Pace, WorkForecast


@dataclass(frozen=True, slots=True)
class Study:
    """What the help of a study tells.

    Attributes
    ----------
    summary : its line in the list of studies
    about : what it computes and concludes
    size, quick : runs and processor time of the whole study, and of the one with ``--quick``
    runs, quick_runs : the same numbers of runs; a test holds them to the study
    sets : the measured sets that it takes when none is named; empty where it takes none
    draws : whether it draws scenes at random, of which a first part may be asked for
    """

    summary: str
    about: str
    size: str
    quick: str
    runs: int
    quick_runs: int
    sets: str = ""
    draws: bool = False


STUDIES = {name: Study(**told) for name, told in read_stated("studies/data/studies.toml").items()}

OWN_TESTS = ("sets",)
"""Studies that take scene files with own tests."""
REPORT = "one page over all studies beside it"


def add_studies(parser: CommandParser) -> None:
    """Add the studies, each a command of its own, and the page over all of them."""
    studies = parser.add_subparsers(
        title="studies",
        dest="name",
        metavar="NAME",
        required=True,
        description="fem-impact study NAME --help tells what a study does and how long it takes",
    )
    for name, one in STUDIES.items():
        first_look = f"With --quick, which is a first look and no result: {one.quick}."
        files = " or scene files with own tests" if name in OWN_TESTS else ""
        taken = f"measured sets, such as t5b{files} (default: {one.sets})"
        options = [
            *([{"like": "ids", "help": taken}] if one.sets else []),
            "quick",
            *(("first", "seed") if one.draws else ()),
            {"like": "out", "help": f"where to write (default: results/{name})"},
            *("workers", "scheduler", "estimate", "page"),
        ]
        told = {
            "about": f"{one.about}\n\nSize and processor time: {one.size}. {first_look}",
            "examples": [f"fem-impact study {name} {option}" for option in ("--quick", "--estimate")],
            "options": options,
        }
        studies.add_parser(name, help=one.summary).state(study, told)
    studies.add_parser("report", help=REPORT).state(study, stated()["study"]["report"])


def study(options: Options) -> int:
    """Run the named study and print its result, or say how long it would take."""
    ids = _checked_ids(options.ids, own=options.name in OWN_TESTS)
    out = checked_out(options.out or Path("results") / options.name)
    from fem_impact.answers.report import Request

    if options.name == "report":
        # write one page over the studies in the parent directory of ``out``
        from fem_impact.files.atomic import directory_lock
        from fem_impact.pages.all_page import write_all

        with directory_lock(out):
            if not options.quiet:
                sys.stderr.write("reading the studies and drawing their figures ...\n")
            path = write_all(out.parent, out)
        print_answer(options, {"path": str(path)}, f"report: {path}\n")
        return 0
    drawn = {"first": options.first, "seed": options.seed} if STUDIES[options.name].draws else {}
    return carry_out(f"studies.{options.name}", options, Request(out, ids, options.quick, **drawn))


def carry_out(module: str, options: Options, request: Request) -> int:
    """Run a study by its module of `fem_impact.evidence` and print its result, or estimate its time."""
    from fem_impact.evidence.runner import estimate_study, run_study
    from fem_impact.files.atomic import directory_lock
    from fem_impact.jobs.executors import LocalProcesses, on_scheduler

    page = asked_page(options)
    lent = on_scheduler(options.scheduler) if options.scheduler else LocalProcesses(options.workers)
    with (
        directory_lock(request.out),
        told_kept(request.out, options),
        closing(chosen_meter(options)) as meter,
        lent as executor,
    ):
        if options.estimate:
            forecast = estimate_study(module, request, meter, executor)
            meter.close()
            print_answer(options, asdict(forecast), _estimate_text(forecast))
            return 0
        result, notes = run_study(module, request, meter, executor), []
        if result.runs:
            from fem_impact.pages.write import present

            presenter = None if options.scheduler else executor  # workers of a cluster may not see the files
            notes = present(result.runs, request.out, meter, presenter)
        meter.close()
        if page:
            write_study_page(page, request.command(options.name), result.text, request.out)
        if options.json:
            print_json({**result.document, "notes": [*result.document.get("notes", []), *notes]})
        else:
            print_notes(notes)
            print_markdown(result.text, options)
            sys.stdout.write(f"results: {request.out}\n")
        return RunError.exit_code if result.document["failures"] else 0


def _estimate_text(forecast: WorkForecast) -> str:
    lines = [
        f"{_jobs(forecast.jobs)}, {forecast.stored} of them stored; work left: {clock_text(forecast.work_s)}"
    ]
    lines += [_group_line(group) for group in forecast.groups]
    lines += ["These processor times rest on", *(_basis(name, pace) for name, pace in forecast.paces.items())]
    lines += [f"  {n:>5} workers: {clock_text(wall)}" for n, wall in forecast.wall_s.items()]
    lines += [f"The longest job takes {clock_text(forecast.longest_s)}; no number of workers beats that."]
    return "\n".join(lines) + "\n"


def _jobs(count: object) -> str:
    return f"{count} job" + ("" if count == 1 else "s")


def _group_line(group: JobGroup) -> str:
    """Return number, fidelity, tip size and expected times of a group of jobs."""
    name = group.fidelity + (f", tip {group.tip_size_m * 1e3:.2g} mm" if group.tip_size_m else "")
    low, high = f"{group.least_s:.2g}", f"{group.most_s:.2g}"
    each = f"{low} s each" if low == high else f"{low} to {high} s each"
    return f"  {_jobs(group.jobs)} {name}: {each}, {clock_text(group.work_s)} in all"


def _basis(fidelity: str, pace: Pace) -> str:
    """Return what the times of a fidelity rest on."""
    ran = f"{pace.measured} that ran" if pace.measured else "none that ran"
    if fidelity != "solid":
        return f"  {fidelity}: median of {ran}" if pace.measured else f"  {fidelity}: assumed, {ran}"
    return f"  solid: the forecast of each scene, times {pace.ratio:.2g} by {ran}"


def _checked_ids(ids: Sequence[str], own: bool) -> tuple[str, ...]:
    """Return the ids of measured sets, with ``own`` also files of scenes that name own tests, each once."""
    from fem_impact.run.tests import tests_of
    from fem_impact.scene.shipped import load
    from fem_impact.scene.types import MEASURED_SETS

    by_id = dict[str, str]()
    for name in dict.fromkeys(ids):
        if own and name.endswith(".toml"):
            scene = load(name)
            if tests_of(scene) is None:
                remedy = 'Write measured = "my_tests.csv" in it.'
                raise UsageError("states no measured tests.", key="ID", value=name, remedy=remedy)
            scene_id = scene.id
        elif name in MEASURED_SETS:
            scene_id = name
        else:
            remedy = did_you_mean(name, MEASURED_SETS, f"Measured: {', '.join(MEASURED_SETS)}.")
            raise UsageError("is not a measured set.", key="ID", value=name, remedy=remedy)
        if (other := by_id.setdefault(scene_id, name)) != name:
            problem = f"is the id of {other}, too, and runs are kept by it."
            remedy = "Give each scene an id of its own."
            raise SceneError(problem, key="id", value=scene_id, remedy=remedy, source=name)
    return tuple(by_id.values())
