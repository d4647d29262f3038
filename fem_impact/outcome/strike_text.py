"""What is told of strikes in words and as a table."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from fem_impact.outcome.keys import Num, Unknown
from fem_impact.outcome.strikes import StrikeRecord, Strikes, StrikeSpread
from fem_impact.tables.table import Table

HEAD = ("", "time, ms", "part", "angle, deg", "approach, m/s", "e", "mu", "lost, J", "friction, J", "model")
SPREAD = ("strike", "tip", "tail", "other", "none", "time, ms", "approach, m/s")


def told(strikes: Strikes) -> list[str]:
    """Return sentences: the end, how hard the other end strikes, the hardest strikes, the totals."""
    if isinstance(strikes.each, Unknown):
        return [f"Later strikes are not known: {strikes.each.reason}."]
    count = len(strikes.each)
    return [
        f"{count} strike{'s' * (count > 1)}. {strikes.because} {_other_end(strikes)}",
        *_certain(strikes),
        _hardest(strikes),
        _totals(strikes),
    ]


def levels_told(levels: Sequence[Strikes]) -> str:
    """Say how far the strikes of the last two levels of meshes differ, nothing where there are no two."""
    known = [one.each for one in levels[-2:] if not isinstance(one.each, Unknown)]
    if len(known) < 2:
        return ""
    coarse, fine = known
    changes = [
        f"strike {number} {a.approach:.3g} to {b.approach:.3g} m/s with e {a.e:.3g} to {b.e:.3g}"
        for number, (a, b) in enumerate(zip(coarse, fine, strict=False), 1)
        if a.fidelity == b.fidelity == "solid" and a.part == b.part
    ]
    return f"From the last level of meshes but one to the last: {', '.join(changes)}." if changes else ""


def strikes_table(each: Sequence[StrikeRecord]) -> Table:
    """Return a row a strike."""
    rows = [_row(number, one) for number, one in enumerate(each, 1)]
    return Table.of(HEAD, rows, left=(2, 9))


def spread_table(spread: Sequence[StrikeSpread]) -> Table:
    """Return a row a strike: what strikes in how many sequences, when and how fast in most."""
    rows = [
        (
            *(str(count) for count in (one.number, one.tip, one.tail, one.other, one.none)),
            f"{1e3 * one.time_low:.3g} to {1e3 * one.time_high:.3g}",
            f"{one.approach_low:.3g} to {one.approach_high:.3g}",
        )
        for one in spread
    ]
    return Table.of(SPREAD, rows)


def _row(number: int, one: StrikeRecord) -> tuple[str, ...]:
    values = 1e3 * one.time, degrees(one.alpha), one.approach, one.e, one.mu, one.lost, one.friction
    time, *rest = (f"{value:.4g}" for value in values)
    return (str(number), time, one.part, *rest, one.fidelity)


def _other_end(strikes: Strikes) -> str:
    """Return how much faster the other end strikes than the first did."""
    ratio = strikes.other_end
    if isinstance(ratio, Unknown):
        return f"{ratio.reason[0].upper()}{ratio.reason[1:]}."
    return f"The other end strikes {ratio:.3g} times as fast as the first strike came."


def _certain(strikes: Strikes) -> list[str]:
    """Return how many strikes hold over the stated intervals, nothing where none is stated."""
    certain, ends = strikes.certain, (strikes.other_end_low, strikes.other_end_high)
    if isinstance(certain, Unknown):
        return []
    known = [f"{end:.3g}" for end in ends if not isinstance(end, Unknown)]
    between = (
        f" What is not known of them lets the other end strike {' to '.join(known)} times as fast."
        if len(known) == 2
        else ""
    )
    return [
        f"In rigid sequences over the stated intervals of friction, angle and speed the order of the first "
        f"{certain} is the same; later strikes are one path of many.{between}"
    ]


def _hardest(strikes: Strikes) -> str:
    names = (
        ("by energy", strikes.hardest_energy),
        ("by force", strikes.hardest_force),
        ("by friction heat", strikes.hardest_heat),
    )
    known = ", ".join(f"{name} {number}" for name, number in names if not isinstance(number, Unknown))
    return f"Hardest strike: {known}."


def _totals(strikes: Strikes) -> str:
    parts: tuple[tuple[str, Num], ...] = (
        ("friction", strikes.friction),
        ("plastic", strikes.plastic),
        ("damping", strikes.damping),
        ("other", strikes.other),
        ("settled", strikes.settled),
        ("left", strikes.left),
    )
    known = ", ".join(f"{name} {v:.3g} J" for name, v in parts if not isinstance(v, Unknown) and v)
    time = "" if isinstance(strikes.time, Unknown) else f" after {strikes.time:.4g} s"
    gravity = "" if isinstance(strikes.gravity, Unknown) else f" Gravity gave {strikes.gravity:.3g} J."
    return f"The end comes{time}: {known}.{gravity}"
