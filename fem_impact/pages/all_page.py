"""One page over all studies of a folder, and its Markdown twin."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import NamedTuple

from fem_impact.answers.report import LEDGER
from fem_impact.errors import ResultError
from fem_impact.files.atomic import make_directory, read_text, write_text
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.pages.comparison import comparison_part
from fem_impact.pages.findings import figure_id, findings_section
from fem_impact.pages.html import Markup, bullets, details, join, place, section, table
from fem_impact.pages.page import data_link, page, sources
from fem_impact.pages.study_data import Study, read_study
from fem_impact.pages.study_page import partition_part
from fem_impact.pages.verdicts import marker_section, marker_sentence, verdict_section, verdicts
from fem_impact.tables.symbols import markup
from fem_impact.tables.table import Table, read_csv

QUESTIONS = {
    "sets": "Does the model meet the measured series?",
    "validation": "How large is the error of the model, and what causes it?",
    "criterion": "When may a rod be called rigid?",
    "gamma": "How much energy does vibration take?",
    "convergence": "How far is the usual mesh from vanishing elements?",
    "effects": "Does each scene choose the effects that it needs?",
    "reduced": "How far is the reduced model from the finite elements?",
    "causes": "What do rate, hardness and a hard skin change?",
    "tip": "Which tip had the rods of Table 3?",
    "cost": "What does accuracy cost?",
}
"""What each study asks; others are named by their title."""


def write_all(results: Path, out: Path) -> Path:
    """Write ``report.html``, ``summary.md``, ``ledger.csv`` over the studies in ``results``; return the page.

    Raises
    ------
    ResultError
        There is no study in the folder, or one is damaged.
    """
    studies = [read_study(folder) for folder in _folders(results)]
    if not studies:
        raise ResultError(f"{results}: holds no study. Run one, such as fem-impact study gamma --quick.")
    figures = make_directory(out / "figures")
    ledger = _ledger(studies)
    write_text(out / "ledger.csv", ledger.csv())
    concluded = conclusions(studies)
    write_text(out / "summary.md", _markdown(studies, conclusion_text(concluded)))
    body = [
        section("", bullets(map(_answer, studies))),
        section("Study by study", *(_folded(study, figures) for study in studies)),
        section("All conclusions", details(f"{len(concluded)} conclusions", conclusion_list(concluded))),
        section("Energy of every run", _ledger_part(ledger)),
        sources({name for study in studies for name in study.sources}),
    ]
    failed = sum(len(study.failures) for study in studies)
    counts = f"{len(studies)} studies, {len(ledger)} runs, {failed} of them failed."
    lead = f"{counts} First what each study asks, and its answer; the rest is folded below."
    text = page("Where the energy of a dropped steel rod goes", "All studies", lead, _footer(studies), body)
    return write_text(out / "report.html", text)


def _folders(results: Path) -> list[Path]:
    """Return the folders that hold a study, that of the measured sets first."""
    places = results.iterdir() if results.is_dir() else ()
    folders = [place for place in places if (place / "study.json").is_file()]
    return sorted(folders, key=lambda place: (place.name != "sets", place.name))


def _answer(study: Study) -> Markup:
    """Return the question of a study, its answer, which is its first finding, and the link to its part."""
    question, answer = QUESTIONS.get(study.study, study.title), "".join(study.findings[:1])
    link = f' <a href="#{escape(study.folder.name)}">more</a>'
    return Markup(f"<strong>{markup(question)}</strong> {markup(answer)}{link}")


def _folded(study: Study, figures: Path) -> Markup:
    """Return all parts of a study, folded; a link to it from above unfolds it."""
    return details(study.title, place(study.folder.name, join(_parts(study, figures))))


def _parts(study: Study, figures: Path) -> list[Markup]:
    """Return the sections of a study; one with outcomes also gets the verdicts on the paper's conclusions."""
    if not study.rows:
        return [findings_section(study, study.title)]
    since = study.folder / "study.json"
    return [
        findings_section(study, study.title),
        section("Model and measurements", comparison_part(study.comparison, study.folder, since)),
        section("Where the energy went", partition_part(study, since)),
        verdict_section(verdicts(study.rows), figures),
        marker_section(study.rows),
    ]


