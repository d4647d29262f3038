"""The audit as text for the terminal: summary first, then constants, disagreements and scatter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from fem_impact.wrap import wrapped

__all__ = ["audit_text"]

Document = Mapping[str, Any]


def audit_text(document: Document) -> str:
    """Lay the document of `audit_document` out for reading."""
    parts = (
        _summary(document),
        _columns(document),
        _constants(document),
        _apart(document),
        _scatter(document),
    )
    return "\n".join(line for part in parts for line in part) + "\n"


def _summary(document: Document) -> Iterator[str]:
    s = document["summary"]
    yield from wrapped(
        f"{s['agree']} of {s['numbers']} printed numbers follow from the printed velocities within rounding."
    )
    yield from wrapped(
        f"{s['marker_velocities_apart']} tip velocities do not (they are a marker's, not the contact "
        "point's), "
        f"{s['others_apart']} other numbers do not; {s['unexplained']} of all these are unexplained."
    )


def _columns(document: Document) -> Iterator[str]:
    for which in ("rows", "mean and SD lines"):
        found = [c for c in document["columns"] if c["lines"] == which]
        if found:
            words = ", ".join(f"{c['column']} {c['agree']}/{c['numbers']}" for c in found)
            yield from wrapped(f"{which}: {words}", "  ")


def _constants(document: Document) -> Iterator[str]:
    yield ""
    yield "What the columns were worked out with (mm, kg, mm2)"
    yield f"  {'set':<16}{'table':>6}{'d_c':>8}{'d_d':>8}{'mass':>9}{'k2':>9}  columns with another d_c"
    for c in document["constants"]:
        other = ", ".join(f"{name} {1e3 * d:.1f}" for name, d in c["other_d_c_m"].items())
        other = other or ("velocities worked back from the coefficients" if c["reconstructed"] else "")
        numbers = (
            f"{1e3 * c['d_c_m']:8.1f}{1e3 * c['d_d_m']:8.1f}{c['mass_kg']:9.4f}{1e6 * c['k_squared_m2']:9.1f}"
        )
        yield f"  {c['set']:<16}{c['table']:>6}{numbers}  {other}".rstrip()


def _apart(document: Document) -> Iterator[str]:
    yield ""
    yield "Disagreements, by reason (printed | recomputed; rounding allows)"
    found = document["disagreements"]
    for why in dict.fromkeys(d["explanation"] for d in found):
        yield from wrapped(f"- {why or 'no explanation is known'}")
        yield from (_place(d) for d in found if d["explanation"] == why)
    if not found:
        yield "  none"


def _place(d: Mapping[str, Any]) -> str:
    where = f"{d['set']:<16}{d['column']:<7}{_row(d['row']):<20}"
    return f"    {where}{d['printed']:>9.4g} | {d['recomputed']:<9.4g} ({d['tolerance']:.2g})"


def _row(row: str) -> str:
    return f"test {row}" if row.isdecimal() else row


def _scatter(document: Document) -> Iterator[str]:
    yield ""
    yield from wrapped(
        "Scatter, mean (SD); e_m of the mean motion with its 95 % interval for a contact point known "
        "to 0.5 mm"
    )
    yield f"  {'set':<16}{'tests':>5}  {'e':<15}{'mu':<15}{'loss/E_0':<15}e_m of the mean motion"
    for s in document["scatter"]:
        kept = s["E_r_over_E_0"]
        loss = f"{1 - kept['mean']:.3f} ({kept['sd']:.3f})"
        numbers = f"{_spread(s['e']):<15}{_spread(s['mu']):<15}{loss:<15}{_interval(s['e_m_of_mean'])}"
        yield f"  {s['set']:<16}{s['e']['tests']:>5}  {numbers}"
    yield from _correlated(document)


def _correlated(document: Document) -> Iterator[str]:
    """Name the pairs of coefficients whose correlation leaves out zero."""
    pairs = [(s["set"], c) for s in document["scatter"] for c in s["correlations"]]
    real = [f"{name}: {c['pair']} r = {c['r']:+.2f}" for name, c in pairs if c["low"] > 0 or c["high"] < 0]
    yield ""
    words = (
        f"Correlations of e, mu, e_m beyond their 95 % interval: {'; '.join(real) or 'none'}. Chance "
        "alone would "
        f"give about {0.05 * len(pairs):.0f} of {len(pairs)}, and numbers worked out from the same "
        "velocities share errors."
    )
    yield from wrapped(words, hang="")


def _spread(s: Mapping[str, Any]) -> str:
    return f"{s['mean']:.3f} ({s['sd']:.3f})"


def _interval(e: Mapping[str, Any]) -> str:
    mark = "" if e["low"] <= -1 <= e["high"] else "  leaves out -1"
    return f"{e['value']:+.2f} ({e['low']:+.2f} to {e['high']:+.2f}){mark}"
