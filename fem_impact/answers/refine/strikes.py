"""What levels of meshes leave open of the strikes by finite elements after the first impact."""

from collections.abc import Sequence
from itertools import takewhile
from math import log

from fem_impact.answers.refine.extrapolate import level_limit
from fem_impact.answers.refine.level import LevelRun
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.strikes import StrikeRecord
from fem_impact.run.certain import Doubt


def open_by_levels(levels: Sequence[LevelRun]) -> list[Doubt | None]:
    """Return the half-widths of each strike of the last level, by the rule of the first impact's numbers.

    They hold the limit of `level_limit` with its half-width, about the last level's own. None where a strike
    is not by finite elements of the same part of the body on two levels at least.
    """
    each = [or_none(level.outcome.strikes.each) or () for level in levels]
    if not levels[-1].runs.resolved:
        return []
    return [_open_of(number, each, levels) for number in range(len(each[-1]))]


def _open_of(number: int, each: Sequence[Sequence[StrikeRecord]], levels: Sequence[LevelRun]) -> Doubt | None:
    """Return the half-widths of one strike by the last levels that have it alike, None of fewer than two."""
    part, struck = each[-1][number].part, list[StrikeRecord]()
    for one in takewhile(lambda strikes: number < len(strikes), reversed(each)):
        if (one[number].fidelity, one[number].part) != ("solid", part):
            break
        struck.insert(0, one[number])
    if len(struck) < 2:
        return None
    runs = [level.runs for level in levels[-len(struck) :]]
    sizes, wide = zip(*((one.size, one.wide) for one in runs), strict=True)

    def half(values: Sequence[float]) -> float:
        limit, band = level_limit(sizes, [[value] for value in values], wide)
        return band + abs(limit - values[-1])

    return Doubt(
        half([one.e for one in struck]),
        half([one.mu for one in struck]),
        half([one.friction for one in struck]),
        half([one.vibration for one in struck]),
        half([log(one.force) if one.force else 0.0 for one in struck]),
    )
