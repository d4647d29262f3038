"""The file of a study, read strictly."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text
from fem_impact.outcome.record import Outcome
from fem_impact.tables.csv import COMPARISON

__all__ = ["STUDY_SCHEMA", "Study", "read_study"]


STUDY_SCHEMA = "fem-impact/study/1"
TOLD = {
    "explanations": ("set", "quantity", "model", "measured_mean", "shares", "could"),
    "sensitivity": ("set", "quantity", "input", "base", "changed"),
}


@dataclass(frozen=True, slots=True)
class Study:
    """A study as its report needs it.

    Parameters
    ----------
    title : str
    rows : tuple of Outcome
        One record a run.
    comparison : tuple of mappings
        Rows with the keys of ``fem_impact.output.COMPARISON``.
    failures : tuple of mappings
        Runs that gave no record: ``scene_id`` and ``error``.
    notes : tuple of str
        Sentences of the study, such as the friction rule.
    explanations : tuple of mappings
        What could explain a quantity outside its interval (`fem_impact.study.inputs.explanations`).
    sensitivity : tuple of mappings
        What each changed input does: ``set``, ``quantity``, ``input``, ``base``, ``changed``.
    """

    title: str
    rows: tuple[Outcome, ...]
    comparison: tuple[Mapping[str, Any], ...]
    failures: tuple[Mapping[str, str], ...]
    notes: tuple[str, ...]
    explanations: tuple[Mapping[str, Any], ...]
    sensitivity: tuple[Mapping[str, Any], ...]


def read_study(path: str | Path) -> Study:
    """Read study.json: ``schema``, ``rows``, ``comparison``; optional ``title``, ``failures``, ``notes``.

    Raises
    ------
    ResultError
        The file is missing, damaged or of another schema, or a row is wrong; file and place are named.
    """
    held = _object(path)
    if held.get("schema") != STUDY_SCHEMA:
        raise ResultError(f'{path}: key "schema" = {held.get("schema")!r} is not {STUDY_SCHEMA!r}.')
    listed = enumerate(_list(held, "rows", path))
    rows = [Outcome.from_dict(row, source=f"{path}: rows[{at}]") for at, row in listed]
    comparison = _list(held, "comparison", path)
    for at, row in enumerate(comparison):
        _check(row, at, path)
    failures = [
        {"scene_id": str(item.get("scene_id", "?")), "error": str(item.get("error", "no reason given"))}
        for item in _list(held, "failures", path)
    ]
    notes = [str(note) for note in held.get("notes") or []]
    title = str(held.get("title") or "Model beside measurement")
    told = {name: _records(held, name, keys, path) for name, keys in TOLD.items()}
    return Study(title, tuple(rows), tuple(comparison), tuple(failures), tuple(notes), **told)


def _object(path: str | Path) -> dict[str, Any]:
    try:
        held = json.loads(read_text(path))
    except (json.JSONDecodeError, RecursionError) as error:
        raise ResultError(f"{path}: not readable JSON ({error}); it may be cut off.") from error
    if not isinstance(held, dict):
        raise ResultError(f"{path}: holds no study.")
    return held


def _list(held: Mapping[str, Any], name: str, path: str | Path) -> list[dict[str, Any]]:
    items = held.get(name, [])
    if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
        raise ResultError(f'{path}: key "{name}" must be a list of records.')
    return items


def _records(
    held: Mapping[str, Any], name: str, keys: tuple[str, ...], path: str | Path
) -> tuple[Mapping[str, Any], ...]:
    items = _list(held, name, path)
    for at, item in enumerate(items):
        missing = [key for key in keys if key not in item]
        if missing:
            raise ResultError(f'{path}: {name}[{at}] lacks the key "{missing[0]}".')
    return tuple(items)


def _check(row: Mapping[str, Any], at: int, path: str | Path) -> None:
    missing = [name for name in COMPARISON if name not in row]
    if missing:
        raise ResultError(f'{path}: comparison[{at}] lacks the key "{missing[0]}".')
    for name in ("model", "band", "measured_mean", "measured_sd", "measured_low", "measured_high", "n"):
        value = row[name]
        if value is not None and (isinstance(value, bool) or not isinstance(value, int | float)):
            raise ResultError(f'{path}: comparison[{at}], key "{name}" = {value!r} is not a number.')
