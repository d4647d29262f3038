"""Coefficients of a user's own data as text for the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from fem_impact.wrap import wrapped

__all__ = ["own_text"]

Document = Mapping[str, Any]


def own_text(document: Document) -> str:
    """Lay the document of `own_coefficients` out for reading."""
    parts = (_head, _coefficients, _scatter, _rest)
    return "\n".join(line for part in parts for line in part(document)) + "\n"


def _head(d: Document) -> Iterator[str]:
    rod, arms = d["rod"], d["arms"]
    size = f"{1e3 * rod['length_m']:g} mm x {1e3 * rod['diameter_m']:g} mm, tip {rod['tip']}"
    yield (
        f"{d['tests']} tests of a rod {size}: {rod['mass_kg']:.4f} kg, k2 = "
        f"{1e6 * rod['k_squared_m2']:.1f} mm2"
    )
    yield from wrapped(
        f"contact point: d_c = {1e3 * arms['d_c_m']:.2f} mm, d_d = {1e3 * arms['d_d_m']:.2f} mm "
        f"({arms['source']})"
    )


def _coefficients(d: Document) -> Iterator[str]:
    yield ""
    yield from wrapped(
        "Coefficients of the mean motion, 95 % intervals (velocity scatter, contact point 0.5 mm, "
        "tracking 2 %)"
    )
    yield f"  {'':<5}{'value':>8}   {'first order':<20}bootstrap"
    for name, c in d["coefficients"].items():
        yield f"  {name:<5}{_number(c['value']):>8}   {_span(c['first_order']):<20}{_span(c['bootstrap'])}"
    yield ""
    yield "Standard uncertainty by source"
    for name, c in d["coefficients"].items():
        parts = ", ".join(f"{k} {_number(v)}" for k, v in c["first_order"]["parts"].items())
        yield f"  {name:<5}{parts}"


def _scatter(d: Document) -> Iterator[str]:
    yield ""
    yield "Scatter of single tests, mean (SD)"
    words = [
        f"{name.replace('_over_E_0', '/E_0')} {s['mean']:.3f} ({s['sd']:.3f})"
        for name, s in d["scatter"].items()
    ]
    yield from wrapped(", ".join(words), "  ", "")


def _rest(d: Document) -> Iterator[str]:
    centre = d["impulse_centre"]
    yield ""
    yield from wrapped(
        f"Centre of impulse (e_m = -1): d_c = {1e3 * centre['d_c_m']:.2f} mm, "
        f"{1e3 * centre['from_contact_m']:+.2f} mm from the contact point"
    )
    yield f"Critical impulse ratio: {_number(d['mu_c'])}"
    for note in d["notes"]:
        yield from wrapped(f"note: {note}")


def _span(estimate: Mapping[str, Any]) -> str:
    return f"{_number(estimate['low'])} to {_number(estimate['high'])}"


def _number(value: float | None) -> str:
    return "not finite" if value is None else f"{value:.3f}"
