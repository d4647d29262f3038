"""The record as text: canonical JSON with a checksum, read back strictly."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from fem_impact.errors import ResultError

__all__ = ["CHECKSUM", "from_text", "plain", "to_text"]

CHECKSUM = "checksum_sha256"
"""Last key of the file: SHA-256 of everything else, so that a damaged file cannot pass for a result."""


def plain(value: Any) -> Any:
    """Return ``value`` as plain JSON types: NumPy scalars unpacked, tuples as lists, mappings as dicts."""
    if isinstance(value, Mapping):
        return {str(name): plain(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return plain(value.tolist()) if hasattr(value, "tolist") else value


def to_text(values: Mapping[str, Any]) -> str:
    """Return the JSON text of a record, its checksum last."""
    signed = {**values, CHECKSUM: _checksum(values)}
    return json.dumps(signed, indent=2, allow_nan=False, ensure_ascii=True) + "\n"


def from_text(text: str, source: str) -> dict[str, Any]:
    """Return the record in ``text`` after its checksum was found right.

    Raises
    ------
    ResultError
        The text is no JSON object, repeats a key, holds a number JSON does not know, or was altered.
    """
    try:
        values = json.loads(text, object_pairs_hook=_unrepeated, parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{source}: not a readable JSON record ({error}); it may be cut off.") from error
    if not isinstance(values, dict):
        raise ResultError(f"{source}: holds a JSON {type(values).__name__}, not a record of keys.")
    return _unsigned(values, source)


def _unsigned(values: dict[str, Any], source: str) -> dict[str, Any]:
    stated = values.pop(CHECKSUM, None)
    if stated is None:
        raise ResultError(f'{source}: key "{CHECKSUM}" is missing; this is no complete outcome.')
    if stated != _checksum(values):
        raise ResultError(
            f'{source}: key "{CHECKSUM}" = {str(stated)[:16]}... does not match the contents; '
            "the file was damaged or edited. Compute the run again or restore a copy."
        )
    return values


def _checksum(values: Mapping[str, Any]) -> str:
    canonical = json.dumps(dict(values), sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(canonical.encode("ascii")).hexdigest()


def _unrepeated(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) != len(pairs):
        raise ValueError("a key stands twice")
    return values


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")
