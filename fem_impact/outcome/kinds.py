"""What a value of each kind must look like; a complaint is a sentence, None means it is right."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from fem_impact.outcome.keys import Key, Kind
from fem_impact.outcome.table import CHOICE_FIELDS, CONTACT_FIELDS, KEY_TABLE

__all__ = ["complaint"]


def complaint(key: Key, value: Any) -> str | None:
    """Return why ``value`` cannot stand under ``key``, or None when it can.

    Parameters
    ----------
    key : Key
        The row of the table.
    value : object
        A plain JSON value (None, bool, int, float, str, list, dict).
    """
    if value is None:
        return None if key.nullable else "must not be null"
    return _CHECKS[key.kind](value)


def _number(value: Any) -> str | None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return "must be a number"
    return None if math.isfinite(value) else "must be finite"


def _count(value: Any) -> str | None:
    whole = isinstance(value, int) and not isinstance(value, bool) and value >= 0
    return None if whole else "must be a whole number, zero or more"


def _flag(value: Any) -> str | None:
    return None if isinstance(value, bool) else "must be true or false"


def _text(value: Any) -> str | None:
    return None if isinstance(value, str) else "must be a text"


def _texts(value: Any) -> str | None:
    right = isinstance(value, list) and all(isinstance(item, str) for item in value)
    return None if right else "must be a list of texts"


def _versions(value: Any) -> str | None:
    right = isinstance(value, dict) and all(isinstance(item, str) for item in value.values())
    return None if right else "must map names to versions (texts)"


def _contacts(value: Any) -> str | None:
    if not isinstance(value, list):
        return "must be a list of contact intervals"
    return next((found for found in map(_contact, value) if found), None)


def _contact(value: Any) -> str | None:
    fields = ", ".join(CONTACT_FIELDS)
    if not isinstance(value, dict) or set(value) != set(CONTACT_FIELDS):
        return f"must hold entries of exactly {fields}"
    if any(_number(item) for item in value.values()):
        return f"must hold finite numbers under {fields}"
    return None if value["start_s"] <= value["end_s"] else "has a contact that ends before it starts"


def _choices(value: Any) -> str | None:
    whole = isinstance(value, list) and all(
        isinstance(item, dict) and set(item) == set(CHOICE_FIELDS) for item in value
    )
    return None if whole else f"must be a list of entries of exactly {', '.join(CHOICE_FIELDS)}"


def _bands(value: Any) -> str | None:
    if not isinstance(value, dict):
        return "must map keys to half-widths"
    return next((found for found in map(_band, value, value.values()) if found), None)


def _band(name: str, width: Any) -> str | None:
    if name not in KEY_TABLE or KEY_TABLE[name].kind != "number":
        return f'names "{name}", which is no numeric key of the table'
    if _number(width) or width < 0.0:
        return f'gives "{name}" a half-width that is not a number of zero or more'
    return None


def _values(value: Any) -> str | None:
    if not isinstance(value, dict):
        return "must map keys to numbers"
    known = all(name in KEY_TABLE and KEY_TABLE[name].kind == "number" for name in value)
    right = known and not any(map(_number, value.values()))
    return None if right else "must give finite numbers to numeric keys of the table"


def _reasons(value: Any) -> str | None:
    if not isinstance(value, Mapping):
        return "must map null keys to sentences"
    right = all(isinstance(item, str) and item.strip() for item in value.values())
    return None if right else "must give every null key a sentence"


_CHECKS: dict[Kind, Callable[[Any], str | None]] = {
    "number": _number,
    "count": _count,
    "flag": _flag,
    "text": _text,
    "texts": _texts,
    "versions": _versions,
    "contacts": _contacts,
    "choices": _choices,
    "bands": _bands,
    "values": _values,
    "reasons": _reasons,
}
