"""The command ``study``: many runs, in local processes or on a cluster, and the conclusions from them."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli.options import Options, add_cluster, add_out, add_page, add_workers
from fem_impact.cli.page import asked_page, write_study_page
from fem_impact.cli.parser import CommandParser
from fem_impact.cli.paths import checked_out, told_kept
from fem_impact.cli.terminal import chosen_meter, print_answer, print_json, print_markdown, print_notes
from fem_impact.errors import RunError, UsageError, did_you_mean
from fem_impact.progress import clock_text

if TYPE_CHECKING:
    from fem_impact.answers.report import Request
    from fem_impact.jobs.run import JobGroup, Pace, WorkForecast
    from fem_impact.progress import ProgressMeter


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


STUDIES = {
    "sets": Study(
        "the published series of tests beside the model",
        "Each of the thirteen measured sets by finite elements on levels of meshes, with the grid of the "
        "plate at two places, and on one mesh with each uncertain input changed. It compares e, mu, Omega, "
        "the velocities and the energies with the tests, says which agree and what could explain those that "
        "do not, and shows where the energy went. A scene file that names own tests (the key measured) is "
        "taken like a set.",
        "104 runs, some 10 min",
        "three sets, one place of the grid: 3 runs, under 1 min",
        104,
        3,
        "all thirteen",
    ),
    "convergence": Study(
        "their limits for vanishing elements",
        "Measured sets on the levels of a run and a finer one, at two places of the plate's grid, and what "
        "vanishing elements would give: the limit of each quantity, its order, and the bands of fewer levels "
        "beside it.",
        "4 runs, each a set with all its levels, some 6 min",
        "4 runs on the levels of a default run, some 1 min",
        4,
        4,
        "t3-machined, t3-contaminated, t5b, t6-17",
    ),
    "gamma": Study(
        "vibration against slenderness",
        "Which share of the energy vibration takes, against the slenderness gamma from 10 to 120: steel rods "
        "of 19 mm at 45 degrees and 2.1 m/s, elastic and yielding, for every state of the surface; then "
        "other diameters, speeds and angles, and strength from hardness. Finite elements on levels, "
        "three measured sets and the reduced model beside them. It says what the published limit, gamma = "
        "26.45, means.",
        "870 runs, 358 of them finite elements, some 2 h",
        "five rods, one place of the grid: 48 runs, some 3 min",
        870,
        48,
    ),
    "criterion": Study(
        "when a rod may be called rigid",
        "Restitution against inclination from 1 to 80 degrees of rods that vibrate and of the same rods that "
        "cannot: by how much rigid theory is wrong, against the slenderness gamma and against the ratio of "
        "bending period to contact time, T1/tau. It says where the published limit and its exponent come "
        "from.",
        "2035 runs, 86 of them levels of finite elements, some 20 min",
        "a few rods and angles: 182 runs, some 1 min",
        2035,
        182,
    ),
    "effects": Study(
        "effects chosen by the scene beside everything on, and what each costs",
        "Scenes with the effects that the program chooses for them, beside the same scenes with all effects "
        "on: how much e and the vibration energy change, and how much computing time each effect takes. The "
        "measured sets, and others that are short and long, slow and fast, hard and soft.",
        "87 runs, some 5 min",
        "three scenes: 17 runs, under 1 min",
        87,
        17,
        "all thirteen and the others",
    ),
    "reduced": Study(
        "the reduced model beside the finite elements",
        "Each scene by both models (fidelity modal and solid): the measured sets, scenes that the reduced "
        "model was made with, and scenes drawn at random.",
        "86 runs, half of them finite elements, some 10 min",
        "four random scenes: 8 runs, under 1 min",
        86,
        8,
    ),
    "coverage": Study(
        "how often the truth lies inside the errors that are told",
        "Scenes drawn at random over shapes, metals, barriers, angles, speeds, spin and friction, twelve "
        "bodies unlike the measured rods at five angles each, and the measured sets, run as a user runs "
        "them: with default levels and with the reduced model, then with one level more, and with two where "
        "that is not dear. It counts how often the finer run lies inside the told band, by quantity and "
        "family, how often told times held, and how runs ended that gave no numbers. By its sheet pairs the "
        "reduced model tells its error; with --seed it draws scenes that this does not rest on.",
        "430 runs, 233 of them finite elements, some 75 min; a finer one follows where they give numbers, "
        "and a second some of those: some 3 h in all",
        "one scene a family: 19 runs, and finer ones of some, some 7 min",
        430,
        19,
        draws=True,
    ),
    "others": Study(
        "tests of other people beside the solver: rods on anvils, spheres on glass",
        "Four published series of aluminium and steel rods that were shot at an anvil, their final lengths "
        "and feet, and one of spheres of alumina that slide on glass, their tangential restitution and spin: "
        "each number beside the solver with all uncertainties (ASME V&V 20), and each series as a whole.",
        "15 runs and 44 rods, some 3 min",
        "one angle and three rods: 1 runs, under 1 min",
        15,
        1,
    ),
    "joint": Study(
        "whether e, mu and Omega of a measured set agree with the tests together",
        "The errors of e, mu and Omega by the study validation, taken together with the correlations of "
        "their uncertainties (ASME V&V 20 and V&V 10): the distance of Mahalanobis of each measured set, and "
        "what it is made of. The reduced model tells how the inputs move the three numbers together.",
        "845 runs of the reduced model, some 5 min",
        "t5b with 8 runs: 9 runs, under 1 min",
        845,
        9,
        "all thirteen",
    ),
    "causes": Study(
        "what rate, hardness and a hard skin change, one after the other and alone",
        "A measured set without any effect of the strain rate on the flow stress; then with the nominal rate "
        "law, with flow stress from hardness, and with a hardened skin, one after the other and each alone. "
        "It shows e, mu and Omega of every step beside the tests.",
        "12 runs, some 2 min",
        "t5b on coarse elements: 6 runs, under 1 min",
        12,
        6,
        "t5b, t6-17",
    ),
    "skin": Study(
        "what a skin that the printed hardness asks for explains of the measured sets",
        "The hardness of both steels of the publication is more than their tensile tests give: layers that "
        "machining has hardened would explain it. Each measured set with two of them, with a law of friction "
        "over speed and with both, beside the default inputs, by the statement of the study joint.",
        "897 runs, 52 of them by finite elements, some 30 min",
        "t5b: 13 runs, some 3 min",
        897,
        13,
        "all thirteen",
    ),
    "tip": Study(
        "what the rows of Table 3 say about the tip of its rods",
        "The caption of Table 3 says tip B. Which arms of the contact point fit the rotation of its rows by "
        "momentum alone, and what finite elements give with either tip, beside the tests. Tip A is shown "
        "beside the measured sets and counted in none of their numbers.",
        "6 runs, some 2 min",
        "the machined rod, one place of the grid: 2 runs, under 1 min",
        6,
        2,
    ),
    "validation": Study(
        "errors of the model with every uncertainty (ASME V&V 20), and what causes them",
        "The difference between model and tests of each measured set beside the standard uncertainties of "
        "mesh, inputs and measurement, and which input causes how much of it. All inputs vary together, in "
        "64 runs a set.",
        "845 runs, some 50 min",
        "t5b with 16 runs a set: 17 runs, under 1 min",
        845,
        17,
        "all thirteen",
    ),
}

OWN_TESTS = ("sets",)
"""Studies that take scene files with own tests."""
REPORT = "one page over all studies beside it"
_REPORT_ABOUT = (
    "Read the studies in the directories beside --out, and write one HTML page over them: conclusions with "
    "their figures, comparison with the tests, energy of every run, papers behind the methods. It computes "
    "nothing and takes some ten seconds."
)


def add_options(parser: CommandParser) -> None:
    """State the command and those of the studies."""
    parser.state(study, "fem-impact study sets --quick")
    studies = parser.add_subparsers(
        title="studies",
        dest="name",
        metavar="NAME",
        required=True,
        description="fem-impact study NAME --help tells what a study does and how long it takes",
    )
    for name, one in STUDIES.items():
        _add_study(studies.add_parser(name, help=one.summary), name, one)
    report = studies.add_parser("report", help=REPORT)
    report.state(study, "fem-impact study report", about=_REPORT_ABOUT)
    add_out(report, "results/report")


def _add_study(parser: CommandParser, name: str, one: Study) -> None:
    """State one study, the sets it takes, and the options of many runs."""
    first_look = f"With --quick, which is a first look and no result: {one.quick}."
    about = f"{one.about}\n\nSize and processor time: {one.size}. {first_look}"
    examples = f"fem-impact study {name} --quick", f"fem-impact study {name} --estimate"
    parser.state(study, *examples, about=about)
    if one.sets:
        files = " or scene files with own tests" if name in OWN_TESTS else ""
        taken = f"measured sets, such as t5b{files} (default: {one.sets})"
        parser.add_argument("ids", nargs="*", default=[], metavar="ID", help=taken)
    parser.add_argument("--quick", action="store_true", help="the small version, for a first look")
    if one.draws:
        part = "only the first N scenes of each family; a later call with more keeps their runs"
        parser.add_argument("--first", type=_count, default=0, metavar="N", help=part)
        other = "draw other scenes, none of which the told errors rest on (default: those they rest on)"
        parser.add_argument("--seed", type=_count, default=0, metavar="N", help=other)
    add_out(parser, f"results/{name}")
    add_workers(parser)
    add_cluster(parser)
    estimate = "say how long it takes on 1 to 1000 workers, and stop"
    parser.add_argument("--estimate", action="store_true", help=estimate)
    add_page(parser, "also")


def _count(text: str) -> int:
    """Read a number of scenes or a seed."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number, 1 or more")
    return int(text)


