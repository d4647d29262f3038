"""Where results go, and that they can go there: known before any work is done."""

from __future__ import annotations

import tempfile
from pathlib import Path

from fem_impact.errors import OutputPathError, ResultError
from fem_impact.run_files import COMPUTED

__all__ = ["checked_file", "checked_out", "checked_result"]

RESULT_FILES = ("outcome.json", "study.json")
_OF_STUDIES = ("store.sqlite", "ledger.csv")
_OWN_FILES = (*RESULT_FILES, *_OF_STUDIES, *COMPUTED, "scene.toml", "row.json")


def checked_out(out: Path) -> Path:
    """Make the directory for results and prove that it can be written.

    Raises
    ------
    OutputPathError
        When it is a file, lies below a file, holds somebody's other files, or cannot be written.
    """
    try:
        _refuse_files(out)
        _refuse_strangers(out)
        out.mkdir(parents=True, exist_ok=True)
        _prove_writable(out)
    except OutputPathError:
        raise
    except (OSError, ValueError) as error:
        raise OutputPathError(_cannot(out, error)) from None
    return out


def checked_file(out: Path) -> Path:
    """Return a file path whose directory exists and can be written."""
    try:
        if out.is_dir():
            raise OutputPathError(f"{out}: is a directory. Give the name of a file with --out.")
        _refuse_files(out.parent)
        _prove_writable(out.parent)
    except OutputPathError:
        raise
    except (OSError, ValueError) as error:
        raise OutputPathError(_cannot(out.parent, error)) from None
    return out


def checked_result(result: Path) -> Path:
    """Return a directory that holds results.

    Raises
    ------
    ResultError
        When it is missing, is a file, or holds no results.
    """
    if not result.exists():
        raise ResultError(f"{result}: there is no such directory. Name one that `fem-impact run` wrote.")
    if not result.is_dir():
        raise ResultError(f"{result}: is a file. Name the directory of the results, such as {result.parent}.")
    if not any((result / name).is_file() for name in RESULT_FILES):
        if (result / "history.csv").is_file():
            way = f"Go on with `fem-impact run {result / 'scene.toml'} --resume --out {result}`."
            raise ResultError(f"{result}: the run here did not come to its end. {way}")
        names = " or ".join(RESULT_FILES)
        raise ResultError(f"{result}: holds no {names}. Name a directory that `fem-impact run` wrote.")
    return result


def _refuse_files(out: Path) -> None:
    for place in (out, *out.parents):
        if place.exists() and not place.is_dir():
            what = "is a file" if place == out else f"lies below {place}, which is a file"
            raise OutputPathError(f"{out}: {what}. Choose another directory with --out.")


def _refuse_strangers(out: Path) -> None:
    if not out.is_dir() or not any(out.iterdir()) or _is_ours(out):
        return
    raise OutputPathError(
        f"{out}: the directory holds other files, and results would mix with them. "
        "Choose an empty or a new directory with --out."
    )


def _is_ours(out: Path) -> bool:
    """Say whether a run, or the runs of a study that was stopped early, wrote here."""
    own = (out / name for name in _OWN_FILES)
    of_runs = (run / name for run in out.iterdir() if run.is_dir() for name in _OWN_FILES)
    return any(path.exists() for path in (*own, *of_runs))


def _prove_writable(directory: Path) -> None:
    with tempfile.TemporaryFile(dir=directory):
        pass


def _cannot(out: Path, error: Exception) -> str:
    words = getattr(error, "strerror", None) or str(error)
    return f"{out}: cannot be written ({words}). Choose another directory with --out."
