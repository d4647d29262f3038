"""The report of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

from fem_impact.figures.partition import comparison_figure, study_partition_figure
from fem_impact.figures.style import percent
from fem_impact.files.atomic import make_directory
from fem_impact.outcome.groups import RunCost
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import EnergyShare, shares
from fem_impact.report.findings import misses_section
from fem_impact.report.html import Markup, bullets, cell, details, join, number, section, table
from fem_impact.report.page import download, page, picture, sources
from fem_impact.report.sections import card, estimated, has_film, history_figures, notices, sentences, unknown
from fem_impact.report.study_data import Study, read_study

__all__ = ["comparison_part", "draw_study", "partition_part", "study_page"]


def draw_study(folder: Path) -> None:
    """Draw the study's own figures into ``folder/figures``, for a page that is not to draw them again."""
    study, figures = read_study(folder / "study.json"), make_directory(folder / "figures")
    comparison_part(study, figures)
    partition_part(study, figures)


def study_page(folder: Path, again: bool = True) -> str:
    """Return the HTML of the study in ``folder``; figures with their data stay in ``folder/figures``.

    Its own figures, where they were drawn after the study, are only drawn ``again`` if that is asked for.

    Raises
    ------
    ResultError
        study.json is missing, damaged or wrong.
    """
    study = read_study(folder / "study.json")
    rows, figures = list(study.rows), make_directory(folder / "figures")
    since = None if again else folder / "study.json"
    body = (
        _cards(study),
        notices(rows),
        section(
            "Model beside measurement", comparison_part(study, figures, since), _tables(study.comparison)
        ),
        misses_section(study),
        section("Notes", bullets(study.notes)),
        section("Where the energy went", partition_part(study, figures, since)),
        section("Runs that failed", _failures(study)),
        section("Over time, run by run", *(_run(row, folder) for row in rows)),
        unknown(rows),
        section("Range of validity", bullets(sentences(rows, lambda row: row.validity.outside))),
        section("Cost", _costs(rows)),
        sources(_used(study, folder)),
    )
    return page(study.title, "Study", _lead(study), _footer(rows), body)


def _cards(study: Study) -> Markup:
    measured = [row for row in study.comparison if row["measured_mean"] is not None]
    inside = sum(_is_inside(row["verdict"]) for row in measured)
    residuals = [abs(row.energy.residual) for row in study.rows]
    seconds = sum(row.cost.wall for row in study.rows)
    cards = [
        card("runs", str(len(study.rows)), f"{len(study.failures)} failed"),
        card("inside 95 % intervals", f"{inside} of {len(measured)}", "measured quantities"),
        card("largest residual", f"{max(residuals):.1e}" if residuals else "–", "of E₀"),
        card("computing time", f"{seconds:.0f} s", "wall time of the runs, added"),
    ]
    return Markup(f'<div class="cards">{join(cards).text}</div>')


def comparison_part(study: Study, figures: Path, since: Path | None = None) -> Markup:
    """Return the figure of model beside measurement, drawn into a folder, unless after ``since`` already."""
    if not study.comparison:
        return Markup("")
    drawn = picture(
        partial(comparison_figure, study.comparison),
        figures / "comparison",
        "Model and measured values with intervals, a panel for each quantity",
        "Measured means with 95 % intervals of the mean and standard deviations; the model with its "
        "two-mesh band where two meshes were run.",
        since,
    )
    return join([drawn, download(figures / "comparison.csv", "its data")])


def _tables(rows: Sequence[Mapping[str, Any]]) -> Markup:
    quantities = dict.fromkeys(row["quantity"] for row in rows)
    return join(
        _quantity(name, [row for row in rows if row["quantity"] == name], opened=at < 3)
        for at, name in enumerate(quantities)
    )


def _quantity(name: str, rows: Sequence[Mapping[str, Any]], opened: bool) -> Markup:
    unit = "" if rows[0]["unit"] in ("", "-") else f", {rows[0]['unit']}"
    measured = [row for row in rows if row["measured_mean"] is not None]
    inside = sum(_is_inside(row["verdict"]) for row in measured)
    title = f"{name}{unit}: " + (f"{inside} of {len(measured)} inside" if measured else "not measured")
    head = ("set", "model", "measured", "95 % interval of the mean", "n", "verdict")
    shown = table(head, map(_comparison_row, rows), numbers=(1, 2, 3, 4), compact=True)
    return details(title, shown, opened=opened)


