"""What is certain of a sequence of strikes: rigid sequences over the stated intervals of what comes in."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.outcome.keys import Num, Unknown, known, or_none
from fem_impact.outcome.strikes import StrikeRecord, Strikes, StrikeSpread
from fem_impact.run.strikes import Followed, other_end

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene

RUNS = 64
"""Sequences over the intervals."""
SEEN = 6
"""Strikes of each that are looked at: later ones are as good as drawn by lot."""
INNER = 0.1, 0.9
"""Quantiles that are told."""
EXACT = Unknown(
    "the scene states no interval: surface.friction_low and friction_high, strikes.angle_error or speed_error"
)


def with_spread(case: Case, strikes: Strikes) -> Strikes:
    """Return strikes with what rigid sequences over the stated intervals tell of them."""
    own = or_none(strikes.each)
    if own is None or not _varies(case):
        return replace(strikes, certain=EXACT, spread=EXACT, other_end_low=EXACT, other_end_high=EXACT)
    try:
        runs = [_rigid(scene) for scene in _drawn(case)]
    except SceneError as error:
        none = Unknown(f"rigid theory does not follow the scene: {error.problem}")
        return replace(strikes, certain=none, spread=none, other_end_low=none, other_end_high=none)
    length = case.contact.body.length
    ends, plain = [other_end(run, length) for run in runs], other_end(_rigid(case.scene), length)
    return replace(
        strikes,
        certain=_common([own, *runs]),
        spread=tuple(_spread(number, runs) for number in range(1, 1 + max(len(run) for run in runs))),
        other_end_low=_moved(strikes.other_end, plain, _quantile(ends, INNER[0])),
        other_end_high=_moved(strikes.other_end, plain, _quantile(ends, INNER[1])),
    )


def _varies(case: Case) -> bool:
    """Return whether the scene states an interval of anything."""
    surface, errors = case.scene.surface, case.scene.strikes
    rubs = "friction" in case.active and surface.friction_low < surface.friction_high
    return bool(rubs or errors.angle_error or errors.speed_error)


def _drawn(case: Case) -> Iterator[Scene]:
    """Yield scenes whose friction, angle and speed fill the stated intervals evenly."""
    scene, surface, impact = case.scene, case.scene.surface, case.scene.impact
    low, high = surface.friction_low, surface.friction_high
    for run, share in enumerate(np.linspace(0.0, 1.0, RUNS).tolist(), 1):
        off = (2.0 * _halton(run, 2) - 1.0) * (scene.strikes.angle_error or 0.0)
        faster = 1.0 + (2.0 * _halton(run, 3) - 1.0) * (scene.strikes.speed_error or 0.0)
        moved = replace(
            impact,
            angle=min(max(impact.angle + off, -0.5 * pi), 0.5 * pi),
            **{key: faster * getattr(impact, key) for key in ("v_n", "v_t", "omega")},
            height=None,
            speed=None,
            slope=impact.vertical,
        )
        friction = low + share * (high - low)
        yield replace(scene, surface=replace(surface, friction=friction), impact=moved)


def _halton(number: int, base: int) -> float:
    """Return the number's place in the unit interval by its digits in a base, which fill it evenly."""
    place, share = 0.0, 1.0
    while number:
        share /= base
        number, digit = divmod(number, base)
        place += share * digit
    return place


def _rigid(scene: Scene) -> list[StrikeRecord]:
    """Return the first strikes of a rigid body."""
    body = Followed.of(Case.of(scene, "rigid"))
    body.upto = min(SEEN, scene.impact.most_strikes or SEEN)
    body.go_on(body.coming)
    return body.each


def _common(runs: Sequence[Sequence[StrikeRecord]]) -> int:
    """Return how many first strikes are of the same part of the body in all runs."""
    same = 0
    for struck in zip(*runs, strict=False):
        if len({one.part for one in struck}) > 1:
            break
        same += 1
    return same


def _spread(number: int, runs: Sequence[Sequence[StrikeRecord]]) -> StrikeSpread:
    """Return what strikes in which of the runs as the strike of a ``number``, from 1."""
    struck = [run[number - 1] for run in runs if len(run) >= number]
    parts = Counter(one.part for one in struck)
    time, approach = (
        np.quantile([getattr(one, key) for one in struck], INNER) for key in ("time", "approach")
    )
    return StrikeSpread(
        number=number,
        tip=parts["tip"],
        tail=parts["tail"],
        other=len(struck) - parts["tip"] - parts["tail"],
        none=len(runs) - len(struck),
        time_low=float(time[0]),
        time_high=float(time[1]),
        approach_low=float(approach[0]),
        approach_high=float(approach[1]),
    )


def _moved(own: Num, plain: Num, to: Num) -> Num:
    """Return a ratio moved as far as from that of the rigid body ``to`` another, or why one is not known."""
    missing = next((one for one in (own, plain, to) if isinstance(one, Unknown)), None)
    return missing if missing is not None else known(own) + known(to) - known(plain)


def _quantile(ratios: Sequence[Num], share: float) -> Num:
    """Return a quantile of the ratios, or why one of them is not known."""
    missing = next((one for one in ratios if isinstance(one, Unknown)), None)
    if missing is not None:
        return missing
    return float(np.quantile([known(one) for one in ratios], share))
