"""What `run` prints of a body that is followed beyond its first impact."""

import sys

from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import print_table
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.strike_text import SHOWN, spread_table, strikes_table, told
from fem_impact.tables.text import wrapped


def print_strikes(outcome: Outcome, options: Options) -> None:
    """Print what is told of a sequence, the strikes that are certain, and how later ones spread."""
    sys.stdout.writelines(f"{line}\n" for sentence in told(outcome.strikes) for line in wrapped(sentence))
    strikes = outcome.strikes
    if isinstance(strikes.each, Unknown):
        return
    print_table(strikes_table(strikes, or_none(strikes.certain) or SHOWN), options, indent="  ")
    if later := (or_none(strikes.spread) or ())[or_none(strikes.certain) or 0 :]:
        print_table(spread_table(later), options, indent="  ")
