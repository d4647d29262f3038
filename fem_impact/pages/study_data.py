"""Reader of study.json; damaged or missing parts are refused."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import fastjsonschema

from fem_impact.answers.report import SCHEMA
from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text
from fem_impact.files.signed_json import read_signed
from fem_impact.outcome.record import Outcome
from fem_impact.tables.csv import COMPARISON

Record = Mapping[str, Any]
TEXTS = ("study", "title", "command")
SENTENCES = ("findings", "assumptions", "sources")
NUMBERS = ("model", "measured_mean", "measured_low", "measured_high")
WIDTHS = ("band", "measured_sd", "n")  # numbers that are never below zero


def _list(items: Mapping[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


def _record(**properties: Mapping[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": list(properties)}


_TEXT, _NUMBER = {"type": "string"}, {"type": ["number", "null"]}
_WIDTH = {**_NUMBER, "minimum": 0}
_FILE = {"type": "string", "pattern": r"^[A-Za-z0-9][\w.-]*$"}  # it becomes part of a path
RECORDS: Mapping[str, dict[str, Any]] = {
    "conclusions": _record(name=_TEXT, sentence=_TEXT),
    "figures": _record(name=_FILE, caption=_TEXT),
    "sheets": _record(
        name=_FILE,
        caption=_TEXT,
        columns=_list(_TEXT),
        rows=_list(_list({"type": ["string", "number", "boolean", "null"]})),
    ),
    "failures": _record(scene_id=_TEXT, error=_TEXT),
    "comparison": _record(
        **dict.fromkeys(COMPARISON, _TEXT) | dict.fromkeys(NUMBERS, _NUMBER) | dict.fromkeys(WIDTHS, _WIDTH)
    ),
}
STUDY_SCHEMA = _record(
    **dict.fromkeys(TEXTS, _TEXT),
    **dict.fromkeys(SENTENCES, _list(_TEXT)),
    **{name: _list(record) for name, record in RECORDS.items()},
    runs={"type": "integer", "minimum": 0},
    rows=_list({"type": "object"}),
)
"""JSON Schema (draft 7) of study.json; its rows are outcomes."""


@dataclass(frozen=True, slots=True)
class Study:
    """What a study published (`fem_impact.answers.report.StudyReport`), as its page needs it.

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
    document = read_signed(read_text(path), str(path))
    if document.get("schema") != SCHEMA:
        stated = json.dumps(document.get("schema"))[:40]
        raise ResultError(f'{path}: key "schema" = {stated} is not "{SCHEMA}"; run the study again.')
    _check_shape(document, path)
    rows = tuple(
        Outcome.from_dict(row, source=f"{path}: rows[{at}]") for at, row in enumerate(document["rows"])
    )
    parts: dict[str, Any] = {name: tuple(document[name]) for name in (*SENTENCES, *RECORDS)}
    texts = {name: document[name] for name in TEXTS}
    return Study(folder, **texts, **parts, rows=rows, runs=document["runs"])


def _check_shape(document: Record, path: Path) -> None:
    """Refuse a document that breaks `STUDY_SCHEMA`, or a table whose rows do not fit its columns."""
    try:
        _validator()(document)
    except fastjsonschema.JsonSchemaValueException as error:
        raise ResultError(f"{path}: {error.message.removeprefix('data').lstrip('. ')}.") from None
    for sheet in document["sheets"]:
        if any(len(row) != len(sheet["columns"]) for row in sheet["rows"]):
            raise ResultError(f'{path}: a row of the table "{sheet["name"]}" does not fit its columns.')


@cache
def _validator() -> Callable[[Any], Any]:
    validate: Callable[[Any], Any] = fastjsonschema.compile(STUDY_SCHEMA)
    return validate
