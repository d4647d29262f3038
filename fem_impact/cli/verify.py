"""The command ``verify``: problems with known answers, run through the solver."""

import sys

from fem_impact.cli.page import checked_page, write_page
from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import print_json, print_table
from fem_impact.errors import RunError, UsageError
from fem_impact.evidence.problems.problem import PROBLEMS, Verification, page, problem
from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped

TITLE, ABOUT = (
    "Verification",
    "Each problem with a known answer, and of its checks the one nearest to its limit.",
)


def verify(options: Options) -> int:
    """Run one problem, or all of them; the exit code says whether every check passed."""
    if options.parameters and (options.changes or options.page):
        remedy = "Leave it out, or leave out --set and --page."
        raise UsageError("lists parameters and runs nothing.", key="--parameters", remedy=remedy)
    if options.parameters:
        return _show_parameters(options)
    if options.page:
        return _write_page(options)
    changes = dict(_change(text) for text in options.changes)
    if changes and not options.problem:
        remedy = "Name it: fem-impact verify NAME --set ..."
        raise UsageError("belongs to one problem.", key="--set", remedy=remedy)
    chosen = [problem(name) for name in ([options.problem] if options.problem else PROBLEMS)]
    done = []
    for one in chosen:
        if not options.quiet:
            sys.stderr.write(f"{one.name}: {one.words} ...\n")
        done.append(one.run(changes))
        if not options.json:
            sys.stdout.write(_text(done[-1]))
            sys.stdout.flush()
    if options.json:
        documents = [verification.document() for verification in done]
        print_json(documents[0] if options.problem else documents)
    return 0 if all(verification.passed for verification in done) else RunError.exit_code


def _write_page(options: Options) -> int:
    """Run all problems at their defaults and write the page."""
    if options.problem or options.changes:
        raise UsageError("runs all problems with their default values.", key="--page")
    path, done = checked_page(options.page), []
    for name in PROBLEMS:
        done.append(problem(name).run())
        if not options.quiet:
            sys.stderr.write(_text(done[-1]).splitlines()[0] + "\n")
    write_page(path, TITLE, ABOUT, "fem-impact verify --page FILE", page(done))
    if options.json:
        print_json([verification.document() for verification in done])
    return 0 if all(verification.passed for verification in done) else RunError.exit_code


def _change(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals:
        raise UsageError("is not of the form parameter=value.", key="--set", value=text)
    return name.strip(), value.strip().strip("\"'")


def _show_parameters(options: Options) -> int:
    if not options.problem:
        remedy = f"Name one of: {', '.join(PROBLEMS)}."
        raise UsageError("needs a problem.", key="--parameters", remedy=remedy)
    chosen = problem(options.problem)
    if options.json:
        print_json(
            [
                {"name": p.key, "meaning": p.meaning, "unit": p.si_unit, "default": p.default}
                | {"low": p.low, "high": p.high, "whole": p.whole, "even": p.even}
                for p in chosen.parameters
            ]
        )
        return 0
    sys.stdout.write(f"{chosen.name}: {chosen.words}\n")
    head = "name", "unit", "default", "range", "meaning"
    rows = [
        (p.key, p.si_unit, f"{p.default:g}", f"{p.low:g} to {p.high:g}", p.meaning) for p in chosen.parameters
    ]
    print_table(Table.of(head, rows, left=range(5)), options)
    return 0


def _text(verification: Verification) -> str:
    verdict = "passed" if verification.passed else "FAILED"
    cost = verification.cost
    spent = f"{cost.cpu_s:.1f} s of CPU, {cost.steps} steps, {cost.elements} elements"
    lines = [f"{verification.name}: {verdict} ({spent})"]
    for c in verification.checks:
        mark = "FAIL" if not c.passed else "ok  " if c.judged else "    "
        allowed = f"allowed {c.tolerance:g} {c.kind}" if c.judged else f"not judged: {c.note}"
        unit = "" if c.unit == "1" else f" {c.unit}"
        values = f"{c.computed:.6g}{unit}, reference {c.reference:.6g}"
        lines += wrapped(f"{mark} {c.name}: {values},", "  ", " " * 5)
        lines += wrapped(f"error {c.error:+.2e}, {allowed}", " " * 7, "")
    return "\n".join(lines) + "\n"