def _ledger(studies: Iterable[Study]) -> Table:
    """Return one table of the runs of all studies."""
    runs = ((study.folder.name, read_csv(study.folder / "runs.csv")) for study in studies)
    rows = [(name, *cells) for name, table in runs for cells in zip(*map(table.cells, LEDGER), strict=True)]
    return Table.of(("study", *LEDGER), rows, left=range(len(LEDGER) + 1))


def _ledger_part(ledger: Table) -> Markup:
    """Return the finite-element runs as a table, and all runs as a file inside the page."""
    at = ledger.names.index("fidelity")
    solid = [tuple(_short(str(cell)) for cell in row) for row in ledger.rows if row[at] == "solid"]
    counts = f"{len(ledger)} runs, {len(solid)} of them with finite elements: "
    link = data_link(ledger.csv().encode(), "ledger.csv", "ledger.csv")
    shown = table(Table(ledger.columns, tuple(solid)), compact=True)
    return join([Markup(f"<p>{counts}{link}</p>"), details("Finite-element runs", shown)])


def _short(cell: str) -> str:
    try:
        return f"{float(cell):.4g}"
    except ValueError:
        return cell[:24]


def _markdown(studies: Iterable[Study], concluded: str) -> str:
    parts = ["# Where the energy of a dropped steel rod goes", concluded]
    parts += [_summary(study.folder) for study in studies]
    return "\n\n".join(part for part in parts if part) + "\n"


def _summary(folder: Path) -> str:
    """Return a study's summary.md one heading level lower, its figure links relative to the report."""
    text = read_text(folder / "summary.md").strip().replace("](figures/", f"](../{folder.name}/figures/")
    return text.replace("# ", "## ", 1)


def _footer(studies: Sequence[Study]) -> str:
    row = next((row for study in studies for row in study.rows), None)
    if row is None:
        return "Versions and dates of the runs stand in the ledger."
    versions = ", ".join(f"{name} {version}" for name, version in row.provenance.versions.items())
    return f"Computed with {versions}; dates of the runs stand in the ledger."


class Conclusion(NamedTuple):
    """A conclusion: its sentence, the id of its figure in the page, and the path of the figure's file."""

    sentence: str
    figure: str = ""
    file: str = ""


def conclusions(studies: Iterable[Study]) -> list[Conclusion]:
    """Return the conclusions of all studies; before those of measured sets the verdicts on the paper."""
    listed = []
    for study in studies:
        listed += _of_paper(study.rows)
        listed += [_conclusion(study, entry["name"], entry["sentence"]) for entry in study.conclusions]
    return listed


def _conclusion(study: Study, name: str, sentence: str) -> Conclusion:
    if not name:
        return Conclusion(sentence)
    file = f"../{study.folder.name}/figures/{name}.png"
    return Conclusion(sentence, figure_id(study.study, name), file)


def _of_paper(rows: Sequence[Outcome]) -> list[Conclusion]:
    judged = [Conclusion(v.sentence, v.name, f"figures/{v.name}.svg") for v in verdicts(rows)]
    marked = marker_sentence([row for row in rows if not isinstance(row.contact.markers.V_n, Unknown)])
    return judged + ([Conclusion(marked)] if marked else [])


def conclusion_list(listed: Sequence[Conclusion]) -> Markup:
    """Return the conclusions, each linked to its figure."""
    links = (f' <a href="#{escape(one.figure)}">figure</a>' if one.figure else "" for one in listed)
    items = (Markup(markup(one.sentence) + link) for one, link in zip(listed, links, strict=True))
    return bullets(items)


def conclusion_text(listed: Sequence[Conclusion]) -> str:
    """Return the conclusions as Markdown, empty when there is none."""
    lines = [f"- {one.sentence}" + (f" ([figure]({one.file}))" if one.file else "") for one in listed]
    return "\n".join(["## Conclusions", "", *lines]) if lines else ""
