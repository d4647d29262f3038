"""Output of the measured costs of one scene: JSON, CSV and tables."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fem_impact.answers.cost.judge import Judged
from fem_impact.answers.cost.measure import CostStudy
from fem_impact.answers.refine.quantities import QUANTITIES
from fem_impact.files.atomic import write_text
from fem_impact.tables.table import Cell, Column, Table

WIDE = 400
"""Characters of a line of cost.txt, enough that no cell of its tables is wrapped."""
NAMES = tuple(quantity.name for quantity in QUANTITIES)
SCALARS = ("name", "kind", "fidelity", "tip_size_m", "places")
COSTS = ("wall_s", "cpu_s", "two_cores_s", "element_steps", "peak_memory_MB")
NUMBERS = tuple(f"{kind}_{name}" for kind in ("value", "error", "scatter", "band") for name in NAMES)
COLUMNS = (*SCALARS, *COSTS, *NUMBERS, "front")


SUMMARY = "fem-impact/cost-summary/5"
"""Schema of the stored form of several scenes' costs."""


def summarise(costs: Mapping[str, CostStudy]) -> dict[str, Any]:
    """Return the stored form of several scenes' costs, with one date and one machine for all."""
    shared = ("created_utc", "versions", "machine")
    whole = {name: cost.to_dict() for name, cost in costs.items()}
    first = next(iter(whole.values()))
    scenes = {
        name: {k: v for k, v in cost.items() if k not in (*shared, "schema")} for name, cost in whole.items()
    }
    return {"schema": SUMMARY, **{key: first[key] for key in shared}, "scenes": scenes}


def write_cost(cost: CostStudy, out: Path) -> None:
    """Write cost.json, cost.csv and cost.txt."""
    write_text(out / "cost.json", json.dumps(cost.to_dict(), indent=1, allow_nan=False) + "\n")
    rows: list[list[Cell]] = []
    for one in cost.settings:
        fields = [getattr(one, key) for key in (*SCALARS, *COSTS)]
        by_name = (one.value, one.error, one.scatter, one.band)
        numbers = (values.get(name) for values in by_name for name in NAMES)
        rows.append([*fields, *numbers, " ".join(one.front)])
    write_text(out / "cost.txt", text_table(cost) + "\n")
    write_text(out / "cost.csv", Table.of(COLUMNS, rows).csv())


COST_COLUMNS = (
    Column("setting", left=True),
    Column("wall_s", "wall time, s", digits=3),
    Column("cpu_s", "processor time, s", digits=3),
    Column("element_steps", "element-steps", digits=2),
    Column("peak_memory_MB", "memory, MB"),
)


def text_table(cost: CostStudy, names: Sequence[str] = NAMES) -> str:
    """Return the tables of `cost_tables` one below the other, each under its caption."""
    shown = (f"{caption}\n{table.terminal(WIDE)}" for _, caption, table in cost_tables(cost, names))
    return "\n\n".join(shown)


def cost_tables(cost: CostStudy, names: Sequence[str] = NAMES) -> list[tuple[str, str, Table]]:
    """Return name, caption and table: errors of the settings, scatter, bands, and changes by an effect.

    The first starts with limit and order of each quantity; an asterisk marks the Pareto front of that
    quantity. Tables without rows are left out.
    """
    listed = [name for name in NAMES if name in names and name in cost.limits]
    columns = (*COST_COLUMNS, *map(Column, listed))
    judged = [_line(one, one.error, listed, one.front) for one in cost.settings if one.kind != "effect"]
    tables = (
        (
            "errors",
            "Errors in %, the limit's uncertainty included; *: no other setting is both quicker and more "
            "accurate",
            [*_limit_rows(cost, listed), *judged],
        ),
        (
            "scatter",
            "Scatter between places of the barrier's grid, as standard error, in %",
            [
                _line(one, one.scatter, listed)
                for one in cost.settings
                if one.kind in ("mesh", "extrapolated")
            ],
        ),
        (
            "bands",
            "Bands of the results extrapolated from two meshes, scatter included, in %",
            [_line(one, one.band, listed) for one in cost.settings if one.band],
        ),
        (
            "effects",
            "Changes by leaving an effect out, on the same mesh, in %",
            [_line(one, one.error, listed) for one in cost.settings if one.kind == "effect"],
        ),
    )
    return [(name, caption, Table(columns, tuple(rows))) for name, caption, rows in tables if rows]


def _limit_rows(cost: CostStudy, names: Sequence[str]) -> list[tuple[Cell, ...]]:
    """Return the rows above the settings: unit, limit, its uncertainty and order of each quantity."""
    units = {quantity.name: quantity.unit for quantity in QUANTITIES}
    limits = [cost.limits[name] for name in names]
    costs = ("",) * (len(COST_COLUMNS) - 1)
    return [
        ("unit", *costs, *(units[name] for name in names)),
        ("limit", *costs, *(each.value for each in limits)),
        (
            "uncertainty of the limit, %",
            *costs,
            *(f"{100 * each.uncertainty / each.scale:.2g}" for each in limits),
        ),
        (
            "observed order",
            *costs,
            *(None if each.order is None else f"{each.order:.2f}" for each in limits),
        ),
    ]


def _line(
    setting: Judged, values: Mapping[str, float | None], names: Sequence[str], front: Sequence[str] = ()
) -> tuple[Cell, ...]:
    """Return name and cost of a setting, and some of its values in per cent."""
    memory = setting.peak_memory_MB
    costs = (setting.wall_s, setting.cpu_s, setting.element_steps, None if memory is None else round(memory))
    shown = [
        None if (share := values.get(name)) is None else f"{'*' if name in front else ''}{100 * share:.3g}"
        for name in names
    ]
    return (setting.name, *costs, *shown)
