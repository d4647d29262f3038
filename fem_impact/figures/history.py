"""Contact force and energy accounts of a run over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import PALETTE, QUIET, Shape, figure, percent, write_data
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.shares import ACCOUNTS, OF_SOME, LedgerAccount
from fem_impact.tables.table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes


COLUMNS = ("time_s", "force_n_N", "force_t_N")


def force_figure(
    history: Table, contacts: Sequence[ContactInterval], path: str | Path, shape: Shape = "wide"
) -> Path:
    """Draw normal and tangential contact force on the whole rod, contact intervals shaded.

    Parameters
    ----------
    history : Table
        history.csv, forces in N.
    contacts : sequence of ContactInterval
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"

    Raises
    ------
    ResultError
        A column is missing or holds no numbers.
    """
    path = Path(path)
    time, normal, tangential = (history.numbers(name) for name in COLUMNS)
    write_data(path, COLUMNS, zip(time, normal, tangential, strict=True))
    with figure(path, shape, 3.6 if shape == "wide" else 4.0) as drawn:
        axes = drawn.add_subplot()
        axes.plot(time * 1e6, normal / 1e3, color=PALETTE["blue"], label="normal (out of the barrier)")
        look: dict[str, Any] = {"color": PALETTE["vermilion"], "linestyle": (0, (5, 1.5))}
        axes.plot(time * 1e6, tangential / 1e3, **look, label="tangential (up the slope)")
        _shade(axes, contacts)
        axes.set(xlabel="time, µs", ylabel="contact force on the rod, kN")
        axes.grid(axis="y")
        axes.axhline(0.0, color=QUIET, linewidth=0.7)
        drawn.legend(loc="outside lower center", ncols=2 if shape == "wide" else 1)
    return path


def _shade(axes: Axes, contacts: Sequence[ContactInterval]) -> None:
    for contact in contacts:
        start, end = contact.start * 1e6, contact.end * 1e6
        axes.axvspan(start, end, color="#eef2f6", zorder=0)
        axes.text(
            (start + end) / 2,
            1.005,
            f"{contact.impulse_n:.3g} N s",
            transform=axes.get_xaxis_transform(),
            ha="center",
            va="bottom",
            fontsize=7.5,
            color=QUIET,
        )


def ledger_figure(history: Table, e_0: float, path: str | Path, shape: Shape = "wide") -> Path:
    """Draw the energy accounts over time as stacked areas, fractions of E_0.

    Parameters
    ----------
    history : Table
        history.csv, energies in J.
    e_0 : float, J
        Kinetic energy at first contact.
    path : path
        The picture; its suffix is the format. The data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
        For a desktop or a phone.

    Raises
    ------
    ResultError
        A column is missing or holds no numbers.
    """
    path, time = Path(path), history.numbers("time_s")
    accounts = [*ACCOUNTS, *(account for account in OF_SOME if account.column in history.names)]
    shares = {account: history.numbers(account.column) / e_0 for account in accounts}
    gravity = history.numbers("E_gravity_J") / e_0
    worst = float(np.abs(history.numbers("residual_J")).max(initial=0.0)) / e_0
    names = [account.column.removesuffix("_J") + "_over_E_0" for account in shares]
    columns = ("time_s", *names, "E_gravity_over_E_0", "worst_residual_over_E_0")
    write_data(path, columns, zip(time, *shares.values(), gravity, np.full(len(time), worst), strict=True))
    with figure(path, shape, 4.6 if shape == "wide" else 5.4) as drawn:
        axes = drawn.add_subplot()
        _areas(axes, time * 1e6, shares)
        total = "E₀ less gravity's potential" if np.any(np.abs(gravity) > 1e-9) else "E₀"
        axes.plot(time * 1e6, 1.0 - gravity, color="black", lw=1.0, ls=(0, (4, 2)), label=total)
        axes.set(xlabel="time, µs", ylabel="fraction of E₀", ylim=(0.0, None))
        if len(time) > 1:
            axes.set_xlim(1e6 * time[0], 1e6 * time[-1])
        axes.grid(axis="y")
        title = f"largest residual {worst:.1e} of E₀"
        axes.set_title(title, fontsize=8.0, color=QUIET, loc="right", weight="normal")
        handles, labels = axes.get_legend_handles_labels()
        across = 3 if shape == "wide" else 2
        drawn.legend(handles[::-1], labels[::-1], loc="outside lower center", ncols=across)
    return path


def _areas(axes: Axes, time: np.ndarray, shares: dict[LedgerAccount, np.ndarray]) -> None:
    ends = [percent(float(share[-1])) if len(share) else "-" for share in shares.values()]
    # at most 800 of the times are drawn; the CSV has all
    kept = np.unique(np.linspace(0, max(len(time) - 1, 0), min(len(time), 800)).astype(int))
    axes.stackplot(
        time[kept],
        [share[kept] for share in shares.values()],
        labels=[f"{account.label}  {end}" for account, end in zip(shares, ends, strict=True)],
        colors=[PALETTE[account.colour] for account in shares],
        edgecolor="white",
        linewidth=0.4,
    )
