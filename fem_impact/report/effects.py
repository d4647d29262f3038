"""The section on the effects of a run: what was decided, by which number, and what it cost."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fem_impact.figures.style import percent
from fem_impact.report.html import Markup, number, section, table

__all__ = ["effects_section"]

HEAD = (
    *("effect", "in the model", "decided by", "number", "threshold"),
    *("e without it", "E_vib/E₀ without it", "run time"),
)


def effects_section(outcome: Mapping[str, Any]) -> Markup:
    """Return the table of effects, nothing where a fidelity has none."""
    rows = [_row(choice) for choice in outcome["effect_choices"] or []]
    caption = (
        "An effect is needed when its number is above its threshold; the changes are rough sizes of what "
        "leaving it out does; the run time is that of its own parts, of friction and rates about."
    )
    return section("Effects", table(HEAD, rows, caption, numbers=range(3, 8)))


def _row(choice: Mapping[str, Any]) -> list[str]:
    return [
        choice["name"],
        f"{'on' if choice['on'] else 'off'}{', by the scene' if choice['forced'] else ''}",
        choice["measure"],
        number(choice["number"]),
        number(choice["threshold"]),
        *(f"± {choice[key]:.1g}".replace("-", "−") for key in ("change_of_e", "change_of_E_vib_over_E_0")),
        "–" if choice["share"] is None else percent(choice["share"]),
    ]
