"""Sections that the reports share, and model beside measured tests."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any

from fem_impact.answers.compare import compare, told
from fem_impact.errors import ResultError, SceneError
from fem_impact.figures.panels import Picture
from fem_impact.figures.runs import (
    comparison_picture,
    force_picture,
    ledger_picture,
    quantity_title,
    waves_picture,
)
from fem_impact.figures.still import percent
from fem_impact.files.waves import read_waves
from fem_impact.films.movement import FRAMES, STUDY_FRAMES
from fem_impact.outcome.groups import WRONG_NUMBERS, LimitationKind, texts
from fem_impact.outcome.keys import Key, Unknown, or_none
from fem_impact.outcome.record import KEYS, Outcome
from fem_impact.pages import html
from fem_impact.run.tests import tests_of
from fem_impact.scene.read import read_toml
from fem_impact.scene.types import OWN, Scene, digest
from fem_impact.tables.history import read_history
from fem_impact.tables.table import DASH, Cell, Marked, Missing, Table, number
from fem_impact.tables.text import markup, with_band

LENGTHS = (
    f"The film of a run of a study has {STUDY_FRAMES} pictures; "
    f"`fem-impact render` with the folder of the run makes one of {FRAMES}."
)


def mismatches(outcome: Outcome, folder: Path) -> list[str]:
    """Return warnings that the folder's scene or history does not belong to the outcome."""
    found, path = [], folder / "scene.toml"
    try:
        if path.is_file() and digest(read_toml(path)) != outcome.provenance.scene_digest:
            changed = "scene.toml was changed after the run, or a file that it names"
            found.append(f"{changed}: it is not the scene of outcome.json.")
    except SceneError as error:
        found.append(str(error))
    intervals = or_none(outcome.contact.intervals)
    if outcome.provenance.fidelity == "solid" and intervals:
        with suppress(ResultError, IndexError):  # `history_figures` says that it is missing or damaged
            last, end = read_history(folder / "history.csv").numbers("time_s")[-1], intervals[-1].end
            if last < end:
                cut = f"ends at {last * 1e6:.4g} us, before the last contact does ({end * 1e6:.4g} us)"
                found.append(f"history.csv {cut}: it is not whole.")
    return found


def notices(rows: list[Outcome], more: Sequence[str] = ()) -> html.Markup:
    """Return a highlighted block of what `validity` does not list, heaviest first; nothing if it is empty."""
    warned = [one for kind in (*WRONG_NUMBERS, "input") for one in _sentences(rows, kind)]
    cut = [
        f"{row.provenance.scene_id} was cut off: {row.validity.stopped_because}"
        for row in rows
        if not row.validity.finished
    ]
    listed = html.bullets([*more, *cut, *warned]).text
    return html.Markup(
        f'<div class="notice"><strong>To keep in mind</strong>\n{listed}</div>' if listed else ""
    )


def validity(rows: Sequence[Outcome]) -> html.Markup:
    """Return the section on what the model leaves out and where scenes leave what was measured."""
    return html.section("Range of validity", html.bullets(_sentences(rows, "range", "model")))


def named(picture: Picture, scene: Scene | None) -> Picture:
    """Return a picture of one run whose labels call the body what it is."""
    if scene is None:
        return picture
    of = scene.projectile.named
    return replace(
        picture,
        panels=tuple(
            replace(
                panel,
                rows=tuple(map(of, panel.rows)),
                series=tuple(replace(one, label=of(one.label)) for one in panel.series),
            )
            for panel in picture.panels
        ),
    )


