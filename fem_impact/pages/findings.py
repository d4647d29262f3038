"""The part of a page that every study has: findings, figures with their data, tables, command, limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from fem_impact.pages.html import Markup, bullets, details, join, paragraph, place, section, table
from fem_impact.pages.page import download, stored_figure
from fem_impact.pages.study_data import Study
from fem_impact.tables.symbols import readable
from fem_impact.tables.table import Column, Table


def findings_section(study: Study, title: str = "", lead: Markup | None = None) -> Markup:
    """Return the answer, which is the first finding, and the first figure; all else folded, with its data.

    ``lead`` is the first figure where it is not one of the study's own.
    """
    runs = f"{study.runs} runs, {len(study.failures)} failed."
    failed = [(failure["scene_id"], failure["error"]) for failure in study.failures]
    drawn = (lead or Markup(""), *(_figure(entry, study) for entry in study.figures))
    figures = [one for one in drawn if one.text]
    return section(
        title,
        paragraph("".join(study.findings[:1]), "answer"),
        *figures[:1],
        _folded("What else was found", bullets(study.findings[1:])),
        _folded("More figures", *figures[1:]),
        *(_sheet(sheet, study) for sheet in study.sheets if sheet["rows"]),
        _folded("More tables", *(_file(sheet, study) for sheet in study.sheets if not sheet["rows"])),
        _folded("What it rests on", bullets(study.assumptions)),
        Markup(f"<p>{escape(runs)} <code>{escape(study.command)}</code></p>"),
        table(Table.of(("run", "why"), failed, left=(0, 1))),
    )


def _folded(title: str, *content: Markup) -> Markup:
    """Return a folded block, nothing when it would be empty."""
    inner = join(content)
    return details(title, inner) if inner.text else inner


def figure_id(study: str, name: str) -> str:
    """Return the id of a study's figure in a page."""
    return f"{study}-{name}"


def _figure(entry: Mapping[str, Any], study: Study) -> Markup:
    stem = study.folder / "figures" / entry["name"]
    shown = place(figure_id(study.study, entry["name"]), stored_figure(stem))
    return join([shown, download(stem.with_suffix(".csv"), "its data")])


def _sheet(sheet: Mapping[str, Any], study: Study) -> Markup:
    columns, rows = sheet["columns"], sheet["rows"]
    texts = {at for at in range(len(columns)) if _holds_words([row[at] for row in rows])}
    named = Table(
        tuple(Column(name, readable(name), left=at in texts) for at, name in enumerate(columns)),
        tuple(map(tuple, rows)),
    )
    data = download(study.folder / f"{sheet['name']}.csv", f"its data ({sheet['name']}.csv)")
    return details(sheet["caption"], table(named, compact=True), data)


def _holds_words(cells: Sequence[Any]) -> bool:
    """Return whether most texts of a column start with a letter; numbers with a sign or band do not."""
    texts = [cell for cell in cells if isinstance(cell, str) and cell]
    return 2 * sum(text[0].isalpha() for text in texts) > len(texts)


def _file(sheet: Mapping[str, Any], study: Study) -> Markup:
    name = f"{sheet['name']}.csv"
    return download(study.folder / name, f"{sheet['caption']} ({name})")
