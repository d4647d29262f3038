"""Every quantity of some runs against the element size, with its limit and band."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.figures.style import PALETTE, figure
from fem_impact.output import write_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["convergence_figure"]

COLUMNS = ("set", "quantity", "tip_size_m", "value", "cpu_s")
COLOURS = [PALETTE[name] for name in ("blue", "vermilion", "green", "purple", "orange", "grey")]


def convergence_figure(rows: Sequence[Mapping[str, Any]], path: str | Path) -> Path:
    """Draw one panel a quantity, one line a set; the data go to the same name with ``.csv``.

    Parameters
    ----------
    rows : sequence of mappings
        Rows of convergence.json: set, quantity, tip_size_m (m), values, limit, band, cpu_s (s).
    path : path
        The picture.
    """
    path = Path(path)
    write_table(path.with_suffix(".csv"), COLUMNS, _flat(rows))
    quantities = list(dict.fromkeys(row["quantity"] for row in rows))
    with figure(path, "wide", 2.2 * max(1, (len(quantities) + 1) // 2)) as drawn:
        panels = drawn.subplots(max(1, (len(quantities) + 1) // 2), 2, sharex=True, squeeze=False).flat
        for panel, quantity in zip(panels, quantities, strict=False):
            _panel(panel, [row for row in rows if row["quantity"] == quantity])
        if rows:
            drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return path


def _flat(rows: Sequence[Mapping[str, Any]]) -> list[tuple[str, str, float, float, float]]:
    return [
        (row["set"], row["quantity"], *numbers)
        for row in rows
        for numbers in zip(row["tip_size_m"], row["values"], row["cpu_s"], strict=True)
    ]


def _panel(axes: Axes, rows: Sequence[Mapping[str, Any]]) -> None:
    """Draw values, and at element size 0 the limit with the finest mesh's band."""
    for row, colour in zip(rows, COLOURS * len(rows), strict=False):
        sizes = [1e3 * size for size in row["tip_size_m"]]
        axes.plot(sizes, row["values"], "o-", color=colour, markersize=3.5, label=row["set"])
        axes.errorbar([0.0], [row["limit"]], [row["band"]], fmt="_", color=colour, capsize=3)
    axes.set(title=rows[0]["quantity"], xlabel="element at the tip, mm", xlim=(-0.02, None))
    axes.grid()
