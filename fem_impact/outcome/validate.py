"""Whole-record checks, with messages that name file, key and value."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Any

from fem_impact.errors import ResultError
from fem_impact.outcome.keys import KEYS, SCHEMA_VERSION
from fem_impact.outcome.kinds import complaint
from fem_impact.outcome.table import KEY_TABLE

__all__ = ["check_record"]

FIDELITIES = ("rigid", "modal", "solid")


def check_record(values: Mapping[str, Any], source: str) -> None:
    """Refuse a record that breaks the table of keys.

    Parameters
    ----------
    values : mapping
        Key to plain JSON value.
    source : str
        The file or object named in the message.

    Raises
    ------
    ResultError
        With the file, the key, the value and the remedy.
    """
    _check_version(values, source)
    _check_names(values, source)
    for key in KEYS:
        _refuse(complaint(key, values[key.name]), key.name, values[key.name], source)
    fidelity = values["fidelity"]
    wrong = None if fidelity in FIDELITIES else f"must be one of {', '.join(FIDELITIES)}"
    _refuse(wrong, "fidelity", fidelity, source)
    _check_reasons(values, source)


def _check_version(values: Mapping[str, Any], source: str) -> None:
    version = values.get("schema_version")
    if version != SCHEMA_VERSION or isinstance(version, bool):
        wrong = f"is not the version {SCHEMA_VERSION} that this program reads; compute the run again"
        _refuse(wrong, "schema_version", version, source)


def _check_names(values: Mapping[str, Any], source: str) -> None:
    for name in values:
        if name not in KEY_TABLE:
            near = difflib.get_close_matches(str(name), KEY_TABLE, n=1)
            hint = f' Did you mean "{near[0]}"?' if near else ""
            raise ResultError(f'{source}: unknown key "{_short(name)}".{hint}')
    missing = [name for name in KEY_TABLE if name not in values]
    if missing:
        raise ResultError(f'{source}: key "{missing[0]}" is missing ({len(missing)} in all).')


def _check_reasons(values: Mapping[str, Any], source: str) -> None:
    reasons = values["reasons"]
    nulls = {name for name in KEY_TABLE if values[name] is None}
    for name in sorted(nulls - set(reasons)):
        raise ResultError(f'{source}: key "{name}" is null, and "reasons" does not say why.')
    for name in sorted(set(reasons) - nulls):
        raise ResultError(f'{source}: "reasons" explains "{_short(name)}", which is not a null key.')


def _refuse(wrong: str | None, name: str, value: Any, source: str) -> None:
    if wrong:
        raise ResultError(f'{source}: key "{name}" = {_short(value)} {wrong}.')


def _short(value: Any, limit: int = 60) -> str:
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."
