"""The rows of hard cases as text."""

from __future__ import annotations

from collections.abc import Sequence

from fem_impact.stress.run import Row
from fem_impact.study.markdown import table

__all__ = ["MARKS", "page", "told"]

MARKS = ("<!-- stress: written by `fem-impact stress --readme` -->", "<!-- end of the stress table -->")
HEAD = ["scene", "what is hard", "verdict", "ledger / E_0", "elements", "steps", "CPU s"]


def page(rows: Sequence[Row], date: str) -> str:
    """Return date and counts, the table, and a sentence for each case that did not simply close."""
    passed, cpu = sum(row.passed for row in rows), sum(row.cpu_s for row in rows)
    line = f"{date}: {passed} of {len(rows)} as they must be, {cpu / 60:.1f} minutes of CPU."
    notes = [f"- `{row.name}`: {row.reason}" for row in rows if row.reason]
    return "\n".join([line, "", table(HEAD, [_cells(row) for row in rows]), "", *notes]).rstrip()


def told(row: Row) -> str:
    """Return one line on a case."""
    mark = "ok  " if row.passed else "FAIL"
    reason = f": {row.reason}" if row.reason else ""
    return f"{mark} {row.name}: {row.verdict}, ledger {_share(row)}, {row.cpu_s:.1f} s of CPU{reason}"


def _cells(row: Row) -> list[str]:
    verdict = row.verdict if row.passed else f"**{row.verdict}**"
    counts = [f"{n}" if n else "" for n in (row.elements, row.steps)]
    return [f"`{row.name}`", row.words, verdict, _share(row), *counts, f"{row.cpu_s:.0f}"]


def _share(row: Row) -> str:
    return "-" if row.residual is None else f"{row.residual:.0e}"