def study(options: Options) -> int:
    """Run the named study and print its result, or say how long it would take."""
    ids = _checked_ids(options.ids, own=options.name in OWN_TESTS)
    out = checked_out(options.out or Path("results") / options.name)
    from fem_impact.answers.report import Request

    if options.name == "report":
        return _report(options, out)
    drawn = {"first": options.first, "seed": options.seed} if STUDIES[options.name].draws else {}
    return carry_out(f"studies.{options.name}", options, Request(out, ids, options.quick, **drawn))


def _report(options: Options, out: Path) -> int:
    """Write one page over the studies in the parent directory of ``out``."""
    from fem_impact.files.lock import directory_lock
    from fem_impact.pages.all_page import write_all

    with directory_lock(out):
        if not options.quiet:
            sys.stderr.write("reading the studies and drawing their figures ...\n")
        path = write_all(out.parent, out)
    print_answer(options, {"path": str(path)}, f"report: {path}\n")
    return 0


def carry_out(module: str, options: Options, request: Request) -> int:
    """Run a study by its module of `fem_impact.evidence` and print its result, or estimate its time."""
    from fem_impact.evidence.runner import estimate_study
    from fem_impact.files.lock import directory_lock
    from fem_impact.jobs.executors import LocalProcesses, on_scheduler

    page = asked_page(options)
    lent = on_scheduler(options.scheduler) if options.scheduler else LocalProcesses(options.workers)
    with (
        directory_lock(request.out),
        told_kept(request.out, options),
        closing(chosen_meter(options)) as meter,
        lent as executor,
    ):
        if not options.estimate:
            return _run(module, options, request, meter, executor, page)
        forecast = estimate_study(module, request, meter, executor)
        meter.close()
        print_answer(options, asdict(forecast), _estimate_text(forecast))
        return 0


