"""What is asked of a study, and what a study is: jobs, and what follows from their results."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.figures.lines import Panel, lines_figure
from fem_impact.files.atomic import make_directory, write_text
from fem_impact.jobs.job import Failure, Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.tables.csv import Cell, write_table
from fem_impact.tables.markdown import table

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter

__all__ = [
    "FINDINGS",
    "LEDGER",
    "Paper",
    "Picture",
    "Request",
    "Sheet",
    "StudyResult",
    "failures_of",
    "publish",
]


@dataclass(frozen=True, slots=True)
class Request:
    """What is asked of a study.

    Attributes
    ----------
    out : Path
        Directory of the study, with the store of its results.
    ids : tuple of str
        Measured sets, where the study is about them; all when empty.
    quick : bool
        A small version for a first look.
    fidelity : str
        Of the studies that leave the choice; each has its default.
    """

    out: Path
    ids: tuple[str, ...] = ()
    quick: bool = False
    fidelity: str = ""

    def command(self, study: str) -> str:
        """Return the command that asks for this."""
        options = [*self.ids, *(["--quick"] if self.quick else [])]
        options += ["--fidelity", self.fidelity] if self.fidelity else []
        return " ".join(["fem-impact study", study, *options])


@dataclass(frozen=True, slots=True)
class StudyResult:
    """The document that study.json holds, its text for a terminal, directories of runs to be presented."""

    document: dict[str, Any]
    text: str
    runs: tuple[Path, ...] = ()


Plan = Callable[[Request, Results], list[Job]]
Conclude = Callable[[Request, Results, "ProgressMeter"], StudyResult]


def failures_of(results: Results) -> list[dict[str, str]]:
    """Return one row a failed job."""
    failed = (result for result in results.values() if isinstance(result, Failure))
    return [{"scene_id": failure.name, "error": failure.reason} for failure in failed]


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
