"""The commands ``study`` and ``stress``: many runs, in local processes or on a cluster."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli.about_studies import OWN_TESTS
from fem_impact.cli.common import checked_out, print_json, told_kept
from fem_impact.cli.options import Options
from fem_impact.cli.terminal import chosen_meter, print_markdown
from fem_impact.errors import RunError, UsageError, did_you_mean

if TYPE_CHECKING:
    from fem_impact.answers.report import Request
    from fem_impact.jobs.run import JobGroup, Pace, WorkForecast
    from fem_impact.progress import ProgressMeter


def study(options: Options) -> int:
    """Run the named study and print its result, or say how long it would take."""
    ids = _checked_ids(options.ids, own=options.name in OWN_TESTS)
    out = checked_out(options.out or Path("results") / options.name)
    from fem_impact.answers.report import Request
    from fem_impact.files.lock import directory_lock

    if options.name == "report":
        with directory_lock(out):
            return _report(options, out)
    return _computed(f"studies.{options.name}", options, Request(out, ids, options.quick))


def stress(options: Options) -> int:
    """Run one hard case, or all of them; the exit code says whether all ended as they must."""
    from fem_impact.answers.report import Request
    from fem_impact.evidence.hard_cases.scenes import CASES

    if options.only and options.page:
        raise UsageError("runs all cases.", key="--page", remedy="Leave --only out.")
    if options.only and options.only not in CASES:
        hint = did_you_mean(options.only, CASES, f"Known are: {', '.join(CASES)}.")
        raise UsageError("is no hard case.", key="--only", value=options.only, remedy=hint)
    out = checked_out(options.out or Path("results") / "stress")
    ids = (options.only,) if options.only else ()
    line = " ".join(["fem-impact stress", *(["--only", options.only] if options.only else [])])
    # one place keeps all cases, whichever were asked for last
    return _computed("hard_cases.study", options, Request(out, ids, line=line, cases="hard cases"))


def _computed(module: str, options: Options, request: Request) -> int:
    """Run a study by its module of `fem_impact.evidence` and print its result, or estimate its time."""
    from fem_impact.cli.page import asked_page
    from fem_impact.files.lock import directory_lock

    page = asked_page(options)
    with (
        directory_lock(request.out),
        told_kept(request.out, options),
        closing(chosen_meter(options)) as meter,
        _workers(options) as executor,
    ):
        if options.estimate:
            return _estimate(module, options, request, meter, executor)
        return _study(module, options, request, meter, executor, page)


def _report(options: Options, out: Path) -> int:
    """Write one page over the studies in the parent directory of ``out``."""
    from fem_impact.pages.all_page import write_all

    if not options.quiet:
        sys.stderr.write("reading the studies and drawing their figures ...\n")
    path = write_all(out.parent, out)
    if options.json:
        print_json({"path": str(path)})
    else:
        sys.stdout.write(f"report: {path}\n")
    return 0


def _study(
    module: str,
    options: Options,
    request: Request,
    meter: ProgressMeter,
    executor: Executor,
    page: Path | None,
) -> int:
    from fem_impact.cli.page import write_study_page
    from fem_impact.evidence.runner import run_study

    result, notes = run_study(module, request, meter, executor), []
    if result.runs:
        from fem_impact.films.movement import QUICK_FRAMES, STUDY_FRAMES
        from fem_impact.pages.write import present

        frames = QUICK_FRAMES if request.quick else STUDY_FRAMES
        here = None if options.scheduler else executor  # workers of a cluster may not see the files
        notes = present(result.runs, request.out, meter, frames, here)
    meter.close()
    if page:
        write_study_page(page, request.command(options.name), result.text, request.out)
    if options.json:
        print_json({**result.document, "notes": [*result.document.get("notes", []), *notes]})
    else:
        sys.stderr.writelines(f"note: {note}\n" for note in notes)
        print_markdown(result.text, options)
        sys.stdout.write(f"results: {request.out}\n")
    return RunError.exit_code if result.document["failures"] else 0


def _estimate(
    module: str, options: Options, request: Request, meter: ProgressMeter, executor: Executor
) -> int:
    from dataclasses import asdict

    from fem_impact.evidence.runner import estimate_study

    forecast = estimate_study(module, request, meter, executor)
    meter.close()
    if options.json:
        print_json(asdict(forecast))
    else:
        sys.stdout.write(_estimate_text(forecast))
    return 0


def _estimate_text(forecast: WorkForecast) -> str:
    from fem_impact.progress import clock_text

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
    from fem_impact.progress import clock_text

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


@contextmanager
def _workers(options: Options) -> Iterator[Executor]:
    from fem_impact.jobs.executors import LocalProcesses, on_scheduler

    lent = on_scheduler(options.scheduler) if options.scheduler else LocalProcesses(options.workers)
    with lent as executor:
        yield executor


def _checked_ids(ids: Sequence[str], own: bool) -> tuple[str, ...]:
    """Return the ids of measured sets, with ``own`` also files of scenes that name own tests, each once."""
    from fem_impact.scene.types import MEASURED_SETS

    for name in ids:
        if own and name.endswith(".toml"):
            _check_own(name)
        elif name not in MEASURED_SETS:
            remedy = did_you_mean(name, MEASURED_SETS, f"Measured: {', '.join(MEASURED_SETS)}.")
            raise UsageError("is not a measured set.", key="ID", value=name, remedy=remedy)
    return tuple(dict.fromkeys(ids))


def _check_own(name: str) -> None:
    """Refuse a scene file without tests, or with some that cannot be read."""
    from fem_impact.run.tests import tests_of
    from fem_impact.scene.shipped import load

    if tests_of(load(name)) is None:
        remedy = 'Write measured = "my_tests.csv" in it.'
        raise UsageError("states no measured tests.", key="ID", value=name, remedy=remedy)
