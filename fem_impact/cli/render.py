"""The command ``render``: a film of the stress waves, or of the strikes of a body that is followed."""

import sys
from pathlib import Path

from fem_impact.cli.parser import Options
from fem_impact.cli.paths import checked_file, checked_result
from fem_impact.cli.terminal import print_answer
from fem_impact.errors import MissingLibraryError, ResultError, UsageError
from fem_impact.files.run_directory import FIELDS

PATH = "path"  # the body from strike to strike, of any fidelity
STRAIN = "strain"  # what several results show side by side


def render(options: Options) -> int:
    """Make a film of the waves of a result, or of several side by side, or a page to turn the rod on."""
    results = [checked_result(result) for result in options.results]
    out = checked_file(options.out) if options.out else None
    if options.field == PATH:
        if len(results) > 1 or options.first or options.last or options.speed or options.frames:
            raise UsageError("shows all strikes of one result.", key="--field", value=PATH)
        from fem_impact.films.path import render_path

        film = render_path(results[0], out, options.size)
        document: dict[str, object] = {"path": str(film.path), "notes": list(film.notes)}
        print_answer(options, document, f"film: {film.path}\n", film.notes)
        return 0
    for result in results:
        _check_fields(result)
    from fem_impact.films import film as films
    from fem_impact.films.movement import Span
    from fem_impact.scene.units import option_quantity

    first, last, speed = (
        option_quantity(text, "time", key) if text else None
        for text, key in ((options.first, "--from"), (options.last, "--until"), (options.speed, "--speed"))
    )
    span = Span(first, last, options.frames, speed)
    if len(results) > 1 and options.field != STRAIN:
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
        film = films.render_side_by_side(results, out, span, options.size)
    else:
        film = films.render(results[0], out, span, options.field, options.size)
    document = {"path": str(film.path) if film.path else None, "notes": list(film.notes)}
    print_answer(options, document, f"film: {film.path}\n" if film.path else "", film.notes)
    return 0 if film.path else MissingLibraryError.exit_code


def _check_fields(result: Path) -> None:
    """Refuse a result without fields, with the reason why it has none and what to do."""
    if (result / FIELDS).is_file():
        return
    runs = sorted(path.parent.name for path in result.glob(f"*/{FIELDS}"))
    if not (result / "outcome.json").is_file():
        if runs:
            raise ResultError(f"{result}: is a study. Name one of its runs, such as {result / runs[0]}.")
        raise ResultError(f"{result}: is a study of which no run has kept its fields. Run one scene itself.")
    from fem_impact.outcome.record import Outcome
    from fem_impact.scene.shipped import load

    outcome = Outcome.read(result / "outcome.json")
    fidelity = outcome.provenance.fidelity
    why, way = (
        ("its scene says save.frames = 0", "Run it with --set save.frames=120.")
        if fidelity == "solid"
        else (f"fidelity {fidelity} has no mesh", "Run its scene with --fidelity solid.")
    )
    stated = result / "scene.toml"
    kept = fidelity == "solid" and stated.is_file() and load(stated).save.frames > 0
    if runs or kept:
        why = "its last level, which alone keeps them, did not end"
        way = "Run it with --resume and more --budget."
    if isinstance(outcome.strikes.each, tuple):
        way += f" Its strikes are filmed with --field {PATH}."
    raise ResultError(f"{result}: holds no {FIELDS}, the fields that a film shows: {why}. {way}")
