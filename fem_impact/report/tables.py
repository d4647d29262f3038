"""Tables and cards made of the keys of outcomes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from fem_impact.outcome import KEY_TABLE, KEYS, Outcome
from fem_impact.report.html import Markup, details, number, section, table, with_band

__all__ = ["all_keys", "card", "contacts_table", "key_table", "sentences", "unknown"]

Row = Mapping[str, Any]


def key_table(outcome: Row, names: Iterable[str], caption: str = "") -> Markup:
    """Return meaning, value with band, and unit of some keys; null ones are left to ``unknown``."""
    known = [name for name in names if outcome[name] is not None]
    rows = [(_meaning(name), _value(outcome, name), _unit(name)) for name in known]
    return table(("quantity", "value", "unit"), rows, caption, numbers=(1,))


def card(name: str, value: str, note: str = "") -> Markup:
    """Return one figure worth seeing first."""
    small = f'<div class="note">{escape(note)}</div>' if note else ""
    inner = f'<div class="name">{escape(name)}</div><div class="value">{escape(value)}</div>{small}'
    return Markup(f'<div class="card">{inner}</div>')


def contacts_table(outcome: Row) -> Markup:
    """Return the contact intervals with their impulses on the whole rod."""
    head = ("contact", "start, µs", "end, µs", "normal impulse, N s", "tangential, N s", "ratio")
    rows = [_contact(at, contact) for at, contact in enumerate(outcome["contacts"] or [], start=1)]
    return table(head, rows, "Contact intervals, impulses on the whole rod.", numbers=range(1, 6))


def unknown(rows: Sequence[Outcome]) -> Markup:
    """Return what is not known and why, equal reasons together."""
    reasons: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        for name, reason in row["reasons"].items():
            reasons.setdefault(reason, {}).setdefault(name, []).append(row["scene_id"])
    lines = [(_names(names), reason, _where(names, len(rows))) for reason, names in reasons.items()]
    shown = lines if len(rows) > 1 else [line[:2] for line in lines]
    head = ("key", "why it is not known", "runs")[: len(shown[0]) if shown else 2]
    return section("What is not known", table(head, shown))


def sentences(rows: Sequence[Outcome], key: str) -> list[str]:
    """Return the sentences under ``validity`` or ``warnings``, each once, with the runs that say it."""
    said: dict[str, list[str]] = {}
    for row in rows:
        for sentence in row[key]:
            said.setdefault(sentence, []).append(row["scene_id"])
    if len(rows) == 1:
        return list(said)
    return [f"{sentence} ({_runs(runs, len(rows))})" for sentence, runs in said.items()]


def all_keys(outcome: Row) -> Markup:
    """Return every plain key of the record, to be unfolded."""
    plain = [key for key in KEYS if key.kind in ("number", "count", "flag", "text")]
    rows = [
        (Markup(f"<code>{key.name}</code>"), _value(outcome, key.name), key.unit, key.meaning)
        for key in plain
    ]
    return details("Every key of the record", table(("key", "value", "unit", "meaning"), rows))


def _meaning(name: str) -> Markup:
    meaning = KEY_TABLE[name].meaning.replace(", as a fraction of E_0.", ".")
    return Markup(f"{escape(meaning)} <code>{name}</code>")


def _unit(name: str) -> str:
    if name.endswith("_over_E_0"):
        return "of\u00a0E₀"
    unit = KEY_TABLE[name].unit
    return "" if unit == "-" else unit.replace("m2", "m²")


def _value(outcome: Row, name: str) -> str:
    value = outcome[name]
    return value if isinstance(value, str) else with_band(value, (outcome["bands"] or {}).get(name))


def _contact(at: int, contact: Mapping[str, float]) -> tuple[str, ...]:
    normal, tangential = contact["impulse_n_Ns"], contact["impulse_t_Ns"]
    ratio = number(tangential / normal) if normal else "–"
    times = (f"{contact['start_s'] * 1e6:.1f}", f"{contact['end_s'] * 1e6:.1f}")
    return (str(at), *times, number(normal), number(tangential), ratio)


def _names(names: Iterable[str]) -> Markup:
    return Markup(", ".join(f"<code>{escape(name)}</code>" for name in names))


def _where(names: Mapping[str, Sequence[str]], count: int) -> str:
    runs = list(dict.fromkeys(run for where in names.values() for run in where))
    return _runs(runs, count)


def _runs(runs: Sequence[str], count: int) -> str:
    return "all runs" if len(runs) == count else ", ".join(runs)
