"""The directory of a run or study: names of its files, whose it is, older results, drafts."""

import os
import shutil
from datetime import UTC, datetime
from pathlib import Path

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import CHECKSUM, DIGESTS, LOCK, atomic_path, make_directory, read_text

CHECKPOINT = "run.checkpoint"
FIELDS = "fields.vtkhdf"
RECORD = "contact.npz"
STAMP = "level.stamp"
"""What a level computes, in its directory before it begins."""
BESIDE = ("contacts.csv", "strikes.csv", "history.csv", FIELDS, "waves.h5", RECORD)
"""Files beside an outcome, whose digests stand in `DIGESTS`."""
COMPUTED = (CHECKPOINT, "outcome.json", *BESIDE, DIGESTS, "level-*")
"""Files that a run computes."""
DERIVED = ("scene.toml", "row.json", "report.html", "figures", "film*")
"""The scene, and files made from those of the run."""
PUBLISHED = ("study.json", "summary.md", "*.csv", "sweep.parquet")
"""The report of a study or sweep; its outcomes stay in the store."""


def is_resumable(out: Path) -> bool:
    """Return whether a run that was stopped left something in a directory from which it can go on."""
    levels = (out.glob(f"level-*/{name}") for name in (CHECKPOINT, "outcome.json"))
    return (out / CHECKPOINT).exists() or any(map(any, levels))


def stands_also_at(file: Path, place: Path) -> None:
    """Give a whole file a second place, where an older one goes; it is copied only where links are not."""
    place.unlink(missing_ok=True)
    try:
        os.link(file, place)
    except OSError:
        with atomic_path(place) as draft:
            shutil.copyfile(file, draft)


def set_aside(out: Path) -> Path | None:
    """Move an older run, or the report of an older study, to a directory in ``out``; return it.

    What was made from their files goes with them.
    """
    patterns = COMPUTED if not (out / "study.json").exists() else (*COMPUTED, *PUBLISHED)
    computed = {path for name in patterns for path in out.glob(name)}
    if not computed:
        return None
    written = datetime.fromtimestamp(max(path.stat().st_mtime for path in computed), UTC)
    stem = f"earlier-{written:%Y-%m-%dT%H-%M-%SZ}"
    names = (stem, *(f"{stem}-{number}" for number in range(2, 1000)))
    place = make_directory(next(out / name for name in names if not (out / name).exists()))
    for path in computed | {path for name in DERIVED for path in out.glob(name)}:
        path.rename(place / path.name)
    return place


def remove_drafts(out: Path) -> None:
    """Remove the drafts that a killed run left; nobody else may write there (`directory_lock`)."""
    for name in map(Path, ("scene.toml", *COMPUTED)):
        for draft in out.glob(f".{name.stem}-????????{name.suffix}"):
            draft.unlink()


def remove_scene_alone(out: Path) -> None:
    """Remove the scene of a run that ended before it computed: alone it does not show whose it is."""
    if not any((out / name).exists() for name in COMPUTED):
        (out / "scene.toml").unlink(missing_ok=True)


def earlier_runs(out: Path) -> list[Path]:
    """Return the directories of older runs, the oldest first."""
    return sorted(out.glob("earlier-*"))


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
    STAMP: b"",
    LOCK: b"",
}
"""Files that show who wrote them, with what stands in each; an empty history is that of a killed run."""
_FILMS = ("*.webp", "*.gif", "*.mp4", "*.html")
_STUDIES = ("store.sqlite", "study.json", "cost.json", "ledger.csv")
_OF_STUDIES = ("*.csv", "*.svg", "summary.*", "cost.txt", "sweep.parquet", "store.sqlite-*", "report")
_KNOWN = (*_MARKS, *COMPUTED, *DERIVED, *_FILMS, "earlier-*", ".*-????????.*")
"""Names that the program gives; the last is that of drafts (`fem_impact.files.atomic`)."""


def foreign_entry(out: Path) -> Path | None:
    """Return something in a directory that the program did not write; None where all of it is its own.

    That is a file with a foreign name, or any file where none shows that the program was here. A directory
    below is the program's by the same rule; an empty one is nobody's.
    """
    entries = sorted(out.iterdir(), key=lambda path: (path.is_dir(), path))
    study = any((out / name).exists() for name in _STUDIES)
    known = (*_KNOWN, *(_OF_STUDIES if study else ()))
    foreign = next(
        (
            path
            for path in entries
            if not any(map(path.match, known)) and not (path.is_dir() and foreign_entry(path) is None)
        ),
        None,
    )
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
            "another out=."
        )


def _shows_us(path: Path) -> bool:
    """Return whether a file bears the program's mark, or a directory holds one that does."""
    if path.is_dir():
        return any(_shows_us(below) for below in path.iterdir())
    mark = _MARKS.get(path.name)
    if mark is None:
        return False
    with path.open("rb") as file:
        data = file.read(-1 if path.suffix == ".json" else 32)
    return mark in data or (path.name == "history.csv" and not data)
