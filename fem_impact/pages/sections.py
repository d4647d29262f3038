"""Sections that the report of a run and of a study share."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from pathlib import Path

from fem_impact.case.effects.registry import BARRIERS
from fem_impact.errors import ResultError, SceneError
from fem_impact.figures.history import force_picture, ledger_picture
from fem_impact.figures.style import percent
from fem_impact.figures.waves import waves_picture
from fem_impact.files.atomic import make_directory
from fem_impact.files.waves import read_waves
from fem_impact.films.timeline import FRAMES, QUICK_FRAMES, STUDY_FRAMES
from fem_impact.outcome.groups import ContactInterval, EffectChoice
from fem_impact.outcome.keys import Key, Unknown, or_none
from fem_impact.outcome.record import KEYS, Outcome
from fem_impact.pages.html import (
    Markup,
    bullets,
    details,
    join,
    paragraph,
    section,
    table,
    with_band,
)
from fem_impact.pages.page import FILMS, figure, film
from fem_impact.scene.read import read_toml
from fem_impact.scene.write import digest
from fem_impact.tables.history import read_history
from fem_impact.tables.symbols import markup
from fem_impact.tables.table import Cell, Missing, Table, number

LENGTHS = (
    f"The film of a run of a study has {STUDY_FRAMES} pictures, of a quick study {QUICK_FRAMES}; "
    f"`fem-impact render` with the folder of the run makes one of {FRAMES}."
)


def strangers(outcome: Outcome, folder: Path) -> list[str]:
    """Return warnings that the folder's scene or history does not belong to the outcome."""
    return [*_other_scene(outcome, folder), *_short_history(outcome, folder)]


def _other_scene(outcome: Outcome, folder: Path) -> list[str]:
    path = folder / "scene.toml"
    try:
        other = path.is_file() and digest(read_toml(path)) != outcome.provenance.scene_digest
    except SceneError as error:
        return [str(error)]
    return ["scene.toml was changed after the run: it is not the scene of outcome.json."] if other else []


def _short_history(outcome: Outcome, folder: Path) -> list[str]:
    intervals = or_none(outcome.contact.intervals)
    if outcome.provenance.fidelity != "solid" or not intervals:
        return []
    try:
        last = read_history(folder / "history.csv").numbers("time_s")[-1]
    except (ResultError, IndexError):
        return []  # `history_figures` says that it is missing or damaged
    end = intervals[-1].end
    cut = f"history.csv ends at {last * 1e6:.4g} us, before the last contact does ({end * 1e6:.4g} us)"
    return [f"{cut}: it is not whole."] if last < end else []


