"""How many of the strikes are certain: those whose order does not depend on what is not known of friction."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from fem_impact.case.case import Case
from fem_impact.outcome.keys import Num, Unknown, or_none

if TYPE_CHECKING:
    from fem_impact.outcome.record import Outcome
    from fem_impact.outcome.strikes import Strikes


def with_certainty(case: Case, outcome: Outcome, again: Callable[[Case], Outcome]) -> Outcome:
    """Return an outcome whose strikes are compared with those at the ends of the interval of friction.

    ``again`` computes the outcome of another case. Where there is no interval, or no friction, all is left.
    """
    surface = case.scene.surface
    ends = {surface.friction_low, surface.friction_high} - {surface.friction}
    if not ends or "friction" not in case.active or isinstance(outcome.strikes.each, Unknown):
        return outcome
    scenes = [replace(case.scene, surface=replace(surface, friction=f)) for f in sorted(ends)]
    all_ = [outcome.strikes, *(again(Case.of(scene, case.fidelity)).strikes for scene in scenes)]
    ratios = [one.other_end for one in all_]
    strikes = replace(
        outcome.strikes,
        certain=_common(all_),
        other_end_low=_extreme(ratios, min),
        other_end_high=_extreme(ratios, max),
    )
    return replace(outcome, strikes=strikes)


def _common(runs: Sequence[Strikes]) -> int:
    """Return how many first strikes are of the same part of the body in all runs."""
    parts = [[one.part for one in or_none(run.each) or ()] for run in runs]
    same = 0
    for struck in zip(*parts, strict=False):
        if len(set(struck)) > 1:
            break
        same += 1
    return same


def _extreme(ratios: Sequence[Num], chosen: Callable[[Sequence[float]], float]) -> Num:
    """Return the least or the largest ratio, or why one of them is not known."""
    missing = next((one for one in ratios if isinstance(one, Unknown)), None)
    if missing is not None:
        return missing
    return chosen([one for one in ratios if not isinstance(one, Unknown)])
