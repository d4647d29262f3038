"""Where E_0 went, one bar an account."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fem_impact.figures.accounts import FINAL, Account
from fem_impact.figures.style import QUIET, Shape, figure, percent
from fem_impact.output import write_table

__all__ = ["partition_figure"]

UNSEEN = 1e-5  # of E_0


def partition_figure(outcome: Mapping[str, Any], path: str | Path, shape: Shape = "wide") -> Path:
    """Draw the known shares of E_0 after the last separation.

    Parameters
    ----------
    outcome : mapping
        An Outcome or one row of a study; null shares are left out (the record holds the reasons).
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    path = Path(path)
    known = [account for account in FINAL if outcome[account.key] is not None]
    write_table(path.with_suffix(".csv"), ("account", "fraction_of_E_0"), _rows(known, outcome))
    with figure(path, shape, 0.9 + 0.27 * max(len(known), 1)) as drawn:
        axes = drawn.add_subplot()
        # a bar too thin to be seen is none: one below 0 would have its number on its name
        values = [100.0 * share if abs(share := outcome[account.key]) > UNSEEN else 0.0 for account in known]
        bars = axes.barh([account.label for account in known], values, height=0.68)
        for bar, account in zip(bars, known, strict=True):
            bar.set_color(account.colour)
        axes.bar_label(bars, [_label(account, outcome) for account in known], padding=4, fontsize=8.5)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.margins(x=0.22)
        axes.grid(axis="x")
        axes.set_xlabel("share of E₀ after the last separation, %", color=QUIET)
    return path


def _rows(known: list[Account], outcome: Mapping[str, Any]) -> list[tuple[str, float]]:
    return [(account.key.removesuffix("_over_E_0"), outcome[account.key]) for account in known]


def _label(account: Account, outcome: Mapping[str, Any]) -> str:
    if account.key == "E_vib_over_E_0" and outcome.get("E_vib_below_floor"):
        return f"below floor ({percent(outcome['E_vib_floor_over_E_0'] or 0.0)})"
    width = (outcome.get("bands") or {}).get(account.key)
    return percent(outcome[account.key], width)
