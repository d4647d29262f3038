"""What `run` prints of a body that is followed beyond its first impact."""

from __future__ import annotations

import sys

from fem_impact.cli.options import Options
from fem_impact.cli.terminal import print_table
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.strike_text import spread_table, strikes_table, told
from fem_impact.tables.text import wrapped

SHOWN = 12
"""Strikes that are listed; all of them stand in strikes.csv."""


def print_strikes(outcome: Outcome, options: Options) -> None:
    """Print the verdict on the sequence, its totals, and the first strikes."""
    sys.stdout.writelines(f"{line}\n" for sentence in told(outcome.strikes) for line in wrapped(sentence))
    if each := or_none(outcome.strikes.each):
        print_table(strikes_table(each[:SHOWN]), options, indent="  ")
    if spread := or_none(outcome.strikes.spread):
        print_table(spread_table(spread), options, indent="  ")
