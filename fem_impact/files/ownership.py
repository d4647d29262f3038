"""Whose a directory is: the program's if it wrote results there and no file of somebody else lies beside."""

from __future__ import annotations

from pathlib import Path

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import read_text
from fem_impact.files.lock import LOCK
from fem_impact.files.run_directory import CHECKPOINT, COMPUTED, DERIVED
from fem_impact.files.signed_json import CHECKSUM

_SIGNED = CHECKSUM.encode()
_MARKS: dict[str, bytes] = {
    "outcome.json": _SIGNED,
    "study.json": _SIGNED,
    "verdict.json": _SIGNED,
    "row.json": b'"stamp"',
    "cost.json": b'"fem-impact/cost/',
    "ledger.csv": b"study,",
    "history.csv": b"time_s,",
    "store.sqlite": b"SQLite format 3",
    CHECKPOINT: b"",
    LOCK: b"",
}
"""Files that show who wrote them, with what stands in each; an empty history is that of a killed run."""
_FILMS = ("*.webp", "*.gif", "*.mp4", "*.html")
_STUDIES = ("store.sqlite", "study.json", "cost.json", "ledger.csv")
_OF_STUDIES = ("*.csv", "*.svg", "summary.*", "cost.txt", "sweep.parquet", "store.sqlite-*", "report")
_KNOWN = (*_MARKS, *COMPUTED, *DERIVED, *_FILMS, "earlier-*", ".*-????????.*")
"""Names that the program gives; the last is that of drafts (`fem_impact.files.atomic`)."""


def stranger(out: Path) -> Path | None:
    """Return something in a directory that the program did not write; None where all of it is its own.

    That is a file with a foreign name, or any file where none shows that the program was here. A directory
    below is the program's by the same rule; an empty one is nobody's.
    """
    entries = sorted(out.iterdir(), key=lambda path: (path.is_dir(), path))
    study = any((out / name).exists() for name in _STUDIES)
    known = (*_KNOWN, *(_OF_STUDIES if study else ()))
    foreign = next((path for path in entries if not _is_known(path, known)), None)
    if foreign or any(map(_shows_us, entries)):
        return foreign
    return next(iter(entries), None)


def refuse_other_scene(path: Path, text: str) -> None:
    """Refuse to replace a scene file by the ``text`` of a scene that does not stand there word for word.

    Raises
    ------
    OutputPathError
        The file exists and holds anything else, if only comments.
    """
    if path.exists() and read_text(path) != text:
        raise OutputPathError(
            f"{path}: is not the scene as this command would write it, and would be replaced. Choose "
            "another place with --out."
        )


def _is_known(path: Path, names: tuple[str, ...]) -> bool:
    if any(path.match(name) for name in names):
        return True
    return path.is_dir() and stranger(path) is None


def _shows_us(path: Path) -> bool:
    """Return whether a file bears the program's mark, or a directory holds one that does."""
    if path.is_dir():
        return any(_shows_us(below) for below in path.iterdir())
    mark = _MARKS.get(path.name)
    if mark is None:
        return False
    data = path.read_bytes() if path.suffix == ".json" else _head(path)
    return mark in data or (path.name == "history.csv" and not data)


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(32)
