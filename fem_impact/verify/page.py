"""The results of the verification as a Markdown page, set between two marks of a file."""

from __future__ import annotations

import re
from collections.abc import Sequence

from fem_impact.errors import UsageError
from fem_impact.study.markdown import table
from fem_impact.verify.problem import Check, Verification

__all__ = ["HEAD", "MARKS", "page", "put_page"]

MARKS = ("<!-- verification: written by `fem-impact verify --readme` -->", "<!-- end of the verification -->")
HEAD = ["problem", "passed", "nearest to its limit", "computed", "reference", "error", "allowed", "CPU s"]


def _use(check: Check) -> float:
    """Return the share of its tolerance that a check uses up."""
    error = abs(check.error)
    return error / check.tolerance if check.tolerance else (float("inf") if error else 0.0)


def _row(found: Verification) -> list[str]:
    judged = [check for check in found.checks if check.judged]
    nearest = max(judged, key=_use)
    unit = "" if nearest.unit == "1" else f" {nearest.unit}"
    return [
        f"`{found.name}`",
        f"{sum(check.passed for check in judged)} of {len(judged)}",
        nearest.name,
        f"{nearest.computed:.5g}{unit}",
        f"{nearest.reference:.5g}{unit}",
        f"{nearest.error:+.1e}",
        f"{nearest.tolerance:.3g} {nearest.kind}",
        f"{found.cost.cpu_s:.0f}",
    ]


def page(done: Sequence[Verification], date: str) -> str:
    """Return the page: date and cost, and a row for every problem."""
    every = [check for found in done for check in found.checks]
    checks = [check for check in every if check.judged]
    wall = sum(found.cost.wall_s for found in done)
    line = (
        f"{date}, all parameters at their defaults: {sum(check.passed for check in checks)} of {len(checks)} "
        f"checks passed, {len(every) - len(checks)} more are only shown, {wall / 60:.1f} minutes."
    )
    return f"{line}\n\n{table(HEAD, [_row(found) for found in done])}"


def put_page(text: str, new: str, marks: tuple[str, str] = MARKS) -> str:
    """Return ``text`` with the page between the marks replaced.

    Raises
    ------
    UsageError
        If the marks are missing.
    """
    between = re.compile(f"({re.escape(marks[0])}\n).*?({re.escape(marks[1])})", re.DOTALL)
    if not between.search(text):
        raise UsageError(
            "has no place for the page.", key="--readme", remedy=f"Add the lines {marks[0]} and {marks[1]}."
        )
    return between.sub(lambda found: f"{found[1]}{new}\n{found[2]}", text)
