"""Checks of a record: its JSON Schema and further rules; error messages name file, key and value."""

import math
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any

import fastjsonschema

from fem_impact.errors import ResultError, did_you_mean
from fem_impact.options import FIDELITIES
from fem_impact.outcome.keys import Key, Kind

SCHEMA_VERSION = 18
"""Raised whenever a key is renamed, removed, added or changes its meaning."""

# JSON Schema of a value by its kind, and the text of the error message
SHAPES: Mapping[Kind, tuple[Mapping[str, Any], str]] = {
    "number": ({"type": "number"}, "must be a number"),
    "count": ({"type": "integer", "minimum": 0}, "must be a whole number, zero or more"),
    "flag": ({"type": "boolean"}, "must be true or false"),
    "text": ({"type": "string"}, "must be a text"),
    "texts": ({"type": "array", "items": {"type": "string"}}, "must be a list of texts"),
    "named texts": (
        {"type": "object", "additionalProperties": {"type": "string"}},
        "must map names to texts",
    ),
    "named numbers": (
        {"type": "object", "additionalProperties": {"type": "number"}},
        "must map names to finite numbers",
    ),
}


def json_schema(keys: Iterable[Key]) -> dict[str, Any]:
    """Return the JSON Schema (draft 7) of a record with these keys; a checksum may stand beside them."""
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": f"Outcome of one run of fem-impact, version {SCHEMA_VERSION}",
        **_object(keys),
    }


def check_record(values: Mapping[str, Any], keys: tuple[Key, ...], source: str) -> None:
    """Refuse a record that breaks the schema of its keys or a rule that a schema cannot state.

    Parameters
    ----------
    values : mapping
        Key to plain JSON value (None, bool, int, float, str, list, dict).
    keys : tuple
        All keys of a record.
    source : str
        The file or object named in the message.

    Raises
    ------
    ResultError
        With the file, the key, the value and the remedy.
    """
    table = {key.name: key for key in keys}
    version = values.get("schema_version")
    if version != SCHEMA_VERSION or isinstance(version, bool):
        wrong = f"is not the version {SCHEMA_VERSION} that this program reads; compute the run again"
        raise _fault(wrong, "schema_version", version, source)
    _check_names(values, table, source)
    _check_shapes(values, keys, source)
    for key in keys:
        if key.kind == "number" and values[key.name] is not None and not math.isfinite(values[key.name]):
            raise _fault("must be finite", key.name, values[key.name], source)
    if values["fidelity"] not in FIDELITIES:
        raise _fault(f"must be one of {', '.join(FIDELITIES)}", "fidelity", values["fidelity"], source)
    for contact in values["contacts"] or ():
        if contact["start_s"] > contact["end_s"]:
            wrong = "has a contact that ends before it starts"
            raise _fault(wrong, "contacts", values["contacts"], source)
    _check_bands(values["mesh_limit"] or {}, values["mesh_band"] or {}, table, source)
    if min((values["model_band"] or {}).values(), default=0.0) < 0.0:
        raise _fault("gives a half-width below zero", "model_band", values["model_band"], source)
    _check_reasons(values, table, source)


def _object(keys: Iterable[Key]) -> dict[str, Any]:
    properties = {key.name: {"description": key.meaning, **_shape(key)} for key in keys}
    return {"type": "object", "properties": properties, "required": list(properties)}


def _shape(key: Key) -> dict[str, Any]:
    if key.kind == "entries":
        entry = {**_object(key.entries), "additionalProperties": False}
        shape: dict[str, Any] = {"type": "array", "items": entry}
    else:
        shape = {**SHAPES[key.kind][0], **({"enum": list(key.choices)} if key.choices else {})}
    return {**shape, "type": [shape["type"], "null"]} if key.nullable else shape


@cache
def _validator(keys: tuple[Key, ...]) -> Callable[[Any], Any]:
    validate: Callable[[Any], Any] = fastjsonschema.compile(json_schema(keys))
    return validate


def _check_shapes(values: Mapping[str, Any], keys: tuple[Key, ...], source: str) -> None:
    """Refuse values that break the schema, with the message for the kind of the key."""
    try:
        _validator(keys)(dict(values))
    except fastjsonschema.JsonSchemaValueException as error:
        name, *inner = error.path[1:]
        key = next(key for key in keys if key.name == name)
        raise _fault(_shape_complaint(key, values[name], inner), name, values[name], source) from None


def _shape_complaint(key: Key, value: Any, inner: list[str]) -> str:
    """Return the fault of a value, or of the part of it at the path ``inner``."""
    if value is None:
        return "must not be null"
    if key.kind != "entries":
        return _demand(key)
    entry = next((entry for entry in key.entries if entry.name in inner), None)
    if entry is None:
        return f"must be a list of entries of exactly {', '.join(entry.name for entry in key.entries)}"
    return f'has an entry whose "{entry.name}" {_demand(entry)}'


def _demand(key: Key) -> str:
    return f"must be one of {', '.join(key.choices)}" if key.choices else SHAPES[key.kind][1]


def _check_names(values: Mapping[str, Any], table: Mapping[str, Key], source: str) -> None:
    for name in values:
        if name not in table:
            hint = did_you_mean(str(name), table, "")
            raise ResultError(f'{source}: unknown key "{_short(name)}". {hint}'.rstrip())
    missing = [name for name in table if name not in values]
    if missing:
        raise ResultError(f'{source}: key "{missing[0]}" is missing ({len(missing)} in all).')


def _check_reasons(values: Mapping[str, Any], table: Mapping[str, Key], source: str) -> None:
    reasons = values["reasons"]
    nulls = {name for name in table if values[name] is None}
    for name in sorted(nulls - set(reasons)):
        raise ResultError(f'{source}: key "{name}" is null, and "reasons" does not say why.')
    for name, reason in reasons.items():
        if name not in nulls:
            raise ResultError(f'{source}: "reasons" explains "{_short(name)}", which is not a null key.')
        if not reason.strip():
            raise ResultError(f'{source}: "reasons" must give the null key "{name}" a sentence.')


def _check_bands(
    limits: Mapping[str, float], bands: Mapping[str, float], table: Mapping[str, Key], source: str
) -> None:
    """Refuse a limit of a key that has none, a band without its limit, and a half-width below zero."""
    for name in limits:
        if name not in table or not table[name].banded:
            wrong = f'names "{name}", a key that meshes give no limit'
            raise _fault(wrong, "mesh_limit", limits, source)
    for name, width in bands.items():
        if name not in limits:
            raise _fault(f'names "{name}", which has no limit', "mesh_band", bands, source)
        if width < 0.0:
            raise _fault("gives a half-width below zero", "mesh_band", bands, source)


def _fault(wrong: str, name: str, value: Any, source: str) -> ResultError:
    return ResultError(f'{source}: key "{name}" = {_short(value)} {wrong}.')


def _short(value: Any, limit: int = 60) -> str:
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."
