"""One page over all studies of a folder, its Markdown twin, and the verdicts on the paper's conclusions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fem_impact.answers.report import LEDGER
from fem_impact.errors import ResultError
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.files.atomic import make_directory, read_text, write_text
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.pages.page import (
    Markup,
    bullets,
    data_link,
    details,
    download,
    figure,
    join,
    page,
    paragraph,
    place,
    section,
    sources,
    table,
)
from fem_impact.pages.sections import comparison_part
from fem_impact.pages.study_page import Study, figure_id, findings_section, partition_part, read_study
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.tables.table import Cell, Table, read_csv
from fem_impact.tables.text import markup, plain
from rigid.experiments import measured_set

MOMENTS = (KEY_TABLE["e_m_paper"], KEY_TABLE["e_m_edge"], KEY_TABLE["e_m_impulse"])
MARKED = {"V_n": "m/s", "V_t": "m/s", "Omega": "rad/s"}
"""Quantities that the two markers measure, by attribute of `motion` and `contact.markers`, and units."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Verdict on a conclusion of the paper: name of the figure, sentence, and the figure's panel."""

    name: str
    sentence: str
    panel: Panel


def verdicts(rows: Sequence[Outcome]) -> list[Verdict]:
    """Return the verdicts on closure, e_m, mu_c as a bound and E_lt as heat, from outcomes of the sets.

    They are about the paper's own sets: scenes of other tests are left out.
    """
    rows = [row for row in rows if row.provenance.scene_id in MEASURED_SETS]
    rows = [row for row in rows if not isinstance(row.restitution.paper.e_m, Unknown)]
    return [part(rows) for part in (_closure, _moment, _critical, _heat)] if rows else []


def verdict_section(judged: Sequence[Verdict], figures: Path) -> Markup:
    """Return the verdicts with their figures, drawn into a folder."""
    title = "What the paper concluded, what stands and what does not"
    return section(title, *(_shown(verdict, figures) for verdict in judged))


def _shown(verdict: Verdict, figures: Path) -> Markup:
    name = verdict.name
    drawn = figure(Picture(name, verdict.panel.title, (verdict.panel,), 1), figures)
    data = download(figures / f"{name}.csv", "its data")
    return join([paragraph(verdict.sentence), place(name, drawn), data])


def _closure(rows: Sequence[Outcome]) -> Verdict:
    lost = [100 * known(row.energy.vibration) for row in rows]
    paper = [row.restitution.paper for row in rows]
    kept = [known(row.energy.rigid) for row in rows]
    gap = [100 * (known(p.E_ln) + known(p.E_lt) + k - 1) for p, k in zip(paper, kept, strict=True)]
    identity = [100 * _spin(row) * (1 + 1 / known(row.restitution.paper.e_m)) for row in rows]
    sentence = (
        "Does not stand: that losses and retained energy add up to E_0 was read as a sign that they hold all "
        "losses. The sum differs from E_0 by (I Omega^2/2)(1 + 1/e_m) whatever the rod lost: over the "
        f"{len(rows)} computed sets it misses E_0 by {min(map(abs, gap)):.1g} to "
        f"{plain(max(map(abs, gap)), 2)} % and that expression by at most {_apart(gap, identity):.1g} %, "
        f"while vibration took {min(lost):.2g} to {max(lost):.2g} %."
    )
    series = (
        Series("E_ln + E_lt + E_r - E_0", range(len(rows)), gap, "points"),
        Series("(I Omega^2/2)(1 + 1/e_m)", range(len(rows)), identity, "rings"),
        Series("vibration", range(len(rows)), lost, "points"),
    )
    panel = Panel("The paper's energy terms, less E_0", "set", "% of E_0", series, names=_names(rows))
    return Verdict("closure", sentence, panel)


