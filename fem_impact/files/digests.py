"""SHA-256 of the files that a run wrote, beside them, so that none is read that was changed or mixed in."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text, write_text

DIGESTS = "files.sha256"
"""Written when a run is done, one line a file, as ``sha256sum --check`` reads it."""


def write_digests(folder: Path, names: Iterable[str]) -> Path:
    """Write the digests of those files that are there; return the path.

    Raises
    ------
    OutputPathError
        The place cannot be written or the disk is full.
    """
    lines = (f"{_digest(folder / name)}  {name}\n" for name in names if (folder / name).is_file())
    return write_text(folder / DIGESTS, "".join(lines))


def check_digest(path: Path) -> None:
    """Refuse a file that is not the one its run wrote; one without a stated digest passes.

    Raises
    ------
    ResultError
        The file was cut off or changed, or is of another run.
    """
    listed = path.parent / DIGESTS
    if not (listed.is_file() and path.is_file()):
        return
    parts = (line.partition("  ") for line in read_text(listed).splitlines())
    stated = {name: value for value, _, name in parts}
    if stated.get(path.name, "") not in ("", _digest(path)):
        raise ResultError(
            f"{path}: is not the file that the run wrote, by {DIGESTS}: it was cut off or changed, or is of "
            "another run. Restore a copy, or run the scene again."
        )


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
