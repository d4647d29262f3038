"""What a record must hold; complaints name file, key and value."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from fem_impact.errors import ResultError, did_you_mean
from fem_impact.outcome.keys import Key, Kind

__all__ = ["SCHEMA_VERSION", "check_record"]


SCHEMA_VERSION = 3
"""Raised whenever a key is renamed, removed, added or changes its meaning."""

FIDELITIES = ("rigid", "modal", "solid")

Table = Mapping[str, Key]


def check_record(values: Mapping[str, Any], table: Table, source: str) -> None:
    """Refuse a record that breaks the table of keys.

    Parameters
    ----------
    values : mapping
        Key to plain JSON value (None, bool, int, float, str, list, dict).
    table : mapping
        The keys by name.
    source : str
        The file or object named in the message.

    Raises
    ------
    ResultError
        With the file, the key, the value and the remedy.
    """
    _check_version(values, source)
    _check_names(values, table, source)
    for name, key in table.items():
        _refuse(_complaint(key, values[name]), name, values[name], source)
    if values["fidelity"] not in FIDELITIES:
        _refuse(f"must be one of {', '.join(FIDELITIES)}", "fidelity", values["fidelity"], source)
    for contact in values["contacts"] or ():
        if contact["start_s"] > contact["end_s"]:
            _refuse("has a contact that ends before it starts", "contacts", values["contacts"], source)
    limits, bands = values["mesh_limit"] or {}, values["mesh_band"] or {}
    _refuse(_limit_complaint(limits, table), "mesh_limit", limits, source)
    _refuse(_band_complaint(bands, limits), "mesh_band", bands, source)
    _check_reasons(values, table, source)


def _check_version(values: Mapping[str, Any], source: str) -> None:
    version = values.get("schema_version")
    if version != SCHEMA_VERSION or isinstance(version, bool):
        wrong = f"is not the version {SCHEMA_VERSION} that this program reads; compute the run again"
        _refuse(wrong, "schema_version", version, source)


def _check_names(values: Mapping[str, Any], table: Table, source: str) -> None:
    for name in values:
        if name not in table:
            hint = did_you_mean(str(name), table, "")
            raise ResultError(f'{source}: unknown key "{_short(name)}". {hint}'.rstrip())
    missing = [name for name in table if name not in values]
    if missing:
        raise ResultError(f'{source}: key "{missing[0]}" is missing ({len(missing)} in all).')


def _check_reasons(values: Mapping[str, Any], table: Table, source: str) -> None:
    reasons = values["reasons"]
    nulls = {name for name in table if values[name] is None}
    for name in sorted(nulls - set(reasons)):
        raise ResultError(f'{source}: key "{name}" is null, and "reasons" does not say why.')
    for name, reason in reasons.items():
        if name not in nulls:
            raise ResultError(f'{source}: "reasons" explains "{_short(name)}", which is not a null key.')
        if not reason.strip():
            raise ResultError(f'{source}: "reasons" must give the null key "{name}" a sentence.')


def _complaint(key: Key, value: Any) -> str | None:
    """Return why a value cannot stand under a key, None when it can."""
    if value is None:
        return None if key.nullable else "must not be null"
    if key.kind == "entries":
        return _entries_complaint(key, value)
    right, wrong = _RULES[key.kind]
    if right(value):
        return "must be finite" if key.kind == "number" and not math.isfinite(value) else None
    return wrong


def _entries_complaint(key: Key, value: Any) -> str | None:
    names = [entry.name for entry in key.entries]
    if not isinstance(value, list) or any(
        not isinstance(held, dict) or set(held) != set(names) for held in value
    ):
        return f"must be a list of entries of exactly {', '.join(names)}"
    wrong = ((entry, _complaint(entry, held[entry.name])) for held in value for entry in key.entries)
    return next((f'has an entry whose "{entry.name}" {why}' for entry, why in wrong if why), None)


def _limit_complaint(limits: Mapping[str, float], table: Table) -> str | None:
    strange = next((name for name in limits if name not in table or not table[name].banded), None)
    return None if strange is None else f'names "{strange}", a key that meshes give no limit'


def _band_complaint(bands: Mapping[str, float], limits: Mapping[str, float]) -> str | None:
    alone = next((name for name in bands if name not in limits), None)
    if alone is not None:
        return f'names "{alone}", which has no limit'
    return "gives a half-width below zero" if min(bands.values(), default=0.0) < 0.0 else None


def _refuse(wrong: str | None, name: str, value: Any, source: str) -> None:
    if wrong:
        raise ResultError(f'{source}: key "{name}" = {_short(value)} {wrong}.')


def _short(value: Any, limit: int = 60) -> str:
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _maps(value: Any, right: Callable[[Any], bool]) -> bool:
    return isinstance(value, dict) and all(map(right, value.values()))


_RULES: Mapping[Kind, tuple[Callable[[Any], bool], str]] = {
    "number": (_is_number, "must be a number"),
    "count": (
        lambda v: _is_number(v) and isinstance(v, int) and v >= 0,
        "must be a whole number, zero or more",
    ),
    "flag": (lambda v: isinstance(v, bool), "must be true or false"),
    "text": (lambda v: isinstance(v, str), "must be a text"),
    "texts": (
        lambda v: isinstance(v, list) and all(isinstance(item, str) for item in v),
        "must be a list of texts",
    ),
    "named texts": (lambda v: _maps(v, lambda item: isinstance(item, str)), "must map names to texts"),
    "named numbers": (
        lambda v: _maps(v, lambda item: _is_number(item) and math.isfinite(item)),
        "must map names to finite numbers",
    ),
}
