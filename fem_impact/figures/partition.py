"""Shares of E_0 of one run and of a study's runs, and the comparison of model and measurement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fem_impact.figures.panels import Look, Panel, Picture, Series
from fem_impact.figures.style import percent
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import ABOVE, EnergyShare, above_modes, shares
from fem_impact.tables.csv import COMPARISON
from fem_impact.tables.table import Table

UNSEEN = 1e-5
"""Fraction of E_0 below which a bar is not drawn."""

AXIS = "share of E_0, %"


def partition_picture(outcome: Outcome) -> Picture:
    """Return the known shares of E_0 after the last separation, of two meshes their limits and bands.

    Shares that are not known are left out (the record holds the reasons).
    """
    listed = [share for share in shares("figure") if not isinstance(share.of(outcome.energy), Unknown)]
    rows = [
        (
            share.label,
            share.key.name.removesuffix("_over_E_0"),
            known(outcome.estimate(share.key)[0]),
            share.colour,
            _label(share, outcome),
        )
        for share in listed
    ]
    if above := above_modes(outcome.energy):
        at = [row[0] for row in rows].index("vibration") + 1
        rows.insert(at, (ABOVE, "E_vib_above_modes", above, rows[at - 1][3], percent(above)))
    labels, names, values, colours, texts = zip(*rows, strict=True)
    # bars below UNSEEN are 0: the number beside a negative one would cover its name
    widths = [100.0 * value if abs(value) > UNSEEN else 0.0 for value in values]
    bars = tuple(
        Series("", [width], [at], "bars", colour, texts=(text,))
        for at, (width, colour, text) in enumerate(zip(widths, colours, texts, strict=True))
    )
    right = 1.3 * max([*widths, 1e-3])  # leaves room for the numbers
    panel = Panel("", AXIS, "", bars, rows=labels, x_range=(min(0.0, *widths), right))
    numbers = Table.of(("account", "fraction_of_E_0"), zip(names, values, strict=True))
    return Picture("partition", "Shares of E₀ after the last separation.", (panel,), 1, numbers)


def _label(share: EnergyShare, outcome: Outcome) -> str:
    energy = outcome.energy
    if share.key.path[-1] == "vibration" and or_none(energy.below_floor):
        return f"below floor ({percent(or_none(energy.vibration_floor) or 0.0)})"
    value, width = outcome.estimate(share.key)
    return percent(known(value), width)


def study_partition_picture(rows: Sequence[Outcome]) -> Picture:
    """Return one stacked bar a run, shares that are not known left white."""
    listed, at = shares("figure"), range(len(rows))
    fractions = {share: [or_none(share.of(row.energy)) for row in rows] for share in listed}
    bars = tuple(
        Series(share.label, [100.0 * (part or 0.0) for part in parts], at, "bars", share.colour)
        for share, parts in fractions.items()
    )
    names = tuple(row.provenance.scene_id for row in rows)
    panel = Panel("", AXIS, "", bars, rows=names, x_range=(0.0, 103.0))
    columns = ("scene_id", *(share.key.name for share in listed))
    numbers = Table.of(columns, zip(names, *fractions.values(), strict=True))
    caption = "Shares of E₀ after the last separation; a white part is not known."
    return Picture("partition", caption, (panel,), 1, numbers)


def comparison_picture(rows: Sequence[Mapping[str, Any]]) -> Picture:
    """Return measured means with their 95 % intervals, and the model with its two-mesh band.

    Parameters
    ----------
    rows : sequence of mappings
        Rows of ``comparison`` in study.json; null values are left out of the picture, and
        quantities that nobody measured.
    """
    quantities, sets = ([*dict.fromkeys(row[name] for row in rows)] for name in ("quantity", "set"))
    groups = ([row for row in rows if row["quantity"] == name] for name in quantities)
    panels = [
        _panel(group, sets) for group in groups if any(row["measured_mean"] is not None for row in group)
    ]
    numbers = Table.of(COMPARISON, [[row[name] for name in COMPARISON] for row in rows])
    caption = (
        "Measured means with 95 % intervals of the mean and standard deviations; the model with its "
        "two-mesh band where two meshes were run."
    )
    return Picture("comparison", caption, tuple(panels), 4, numbers)


def _panel(rows: Sequence[Mapping[str, Any]], sets: list[str]) -> Panel:
    unit = rows[0]["unit"]
    title = rows[0]["quantity"] + (f", {unit}" if unit not in ("", "-") else "")
    at = np.array([sets.index(row["set"]) for row in rows])
    mean, sd, low, high, model, band = (
        np.array([np.nan if row[name] is None else row[name] for row in rows], float)
        for name in ("measured_mean", "measured_sd", "measured_low", "measured_high", "model", "band")
    )
    above = at - 0.16
    interval: tuple[Look, str] = ("interval", "ink")
    series = (
        Series("± one standard deviation", mean, above, "spread", "grey", sd),
        Series("95 % interval of the mean", (low + high) / 2, above, *interval, (high - low) / 2),
        Series("measured mean", mean, above, "points", "ink"),
        Series("model, two-mesh band", model, at + 0.16, "diamonds", "vermilion", band),
    )
    return Panel(title, "", "", series, rows=tuple(sets))
