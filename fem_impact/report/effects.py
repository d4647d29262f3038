"""The section on the effects of a run: what was decided, by which number, and what it cost."""

from __future__ import annotations

from fem_impact.figures.style import percent
from fem_impact.outcome import EffectChoice, Outcome, or_none
from fem_impact.report.html import Markup, number, section, table
from fem_impact.scene import BARRIERS

__all__ = ["effects_section"]

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
    return section("Effects", table(HEAD, rows, caption, numbers=range(3, 8)))


def _row(choice: EffectChoice) -> list[str]:
    return [
        choice.name,
        f"{'on' if choice.on else 'off'}{', by the scene' if choice.forced else ''}",
        choice.measure,
        number(choice.number),
        number(choice.threshold),
        *_changes(choice),
        "–" if choice.share is None else percent(choice.share),
    ]


def _changes(choice: EffectChoice) -> list[str]:
    """Return what leaving it out changes; nothing for a barrier beside the one in use."""
    if choice.name in BARRIERS and not choice.on:
        return ["–", "–"]
    return [f"± {c:.1g}".replace("-", "−") for c in (choice.change_of_e, choice.change_of_vibration)]
