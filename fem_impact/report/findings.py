"""The part of a page that tells one study: sentences, pictures with their data, tables, command, limits."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text
from fem_impact.report.html import Markup, bullets, details, join, number, paragraph, place, section, table
from fem_impact.report.page import data_link, download, stored_picture
from fem_impact.report.study_data import Study
from fem_impact.study.inputs import WORDS

__all__ = ["FINDINGS", "figure_id", "findings_section", "miss_sentence", "misses_section", "read_findings"]


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


Row = Mapping[str, Any]
COLUMNS = ("set", "quantity", "input", "base", "changed")


def misses_section(study: Study) -> Markup:
    """Return, for each quantity outside its interval, which inputs could explain it and which not."""
    if not study.explanations:
        return Markup("")
    head = (
        "set",
        "quantity",
        "model",
        "measured",
        "could explain it",
        "share of the miss that each makes up",
    )
    shown = [_row(row) for row in study.explanations]
    told = [f"{name}: {meaning}" for name, meaning in WORDS.items()]
    link = Markup(f"<p>{data_link(_data(study.sensitivity), 'sensitivity.csv', 'what every input does')}</p>")
    return section(
        "What could explain the misses",
        paragraph(miss_sentence(study.explanations)),
        paragraph(
            "Each uncertain input was changed alone, on the coarser mesh, as far as its sources allow. A "
            "share of 100 % brings the model to the measured mean, one below 0 takes it further away."
        ),
        details("Quantity by quantity", table(head, shown, numbers=(2, 3))),
        details("What was changed", bullets(told)),
        link,
    )


def miss_sentence(rows: Sequence[Row]) -> str:
    """Say how many misses each input could explain, and how many none could."""
    counts = {name: sum(name in row["could"] for row in rows) for name in WORDS}
    ranked = sorted((name for name in counts if counts[name]), key=lambda name: -counts[name])
    listed = ", ".join(f"{name} {counts[name]}" for name in ranked) or "none"
    lost = sum(not row["could"] for row in rows)
    return (
        f"{len(rows)} computed quantities lie outside the 95 % interval of the measured mean. An uncertain "
        f"input, changed alone, could explain: {listed}. None of them explains {lost}."
    )


def _row(row: Row) -> list[str]:
    shares = ", ".join(f"{name} {share:+.0%}" for name, share in row["shares"].items())
    could = ", ".join(row["could"]) or "none of these"
    return [row["set"], row["quantity"], number(row["model"]), number(row["measured_mean"]), could, shares]


def _data(rows: Sequence[Row]) -> bytes:
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([row[name] for name in COLUMNS] for row in rows)
    return lines.getvalue().encode()
