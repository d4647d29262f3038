"""The command ``render``: a film of the stress waves, or of the strikes of a body that is followed."""

import argparse
import sys
from pathlib import Path

from fem_impact.cli.parser import CommandParser, Options
from fem_impact.cli.paths import checked_file, checked_result
from fem_impact.cli.terminal import print_answer
from fem_impact.errors import MissingLibraryError, ResultError, UsageError
from fem_impact.files.run_directory import FIELDS

PATH = "path"  # the body from strike to strike, of any fidelity
FILMED = ("strain", "stress", "velocity", "plastic", PATH)  # what a film can show, the default first


def add_options(parser: CommandParser) -> None:
    """State the command and its options."""
    example = "fem-impact render results/quick"
    parser.state(render, example, f"{example} --until '0.1 ms'")
    several = "directory that a run or a study wrote; several make one film side by side"
    film = "film: .mp4, .webp, .gif, .png for a folder, or .html to turn it (default: beside the fields)"
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help=several)
    parser.add_argument("--out", type=Path, metavar="FILE", help=film)
    colours = "colours of the film (default: strain along the axis), or the body's path through its strikes"
    parser.add_argument("--field", choices=FILMED, default=FILMED[0], help=colours)
    parser.add_argument("--frames", type=int, metavar="N", help="number of frames (default: 144)")
    for option, name, text in (
        ("--from", "first", "first time, such as '20 us'"),
        ("--until", "last", "last time, such as '0.3 ms'"),
        ("--speed", "speed", "motion in one second of the film, such as '25 us'"),
    ):
        parser.add_argument(option, dest=name, default="", metavar="TIME", help=text)
    pixels = "size of the film in pixels, multiples of 16 (default: 1280x720)"
    parser.add_argument("--size", type=_size, default=(1280, 720), metavar="WxH", help=pixels)


def _size(text: str) -> tuple[int, int]:
    """Read width and height in pixels."""
    width, by, height = text.partition("x")
    if not (by and width.isdecimal() and height.isdecimal()):
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 1280x720")
    return int(width), int(height)


def render(options: Options) -> int:
    """Make a film of the waves of a result, or of several side by side, or a page to turn the rod on."""
    results = [checked_result(result) for result in options.results]
    out = checked_file(options.out) if options.out else None
    if options.field == PATH:
        return _path(results, out, options)
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
        film = films.render_side_by_side(results, out, span, options.size)
    else:
        film = films.render(results[0], out, span, options.field, options.size)
    document = {"path": str(film.path) if film.path else None, "notes": list(film.notes)}
    print_answer(options, document, f"film: {film.path}\n" if film.path else "", film.notes)
    return 0 if film.path else MissingLibraryError.exit_code


def _path(results: list[Path], out: Path | None, options: Options) -> int:
    """Make a film of the strikes of a result."""
    if len(results) > 1 or options.first or options.last or options.speed or options.frames:
        raise UsageError("shows all strikes of one result.", key="--field", value=PATH)
    from fem_impact.films.path import render_path

    film = render_path(results[0], out, options.size)
    print_answer(
        options, {"path": str(film.path), "notes": list(film.notes)}, f"film: {film.path}\n", film.notes
    )
    return 0


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

    outcome = Outcome.read(result / "outcome.json")
    fidelity, strikes = outcome.provenance.fidelity, isinstance(outcome.strikes.each, tuple)
    why, way = (
        ("its scene says save.frames = 0", "Run it with --set save.frames=120.")
        if fidelity == "solid"
        else (f"fidelity {fidelity} has no mesh", "Run its scene with --fidelity solid.")
    )
    if strikes:
        way += f" Its strikes are filmed with --field {PATH}."
    raise ResultError(f"{result}: holds no {FIELDS}, the fields that a film shows: {why}. {way}")
