"""The part of a page that tells one study: sentences, pictures with their data, tables, command, limits."""

from __future__ import annotations

import json
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

from fem_impact.errors import ResultError
from fem_impact.output import read_text
from fem_impact.report.embed import download, stored_picture
from fem_impact.report.html import Markup, bullets, details, join, number, paragraph, place, section, table

__all__ = ["FINDINGS", "figure_id", "findings_section", "read_findings"]

FINDINGS = "fem-impact/findings/1"
WANTED = {"study": str, "title": str, "command": str, "findings": list, "assumptions": list, "sources": list}
PARTS = {
    "figures": ("name", "caption"),
    "sheets": ("name", "caption", "columns", "rows"),
    "conclusions": ("name", "sentence"),
}


def read_findings(folder: Path) -> dict[str, Any] | None:
    """Return the study.json of a folder if it is one of findings, None if it is none or another kind.

    Raises
    ------
    ResultError
        The file is damaged.
    """
    path = folder / "study.json"
    if not path.is_file():
        return None
    try:
        held = json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{path}: not readable JSON ({error}); it may be cut off.") from error
    if not isinstance(held, dict) or held.get("schema") != FINDINGS:
        return None
    held.setdefault("conclusions", [])  # none in those of an earlier version
    _check(held, path)
    return held


def _check(held: Mapping[str, Any], path: Path) -> None:
    for name, kind in WANTED.items():
        if not isinstance(held.get(name), kind):
            raise ResultError(f'{path}: key "{name}" is missing or of the wrong kind.')
    for name, keys in PARTS.items():
        items = held.get(name)
        if not isinstance(items, list) or not all(_has(item, keys) for item in items):
            raise ResultError(f'{path}: key "{name}" must be a list of records with {", ".join(keys)}.')


def _has(item: object, keys: tuple[str, ...]) -> bool:
    # a name becomes part of a path
    return isinstance(item, dict) and set(keys) <= set(item) and Path(str(item["name"])).name == item["name"]


def findings_section(held: Mapping[str, Any], folder: Path) -> Markup:
    """Return the study of a folder, its pictures and data inside."""
    runs = f"{held['runs']} runs, {len(held['failures'])} failed."
    failed = table(("run", "why"), [(f["scene_id"], f["error"]) for f in held["failures"]])
    return section(
        held["title"],
        bullets(held["findings"]),
        *(_figure(entry, held["study"], folder) for entry in held["figures"]),
        *(_sheet(sheet, folder) for sheet in held["sheets"]),
        details("What it rests on", bullets(held["assumptions"])),
        Markup(f"<p>{escape(runs)} <code>{escape(held['command'])}</code></p>"),
        failed,
    )


def figure_id(study: str, name: str) -> str:
    """Return the name under which a page links to a study's figure."""
    return f"{study}-{name}"


def _figure(entry: Mapping[str, Any], study: str, folder: Path) -> Markup:
    stem = folder / "figures" / entry["name"]
    shown = place(figure_id(study, entry["name"]), stored_picture(stem, entry["caption"]))
    return join([shown, download(stem.with_suffix(".csv"), "its data")])


def _sheet(sheet: Mapping[str, Any], folder: Path) -> Markup:
    columns = range(len(sheet["columns"]))
    rows = [[_cell(cell) for cell in row] for row in sheet["rows"]]
    shown = table(sheet["columns"], rows, numbers=columns, compact=True)
    link = download(folder / f"{sheet['name']}.csv", f"{sheet['name']}.csv")
    return details(sheet["caption"], shown, link) if rows else join([paragraph(sheet["caption"]), link])


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else number(value)
