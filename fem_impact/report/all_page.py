"""One page over all studies of a folder, and its Markdown twin."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from fem_impact.errors import ResultError
from fem_impact.files.atomic import make_directory, read_text, write_text
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.report.findings import (
    figure_id,
    findings_section,
    miss_sentence,
    misses_section,
    read_findings,
)
from fem_impact.report.html import Markup, bullets, details, join, section, table
from fem_impact.report.page import data_link, page, sources
from fem_impact.report.sections import card
from fem_impact.report.study_data import STUDY_SCHEMA, Study, read_study
from fem_impact.report.study_page import comparison_part, partition_part
from fem_impact.report.verdicts import marker_section, marker_sentence, verdict_section, verdicts

__all__ = ["Conclusion", "conclusion_section", "conclusion_text", "conclusions", "write_all"]


LEDGER, RECORD = "runs.csv", "outcome.json"
SETS_COMMAND = "<p>Measured sets, and what follows from them below: <code>fem-impact study sets</code></p>"


def write_all(results: Path, out: Path) -> Path:
    """Write ``report.html``, ``summary.md``, ``ledger.csv`` over the studies in ``results``; return the page.

    Raises
    ------
    ResultError
        There is no study in the folder, or one is damaged.
    """
    told = {folder: held for folder in _folders(results) if (held := read_findings(folder)) is not None}
    sets = _sets(results)
    if not told and sets is None:
        raise ResultError(f"{results}: holds no study. Run one, such as fem-impact study gamma --quick.")
    figures = make_directory(out / "figures")
    ledger = _ledger(told, _runs(results / "sets", sets) if sets else [])
    write_text(out / "ledger.csv", ledger)
    concluded = conclusions(told, sets)
    folders = ([results / "sets"] if sets else []) + list(told)
    write_text(out / "summary.md", _markdown(folders, conclusion_text(concluded)))
    body = [
        _cards(told, sets, ledger),
        conclusion_section(concluded),
        *(_sets_part(sets, figures) if sets else []),
        *(findings_section(held, folder) for folder, held in told.items()),
        section("Ledger of every run", _ledger_part(ledger)),
        sources({name for held in told.values() for name in held["sources"]} | _effects(sets)),
    ]
    lead = f"{len(told) + (sets is not None)} studies of where the energy of a dropped rod goes."
    text = page("Where the energy of a dropped steel rod goes", "All studies", lead, _footer(sets), body)
    return write_text(out / "report.html", text)


def _folders(results: Path) -> list[Path]:
    return sorted(place for place in results.iterdir() if place.is_dir()) if results.is_dir() else []


def _sets(results: Path) -> Study | None:
    path = results / "sets" / "study.json"
    return read_study(path) if path.is_file() and STUDY_SCHEMA in read_text(path) else None


def _effects(sets: Study | None) -> set[str]:
    return {effect for row in sets.rows for effect in row.provenance.effects} if sets else set()


def _sets_part(sets: Study, figures: Path) -> list[Markup]:
    rows = list(sets.rows)
    return [
        section("Model beside measurement", Markup(SETS_COMMAND), comparison_part(sets, figures)),
        section("Where the energy went", partition_part(sets, figures)),
        misses_section(sets),
        verdict_section(verdicts(rows), figures),
        marker_section(rows),
    ]


def _cards(told: dict[Path, dict[str, Any]], sets: Study | None, ledger: str) -> Markup:
    failed = sum(len(held["failures"]) for held in told.values()) + (len(sets.failures) if sets else 0)
    runs = ledger.count("\n") - 1
    count = str(len(told) + (sets is not None))
    cards = [card("studies", count, ""), card("runs", str(runs), f"{failed} failed")]
    return Markup(f'<div class="cards">{join(cards).text}</div>')


def _runs(folder: Path, sets: Study) -> list[Outcome]:
    """Return the runs of the measured sets; coarser meshes and changed inputs where their files stand."""
    shown = {row.provenance.scene_id for row in sets.rows}
    beside = [place for place in _folders(folder) if place.name not in shown]
    found = [(place.name, Outcome.read(place / RECORD)) for place in beside if (place / RECORD).is_file()]
    return [*sets.rows, *(_renamed(run, name) for name, run in found)]


def _renamed(run: Outcome, name: str) -> Outcome:
    return replace(run, provenance=replace(run.provenance, scene_id=name))


def _ledger(told: Iterable[Path], runs: Iterable[Outcome]) -> str:
    """Return one table of the runs of all studies."""
    lines = io.StringIO()
    writer, head = csv.writer(lines, lineterminator="\n"), None
    for folder in told:
        for row in csv.reader(io.StringIO(read_text(folder / LEDGER))):
            if row and row[0] == "run":
                head = head or writer.writerow(["study", *row])
            elif row:
                writer.writerow([folder.name, *row])
    names = _columns(lines.getvalue())
    if head is None:
        writer.writerow(names)
    for run in runs:
        values = run.to_dict()
        writer.writerow(["sets", run.provenance.scene_id, *(_cell(values[name]) for name in names[2:])])
    return lines.getvalue()


def _columns(text: str) -> list[str]:
    default = "study,run,fidelity,scene_digest,tip_size_m,contacts,e_edge,mu,residual_over_E_0,wall_s"
    return (text.partition("\n")[0] or default).split(",")


def _cell(value: Any) -> Any:
    """Return a value of a record; of the contacts their number."""
    return len(value) if isinstance(value, list) else value


def _ledger_part(ledger: str) -> Markup:
    """Return the finite-element runs as a table, and all runs as a file inside the page."""
    head, *rows = list(csv.reader(io.StringIO(ledger)))
    at = head.index("fidelity")
    solid = [row for row in rows if row[at] == "solid"]
    words = f"{len(rows)} runs, {len(solid)} of them with finite elements: "
    link = data_link(ledger.encode(), "ledger.csv", "ledger.csv")
    shown = [[_short(cell) for cell in row] for row in solid]
    listed = details("Finite-element runs", table(head, shown, compact=True))
    return join([Markup(f"<p>{words}{link}</p>"), listed])


def _short(cell: str) -> str:
    try:
        return f"{float(cell):.4g}"
    except ValueError:
        return cell[:24]


def _markdown(folders: Iterable[Path], concluded: str) -> str:
    parts = ["# Where the energy of a dropped steel rod goes", concluded]
    parts += [_summary(folder) for folder in folders]
    return "\n\n".join(part for part in parts if part) + "\n"


def _summary(folder: Path) -> str:
    """Return a study's summary one heading lower, its pictures found from the report's folder."""
    text = read_text(folder / "summary.md").strip().replace("](figures/", f"](../{folder.name}/figures/")
    return text.replace("# ", "## ", 1) if text.startswith("# ") else f"## {folder.name}\n\n{text}"


def _footer(sets: Study | None) -> str:
    if not sets or not sets.rows:
        return "Versions and dates of the runs stand in the ledger."
    versions = ", ".join(f"{name} {version}" for name, version in sets.rows[0].provenance.versions.items())
    return f"Computed with {versions}; dates of the runs stand in the ledger."


class Conclusion(NamedTuple):
    """A sentence, and where its figure is: in the page, and as a file beside the report."""

    sentence: str
    figure: str = ""
    file: str = ""


def conclusions(told: Mapping[Path, Mapping[str, Any]], sets: Study | None) -> list[Conclusion]:
    """Return what the measured sets come to, then what each study concludes."""
    found = _of_sets(sets) if sets else []
    for folder, held in told.items():
        for entry in held["conclusions"]:
            file = f"../{folder.name}/figures/{entry['name']}.png"
            found.append(Conclusion(entry["sentence"], figure_id(held["study"], entry["name"]), file))
    return found


def _of_sets(sets: Study) -> list[Conclusion]:
    rows: Sequence[Outcome] = [row for row in sets.rows if not isinstance(row.contact.markers.V_n, Unknown)]
    judged = [Conclusion(v.sentence, v.name, f"figures/{v.name}.svg") for v in verdicts(sets.rows)]
    more = [marker_sentence(rows), miss_sentence(sets.explanations) if sets.explanations else ""]
    return judged + [Conclusion(sentence) for sentence in more if sentence]


def conclusion_section(found: Sequence[Conclusion]) -> Markup:
    """Return the page of conclusions, each linked to its figure."""
    return section("Conclusions", bullets(_linked(one) for one in found))


def _linked(one: Conclusion) -> Markup:
    link = f' <a href="#{escape(one.figure)}">figure</a>' if one.figure else ""
    return Markup(escape(one.sentence) + link)


def conclusion_text(found: Sequence[Conclusion]) -> str:
    """Return the same as Markdown, nothing when there is none."""
    lines = [f"- {one.sentence}" + (f" ([figure]({one.file}))" if one.file else "") for one in found]
    return "\n".join(["## Conclusions", "", *lines]) if lines else ""
