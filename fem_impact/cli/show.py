"""The commands that show results: ``render`` and ``report``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli.about_results import FILMED
from fem_impact.cli.common import checked_file, checked_result, print_json
from fem_impact.cli.options import Options
from fem_impact.errors import MissingLibraryError, ResultError, UsageError

if TYPE_CHECKING:
    from fem_impact.films.movement import Span

FIELDS = "fields.vtkhdf"


def render(options: Options) -> int:
    """Make a film of the waves of a result, or of several side by side, or a page to turn the rod on."""
    results = [checked_result(result) for result in options.results]
    out = checked_file(options.out) if options.out else None
    for result in results:
        _check_fields(result)
    from fem_impact.films import film as films
    from fem_impact.films.film import render_side_by_side

    span = _span(options)
    if len(results) > 1 and options.field != FILMED[0]:
        raise UsageError("shows the strain only, side by side.", key="--field", value=options.field)
    turning = out is not None and out.suffix == ".html"
    if len(results) > 1 and turning:
        raise UsageError("shows one result only.", key="--out", value=str(out), remedy="Name one RESULT.")
    if not options.quiet:
        sys.stderr.write("drawing the film ...\n")
    if out is not None and turning:
        from fem_impact.pages.turning import write_view

        film = write_view(results[0], out, span, options.field)
    elif len(results) > 1:
        film = render_side_by_side(results, out, span, options.size)
    else:
        film = films.render(results[0], out, span, options.field, options.size)
    if options.json:
        print_json({"path": str(film.path) if film.path else None, "notes": list(film.notes)})
    else:
        sys.stderr.writelines(f"note: {note}\n" for note in film.notes)
        sys.stdout.write(f"film: {film.path}\n" if film.path else "")
    return 0 if film.path else MissingLibraryError.exit_code


def _span(options: Options) -> Span:
    """Return what the film shall show."""
    from fem_impact.films.movement import Span
    from fem_impact.scene.units import option_quantity

    first, last, speed = (
        option_quantity(text, "time", key) if text else None
        for text, key in ((options.first, "--from"), (options.last, "--until"), (options.speed, "--speed"))
    )
    return Span(first, last, options.frames, speed)


def _check_fields(result: Path) -> None:
    """Refuse a result without fields, with the reason why it has none and what to do."""
    if (result / FIELDS).is_file():
        return
    runs = sorted(path.parent.name for path in result.glob(f"*/{FIELDS}"))
    if runs:
        raise ResultError(f"{result}: is a study. Name one of its runs, such as {result / runs[0]}.")
    if not (result / "outcome.json").is_file():
        raise ResultError(f"{result}: is a study of which no run has kept its fields. Run one scene itself.")
    from fem_impact.outcome.record import Outcome

    fidelity = Outcome.read(result / "outcome.json").provenance.fidelity
    why, way = (
        ("its scene says save.frames = 0", "Run it with --set save.frames=120.")
        if fidelity == "solid"
        else (f"fidelity {fidelity} has no mesh", "Run its scene with --fidelity solid.")
    )
    raise ResultError(f"{result}: holds no {FIELDS}, the fields that a film shows: {why}. {way}")


def report(options: Options) -> int:
    """Write the HTML report of a result."""
    result = checked_result(options.result)
    from fem_impact.pages.write import write_report

    notes = _missing_film(result, options)
    path = write_report(result)
    if options.json:
        print_json({"path": str(path), "notes": notes})
    else:
        sys.stderr.writelines(f"note: {note}\n" for note in notes)
        sys.stdout.write(f"report: {path}\n")
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


def schema(options: Options) -> int:
    """Print the JSON Schema of an outcome."""
    from fem_impact.outcome.check import json_schema
    from fem_impact.outcome.record import KEYS

    print_json(json_schema(KEYS))
    return 0