def _run(
    module: str,
    options: Options,
    request: Request,
    meter: ProgressMeter,
    executor: Executor,
    page: Path | None,
) -> int:
    from fem_impact.evidence.runner import run_study

    result, notes = run_study(module, request, meter, executor), []
    if result.runs:
        from fem_impact.films.movement import QUICK_FRAMES, STUDY_FRAMES
        from fem_impact.pages.write import present

        frames = QUICK_FRAMES if request.quick else STUDY_FRAMES
        presenter = None if options.scheduler else executor  # workers of a cluster may not see the files
        notes = present(result.runs, request.out, meter, frames, presenter)
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
    return f"  solid: the plan of each scene, times {pace.ratio:.2g} by {ran}"


def _checked_ids(ids: Sequence[str], own: bool) -> tuple[str, ...]:
    """Return the ids of measured sets, with ``own`` also files of scenes that name own tests, each once."""
    from fem_impact.scene.types import MEASURED_SETS

    for name in ids:
        if own and name.endswith(".toml"):
            _refuse_without_tests(name)
        elif name not in MEASURED_SETS:
            remedy = did_you_mean(name, MEASURED_SETS, f"Measured: {', '.join(MEASURED_SETS)}.")
            raise UsageError("is not a measured set.", key="ID", value=name, remedy=remedy)
    return tuple(dict.fromkeys(ids))


def _refuse_without_tests(name: str) -> None:
    """Refuse a scene file without tests, or with some that cannot be read."""
    from fem_impact.run.tests import tests_of
    from fem_impact.scene.shipped import load

    if tests_of(load(name)) is None:
        remedy = 'Write measured = "my_tests.csv" in it.'
        raise UsageError("states no measured tests.", key="ID", value=name, remedy=remedy)
