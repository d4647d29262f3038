"""Contact force and energy accounts of a run over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_impact.figures.panels import Interval, Panel, Picture, Series
from fem_impact.figures.style import percent
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.shares import ACCOUNTS, OF_SOME
from fem_impact.tables.table import Table

COLUMNS = ("time_s", "force_n_N", "force_t_N")
MOST = 800
"""Times of a curve that are drawn at most; the CSV beside the figure has all."""


def force_picture(history: Table, contacts: Sequence[ContactInterval]) -> Picture:
    """Return normal and tangential contact force on the whole rod, contact intervals shaded.

    Parameters
    ----------
    history : Table
        history.csv, forces in N.
    contacts : sequence of ContactInterval

    Raises
    ------
    ResultError
        A column is missing or holds no numbers.
    """
    time, normal, tangential = (history.numbers(name) for name in COLUMNS)
    series = (
        Series("normal (out of the barrier)", time * 1e6, normal / 1e3, "line", "blue"),
        Series("tangential (up the slope)", time * 1e6, tangential / 1e3, "dashed", "vermilion"),
    )
    intervals = [Interval(c.start * 1e6, c.end * 1e6, f"{c.impulse_n:.3g} N s") for c in contacts]
    panel = Panel("", "time, µs", "contact force on the rod, kN", series, intervals=tuple(intervals))
    caption = "Contact force on the whole rod; contact intervals shaded, with their normal impulse."
    numbers = Table.of(COLUMNS, zip(time, normal, tangential, strict=True))
    return Picture("force", caption, (panel,), 1, numbers)


def ledger_picture(history: Table, e_0: float) -> Picture:
    """Return the energy accounts over time as stacked areas, fractions of E_0.

    Parameters
    ----------
    history : Table
        history.csv, energies in J.
    e_0 : float, J
        Kinetic energy at first contact.

    Raises
    ------
    ResultError
        A column is missing or holds no numbers.
    """
    time = history.numbers("time_s")
    accounts = [*ACCOUNTS, *(account for account in OF_SOME if account.column in history.names)]
    shares = {account: history.numbers(account.column) / e_0 for account in accounts}
    gravity = history.numbers("E_gravity_J") / e_0
    worst = float(np.abs(history.numbers("residual_J")).max(initial=0.0)) / e_0
    kept = np.unique(np.linspace(0, max(len(time) - 1, 0), min(len(time), MOST)).astype(int))
    ends = [percent(float(share[-1])) if len(share) else "-" for share in shares.values()]
    areas = [
        Series(f"{account.label}  {end}", 1e6 * time[kept], share[kept], "area", account.colour)
        for (account, share), end in zip(shares.items(), ends, strict=True)
    ]
    total = "E_0 less gravity's potential" if np.any(np.abs(gravity) > 1e-9) else "E_0"
    whole = Series(total, 1e6 * time[kept], 1.0 - gravity[kept], "dashed", "ink")
    title = f"largest residual {worst:.1e} of E_0"
    panel = Panel(title, "time, µs", "fraction of E_0", (*areas, whole), y_range=(0.0, 1.05))
    names = [account.column.removesuffix("_J") + "_over_E_0" for account in shares]
    columns = ("time_s", *names, "E_gravity_over_E_0", "worst_residual_over_E_0")
    rows = zip(time, *shares.values(), gravity, np.full(len(time), worst), strict=True)
    caption = (
        "Ledger: each account as a fraction of E₀; the number beside a name is its last value. "
        "Strain energies include that of residual stress."
    )
    return Picture("ledger", caption, (panel,), 1, Table.of(columns, rows))
