"""The command ``report``: the HTML report of a result."""

import sys

from fem_impact.cli.parser import Options
from fem_impact.cli.paths import checked_result
from fem_impact.cli.terminal import print_answer
from fem_impact.errors import MissingLibraryError, ResultError, UsageError
from fem_impact.files.run_directory import FIELDS


def report(options: Options) -> int:
    """Write the HTML report of a result, or the page of a run to sign."""
    result = checked_result(options.result)
    if (options.document or options.revision) and not options.sign:
        problem = "stands on the page to sign alone."
        given = "--document" if options.document else "--revision"
        raise UsageError(problem, key=given, remedy="Add --sign.")
    if options.sign:
        from fem_impact.pages.sheet import write_sheet

        path = write_sheet(result, options.document, options.revision)
        print_answer(options, {"path": str(path)}, f"page to sign: {path}\n")
        return 0
    from fem_impact.pages.html import film_of
    from fem_impact.pages.write import write_report

    notes: list[str] = []
    if not film_of(result) and (result / FIELDS).is_file():  # a film can be made
        from fem_impact.films import film as films

        if not options.quiet:
            sys.stderr.write("drawing the film ...\n")
        try:
            notes = list(films.render(result).notes)
        except (MissingLibraryError, ResultError) as error:
            notes = [f"The page has no film: {error}"]
    path = write_report(result)
    print_answer(options, {"path": str(path), "notes": notes}, f"report: {path}\n", notes)
    return 0