def _apart(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the largest absolute difference."""
    return float(np.abs(np.subtract(a, b)).max())


def _spin(row: Outcome) -> float:
    """Return I Omega^2/2 after the impact, fraction of E_0."""
    m = row.motion
    return 0.5 * m.mass * m.k_squared * known(m.Omega) ** 2 / row.energy.E_0


def _moment(rows: Sequence[Outcome]) -> Verdict:
    angle = np.degrees([row.motion.alpha for row in rows])
    paper, edge, impulse = ([known(key.of(row)) for row in rows] for key in MOMENTS)
    named = {"the paper's arms": paper, "arms of the edge": edge, "centre of the impulse": impulse}
    series = tuple(Series(label, angle, e_m, "points") for label, e_m in named.items())
    spread = [abs(a - b) for a, b in zip(paper, edge, strict=True)]
    sentence = (
        "Does not stand as physics: e_m moves with the contact point that is assumed. The same computed "
        f"motion gives values up to {max(spread):.2g} apart with the paper's arms and those of the edge, and "
        "-1 at the centre of the impulse."
    )
    return Verdict("moment", sentence, Panel("e_m against angle", "angle, degrees", "e_m", series))


def _critical(rows: Sequence[Outcome]) -> Verdict:
    measured = [measured_set(row.provenance.scene_id).statistics()["mu"].mean for row in rows]
    at = range(len(rows))
    series = (
        Series("measured mu", at, measured, "rings"),
        Series("computed mu", at, [known(row.restitution.mu) for row in rows], "points"),
        Series("mu_c", at, [known(row.restitution.mu_c) for row in rows], "points"),
    )
    ratios = [row.restitution for row in rows]
    most = [max(mu, known(r.mu)) / known(r.mu_c) for r, mu in zip(ratios, measured, strict=True)]
    above = [name for name, ratio in zip(_names(rows), most, strict=True) if ratio > 1.02]
    sentence = (
        "Stands with a limit: mu_c is the ratio at which the tip stops without turning back, and no upper "
        f"bound. It is exceeded by more than 2 %, measured or computed, in {', '.join(above) or 'no set'}."
    )
    panel = Panel("Impulse ratio and mu_c", "set", "mu", series, names=_names(rows))
    return Verdict("critical", sentence, panel)


def _heat(rows: Sequence[Outcome]) -> Verdict:
    at = range(len(rows))
    tangential = [100 * known(row.restitution.paper.E_lt) for row in rows]
    rubbed = [100 * known(row.energy.friction) for row in rows]
    series = (
        Series("E_lt, rigid theory", at, tangential, "rings"),
        Series("friction work", at, rubbed, "points"),
        Series("vibration", at, [100 * known(row.energy.vibration) for row in rows], "points"),
    )
    ratio = [100 * r / t for r, t in zip(rubbed, tangential, strict=True) if t > 0]
    sentence = (
        "Does not stand: E_lt is not the energy that can heat the contact. Friction, which can, takes "
        f"{min(rubbed):.2g} to {max(rubbed):.2g} % of E_0 and {min(ratio):.0f} to {max(ratio):.0f} % of "
        "E_lt; what is left of E_lt is plastic flow and vibration."
    )
    panel = Panel("E_lt and friction work", "set", "% of E_0", series, names=_names(rows))
    return Verdict("heat", sentence, panel)


def _names(rows: Sequence[Outcome]) -> tuple[str, ...]:
    return tuple(row.provenance.scene_id for row in rows)


def marker_section(rows: Sequence[Outcome]) -> Markup:
    """Return the table of velocities by momentum sums and by two camera markers on the computed flight."""
    seen = [row for row in rows if not isinstance(row.contact.markers.V_n, Unknown)]
    shown: list[tuple[Cell, ...]] = [
        (row.provenance.scene_id, *(v for name in MARKED for v in _pair(row, name))) for row in seen
    ]
    titles = ((f"{name}, {unit}", "by markers") for name, unit in MARKED.items())
    head = ("set", *(title for pair in titles for title in pair))
    listed = table(Table.of(head, shown), compact=True)
    return section("The camera's measurement, replayed", paragraph(marker_sentence(seen)), listed)


def marker_sentence(seen: Sequence[Outcome]) -> str:
    """Return the largest differences of markers and momentum sums as a sentence, empty without markers."""
    if not seen:
        return ""
    away = {name: _apart(*zip(*(_pair(row, name) for row in seen), strict=True)) for name in MARKED}
    return (
        "Two markers over 40 frames at 10 kHz, replayed on the computed flight, give the exact momentum sums "
        f"within {away['V_n']:.2g} m/s along n, {away['V_t']:.2g} m/s along t and {away['Omega']:.2g} rad/s."
    )


def _pair(row: Outcome, name: str) -> tuple[float, float]:
    """Return a velocity by the momentum sums and by the markers."""
    return getattr(row.motion, name), known(getattr(row.contact.markers, name))


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
