"""The report of a study."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

from fem_impact.figures.partition import study_partition_picture
from fem_impact.files.atomic import make_directory
from fem_impact.outcome.groups import RunCost
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.pages.comparison import comparison_part, comparison_tables, is_inside
from fem_impact.pages.findings import findings_section
from fem_impact.pages.html import Markup, bullets, details, join, section, table
from fem_impact.pages.page import download, figure, page, sources
from fem_impact.pages.sections import (
    card,
    estimated,
    has_film,
    history_figures,
    known_cell,
    notices,
    sentences,
    unknown,
)
from fem_impact.pages.study_data import Study, read_study
from fem_impact.tables.table import Cell, Table


def draw_study(folder: Path) -> None:
    """Draw comparison and partition of the study into ``folder/figures``; `study_page` can reuse them."""
    study = read_study(folder)
    comparison_part(study.comparison, study.folder)
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
    filmed = any(has_film(folder / row.provenance.scene_id) for row in rows)
    body = (
        findings_section(study, lead=comparison_part(study.comparison, study.folder, since)),
        _cards(study),
        notices(rows),
        section("Model beside measurement", comparison_tables(study.comparison)),
        section("Where the energy went", partition_part(study, since)),
        section("Over time, run by run", *(_run(row, folder) for row in rows)),
        unknown(rows),
        section("Range of validity", bullets(sentences(rows, lambda row: row.validity.outside))),
        section("Cost", details("Time, memory and elements", _costs(rows)) if rows else Markup("")),
        sources([*study.sources, *(["film"] if filmed else [])]),
    )
    return page(study.title, "Study", "", _footer(study), body)


def _cards(study: Study) -> Markup:
    if not study.rows:
        return Markup("")
    measured = [row for row in study.comparison if row["measured_mean"] is not None]
    inside = sum(is_inside(row["verdict"]) for row in measured)
    residuals = [abs(row.energy.residual) for row in study.rows]
    seconds = sum(row.cost.wall for row in study.rows)
    cards = [
        card("runs", str(len(study.rows)), f"{len(study.failures)} failed"),
        card("inside 95 % intervals", f"{inside} of {len(measured)}", "measured quantities"),
        card("largest residual", f"{max(residuals):.1e}", "of E₀"),
        card("computing time", f"{seconds:.0f} s", "wall time of the runs, added"),
    ]
    return Markup(f'<div class="cards">{join(cards).text}</div>')


def partition_part(study: Study, since: Path | None = None) -> Markup:
    """Return the figure of the shares of E_0; one newer than the file ``since`` is not drawn again."""
    if not study.rows:
        return Markup("")
    figures = make_directory(study.folder / "figures")
    drawn = figure(study_partition_picture(study.rows), figures, since)
    return join([drawn, download(figures / "partition.csv", "its data")])


def _run(row: Outcome, folder: Path) -> Markup:
    place = folder / row.provenance.scene_id
    if not (place / "history.csv").is_file():
        return Markup("")
    e, mu = (estimated(row, KEY_TABLE[name]) for name in ("e_paper", "mu"))
    title = f"{row.provenance.scene_id}: {row.provenance.scene_title} (e = {e}, µ = {mu})"
    return details(title, history_figures(row, place, again=False), _own_page(place))


def _own_page(place: Path) -> Markup:
    """Return the link to the run's page with its film; films of all runs would make this page too large."""
    if not (has_film(place) and (place / "report.html").is_file()):
        return Markup("")
    return Markup(f'<p><a href="{escape(place.name)}/report.html">The film of its waves</a></p>')


def _costs(rows: Sequence[Outcome]) -> Markup:
    head = ("run", "tip, mm", "steps", "element-steps", "rod", "barrier", "wall, s", "memory, MB")
    shown = Table.of(head, [[row.provenance.scene_id, *_cost(row.cost)] for row in rows])
    return table(shown, compact=True)


def _cost(cost: RunCost) -> list[Cell]:
    size = or_none(cost.tip_size)
    counts = (cost.steps, cost.element_steps, cost.elements_rod, cost.elements_barrier)
    lengths = [None if size is None else 1e3 * size]
    return [*lengths, *map(known_cell, counts), cost.wall, known_cell(cost.peak_memory)]


def _footer(study: Study) -> str:
    made = f"Made by {study.command}."
    if not study.rows:
        return made
    versions = ", ".join(f"{name} {version}" for name, version in study.rows[0].provenance.versions.items())
    return f"{made} Computed up to {max(row.provenance.created_utc for row in study.rows)} with {versions}."