def history_figures(
    outcome: Outcome, folder: Path, again: bool = True, scene: Scene | None = None
) -> html.Markup:
    """Return ledger and contact force over time, or the sentence that says why they are missing.

    With ``again`` False, figures newer than history.csv are not drawn again.
    """
    if outcome.provenance.fidelity == "rigid":
        return html.section("Over time", html.paragraph("No curves over time: a rigid impact takes no time."))
    since = None if again else folder / "history.csv"
    try:
        history, figures = read_history(folder / "history.csv"), folder / "figures"
        ledger = html.figure(named(ledger_picture(history, outcome.energy.E_0), scene), figures, since)
        force = html.figure(force_picture(history, or_none(outcome.contact.intervals) or ()), figures, since)
    except ResultError as error:
        return html.section("Over time", html.paragraph(f"No curves over time: {error}"))
    return html.join([html.section("Energy over time", ledger), html.section("Contact force", force)])


def waves_section(folder: Path) -> html.Markup:
    """Return the strain along the axis over time, nothing where the run did not store it."""
    stored = folder / "waves.h5"
    if not stored.is_file():
        return html.Markup("")
    try:
        drawn = html.figure(waves_picture(read_waves(stored)), folder / "figures")
    except ResultError as error:
        drawn = html.paragraph(f"No diagram of the waves: {error}")
    return html.section("Waves along the projectile", drawn)


def film_section(folder: Path) -> html.Markup:
    """Return the film of the run, nothing when there is none."""
    film = html.film_of(folder)
    if film is None:
        return html.Markup("")
    shown = html.film(film, "Waves in the projectile; scales are written on the picture.")
    return html.section("Film of the waves", shown, html.paragraph(LENGTHS))


def key_table(outcome: Outcome, keys: Iterable[Key], rigid: Outcome | None = None) -> html.Markup:
    """Return a table of meaning, value and unit of keys; of two meshes the limit and its band.

    Keys that are not known are left out: `unknown` lists them. With ``rigid``, what rigid theory predicts
    stands beside each value.
    """
    rows: list[list[Cell]] = []
    for key in keys:
        if isinstance(key.of(outcome), Unknown):
            continue
        meaning = key.meaning.replace(", as a fraction of E_0.", ".")
        cells: list[Cell] = [f"{meaning} `{key.name}`", estimated(outcome, key)]
        if rigid is not None:
            value = key.of(rigid)
            cells.append(Missing(value.reason) if isinstance(value, Unknown) else number(or_none(value)))
        unit = "" if key.unit == "-" else key.unit.replace("m2", "m²")
        rows.append([*cells, "of\u00a0E₀" if key.name.endswith("_over_E_0") else unit])
    head = ("quantity", "value", *(["rigid theory"] if rigid else []), "unit")
    return html.table(Table.of(head, rows, left=(0, len(head) - 1)))


def card(name: str, value: str, note: str) -> html.Markup:
    """Return a card that shows one number with its name and a note."""
    small = f'<div class="note">{markup(note)}</div>' if note else ""
    inner = f'<div class="name">{markup(name)}</div><div class="value">{escape(value)}</div>{small}'
    return html.Markup(f'<div class="card">{inner}</div>')


def cards(*shown: html.Markup) -> html.Markup:
    """Return cards side by side."""
    return html.Markup(f'<div class="cards">{html.join(shown).text}</div>')


def estimated(outcome: Outcome, key: Key) -> str:
    """Return a number as text, with its half-width where it has one."""
    value = key.of(outcome)
    if isinstance(value, Unknown):
        return DASH
    return number(value) if isinstance(value, int) else html.signed(outcome.told(key))


def contacts_table(outcome: Outcome) -> html.Markup:
    """Return the contact intervals with their impulses on the whole projectile."""
    head = ("contact", "start, µs", "end, µs", "normal impulse, N s", "tangential, N s", "ratio")
    intervals = or_none(outcome.contact.intervals) or ()
    rows: list[list[Cell]] = []
    for at, contact in enumerate(intervals, start=1):
        times = (f"{contact.start * 1e6:.1f}", f"{contact.end * 1e6:.1f}")
        normal, tangential = contact.impulse_n, contact.impulse_t
        rows.append([at, *times, normal, tangential, tangential / normal if normal else None])
    return html.table(Table.of(head, rows), "Contact intervals, impulses on the whole projectile.")


