"""Checksums of a run's files and of JSON records: none is read that was changed or mixed in."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

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
    digests = {name: value for value, _, name in parts}
    if digests.get(path.name, "") not in ("", _digest(path)):
        raise ResultError(
            f"{path}: is not the file that the run wrote, by {DIGESTS}: it was cut off or changed, or is of "
            "another run. Restore a copy, or run the scene again."
        )


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


CHECKSUM = "checksum_sha256"
"""Last key of a record: SHA-256 of all other keys."""


def signed(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a record of plain JSON values with its checksum."""
    return {**values, CHECKSUM: checksum(values)}


def checksum(values: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a record written with sorted keys, without spaces and in ASCII."""
    canonical = json.dumps(dict(values), sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(canonical.encode("ascii")).hexdigest()


def read_signed(text: str, source: str) -> dict[str, Any]:
    """Return a record from text, without its checksum.

    Parameters
    ----------
    text : str
    source : str
        The file named in the message.

    Raises
    ------
    ResultError
        It is not JSON, not one record, a key stands twice, or the checksum is missing or wrong.
    """
    try:
        values = json.loads(text, object_pairs_hook=_unrepeated, parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{source}: not a readable JSON record ({error}); it may be cut off.") from error
    if not isinstance(values, dict):
        raise ResultError(f"{source}: holds a JSON {type(values).__name__}, not a record of keys.")
    written = values.pop(CHECKSUM, None)
    if written is None:
        raise ResultError(f'{source}: key "{CHECKSUM}" is missing; the file is not complete.')
    if written != checksum(values):
        raise ResultError(
            f'{source}: key "{CHECKSUM}" = {str(written)[:16]}... does not match the contents; '
            "the file was damaged or edited. Compute it again or restore a copy."
        )
    return values


def _unrepeated(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) != len(pairs):
        raise ValueError("a key stands twice")
    return values


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")
