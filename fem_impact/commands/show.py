"""The commands that show results: ``render`` and ``report``."""

from __future__ import annotations

import sys
from pathlib import Path

from fem_impact.commands.common import checked_file, checked_result, print_json
from fem_impact.commands.parser import Options
from fem_impact.errors import MissingLibraryError, ResultError


def render(options: Options) -> int:
    """Make a film of the stress waves of a result, or of several side by side."""
    results = [checked_result(result) for result in options.results]
    out = checked_file(options.out) if options.out else None
    for result in results:
        _check_fields(result)
    from fem_impact.render import film as films
    from fem_impact.render.side_by_side import render_side_by_side

    sys.stderr.write("drawing the film ...\n")
    film = films.render(results[0], out) if len(results) == 1 else render_side_by_side(results, out)
    if options.json:
        print_json({"path": str(film.path) if film.path else None, "notes": list(film.notes)})
    else:
        sys.stderr.writelines(f"note: {note}\n" for note in film.notes)
        sys.stdout.write(f"film: {film.path}\n" if film.path else "")
    return 0 if film.path else MissingLibraryError.exit_code


def _check_fields(result: Path) -> None:
    if not (result / "fields.vtkhdf").is_file():
        raise ResultError(
            f"{result}: holds no fields.vtkhdf, which only the finite elements write. "
            "Run its scene with --fidelity solid."
        )


def report(options: Options) -> int:
    """Write the HTML report of a result."""
    result = checked_result(options.result)
    from fem_impact.report.write import write_report

    path = write_report(result)
    if options.json:
        print_json({"path": str(path)})
    else:
        sys.stdout.write(f"report: {path}\n")
    return 0
