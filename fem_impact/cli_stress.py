"""``fem-impact stress``: hard cases, run and judged."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from fem_impact.cli_out import checked_out
from fem_impact.cli_parser import Options
from fem_impact.cli_print import print_json
from fem_impact.cores import cores
from fem_impact.errors import RunError, UsageError, did_you_mean
from fem_impact.outcome import utc_now
from fem_impact.output import read_text, write_text
from fem_impact.stress import CASES, Row, run_cases
from fem_impact.stress.page import MARKS, page, told
from fem_impact.verify.page import put_page

__all__ = ["stress"]


def stress(options: Options) -> int:
    """Run one case, or all of them; the exit code says whether each is as it must be."""
    names = _chosen(options)
    if options.readme:
        put_page(read_text(options.readme), "", MARKS)  # before any work
    out = checked_out(options.out or Path("results") / "stress")
    rows = run_cases(names, out, _progress(options, len(names)), options.workers or cores())
    text = page(rows, utc_now()[:10])
    if options.readme:
        write_text(options.readme, put_page(read_text(options.readme), text, MARKS))
    if options.json:
        print_json([asdict(row) for row in rows])
    else:
        sys.stdout.write(f"{text}\n\nresults: {out}\n")
    return 0 if all(row.passed for row in rows) else RunError.exit_code


def _progress(options: Options, total: int) -> Callable[[Row], None]:
    """Return what tells of each case when it is done."""
    count = itertools.count(1)

    def show(row: Row) -> None:
        if not options.quiet:
            sys.stderr.write(f"{next(count)} of {total}: {told(row)}\n")

    return show


def _chosen(options: Options) -> list[str]:
    if not options.only:
        return list(CASES)
    if options.readme:
        raise UsageError("takes all cases.", key="--readme", remedy="Leave --only out.")
    if options.only not in CASES:
        hint = did_you_mean(options.only, CASES, f"Known are: {', '.join(CASES)}.")
        raise UsageError("is no hard case.", key="--only", value=options.only, remedy=hint)
    return [options.only]
