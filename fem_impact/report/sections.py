"""Sections that the report of a run and of a study share."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fem_impact.errors import ResultError, SceneError
from fem_impact.figures import force_figure, ledger_figure
from fem_impact.outcome import Outcome, or_none
from fem_impact.output import make_directory, read_table
from fem_impact.report.embed import FILMS, film, picture
from fem_impact.report.html import Markup, bullets, join, paragraph, section
from fem_impact.report.tables import sentences
from fem_impact.scene import Scene

__all__ = ["film_section", "has_film", "history_figures", "notices", "strangers"]


def strangers(outcome: Outcome, folder: Path) -> list[str]:
    """Return what says that files of the folder are not, or not wholly, those of the outcome."""
    return [*_other_scene(outcome, folder), *_short_history(outcome, folder)]


def _other_scene(outcome: Outcome, folder: Path) -> list[str]:
    path = folder / "scene.toml"
    try:
        other = path.is_file() and Scene.from_toml(path).digest() != outcome.provenance.scene_digest
    except SceneError as error:
        return [str(error)]
    return ["scene.toml was changed after the run: it is not the scene of outcome.json."] if other else []


def _short_history(outcome: Outcome, folder: Path) -> list[str]:
    intervals = or_none(outcome.contact.intervals)
    if outcome.provenance.fidelity != "solid" or not intervals:
        return []
    try:
        last = read_table(folder / "history.csv").numbers("time_s")[-1]
    except (ResultError, IndexError):
        return []  # that it is missing or damaged is told where its curves would stand
    end = intervals[-1].end
    told = f"history.csv ends at {last * 1e6:.4g} us, before the last contact does ({end * 1e6:.4g} us)"
    return [f"{told}: it is not whole."] if last < end else []


def notices(rows: list[Outcome], more: Sequence[str] = ()) -> Markup:
    """Return the warnings where they cannot be missed."""
    warned = sentences(rows, lambda row: row.validity.warnings)
    cut = [
        f"{row.provenance.scene_id} was cut off: {row.validity.stopped_because}"
        for row in rows
        if not row.validity.finished
    ]
    listed = bullets([*more, *cut, *warned]).text
    return Markup(f'<div class="notice"><strong>To keep in mind</strong>\n{listed}</div>' if listed else "")


def history_figures(outcome: Outcome, folder: Path, again: bool = True) -> Markup:
    """Return ledger and contact force over time, or the sentence that says why they are missing.

    Pictures that were drawn after the run are only drawn ``again`` if that is asked for.
    """
    if outcome.provenance.fidelity != "solid":
        return section("Over time", paragraph("No curves over time: only the finite elements write them."))
    since = None if again else folder / "history.csv"
    try:
        history = read_table(folder / "history.csv")
        figures = make_directory(folder / "figures")
        ledger = picture(
            lambda path, shape: ledger_figure(history, outcome.energy.E_0, path, shape),
            figures / "ledger",
            "Stacked areas of the energy accounts over time",
            "Ledger: each account as a fraction of E₀; the number beside a name is its last value. "
            "Strain energies include what stays locked in.",
            since,
        )
        force = picture(
            lambda path, shape: force_figure(history, or_none(outcome.contact.intervals) or (), path, shape),
            figures / "force",
            "Normal and tangential contact force over time",
            "Contact force on the whole rod; contact intervals shaded, with their normal impulse.",
            since,
        )
    except ResultError as error:
        return section("Over time", paragraph(f"No curves over time: {error}"))
    return join([section("Ledger over time", ledger), section("Contact force", force)])


def film_section(folder: Path) -> Markup:
    """Return the film of the run, nothing when there is none."""
    return section("Film of the waves", film(folder, "Waves in the rod; scales are written on the picture."))


def has_film(folder: Path) -> bool:
    """Return whether the run was filmed in a format that a page can show."""
    return any((folder / name).is_file() for name in FILMS)
