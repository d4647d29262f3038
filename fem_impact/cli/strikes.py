"""What `run` prints of a body that is followed beyond its first impact."""

from __future__ import annotations

from math import degrees

from fem_impact.cli.options import Options
from fem_impact.cli.terminal import print_table
from fem_impact.outcome.keys import Num, Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.strikes import StrikeRecord, Strikes
from fem_impact.scene.impact import FIRST
from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped

SHOWN = 12
"""Strikes that are listed; the others stand in strikes.csv."""
HEAD = ("", "time, ms", "part", "angle, deg", "approach, m/s", "e", "mu", "lost, J", "friction, J")


def strike_lines(outcome: Outcome) -> list[str]:
    """Return the verdict on the sequence and its totals; none of a scene that asks for the first impact."""
    strikes = outcome.strikes
    if strikes.until == FIRST:
        return []
    if isinstance(strikes.each, Unknown):
        return wrapped(f"later strikes not known: {strikes.each.reason}")
    return [
        *wrapped(f"{len(strikes.each)} strikes. {strikes.because} {_other_end(strikes)}"),
        *wrapped(_hardest(strikes)),
        *wrapped(_totals(strikes)),
    ]


def print_strikes(outcome: Outcome, options: Options) -> None:
    """Print the strikes as a table."""
    each = outcome.strikes.each
    if isinstance(each, Unknown):
        return
    rows = [_row(number, one) for number, one in enumerate(each[:SHOWN], 1)]
    print_table(Table.of(HEAD, rows, left=(2,)), options, indent="  ")


def _row(number: int, one: StrikeRecord) -> tuple[str, ...]:
    values = 1e3 * one.time, degrees(one.alpha), one.approach, one.e, one.mu, one.lost, one.friction
    time, *rest = (f"{value:.4g}" for value in values)
    return (str(number), time, one.part, *rest)


def _other_end(strikes: Strikes) -> str:
    """Return how much faster the other end strikes than the first did."""
    ratio = strikes.other_end
    if isinstance(ratio, Unknown):
        return f"Whether the other end strikes harder is not known: {ratio.reason}."
    return f"The other end strikes {ratio:.3g} times as fast as the first strike came."


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
