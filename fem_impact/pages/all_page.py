"""One page over all studies of a folder, its Markdown twin, and the verdicts on the paper's conclusions."""

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
from fem_impact.pages import html
from fem_impact.pages.sections import comparison_part
from fem_impact.pages.study_page import StudyRecord, figure_id, findings_section, partition_part, read_study
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.tables.table import Cell, Table, read_csv
from fem_impact.tables.text import markup, plain
from rigid.experiments import measured_set

MOMENTS = (KEY_TABLE["e_m_paper"], KEY_TABLE["e_m_edge"], KEY_TABLE["e_m_impulse"])
MARKED = {"V_n": "m/s", "V_t": "m/s", "Omega": "rad/s"}
"""Quantities that the two markers measure, by attribute of `motion` and `contact.markers`, and units."""


@dataclass(frozen=True, slots=True)
class PaperVerdict:
    """Verdict on a conclusion of the paper: name of the figure, sentence, and the figure's panel."""

    name: str
    sentence: str
    panel: Panel


def verdicts(rows: Sequence[Outcome]) -> list[PaperVerdict]:
    """Return the verdicts on closure, e_m, mu_c as a bound and E_lt as heat, from outcomes of the sets.

    They are about the paper's own sets: scenes of other tests are left out.
    """
    rows = [row for row in rows if row.provenance.scene_id in MEASURED_SETS]
    rows = [row for row in rows if not isinstance(row.restitution.paper.e_m, Unknown)]
    return [part(rows) for part in (_closure, _moment, _critical, _heat)] if rows else []


def verdict_section(judged: Sequence[PaperVerdict], figures: Path) -> html.Markup:
    """Return the verdicts with their figures, drawn into a folder."""
    title = "What the paper concluded, what stands and what does not"
    shown = []
    for verdict in judged:
        drawn = html.figure(Picture(verdict.name, verdict.panel.title, (verdict.panel,), 1), figures)
        data = html.download(figures / f"{verdict.name}.csv", "its data")
        shown += [html.paragraph(verdict.sentence), html.place(verdict.name, drawn), data]
    return html.section(title, *shown)


def _closure(rows: Sequence[Outcome]) -> PaperVerdict:
    lost = [100 * known(row.energy.vibration) for row in rows]
    paper = [row.restitution.paper for row in rows]
    rigid = [known(row.energy.rigid) for row in rows]
    gap = [100 * (known(p.E_ln) + known(p.E_lt) + k - 1) for p, k in zip(paper, rigid, strict=True)]
    spin = [
        0.5 * row.motion.mass * row.motion.k_squared * known(row.motion.Omega) ** 2 / row.energy.E_0
        for row in rows
    ]
    identity = [100 * s * (1 + 1 / known(p.e_m)) for s, p in zip(spin, paper, strict=True)]
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
    return PaperVerdict("closure", sentence, panel)


