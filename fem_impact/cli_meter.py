"""The meter that the command line asks for."""

from __future__ import annotations

import shutil
import sys

from fem_impact.cli_parser import Options
from fem_impact.progress import Meter, NullMeter, meter_for

__all__ = ["chosen_meter"]


def chosen_meter(options: Options) -> Meter:
    """Return a meter on standard error, or a silent one."""
    if options.quiet:
        return NullMeter()
    return meter_for(sys.stderr, width=max(40, shutil.get_terminal_size((100, 24)).columns - 1))
