"""What the interval of friction changes of a run's numbers, by the same or a quicker model."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fem_impact.errors import FemImpactError
from fem_impact.outcome.keys import Key, or_none
from fem_impact.outcome.record import KEYS, ROUND_OFF, Outcome
from fem_impact.run.simulate import simulate
from fem_impact.scene.impact import FIRST
from fem_impact.scene.types import Scene
from fem_impact.tables.text import plain

LEAST = 1e-4
"""Least change that is told, over the number."""


@dataclass(frozen=True, slots=True)
class FrictionSpread:
    """What the ends of the interval of friction change.

    Attributes
    ----------
    said : the interval and the model that computed its ends, as the end of a sentence; empty where there is
        no interval, or it changes nothing
    changes : least and largest change of each number from that at the stated friction, in its unit
    """

    said: str
    changes: Mapping[Key, tuple[float, float]]

    def told(self, key: Key, scale: float = 1.0) -> str:
        """Return the changes of a number times ``scale`` as text, empty where there are none."""
        return " to ".join(_signed(scale * end) for end in self.changes.get(key, ()))


def friction_spread(scene: Scene, fidelity: str, outcome: Outcome | None = None) -> FrictionSpread:
    """Return what the stated interval of friction changes of the first impact.

    Finite elements take the reduced model for it, a body that has none the rigid theory. An ``outcome`` that
    this program has just computed stands for the run at the stated friction, where it is of the same model;
    changes are those of numbers that it knows, and take none of them beyond its ends, as of shares 0 and 1.
    """
    low, stated, high = scene.surface.friction_low, scene.surface.friction, scene.surface.friction_high
    if low >= high:
        return FrictionSpread("", {})
    for model in ("rigid",) if fidelity == "rigid" else ("modal", "rigid"):
        nominal = outcome if outcome and fidelity == model and scene.impact.until == FIRST else None
        try:
            nominal = nominal or _at(scene, stated, model)
            ends = [_at(scene, f, model) for f in (low, high)]
        except FemImpactError:
            continue
        if not all(one.validity.finished for one in (nominal, *ends)):
            continue
        by = "rigid theory" if model == "rigid" else "the reduced model"
        changes = _changes(nominal, ends)
        held = _held(outcome, changes) if outcome else changes
        said = f"what f = {low:g} to {high:g} instead of {stated:g} changes, by {by}."
        return FrictionSpread(said if held else "", held)
    return FrictionSpread("", {})


def _signed(change: float) -> str:
    return f"{'' if change < 0 else '+'}{plain(change, 2)}"


def _at(scene: Scene, friction: float, model: str) -> Outcome:
    """Return the first impact at one friction."""
    changed = replace(
        scene.untargeted,
        surface=replace(scene.surface, friction=friction),
        impact=replace(scene.impact, until=FIRST),
    )
    return simulate(changed, model)


def _changes(nominal: Outcome, ends: list[Outcome]) -> dict[Key, tuple[float, float]]:
    """Return least and largest change of each number that all three know."""
    changes = {}
    for key in (key for key in KEYS if key.banded):
        values = (or_none(key.of(outcome)) for outcome in (nominal, *ends))
        numbers = [value for value in values if value is not None]
        if len(numbers) == 1 + len(ends):
            low, high = min(numbers) - numbers[0], max(numbers) - numbers[0]
            if high - low > max(LEAST * abs(numbers[0]), ROUND_OFF):
                changes[key] = low, high
    return changes


def _held(outcome: Outcome, changes: Mapping[Key, tuple[float, float]]) -> dict[Key, tuple[float, float]]:
    """Return the changes of numbers that the outcome knows, up to the ends of each."""
    held = {}
    for key, (low, high) in changes.items():
        value, (least, most) = or_none(outcome.estimate(key)[0]), outcome.ends_of(key)
        if value is not None:
            held[key] = max(low, min(0.0, least - value)), min(high, max(0.0, most - value))
    return {key: ends for key, ends in held.items() if ends[1] > ends[0]}
