"""Where E_0 went, one bar a share."""

from __future__ import annotations

from pathlib import Path

from fem_impact.figures.style import PALETTE, QUIET, Shape, figure, percent
from fem_impact.outcome import EnergyShare, Outcome, Unknown, known, or_none, shares
from fem_impact.output import write_table

__all__ = ["partition_figure"]

UNSEEN = 1e-5  # of E_0


def partition_figure(outcome: Outcome, path: str | Path, shape: Shape = "wide") -> Path:
    """Draw the known shares of E_0 after the last separation, of two meshes their limits and bands.

    Parameters
    ----------
    outcome : Outcome
        Shares that are not known are left out (the record holds the reasons).
    path : path
        The picture; the data go to the same name with ``.csv``.
    shape : "wide" or "narrow"
    """
    path = Path(path)
    listed = [share for share in shares("figure") if not isinstance(share.of(outcome.energy), Unknown)]
    values = [known(outcome.estimate(share.key)[0]) for share in listed]
    names = [share.key.name.removesuffix("_over_E_0") for share in listed]
    write_table(path.with_suffix(".csv"), ("account", "fraction_of_E_0"), zip(names, values, strict=True))
    with figure(path, shape, 0.9 + 0.27 * max(len(listed), 1)) as drawn:
        axes = drawn.add_subplot()
        # a bar too thin to be seen is none: one below 0 would have its number on its name
        widths = [100.0 * value if abs(value) > UNSEEN else 0.0 for value in values]
        bars = axes.barh([share.label for share in listed], widths, height=0.68)
        for bar, share in zip(bars, listed, strict=True):
            bar.set_color(PALETTE[share.colour])
        axes.bar_label(bars, [_label(share, outcome) for share in listed], padding=4, fontsize=8.5)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.margins(x=0.22)
        axes.grid(axis="x")
        axes.set_xlabel("share of E₀ after the last separation, %", color=QUIET)
    return path


def _label(share: EnergyShare, outcome: Outcome) -> str:
    energy = outcome.energy
    if share.key.path[-1] == "vibration" and or_none(energy.below_floor):
        return f"below floor ({percent(or_none(energy.vibration_floor) or 0.0)})"
    value, width = outcome.estimate(share.key)
    return percent(known(value), width)
