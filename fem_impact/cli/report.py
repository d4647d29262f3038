"""The command ``report``: the HTML report of a result."""

from __future__ import annotations

import sys
from pathlib import Path

from fem_impact.cli.options import Options
from fem_impact.cli.parser import CommandParser
from fem_impact.cli.paths import checked_result
from fem_impact.cli.terminal import print_answer
from fem_impact.errors import MissingLibraryError, ResultError
from fem_impact.files.run_directory import FIELDS


def add_options(parser: CommandParser) -> None:
    """State the command and its options."""
    parser.state(report, "fem-impact report results/quick")
    about = "directory that a run or a study wrote"
    parser.add_argument("result", type=Path, metavar="RESULT", help=about)


def report(options: Options) -> int:
    """Write the HTML report of a result."""
    result = checked_result(options.result)
    from fem_impact.pages.write import write_report

    notes = _missing_film(result, options)
    path = write_report(result)
    print_answer(options, {"path": str(path), "notes": notes}, f"report: {path}\n", notes)
    return 0


def _missing_film(result: Path, options: Options) -> list[str]:
    """Make the film of a run that has fields and no film yet; return why there is none."""
    from fem_impact.pages.sections import has_film

    if has_film(result) or not (result / FIELDS).is_file():
        return []
    from fem_impact.films import film as films

    if not options.quiet:
        sys.stderr.write("drawing the film ...\n")
    try:
        return list(films.render(result).notes)
    except (MissingLibraryError, ResultError) as error:
        return [f"The page has no film: {error}"]
