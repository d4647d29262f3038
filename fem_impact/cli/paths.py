"""Paths on the command line: checked before any work, and shown from the working directory."""

import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fem_impact.cli.parser import Options
from fem_impact.errors import OutputPathError, ResultError
from fem_impact.files.run_directory import COMPUTED, earlier_runs, foreign_entry

RESULT_FILES = ("outcome.json", "study.json")


def checked_out(out: Path) -> Path:
    """Make the directory for results and check that it can be written.

    Raises
    ------
    OutputPathError
        It is a file, lies below a file, holds anything but results of the program, or cannot be written.
    """
    with _own_errors(out):
        _refuse_files(out)
        if out.is_dir() and (foreign := foreign_entry(out)):
            raise OutputPathError(
                f"{out}: the directory holds other files, such as {foreign.name}, and results would mix with "
                "them. Choose an empty or a new directory with --out."
            )
        out.mkdir(parents=True, exist_ok=True)
        _prove_writable(out)
    return out


def checked_file(out: Path) -> Path:
    """Return a file path whose directory exists and can be written."""
    with _own_errors(out.parent):
        if out.is_dir():
            raise OutputPathError(f"{out}: is a directory. Give the name of a file with --out.")
        _refuse_files(out.parent)
        _prove_writable(out.parent)
    return out


@contextmanager
def _own_errors(out: Path) -> Iterator[None]:
    """Turn an error of the disk into an `OutputPathError` with what to do."""
    try:
        yield
    except OutputPathError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        remedy = "Choose another directory with --out."
        raise OutputPathError(f"{out}: cannot be written ({reason}). {remedy}") from None


def _refuse_files(out: Path) -> None:
    for place in (out, *out.parents):
        if place.exists() and not place.is_dir():
            what = "is a file" if place == out else f"lies below {place}, which is a file"
            raise OutputPathError(f"{out}: {what}. Choose another directory with --out.")


def _prove_writable(directory: Path) -> None:
    with tempfile.TemporaryFile(dir=directory):
        pass


def checked_result(result: Path) -> Path:
    """Return a directory that holds results.

    Raises
    ------
    ResultError
        It is missing, is a file, or holds no results.
    """
    if not result.exists():
        raise ResultError(f"{result}: there is no such directory. Name one that `fem-impact run` wrote.")
    if not result.is_dir():
        way = "Name the one that `fem-impact run` printed at its end."
        if any((result.parent / name).is_file() for name in (*RESULT_FILES, *COMPUTED)):
            way = f"Name the directory that it lies in: {result.parent}"
        elif result.suffix == ".toml":
            way = f"Compute the scene by `fem-impact run {result}`, which prints its directory at the end."
        raise ResultError(f"{result}: is a file, not the directory of a result. {way}")
    if not any((result / name).is_file() for name in RESULT_FILES):
        if (result / "history.csv").is_file():
            way = f"Go on with `fem-impact run {result / 'scene.toml'} --resume --out {result}`."
            raise ResultError(f"{result}: the run here did not come to its end. {way}")
        if any(result.glob("*/study.json")):
            line = f"fem-impact study report --out {result / 'report'}"
            raise ResultError(f"{result}: holds studies. Name one, or write a page over all: {line}")
        names = " or ".join(RESULT_FILES)
        raise ResultError(f"{result}: holds no {names}. Name a directory that `fem-impact run` wrote.")
    return result


@contextmanager
def told_kept(out: Path, options: Options) -> Iterator[None]:
    """Say at the end which older results of a directory were set aside, and where they are."""
    before = earlier_runs(out)
    try:
        yield
    finally:
        for place in earlier_runs(out):
            if place not in before and not options.quiet:
                sys.stderr.write(f"Older results that were in {out} are kept in {place}\n")


def shown_path(path: str) -> str:
    """Return a path from the working directory where it lies there, else as it is."""
    place = Path(path)
    return str(place.relative_to(Path.cwd())) if place.is_relative_to(Path.cwd()) else path
