"""The command ``stress``: scenes that are hard on the solver."""

from pathlib import Path

from fem_impact.answers.report import Request
from fem_impact.cli.parser import Options
from fem_impact.cli.paths import checked_out
from fem_impact.cli.study import carry_out
from fem_impact.errors import UsageError, did_you_mean
from fem_impact.evidence.hard_cases.study import CASES


def stress(options: Options) -> int:
    """Run one hard case, or all of them; the exit code says whether all ended as they must."""
    if options.only and options.page:
        raise UsageError("runs all cases.", key="--page", remedy="Leave --only out.")
    if options.only and options.only not in CASES:
        hint = did_you_mean(options.only, CASES, f"Known are: {', '.join(CASES)}.")
        raise UsageError("is no hard case.", key="--only", value=options.only, remedy=hint)
    out = checked_out(options.out or Path("results") / "stress")
    ids = (options.only,) if options.only else ()
    line = " ".join(["fem-impact stress", *(["--only", options.only] if options.only else [])])
    # one place keeps all cases, whichever were asked for last
    return carry_out("hard_cases.study", options, Request(out, ids, line=line, cases="hard cases"))