def contact_places(outcome: Outcome) -> html.Markup:
    """Return where the bodies touched, nothing where that is not known."""
    times, impulses = ("start, µs", "end, µs"), ("normal impulse, N s", "tangential, N s")
    head = ("place", *times, *impulses, "along t, mm", "width, mm", "depth, µm")
    rigid = isinstance(outcome.cost.elements_barrier, Unknown)
    rows: list[list[Cell]] = []
    for at, site in enumerate(or_none(outcome.contact.sites) or (), start=1):
        when = (f"{site.start * 1e6:.1f}", f"{site.end * 1e6:.1f}")
        given = (number(site.impulse_n, 2), number(site.impulse_t, 2))  # they are sampled every few steps
        along = f"{number(1e3 * site.low_t, 3)} to {number(1e3 * site.high_t, 3)}"
        depth = None if rigid else number(1e6 * site.depth, 3)
        rows.append([at, *when, *given, along, number(1e3 * site.width, 3), depth])
    cell = or_none(outcome.cost.tip_size)
    known_to = "" if cell is None else f", known to about a cell, {number(1e3 * cell, 2)} mm"
    caption = (
        "Places of contact: the projectile's skin that was pressed, as it lies before the impact, from the "
        f"place that touches first{known_to}; the deepest indentation of the barrier there; impulses on the "
        "whole projectile."
    )
    return html.table(Table.of(head, rows), caption)


def unknown(rows: Sequence[Outcome]) -> html.Markup:
    """Return the table of keys that are not known, with reason and runs; one row a reason."""
    reasons: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        for name, reason in row.reasons.items():
            reasons.setdefault(reason, {}).setdefault(name, []).append(row.provenance.scene_id)
    columns, lines = 3 if len(rows) > 1 else 2, []
    for reason, names in reasons.items():
        runs = dict.fromkeys(run for ids in names.values() for run in ids)
        line = (", ".join(f"`{name}`" for name in names), reason, _runs(list(runs), len(rows)))
        lines.append(line[:columns])
    head = ("key", "why it is not known", "runs")[:columns]
    listed = html.details("Keys and reasons", html.table(Table.of(head, lines, left=range(columns))))
    return html.section("What is not known", listed if lines else html.Markup(""))


def _sentences(rows: Sequence[Outcome], *kinds: LimitationKind) -> list[str]:
    """Return the distinct limitations of outcomes of some kinds, each with the ids of its runs."""
    ids: dict[str, list[str]] = {}
    for row in rows:
        for sentence in texts(row.validity.limitations, *kinds):
            ids.setdefault(sentence, []).append(row.provenance.scene_id)
    if len(rows) == 1:
        return list(ids)
    return [f"{sentence} ({_runs(runs, len(rows))})" for sentence, runs in ids.items()]


def all_keys(outcome: Outcome) -> html.Markup:
    """Return a folded table of every number, count, flag and text of the outcome."""
    plain = [key for key in KEYS if key.kind in ("number", "count", "flag", "text")]
    rows = [(f"`{key.name}`", known_cell(key.of(outcome)), key.unit, key.meaning) for key in plain]
    shown = Table.of(("key", "value", "unit", "meaning"), rows, left=range(4))
    return html.details("Every key of the record", html.table(shown))


def known_cell(value: Cell | Unknown) -> Cell:
    """Return a value of an outcome as a cell, with the reason where it is not known."""
    return Missing(value.reason) if isinstance(value, Unknown) else value


def _runs(runs: Sequence[str], count: int) -> str:
    return "all runs" if len(runs) == count else ", ".join(runs)


EFFECTS = ("effect", "in the model", "decided by", "number", "threshold", "run time")


