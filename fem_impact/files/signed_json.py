"""JSON records with a checksum, by which a damaged or edited file is refused."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from fem_impact.errors import ResultError

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
    values = _parsed(text, source)
    stated = values.pop(CHECKSUM, None)
    if stated is None:
        raise ResultError(f'{source}: key "{CHECKSUM}" is missing; the file is not complete.')
    if stated != checksum(values):
        raise ResultError(
            f'{source}: key "{CHECKSUM}" = {str(stated)[:16]}... does not match the contents; '
            "the file was damaged or edited. Compute it again or restore a copy."
        )
    return values


def _parsed(text: str, source: str) -> dict[str, Any]:
    try:
        values = json.loads(text, object_pairs_hook=_unrepeated, parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{source}: not a readable JSON record ({error}); it may be cut off.") from error
    if not isinstance(values, dict):
        raise ResultError(f"{source}: holds a JSON {type(values).__name__}, not a record of keys.")
    return values


def _unrepeated(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) != len(pairs):
        raise ValueError("a key stands twice")
    return values


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")
