"""Reader of study.json; damaged or missing parts are refused."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text
from fem_impact.outcome.record import Outcome
from fem_impact.study.document import SCHEMA
from fem_impact.tables.csv import COMPARISON

Record = Mapping[str, Any]
TEXTS = ("study", "title", "command")
SENTENCES = ("findings", "assumptions", "sources")
RECORDS = {
    "conclusions": ("name", "sentence"),
    "figures": ("name", "caption"),
    "sheets": ("name", "caption", "columns", "rows"),
    "failures": ("scene_id", "error"),
    "comparison": COMPARISON,
}
NUMBERS = ("model", "band", "measured_mean", "measured_sd", "measured_low", "measured_high", "n")


@dataclass(frozen=True, slots=True)
class Study:
    """What a study published (`fem_impact.study.document.StudyReport`), as its page needs it.

    Parameters
    ----------
    folder : Path
        Directory of the study, with its figures and CSV tables.
    study, title, command : str
    findings, assumptions, sources : tuple of str
    conclusions, figures, sheets : tuple of mappings
    runs : int
        Jobs of the study.
    failures : tuple of mappings
        Runs that gave no record: ``scene_id`` and ``error``.
    rows : tuple of Outcome
        Runs that the page shows one by one.
    comparison : tuple of mappings
        Rows with the keys of `fem_impact.tables.csv.COMPARISON`.
    """

    folder: Path
    study: str
    title: str
    command: str
    findings: tuple[str, ...]
    assumptions: tuple[str, ...]
    sources: tuple[str, ...]
    conclusions: tuple[Record, ...]
    figures: tuple[Record, ...]
    sheets: tuple[Record, ...]
    runs: int
    failures: tuple[Record, ...]
    rows: tuple[Outcome, ...]
    comparison: tuple[Record, ...]


def read_study(folder: Path) -> Study:
    """Read ``folder/study.json``.

    Raises
    ------
    ResultError
        The file is missing, damaged or of another schema, or a part of it is wrong; file and place are named.
    """
    path = folder / "study.json"
    document = _document(path)
    parts: dict[str, Any] = {name: _typed(document, name, str, path) for name in TEXTS}
    parts |= {name: tuple(map(str, _typed(document, name, list, path))) for name in SENTENCES}
    parts |= {name: _records(document, name, keys, path) for name, keys in RECORDS.items()}
    _check_names([*parts["figures"], *parts["sheets"]], path)
    _check_numbers(parts["comparison"], path)
    rows = tuple(
        Outcome.from_dict(row, source=f"{path}: rows[{at}]")
        for at, row in enumerate(_records(document, "rows", (), path))
    )
    runs = _typed(document, "runs", int, path)
    return Study(folder, **parts, rows=rows, runs=runs)


def _document(path: Path) -> dict[str, Any]:
    try:
        document = json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{path}: not readable JSON ({error}); it may be cut off.") from error
    schema = document.get("schema") if isinstance(document, dict) else None
    if schema != SCHEMA:
        raise ResultError(f'{path}: key "schema" = {schema!r} is not {SCHEMA!r}; run the study again.')
    return dict(document)


def _typed(document: Record, name: str, kind: type, path: Path) -> Any:
    if not isinstance(document.get(name), kind):
        raise ResultError(f'{path}: key "{name}" is missing or of the wrong kind.')
    return document[name]


def _records(document: Record, name: str, keys: tuple[str, ...], path: Path) -> tuple[Any, ...]:
    items = document.get(name)
    if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
        raise ResultError(f'{path}: key "{name}" must be a list of records.')
    for at, item in enumerate(items):
        missing = [key for key in keys if key not in item]
        if missing:
            raise ResultError(f'{path}: {name}[{at}] lacks the key "{missing[0]}".')
    return tuple(items)


def _check_names(records: list[Record], path: Path) -> None:
    """Refuse a name that is no plain file name, since it becomes part of a path."""
    for record in records:
        if Path(str(record["name"])).name != record["name"]:
            raise ResultError(f'{path}: key "name" = {record["name"]!r} is no name of a figure or table.')


def _check_numbers(rows: tuple[Record, ...], path: Path) -> None:
    for at, row in enumerate(rows):
        for name in NUMBERS:
            value = row[name]
            if value is not None and (isinstance(value, bool) or not isinstance(value, int | float)):
                raise ResultError(f'{path}: comparison[{at}], key "{name}" = {value!r} is not a number.')