def _apart(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the largest absolute difference."""
    return float(np.abs(np.subtract(a, b)).max())


def _moment(rows: Sequence[Outcome]) -> PaperVerdict:
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
    return PaperVerdict("moment", sentence, Panel("e_m against angle", "angle, degrees", "e_m", series))


def _critical(rows: Sequence[Outcome]) -> PaperVerdict:
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
    return PaperVerdict("critical", sentence, panel)


def _heat(rows: Sequence[Outcome]) -> PaperVerdict:
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
    return PaperVerdict("heat", sentence, panel)


def _names(rows: Sequence[Outcome]) -> tuple[str, ...]:
    return tuple(row.provenance.scene_id for row in rows)


def marker_section(rows: Sequence[Outcome]) -> html.Markup:
    """Return the table of velocities by momentum sums and by two camera markers on the computed flight."""
    shown: list[tuple[Cell, ...]] = [
        (row.provenance.scene_id, *(v for name in MARKED for v in _pair(row, name))) for row in _filmed(rows)
    ]
    titles = ((f"{name}, {unit}", "by markers") for name, unit in MARKED.items())
    head = ("set", *(title for pair in titles for title in pair))
    listed = html.table(Table.of(head, shown), compact=True)
    return html.section("The camera's measurement, replayed", html.paragraph(marker_sentence(rows)), listed)


def marker_sentence(rows: Sequence[Outcome]) -> str:
    """Return the largest differences of markers and momentum sums as a sentence, empty without markers."""
    seen = _filmed(rows)
    if not seen:
        return ""
    away = {name: _apart(*zip(*(_pair(row, name) for row in seen), strict=True)) for name in MARKED}
    return (
        "Two markers over 40 frames at 10 kHz, replayed on the computed flight, give the exact momentum sums "
        f"within {away['V_n']:.2g} m/s along n, {away['V_t']:.2g} m/s along t and {away['Omega']:.2g} rad/s."
    )


def _filmed(rows: Sequence[Outcome]) -> list[Outcome]:
    """Return the outcomes that have velocities by markers."""
    return [row for row in rows if not isinstance(row.contact.markers.V_n, Unknown)]


def _pair(row: Outcome, name: str) -> tuple[float, float]:
    """Return a velocity by the momentum sums and by the markers."""
    return getattr(row.motion, name), known(getattr(row.contact.markers, name))


TITLE = "Where the energy of a dropped steel rod goes"
QUESTIONS = {
    "sets": "Does the model meet the measured series?",
    "validation": "How large is the error of the model, and what causes it?",
    "gamma": "When may a rod be called rigid, and how much energy does vibration take?",
    "convergence": "How far is the usual mesh from vanishing elements?",
    "effects": "Does each scene choose the effects that it needs?",
    "reduced": "How far is the reduced model from the finite elements?",
    "skin": "Does a hardened skin that follows from the printed hardness explain the tests?",
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
    folders = [stored.parent for stored in results.glob("*/study.json")]
    # that of the measured sets first
    studies = [read_study(one) for one in sorted(folders, key=lambda one: (one.name != "sets", one.name))]
    if not studies:
        raise ResultError(f"{results}: holds no study. Run one, such as fem-impact study gamma --quick.")
    figures = make_directory(out / "figures")
    runs = ((study.folder.name, read_csv(study.folder / "runs.csv")) for study in studies)
    rows = [(name, *cells) for name, table in runs for cells in zip(*map(table.cells, LEDGER), strict=True)]
    ledger = Table.of(("study", *LEDGER), rows, left=range(len(LEDGER) + 1))
    write_text(out / "ledger.csv", ledger.csv())
    concluded = conclusions(studies)
    write_text(out / "summary.md", _markdown(studies, conclusion_text(concluded)))
    folded = html.details(f"{len(concluded)} conclusions", conclusion_list(concluded))
    parts = (
        html.details(study.title, html.place(study.folder.name, html.join(_parts(study, figures))))
        for study in studies
    )
    body = [
        html.section("", html.bullets(map(_answer, studies))),
        html.section("Study by study", *parts),
        html.section("All conclusions", folded),
        html.section("Energy of every run", _ledger_part(ledger)),
        html.sources({name for study in studies for name in study.sources}),
    ]
    failed = sum(len(study.failures) for study in studies)
    footer = "Versions and dates of the runs stand in the ledger."
    if row := next((row for study in studies for row in study.rows), None):
        versions = html.versions_text(row.provenance.versions)
        footer = f"Computed with {versions}; dates of the runs stand in the ledger."
    counts = f"{len(studies)} studies, {len(ledger)} runs, {failed} of them failed."
    lead = f"{counts} First what each study asks, and its answer; the rest is folded below."
    return write_text(out / "report.html", html.page(TITLE, "All studies", lead, footer, body))


def _answer(study: StudyRecord) -> html.Markup:
    """Return the question of a study, its answer, which is its first finding, and the link to its part."""
    question, answer = QUESTIONS.get(study.study, study.title), "".join(study.findings[:1])
    link = f' <a href="#{escape(study.folder.name)}">more</a>'
    return html.Markup(f"<strong>{markup(question)}</strong> {markup(answer)}{link}")


def _parts(study: StudyRecord, figures: Path) -> list[html.Markup]:
    """Return the sections of a study; one with outcomes also gets the verdicts on the paper's conclusions."""
    if not study.rows:
        return [findings_section(study, study.title)]
    since = study.folder / "study.json"
    return [
        findings_section(study, study.title),
        html.section("Model and measurements", comparison_part(study.comparison, study.folder, since)),
        html.section("Where the energy went", partition_part(study, since)),
        verdict_section(verdicts(study.rows), figures),
        marker_section(study.rows),
    ]


def _ledger_part(ledger: Table) -> html.Markup:
    """Return the finite-element runs as a table, and all runs as a file inside the page."""
    at = ledger.names.index("fidelity")
    solid = [tuple(_short(str(cell)) for cell in row) for row in ledger.rows if row[at] == "solid"]
    counts = f"{len(ledger)} runs, {len(solid)} of them with finite elements: "
    link = html.data_link(ledger.csv().encode(), "ledger.csv", "ledger.csv")
    shown = html.table(Table(ledger.columns, tuple(solid)), compact=True)
    return html.join([html.Markup(f"<p>{counts}{link}</p>"), html.details("Finite-element runs", shown)])


def _short(cell: str) -> str:
    try:
        return f"{float(cell):.4g}"
    except ValueError:
        return cell[:24]


def _markdown(studies: Iterable[StudyRecord], concluded: str) -> str:
    """Return the summaries of all studies below the conclusions, figure links relative to the report."""
    parts = [f"# {TITLE}", concluded]
    for study in studies:
        text = read_text(study.folder / "summary.md").strip()
        text = text.replace("](figures/", f"](../{study.folder.name}/figures/")
        parts.append(text.replace("# ", "## ", 1))  # one heading level lower
    return "\n\n".join(part for part in parts if part) + "\n"


class Conclusion(NamedTuple):
    """A conclusion: its sentence, the id of its figure in the page, and the path of the figure's file."""

    sentence: str
    figure: str = ""
    file: str = ""


def conclusions(studies: Iterable[StudyRecord]) -> list[Conclusion]:
    """Return the conclusions of all studies; before those of measured sets the verdicts on the paper."""
    listed = []
    for study in studies:
        listed += [Conclusion(v.sentence, v.name, f"figures/{v.name}.svg") for v in verdicts(study.rows)]
        marked = marker_sentence(study.rows)
        listed += [Conclusion(marked)] if marked else []
        for entry in study.conclusions:
            name, sentence = entry["name"], entry["sentence"]
            file = f"../{study.folder.name}/figures/{name}.png"
            drawn = Conclusion(sentence, figure_id(study.study, name), file)
            listed.append(drawn if name else Conclusion(sentence))
    return listed


def conclusion_list(listed: Sequence[Conclusion]) -> html.Markup:
    """Return the conclusions, each linked to its figure."""
    items = []
    for conclusion in listed:
        link = f' <a href="#{escape(conclusion.figure)}">figure</a>' if conclusion.figure else ""
        items.append(html.Markup(markup(conclusion.sentence) + link))
    return html.bullets(items)


def conclusion_text(listed: Sequence[Conclusion]) -> str:
    """Return the conclusions as Markdown, empty when there is none."""
    lines = [f"- {entry.sentence}" + (f" ([figure]({entry.file}))" if entry.file else "") for entry in listed]
    return "\n".join(["## Conclusions", "", *lines]) if lines else ""