def _comparison_row(row: Mapping[str, Any]) -> list[str | Markup]:
    low, high = row["measured_low"], row["measured_high"]
    between = "–" if low is None or high is None else f"{_three(low)} to {_three(high)}"
    measured = row["measured_mean"] is not None
    kind = ("inside" if _is_inside(row["verdict"]) else "outside") if measured else ""
    model = _three(row["model"]) + ("" if row["band"] is None else f" ± {row['band']:.2g}")
    count = "–" if row["n"] is None else str(row["n"])
    spread = "" if row["measured_sd"] is None else f" ± {row['measured_sd']:.2g}"
    shown = [_three(row["measured_mean"]) + spread, between, count]
    return [
        str(row["set"]),
        cell(model, f"number {kind}".strip()),
        *shown,
        cell(str(row["verdict"] or "–"), kind),
    ]


def _three(value: float | None) -> str:
    return "–" if value is None else f"{value:#.3g}".rstrip(".").replace("-", "−")


def _is_inside(verdict: Any) -> bool:
    return str(verdict).startswith("inside")


def partition_part(study: Study, figures: Path, since: Path | None = None) -> Markup:
    """Return figure and table of the shares of E_0; the figure is not drawn again ``since`` a file."""
    if not study.rows:
        return Markup("")
    drawn = picture(
        partial(study_partition_figure, study.rows),
        figures / "partition",
        "Stacked bars of the shares of the energy, one a run",
        "Shares of E₀ after the last separation; a white rest is not known.",
        since,
    )
    return join([drawn, download(figures / "partition.csv", "its data"), _energies(study.rows)])


def _energies(rows: Sequence[Outcome]) -> Markup:
    listed = shares("report")
    head = ("run", *(share.label for share in listed), "residual")
    shown = [
        [
            row.provenance.scene_id,
            *(_share(row, share) for share in listed),
            percent(row.energy.residual),
        ]
        for row in rows
    ]
    return table(head, shown, "Shares of E₀.", numbers=range(1, len(head)), compact=True)


def _share(row: Outcome, share: EnergyShare) -> str:
    if share.key.path[-1] == "vibration" and or_none(row.energy.below_floor):
        return "below floor"
    value, width = row.estimate(share.key)
    return "–" if isinstance(value, Unknown) else percent(value, width)


def _failures(study: Study) -> Markup:
    return table(("run", "why"), [(item["scene_id"], item["error"]) for item in study.failures])


def _run(row: Outcome, folder: Path) -> Markup:
    place = folder / row.provenance.scene_id
    if not (place / "history.csv").is_file():
        return Markup("")
    e, mu = (estimated(row, KEY_TABLE[name]) for name in ("e_paper", "mu"))
    title = f"{row.provenance.scene_id}: {row.provenance.scene_title} (e = {e}, µ = {mu})"
    return details(title, history_figures(row, place, again=False), _own_page(place))


def _own_page(place: Path) -> Markup:
    """Return the link to the run's own page, which carries its film: thirteen films make no page to send."""
    if not (has_film(place) and (place / "report.html").is_file()):
        return Markup("")
    return Markup(f'<p><a href="{escape(place.name)}/report.html">The film of its waves</a></p>')


def _costs(rows: Sequence[Outcome]) -> Markup:
    head = ("run", "tip, mm", "steps", "element-steps", "rod", "barrier", "wall, s", "memory, MB")
    shown = [[row.provenance.scene_id, *_cost(row.cost)] for row in rows]
    return table(head, shown, numbers=range(1, len(head)), compact=True)


def _cost(cost: RunCost) -> list[str]:
    size = or_none(cost.tip_size)
    counts = (cost.steps, cost.element_steps, cost.elements_rod, cost.elements_barrier)
    return [
        number(None if size is None else 1e3 * size),
        *(number(or_none(count)) for count in counts),
        number(cost.wall),
        number(or_none(cost.peak_memory)),
    ]


def _used(study: Study, folder: Path) -> set[str]:
    origins = [row.provenance for row in study.rows]
    films = any(has_film(folder / origin.scene_id) for origin in origins)
    return {effect for origin in origins for effect in origin.effects} | ({"film"} if films else set())


def _lead(study: Study) -> str:
    sets = len({row["set"] for row in study.comparison})
    compared = sum(row["measured_mean"] is not None for row in study.comparison)
    return f"{len(study.rows)} runs, {compared} comparisons with {sets} measured sets."


def _footer(rows: Sequence[Outcome]) -> str:
    if not rows:
        return "No run gave a record."
    versions = ", ".join(f"{name} {version}" for name, version in rows[0].provenance.versions.items())
    return f"Computed up to {max(row.provenance.created_utc for row in rows)} with {versions}."
