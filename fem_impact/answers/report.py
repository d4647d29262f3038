"""Request and result of a study, its report, and how the report is written.

A study of `fem_impact.evidence` makes such a report from its results; so do `sweep` and `cost`.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from fem_impact.errors import ResultError
from fem_impact.figures.live import live
from fem_impact.figures.panels import Picture
from fem_impact.figures.still import draw
from fem_impact.files.atomic import make_directory, read_signed, read_text, signed, write_text
from fem_impact.files.run_directory import set_aside
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import shares
from fem_impact.tables.table import Cell, Table


@dataclass(frozen=True, slots=True)
class Request:
    """Options of a study.

    Attributes
    ----------
    out : Path
        Directory of the study, with the store of its results.
    ids : tuple of str
        Measured sets or hard cases, where the study is about them; all when empty.
    quick : bool
        Whether to run the small version.
    line : str
        Command line that made it, where that is not one of ``fem-impact study``.
    cases : str
        What is computed, where that is not told by ``ids``, such as the digest of a sweep's cases: by it the
        report of something else in ``out`` is known.
    first : int
        So many scenes of each family alone, where the study draws them; 0: all.
    seed : int
        Of the scenes that it draws; 0: the study's own.
    """

    out: Path
    ids: tuple[str, ...] = ()
    quick: bool = False
    line: str = ""
    cases: str = ""
    first: int = 0
    seed: int = 0

    @property
    def about(self) -> str:
        """What is computed; a report of something else in the directory is set aside."""
        return self.cases or " ".join(self._asked)

    def command(self, study: str) -> str:
        """Return the command line of this request."""
        return self.line or " ".join(["fem-impact study", study, *self._asked])

    @property
    def _asked(self) -> list[str]:
        """Return what a command line asks for beside the study's name."""
        drawn = {"first": self.first, "seed": self.seed}
        options = [f"--{name} {number}" for name, number in drawn.items() if number]
        return [*self.ids, *options, *(["--quick"] if self.quick else [])]


@dataclass(frozen=True, slots=True)
class StudyResult:
    """Contents of study.json, text for a terminal, and directories of the runs to be presented."""

    document: dict[str, Any]
    text: str
    runs: tuple[Path, ...] = ()


def failures_of(results: Mapping[str, object]) -> list[dict[str, str]]:
    """Return one row per failed job: its name and reason."""
    failed = (result for result in results.values() if isinstance(result, Failure))
    return [{"scene_id": failure.name, "error": failure.reason} for failure in failed]


SCHEMA = "fem-impact/study/3"
LEDGER = (
    *("run", "fidelity", "scene_digest", "tip_size_m", "contacts", "e_edge", "mu", "Omega_rad_per_s"),
    *(share.key.name for share in shares("study")),
    *("residual_over_E_0", "wall_s", "created_utc"),
)
"""Columns of runs.csv, one row per run."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table: written as CSV under its name; in the summary if ``shown``, or a part of it, ``brief``."""

    name: str
    caption: str
    table: Table
    shown: bool = True
    brief: Table | None = None

    @property
    def summary(self) -> Table:
        """The table that the summary shows."""
        return self.brief or self.table


@dataclass(frozen=True, slots=True)
class StudyReport:
    """The result of a study.

    Parameters
    ----------
    study, title : str
        Name of the study and of its page.
    findings : sequence of str
        Sentences on the results.
    pictures, sheets : sequences
        Figures and tables.
    assumptions : sequence of str
        Ranges and limits.
    sources : sequence of str
        Entries of the report's list of papers.
    conclusions : sequence of (str, str)
        Findings for the page over all studies, each after the name of its picture, empty for none.
    outcomes : sequence of Outcome
        Runs that the page shows one by one, with energies, curves and costs.
    comparison : sequence of mappings
        Rows of model beside measurement (`fem_impact.answers.compare`).
    runs : sequence of Path
        Directories of runs to be presented with pages and films.
    """

    study: str
    title: str
    findings: Sequence[str]
    pictures: Sequence[Picture] = ()
    sheets: Sequence[Sheet] = ()
    assumptions: Sequence[str] = ()
    sources: Sequence[str] = ()
    conclusions: Sequence[tuple[str, str]] = ()
    outcomes: Sequence[Outcome] = ()
    comparison: Sequence[Mapping[str, Any]] = ()
    runs: Sequence[Path] = ()


