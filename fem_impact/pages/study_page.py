"""The report of a study: its study.json read and checked, its findings, its runs."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

import fastjsonschema

from fem_impact.answers.report import SCHEMA
from fem_impact.errors import ResultError
from fem_impact.figures.runs import study_partition_picture
from fem_impact.files.atomic import read_signed, read_text
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.pages import html, sections
from fem_impact.tables.table import COMPARISON, Cell, Column, Table
from fem_impact.tables.text import readable

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
class StudyRecord:
    """What a study published (`fem_impact.answers.report.StudyReport`), as its page needs it.

    Attributes
    ----------
    folder : directory of the study, with its figures and CSV tables
    runs : number of its jobs
    failures : runs that gave no record: ``scene_id`` and ``error``
    rows : runs that the page shows one by one
    comparison : rows with the keys of `fem_impact.tables.table.COMPARISON`
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


def read_study(folder: Path) -> StudyRecord:
    """Read ``folder/study.json``.

    Raises
    ------
    ResultError
        The file is missing, damaged or of another schema, or a part of it is wrong; file and place are named.
    """
    path = folder / "study.json"
    document = read_signed(read_text(path), str(path))
    if document.get("schema") != SCHEMA:
        schema = json.dumps(document.get("schema"))[:40]
        raise ResultError(f'{path}: key "schema" = {schema} is not "{SCHEMA}"; run the study again.')
    try:
        _validator()(document)
    except fastjsonschema.JsonSchemaValueException as error:
        raise ResultError(f"{path}: {error.message.removeprefix('data').lstrip('. ')}.") from None
    for sheet in document["sheets"]:
        if any(len(row) != len(sheet["columns"]) for row in sheet["rows"]):
            raise ResultError(f'{path}: a row of the table "{sheet["name"]}" does not fit its columns.')
    for at, row in enumerate(document["comparison"]):
        low, high = row["measured_low"], row["measured_high"]
        if low is not None and high is not None and low > high:
            raise ResultError(
                f"{path}: comparison[{at}].measured_low = {low:g} is above measured_high, {high:g}."
            )
    rows = tuple(
        Outcome.from_dict(row, source=f"{path}: rows[{at}]") for at, row in enumerate(document["rows"])
    )
    parts: dict[str, Any] = {name: tuple(document[name]) for name in (*SENTENCES, *RECORDS)}
    texts = {name: document[name] for name in TEXTS}
    return StudyRecord(folder, **texts, **parts, rows=rows, runs=document["runs"])


@cache
def _validator() -> Callable[[Any], Any]:
    validate: Callable[[Any], Any] = fastjsonschema.compile(STUDY_SCHEMA)
    return validate


def findings_section(study: StudyRecord, title: str = "", lead: html.Markup | None = None) -> html.Markup:
    """Return the answer, which is the first finding, and the first figure; all else folded, with its data.

    ``lead`` is the first figure where it is not one of the study's own.
    """
    runs = f"{study.runs} runs, {len(study.failures)} failed."
    failed = [(failure["scene_id"], failure["error"]) for failure in study.failures]
    figures = [lead] if lead and lead.text else []
    for entry in study.figures:
        stem = study.folder / "figures" / entry["name"]
        shown = html.place(figure_id(study.study, entry["name"]), html.stored_figure(stem))
        figures.append(html.join([shown, html.download(stem.with_suffix(".csv"), "its data")]))
    files = [
        html.download(study.folder / f"{sheet['name']}.csv", f"{sheet['caption']} ({sheet['name']}.csv)")
        for sheet in study.sheets
        if not sheet["rows"]
    ]
    return html.section(
        title,
        html.paragraph("".join(study.findings[:1]), "answer"),
        *figures[:1],
        _folded("What else was found", html.bullets(study.findings[1:])),
        _folded("More figures", *figures[1:]),
        *(_sheet(sheet, study) for sheet in study.sheets if sheet["rows"]),
        _folded("More tables", *files),
        _folded("What it rests on", html.bullets(study.assumptions)),
        html.Markup(f"<p>{escape(runs)} <code>{escape(study.command)}</code></p>"),
        html.table(Table.of(("run", "why"), failed, left=(0, 1))),
    )


def _folded(title: str, *content: html.Markup) -> html.Markup:
    """Return a folded block, nothing when it would be empty."""
    inner = html.join(content)
    return html.details(title, inner) if inner.text else inner


def figure_id(study: str, name: str) -> str:
    """Return the id of a study's figure in a page."""
    return f"{study}-{name}"


