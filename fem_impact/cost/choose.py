"""Which setting meets a target, or is the best within a budget."""

from __future__ import annotations

from collections.abc import Sequence

from fem_impact.cost.judge import Judged, front, worst

__all__ = ["advice", "best_within", "cheapest"]


def cheapest(settings: Sequence[Judged], names: Sequence[str], target: float) -> Judged | None:
    """Return the quickest setting whose worst error is at most the target, None if there is none."""
    good = [one for one in front(settings, names) if worst(one, names) <= target]
    return min(good, key=lambda one: one.cpu_s, default=None)


def best_within(settings: Sequence[Judged], names: Sequence[str], budget: float) -> Judged | None:
    """Return the most accurate setting that takes at most ``budget`` s, None if there is none."""
    quick = [one for one in front(settings, names) if one.cpu_s <= budget]
    return min(quick, key=lambda one: worst(one, names), default=None)


def advice(
    settings: Sequence[Judged], names: Sequence[str], target: float | None, budget: float | None
) -> list[str]:
    """Return the answer in sentences."""
    of = " and ".join(names)
    lines = []
    if target is not None:
        found = cheapest(settings, names, target)
        best = front(settings, names)[-1]
        lines.append(
            f"Cheapest within {100 * target:.3g} % of {of}: {_words(found, names)}."
            if found
            else f"No setting brings {of} within {100 * target:.3g} %; best: {_words(best, names)}."
        )
    if budget is not None:
        within = best_within(settings, names, budget)
        lines.append(
            f"Best within {budget:.3g} s: {_words(within, names)}."
            if within
            else f"No setting takes only {budget:.3g} s."
        )
    return lines


def _words(setting: Judged, names: Sequence[str]) -> str:
    return f"{setting.name}, error {100 * worst(setting, names):.2g} % in {setting.cpu_s:.3g} s"
