"""What a study publishes: findings, sheets of numbers, pictures with their data, the ledger of every run."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fem_impact.figures.lines import Panel, lines_figure
from fem_impact.outcome import Outcome, or_none
from fem_impact.output import make_directory, write_table, write_text
from fem_impact.output.tables import Cell
from fem_impact.scale import Results
from fem_impact.study.markdown import table
from fem_impact.study.request import Request, StudyResult, failures_of

__all__ = ["FINDINGS", "LEDGER", "Paper", "Picture", "Sheet", "publish"]

FINDINGS = "fem-impact/findings/1"
LEDGER = (
    *("run", "fidelity", "scene_digest", "tip_size_m", "contacts", "e_edge", "mu", "Omega_rad_per_s"),
    *("E_r_over_E_0", "E_vib_over_E_0", "W_friction_over_E_0", "E_plastic_rod_over_E_0"),
    *("E_plastic_barrier_over_E_0", "residual_over_E_0", "wall_s", "created_utc"),
)


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table: CSV of its name, and shown in the summary unless it is long."""

    name: str
    caption: str
    columns: tuple[str, ...]
    rows: Sequence[Sequence[Cell]]
    shown: bool = True


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure: name of its files, caption, and what it draws."""

    name: str
    caption: str
    panels: tuple[Panel, ...]
    columns: int = 2


@dataclass(frozen=True, slots=True)
class Paper:
    """A study as it is told: its name, title, findings in sentences, pictures, sheets and sources.

    ``sources`` name entries of the report's list of papers; ``assumptions`` state ranges and limits;
    ``conclusions`` are the findings for the report's first page, by the picture that shows them.
    """

    study: str
    title: str
    findings: Sequence[str]
    pictures: Sequence[Picture] = ()
    sheets: Sequence[Sheet] = ()
    assumptions: Sequence[str] = ()
    sources: Sequence[str] = ()
    conclusions: Sequence[tuple[str, str]] = ()


def publish(paper: Paper, request: Request, results: Results) -> StudyResult:
    """Write study.json, summary.md, a CSV a sheet, and each picture (SVG, PNG, phone width) with its data."""
    ledger = [_ledger_row(name, run) for name, run in results.items() if isinstance(run, Outcome)]
    document = _document(paper, request, results)
    for picture in paper.pictures:
        _draw(picture, make_directory(request.out / "figures"))
    for sheet in paper.sheets:
        write_table(request.out / f"{sheet.name}.csv", sheet.columns, sheet.rows)
    write_table(request.out / "runs.csv", LEDGER, ledger)
    text = _markdown(paper, document)
    write_text(request.out / "summary.md", text)
    write_text(request.out / "study.json", json.dumps(document, indent=1, allow_nan=False))
    return StudyResult(document, text)


def _document(paper: Paper, request: Request, results: Results) -> dict[str, Any]:
    return {
        "schema": FINDINGS,
        "study": paper.study,
        "title": paper.title,
        "command": request.command(paper.study),
        "findings": list(paper.findings),
        "conclusions": [{"name": name, "sentence": sentence} for name, sentence in paper.conclusions],
        "assumptions": list(paper.assumptions),
        "sources": list(paper.sources),
        "figures": [{"name": p.name, "caption": p.caption} for p in paper.pictures],
        "sheets": [_sheet(sheet) for sheet in paper.sheets],
        "runs": len(results),
        "failures": failures_of(results),
    }


def _sheet(sheet: Sheet) -> dict[str, Any]:
    rows = [list(row) for row in sheet.rows] if sheet.shown else []
    return {"name": sheet.name, "caption": sheet.caption, "columns": list(sheet.columns), "rows": rows}


def _ledger_row(name: str, run: Outcome) -> list[Cell]:
    intervals = or_none(run.contact.intervals)
    contacts = None if intervals is None else len(intervals)
    values = {**run.to_dict(), "run": name, "contacts": contacts}
    return [values[column] for column in LEDGER]


def _draw(picture: Picture, place: Path) -> None:
    stem = place / picture.name
    for suffix in (".svg", ".png"):
        lines_figure(picture.panels, stem.with_suffix(suffix), "wide", picture.columns)
    narrow = stem.with_name(f"{picture.name}-narrow.svg")
    lines_figure(picture.panels, narrow, "narrow")
    narrow.with_suffix(".csv").unlink()  # the same numbers stand beside the wide one


def _markdown(paper: Paper, document: Mapping[str, Any]) -> str:
    ran = f"`{document['command']}`: {document['runs']} runs, {len(document['failures'])} failed."
    parts = [f"# {paper.title}", ran, _bullets(paper.findings)]
    parts += [f"![{p.caption}](figures/{p.name}.png)\n\n{p.caption}" for p in paper.pictures]
    for sheet in paper.sheets:
        parts += [f"{sheet.caption} (`{sheet.name}.csv`)", *([_shown(sheet)] if sheet.shown else [])]
    parts += ["What it rests on:", _bullets(paper.assumptions)] if paper.assumptions else []
    parts += [f"failed: {f['scene_id']}: {f['error']}" for f in document["failures"]]
    return "\n\n".join(parts) + "\n"


def _bullets(sentences: Sequence[str]) -> str:
    return "\n".join(f"- {sentence}" for sentence in sentences)


def _shown(sheet: Sheet) -> str:
    return table(list(sheet.columns), [[_text(cell) for cell in row] for row in sheet.rows])


def _text(cell: Cell) -> str:
    if cell is None:
        return "–"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)