def notices(rows: list[Outcome], more: Sequence[str] = ()) -> Markup:
    """Return a highlighted block of warnings, nothing when there is none."""
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

    With ``again`` False, figures newer than history.csv are not drawn again.
    """
    if outcome.provenance.fidelity == "rigid":
        return section("Over time", paragraph("No curves over time: a rigid impact takes no time."))
    since = None if again else folder / "history.csv"
    try:
        history = read_history(folder / "history.csv")
        figures = make_directory(folder / "figures")
        ledger = figure(ledger_picture(history, outcome.energy.E_0), figures, since)
        force = figure(force_picture(history, or_none(outcome.contact.intervals) or ()), figures, since)
    except ResultError as error:
        return section("Over time", paragraph(f"No curves over time: {error}"))
    return join([section("Energy over time", ledger), section("Contact force", force)])


def waves_section(folder: Path) -> Markup:
    """Return the strain along the axis over time, nothing where the run did not store it."""
    stored = folder / "waves.h5"
    if not stored.is_file():
        return Markup("")
    try:
        drawn = figure(waves_picture(read_waves(stored)), make_directory(folder / "figures"))
    except ResultError as error:
        drawn = paragraph(f"No diagram of the waves: {error}")
    return section("Waves along the rod", drawn)


def film_section(folder: Path) -> Markup:
    """Return the film of the run, nothing when there is none."""
    shown = film(folder, "Waves in the rod; scales are written on the picture.")
    return section("Film of the waves", *([shown, paragraph(LENGTHS)] if shown.text else []))


def has_film(folder: Path) -> bool:
    """Return whether the run was filmed in a format that a page can show."""
    return any((folder / name).is_file() for name in FILMS)


def key_table(
    outcome: Outcome, keys: Iterable[Key], caption: str = "", rigid: Outcome | None = None
) -> Markup:
    """Return a table of meaning, value and unit of keys; of two meshes the limit and its band.

    Keys that are not known are left out: `unknown` lists them. With ``rigid``, what rigid theory predicts
    stands beside each value.
    """
    shown = [key for key in keys if not isinstance(key.of(outcome), Unknown)]
    meanings = [key.meaning.replace(", as a fraction of E_0.", ".") for key in shown]
    rows = [
        (f"{meaning} `{key.name}`", estimated(outcome, key), *_predicted(rigid, key), _unit(key))
        for key, meaning in zip(shown, meanings, strict=True)
    ]
    head = ("quantity", "value", *(["rigid theory"] if rigid else []), "unit")
    return table(Table.of(head, rows, left=(0, len(head) - 1)), caption)


def _predicted(rigid: Outcome | None, key: Key) -> list[Cell]:
    if rigid is None:
        return []
    value = key.of(rigid)
    return [Missing(value.reason) if isinstance(value, Unknown) else number(or_none(value))]


def card(name: str, value: str, note: str = "") -> Markup:
    """Return a card that shows one number with its name and a note."""
    small = f'<div class="note">{markup(note)}</div>' if note else ""
    inner = f'<div class="name">{markup(name)}</div><div class="value">{escape(value)}</div>{small}'
    return Markup(f'<div class="card">{inner}</div>')


def estimated(outcome: Outcome, key: Key) -> str:
    """Return a number as text; of two meshes the limit with its band."""
    value, band = outcome.estimate(key)
    return with_band(or_none(value), band)


def contacts_table(outcome: Outcome) -> Markup:
    """Return the contact intervals with their impulses on the whole rod."""
    head = ("contact", "start, µs", "end, µs", "normal impulse, N s", "tangential, N s", "ratio")
    intervals = or_none(outcome.contact.intervals) or ()
    rows = [_contact(at, contact) for at, contact in enumerate(intervals, start=1)]
    return table(Table.of(head, rows), "Contact intervals, impulses on the whole rod.")


def unknown(rows: Sequence[Outcome]) -> Markup:
    """Return the table of keys that are not known, with reason and runs; one row a reason."""
    reasons: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        for name, reason in row.reasons.items():
            reasons.setdefault(reason, {}).setdefault(name, []).append(row.provenance.scene_id)
    lines = [
        (", ".join(f"`{name}`" for name in names), reason, _where(names, len(rows)))
        for reason, names in reasons.items()
    ]
    shown = lines if len(rows) > 1 else [line[:2] for line in lines]
    head = ("key", "why it is not known", "runs")[: len(shown[0]) if shown else 2]
    listed = table(Table.of(head, shown, left=range(len(head))))
    return section("What is not known", details("Keys and reasons", listed) if shown else Markup(""))


def sentences(rows: Sequence[Outcome], of: Callable[[Outcome], Iterable[str]]) -> list[str]:
    """Return the distinct sentences of outcomes, such as warnings, each with the ids of its runs."""
    said: dict[str, list[str]] = {}
    for row in rows:
        for sentence in of(row):
            said.setdefault(sentence, []).append(row.provenance.scene_id)
    if len(rows) == 1:
        return list(said)
    return [f"{sentence} ({_runs(runs, len(rows))})" for sentence, runs in said.items()]


def all_keys(outcome: Outcome) -> Markup:
    """Return a folded table of every number, count, flag and text of the outcome."""
    plain = [key for key in KEYS if key.kind in ("number", "count", "flag", "text")]
    rows = [(f"`{key.name}`", known_cell(key.of(outcome)), key.unit, key.meaning) for key in plain]
    shown = Table.of(("key", "value", "unit", "meaning"), rows, left=range(4))
    return details("Every key of the record", table(shown))


def known_cell(value: Cell | Unknown) -> Cell:
    """Return a value of an outcome as a cell, with the reason where it is not known."""
    return Missing(value.reason) if isinstance(value, Unknown) else value


def _unit(key: Key) -> str:
    if key.name.endswith("_over_E_0"):
        return "of\u00a0E₀"
    return "" if key.unit == "-" else key.unit.replace("m2", "m²")


def _contact(at: int, contact: ContactInterval) -> tuple[Cell, ...]:
    normal, tangential = contact.impulse_n, contact.impulse_t
    times = (f"{contact.start * 1e6:.1f}", f"{contact.end * 1e6:.1f}")
    return (at, *times, normal, tangential, tangential / normal if normal else None)


def _where(names: Mapping[str, Sequence[str]], count: int) -> str:
    runs = list(dict.fromkeys(run for where in names.values() for run in where))
    return _runs(runs, count)


def _runs(runs: Sequence[str], count: int) -> str:
    return "all runs" if len(runs) == count else ", ".join(runs)


HEAD = (
    *("effect", "in the model", "decided by", "number", "threshold"),
    *("change of e", "change of E_vib/E₀", "run time"),
)


def effects_section(outcome: Outcome) -> Markup:
    """Return the table of effects, nothing where a fidelity has none."""
    rows = [_row(choice) for choice in or_none(outcome.provenance.effect_choices) or ()]
    caption = (
        "An effect is needed when its number is above its threshold. The changes are about what leaving it "
        "out does. The run time is the share of its own parts; that of friction and rates is estimated."
    )
    folded = details("What the model has, and why", table(Table.of(HEAD, rows, left=range(3)), caption))
    return section("Effects", folded if rows else Markup(""))


def _row(choice: EffectChoice) -> list[Cell]:
    return [
        choice.name,
        f"{'on' if choice.on else 'off'}{', by the scene' if choice.forced else ''}",
        choice.measure,
        choice.number,
        choice.threshold,
        *_changes(choice),
        None if choice.share is None else percent(choice.share),
    ]


def _changes(choice: EffectChoice) -> list[Cell]:
    """Return the changes of e and E_vib/E_0 without the effect; none for a barrier that is not in use."""
    if choice.name in BARRIERS and not choice.on:
        return [None, None]
    return [f"± {c:.1g}".replace("-", "−") for c in (choice.change_of_e, choice.change_of_vibration)]
