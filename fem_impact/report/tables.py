"""Tables and cards made of the keys of outcomes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape

from fem_impact.outcome import KEYS, ContactInterval, Key, Outcome, Unknown, or_none
from fem_impact.report.html import Markup, details, number, section, table, with_band

__all__ = ["all_keys", "card", "contacts_table", "estimated", "key_table", "sentences", "unknown"]


def key_table(outcome: Outcome, keys: Iterable[Key], caption: str = "") -> Markup:
    """Return meaning, value and unit of some keys, limit and band where two meshes gave them.

    Those that are not known are left to ``unknown``.
    """
    shown = [key for key in keys if not isinstance(key.of(outcome), Unknown)]
    rows = [(_meaning(key), estimated(outcome, key), _unit(key)) for key in shown]
    return table(("quantity", "value", "unit"), rows, caption, numbers=(1,))


def card(name: str, value: str, note: str = "") -> Markup:
    """Return one figure worth seeing first."""
    small = f'<div class="note">{escape(note)}</div>' if note else ""
    inner = f'<div class="name">{escape(name)}</div><div class="value">{escape(value)}</div>{small}'
    return Markup(f'<div class="card">{inner}</div>')


def estimated(outcome: Outcome, key: Key) -> str:
    """Return a number for the eye, of two meshes their limit with its band."""
    value, band = outcome.estimate(key)
    return with_band(or_none(value), band)


def contacts_table(outcome: Outcome) -> Markup:
    """Return the contact intervals with their impulses on the whole rod."""
    head = ("contact", "start, µs", "end, µs", "normal impulse, N s", "tangential, N s", "ratio")
    intervals = or_none(outcome.contact.intervals) or ()
    rows = [_contact(at, contact) for at, contact in enumerate(intervals, start=1)]
    return table(head, rows, "Contact intervals, impulses on the whole rod.", numbers=range(1, 6))


def unknown(rows: Sequence[Outcome]) -> Markup:
    """Return what is not known and why, equal reasons together."""
    reasons: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        for name, reason in row.reasons.items():
            reasons.setdefault(reason, {}).setdefault(name, []).append(row.provenance.scene_id)
    lines = [(_names(names), reason, _where(names, len(rows))) for reason, names in reasons.items()]
    shown = lines if len(rows) > 1 else [line[:2] for line in lines]
    head = ("key", "why it is not known", "runs")[: len(shown[0]) if shown else 2]
    return section("What is not known", table(head, shown))


def sentences(rows: Sequence[Outcome], of: Callable[[Outcome], Iterable[str]]) -> list[str]:
    """Return the sentences that outcomes hold, such as warnings, each once, with the runs that say it."""
    said: dict[str, list[str]] = {}
    for row in rows:
        for sentence in of(row):
            said.setdefault(sentence, []).append(row.provenance.scene_id)
    if len(rows) == 1:
        return list(said)
    return [f"{sentence} ({_runs(runs, len(rows))})" for sentence, runs in said.items()]


def all_keys(outcome: Outcome) -> Markup:
    """Return every plain key of the record, to be unfolded."""
    plain = [key for key in KEYS if key.kind in ("number", "count", "flag", "text")]
    rows = [
        (Markup(f"<code>{key.name}</code>"), _value(outcome, key), key.unit, key.meaning) for key in plain
    ]
    return details("Every key of the record", table(("key", "value", "unit", "meaning"), rows))


def _value(outcome: Outcome, key: Key) -> str:
    value = or_none(key.of(outcome))
    return value if isinstance(value, str) else number(value)


def _meaning(key: Key) -> Markup:
    meaning = key.meaning.replace(", as a fraction of E_0.", ".")
    return Markup(f"{escape(meaning)} <code>{key.name}</code>")


def _unit(key: Key) -> str:
    if key.name.endswith("_over_E_0"):
        return "of\u00a0E₀"
    return "" if key.unit == "-" else key.unit.replace("m2", "m²")


def _contact(at: int, contact: ContactInterval) -> tuple[str, ...]:
    normal, tangential = contact.impulse_n, contact.impulse_t
    ratio = number(tangential / normal) if normal else "–"
    times = (f"{contact.start * 1e6:.1f}", f"{contact.end * 1e6:.1f}")
    return (str(at), *times, number(normal), number(tangential), ratio)


def _names(names: Iterable[str]) -> Markup:
    return Markup(", ".join(f"<code>{escape(name)}</code>" for name in names))


def _where(names: Mapping[str, Sequence[str]], count: int) -> str:
    runs = list(dict.fromkeys(run for where in names.values() for run in where))
    return _runs(runs, count)


def _runs(runs: Sequence[str], count: int) -> str:
    return "all runs" if len(runs) == count else ", ".join(runs)