def _sheet(sheet: Mapping[str, Any], study: StudyRecord) -> html.Markup:
    columns, rows = sheet["columns"], sheet["rows"]
    texts = {at for at in range(len(columns)) if _holds_words([row[at] for row in rows])}
    named = Table(
        tuple(Column(name, readable(name), left=at in texts) for at, name in enumerate(columns)),
        tuple(map(tuple, rows)),
    )
    data = html.download(study.folder / f"{sheet['name']}.csv", f"its data ({sheet['name']}.csv)")
    return html.details(sheet["caption"], html.table(named, compact=True), data)


def _holds_words(cells: Sequence[Any]) -> bool:
    """Return whether most texts of a column start with a letter; numbers with a sign or band do not."""
    texts = [cell for cell in cells if isinstance(cell, str) and cell]
    return 2 * sum(text[0].isalpha() for text in texts) > len(texts)


def draw_study(folder: Path) -> None:
    """Draw comparison and partition of the study into ``folder/figures``; `study_page` can reuse them."""
    study = read_study(folder)
    sections.comparison_part(study.comparison, study.folder)
    partition_part(study)


def study_page(folder: Path, again: bool = True) -> str:
    """Return the HTML of the study in ``folder``; figures with their data stay in ``folder/figures``.

    With ``again`` False, figures newer than study.json are not drawn again.

    Raises
    ------
    ResultError
        study.json is missing, damaged or wrong.
    """
    study, since = read_study(folder), None if again else folder / "study.json"
    rows = list(study.rows)
    filmed = any(html.film_of(folder / row.provenance.scene_id) for row in rows)
    body = (
        findings_section(study, lead=sections.comparison_part(study.comparison, study.folder, since)),
        _cards(study),
        sections.notices(rows),
        html.section("Model beside measurement", sections.comparison_tables(study.comparison)),
        html.section("Where the energy went", partition_part(study, since)),
        html.section("Over time, run by run", *(_run(row, folder) for row in rows)),
        sections.unknown(rows),
        sections.validity(rows),
        html.section("Cost", *([html.details("Time, memory and elements", _costs(rows))] if rows else [])),
        html.sources([*study.sources, *(["film"] if filmed else [])]),
    )
    footer = f"Made by {study.command}."
    if rows:
        last = max(row.provenance.created_utc for row in rows)
        footer += f" Computed up to {last} with {html.versions_text(rows[0].provenance.versions)}."
    return html.page(study.title, "Study", "", footer, body)


def _cards(study: StudyRecord) -> html.Markup:
    if not study.rows:
        return html.Markup("")
    measured = [row for row in study.comparison if row["measured_mean"] is not None]
    inside = sum(sections.is_inside(row["verdict"]) for row in measured)
    residuals = [abs(row.energy.residual) for row in study.rows]
    seconds = sum(row.cost.wall for row in study.rows)
    return sections.cards(
        sections.card("runs", str(len(study.rows)), f"{len(study.failures)} failed"),
        sections.card("inside 95 % intervals", f"{inside} of {len(measured)}", "measured quantities"),
        sections.card("largest residual", f"{max(residuals):.1e}", "of E₀"),
        sections.card("computing time", f"{seconds:.0f} s", "wall time of the runs, added"),
    )


def partition_part(study: StudyRecord, since: Path | None = None) -> html.Markup:
    """Return the figure of the shares of E_0; one newer than the file ``since`` is not drawn again."""
    if not study.rows:
        return html.Markup("")
    return html.figure_with_data(study_partition_picture(study.rows), study.folder / "figures", since)


def _run(row: Outcome, folder: Path) -> html.Markup:
    place = folder / row.provenance.scene_id
    if not (place / "history.csv").is_file():
        return html.Markup("")
    e, mu = (sections.estimated(row, KEY_TABLE[name]) for name in ("e_paper", "mu"))
    title = f"{row.provenance.scene_id}: {row.provenance.scene_title} (e = {e}, µ = {mu})"
    link = ""  # to the film: those of all runs would make this page too large
    if html.film_of(place) and (place / "report.html").is_file():
        link = f'<p><a href="{escape(place.name)}/report.html">The film of its waves</a></p>'
    return html.details(title, sections.history_figures(row, place, again=False), html.Markup(link))


def _costs(rows: Sequence[Outcome]) -> html.Markup:
    head = ("run", "tip, mm", "steps", "element-steps", "rod", "barrier", "wall, s", "memory, MB")
    lines: list[list[Cell]] = []
    for row in rows:
        cost, size = row.cost, or_none(row.cost.tip_size)
        counts = (cost.steps, cost.element_steps, cost.elements_rod, cost.elements_barrier)
        tip = None if size is None else 1e3 * size
        cells = (*map(sections.known_cell, counts), cost.wall, sections.known_cell(cost.peak_memory))
        lines.append([row.provenance.scene_id, tip, *cells])
    return html.table(Table.of(head, lines), compact=True)