def publish(report: StudyReport, request: Request, results: Mapping[str, object]) -> StudyResult:
    """Write study.json, summary.md, a CSV a sheet, and each picture (SVG, PNG, JSON) with its data.

    A run, another study, or a report of other cases that stands in the directory is set aside.
    """
    ledger: list[list[Cell]] = []
    for name, run in results.items():
        if isinstance(run, Outcome):
            intervals = or_none(run.contact.intervals)
            contacts = None if intervals is None else len(intervals)
            values = {**run.to_dict(), "run": name, "contacts": contacts}
            ledger.append([values[column] for column in LEDGER])
    look = f" (quick look: {len(results)} runs, not a result)" if request.quick else ""
    # panels with more than one place along x; no picture without any
    cut = (
        replace(p, panels=tuple(panel for panel in p.panels if panel.informative)) for p in report.pictures
    )
    report = replace(report, title=report.title + look, pictures=[p for p in cut if p.panels])
    document = _document(report, request, results)
    if _stands_another(request.out, document):
        set_aside(request.out)
    for picture in report.pictures:
        _draw(picture, make_directory(request.out / "figures"))
    for sheet in report.sheets:
        write_text(request.out / f"{sheet.name}.csv", sheet.table.csv())
    write_text(request.out / "runs.csv", Table.of(LEDGER, ledger).csv())
    text = _markdown(report, document)
    write_text(request.out / "summary.md", text)
    write_text(request.out / "study.json", json.dumps(signed(document), indent=1, allow_nan=False))
    return StudyResult(document, text, tuple(report.runs))


def _stands_another(out: Path, document: Mapping[str, Any]) -> bool:
    """Return whether a directory holds a run, another study, or a report damaged or of other cases."""
    path = out / "study.json"
    if not path.exists():
        return (out / "outcome.json").exists()
    try:
        old = read_signed(read_text(path), str(path))
    except ResultError:
        return True
    return any(old.get(key, "") != document[key] for key in ("study", "about"))


def _document(report: StudyReport, request: Request, results: Mapping[str, object]) -> dict[str, Any]:
    drawn = {picture.name for picture in report.pictures}
    return {
        "schema": SCHEMA,
        "study": report.study,
        "title": report.title,
        "command": request.command(report.study),
        "about": request.about,
        "findings": list(report.findings),
        "conclusions": [
            {"name": name if name in drawn else "", "sentence": sentence}
            for name, sentence in report.conclusions
        ],
        "assumptions": list(report.assumptions),
        "sources": list(report.sources),
        "figures": [{"name": p.name, "caption": p.caption} for p in report.pictures],
        "sheets": [
            {
                "name": sheet.name,
                "caption": sheet.caption,
                "columns": [column.title for column in sheet.summary.columns],
                "rows": list(map(list, sheet.summary.rows)) if sheet.shown else [],
            }
            for sheet in report.sheets
        ],
        "runs": len(results),
        "failures": failures_of(results),
        "rows": [outcome.to_dict() for outcome in report.outcomes],
        "comparison": [dict(row) for row in report.comparison],
    }


def _draw(picture: Picture, place: Path) -> None:
    stem = place / picture.name
    for suffix in (".svg", ".png"):
        draw(picture, stem.with_suffix(suffix))
    write_text(stem.with_suffix(".json"), json.dumps(live(picture), allow_nan=False))


def _markdown(report: StudyReport, document: Mapping[str, Any]) -> str:
    ran = f"`{document['command']}`: {document['runs']} runs, {len(document['failures'])} failed."
    parts = [f"# {report.title}", _bullets(report.findings), ran]
    parts += [f"![{p.caption}](figures/{p.name}.png)\n\n{p.caption}" for p in report.pictures]
    for sheet in report.sheets:
        parts += [f"{sheet.caption} (`{sheet.name}.csv`)"]
        parts += [sheet.summary.markdown()] if sheet.shown else []
    parts += ["What it rests on:", _bullets(report.assumptions)] if report.assumptions else []
    parts += [f"failed: {f['scene_id']}: {f['error']}" for f in document["failures"]]
    return "\n\n".join(part for part in parts if part) + "\n"


def _bullets(sentences: Sequence[str]) -> str:
    return "\n".join(f"- {sentence}" for sentence in sentences)