def effects_section(outcome: Outcome) -> html.Markup:
    """Return the table of effects, nothing where a fidelity has none."""
    rows: list[list[Cell]] = [
        [
            choice.name,
            f"{'on' if choice.on else 'off'}{', by the scene' if choice.forced else ''}",
            choice.measure,
            choice.number,
            choice.threshold,
            None if choice.share is None else percent(choice.share),
        ]
        for choice in or_none(outcome.provenance.effect_choices) or ()
    ]
    caption = (
        "An effect is needed when its number is above its threshold. The run time is the share of its own "
        "parts; that of friction and rates is estimated."
    )
    shown = html.table(Table.of(EFFECTS, rows, left=range(3)), caption)
    folded = html.details("What the model has, and why", shown)
    return html.section("Effects", folded if rows else html.Markup(""))


COMPARED = ("model", "measured", "95 % interval of the mean", "n", "verdict")


def beside_tests(outcome: Outcome, scene: Scene | None, folder: Path) -> html.Markup:
    """Return the section that sets a run beside the tests its scene names; nothing where it names none.

    Its figure and data are written to ``folder/figures``. A file of tests that cannot be read is reported.
    """
    title = "Beside the measured tests"
    if scene is None or scene.measured is None:
        return html.Markup("")
    try:
        tests = tests_of(scene)
    except (ResultError, OSError) as error:
        return html.section(title, html.paragraph(f"The tests can no longer be read: {error}"))
    rows = [row for row in compare(outcome, tests) if row["measured_mean"] is not None]
    known = [row for row in rows if row["model"] is not None]
    inside = sum(is_inside(row["verdict"]) for row in known)
    is_file = scene.measured.endswith(OWN)
    name = Path(scene.measured).name if is_file else f"the published set {scene.measured}"
    summary = html.paragraph(
        f"{inside} of {len(known)} computed quantities lie inside the 95 % interval of the measured mean "
        f"({max(row['n'] for row in rows)} tests, {name})."
    )
    lines = [[quantity_title(row), *_cells(row)] for row in rows]
    shown = Table.of(("quantity", *COMPARED), lines, left=(0, 5))
    return html.section(title, summary, html.table(shown, compact=True), comparison_part(rows, folder))


def comparison_part(
    rows: Sequence[Mapping[str, Any]], folder: Path, since: Path | None = None
) -> html.Markup:
    """Return the figure of model and measurement; one newer than the file ``since`` is not drawn again."""
    if all(row["measured_mean"] is None for row in rows):
        return html.Markup("")
    return html.figure_with_data(comparison_picture(rows), folder / "figures", since)


def comparison_tables(rows: Sequence[Mapping[str, Any]]) -> html.Markup:
    """Return a table a quantity that was measured: model, measurement, interval and verdict of each set."""
    quantities = dict.fromkeys(row["quantity"] for row in rows if row["measured_mean"] is not None)
    tables = []
    for name in quantities:
        of_sets = [row for row in rows if row["quantity"] == name]
        measured = [row for row in of_sets if row["measured_mean"] is not None]
        inside = sum(is_inside(row["verdict"]) for row in measured)
        lines = [[str(row["set"]), *_cells(row)] for row in of_sets]
        shown = html.table(Table.of(("set", *COMPARED), lines, left=(0, 5)), compact=True)
        title = f"{quantity_title(of_sets[0])}: {inside} of {len(measured)} inside"
        tables.append(html.details(title, shown))
    return html.join(tables)


def _cells(row: Mapping[str, Any]) -> list[Cell]:
    low, high = row["measured_low"], row["measured_high"]
    mean, sd = row["measured_mean"], row["measured_sd"]
    style = "" if mean is None else "inside" if is_inside(row["verdict"]) else "outside"
    return [
        Marked(DASH if row["model"] is None else html.signed(told(row)), style),
        _three(mean) if mean is None or sd is None else html.signed(with_band(mean, sd)),
        None if low is None or high is None else f"{_three(low)} to {_three(high)}",
        row["n"],
        Marked(str(row["verdict"] or DASH), style),
    ]


def _three(value: float | None) -> str:
    return DASH if value is None else f"{value:#.3g}".rstrip(".").replace("-", "−")


def is_inside(verdict: Any) -> bool:
    """Return whether a verdict says that the model lies inside the 95 % interval of the mean."""
    return str(verdict).startswith("inside")
