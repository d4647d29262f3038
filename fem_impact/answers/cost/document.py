"""Output of the measured costs of one scene: JSON, CSV and tables."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fem_impact.answers.cost.judge import Judged, elements_of
from fem_impact.answers.cost.measure import CostStudy
from fem_impact.answers.refine.quantities import QUANTITIES
from fem_impact.files.atomic import write_text
from fem_impact.tables.table import Cell, Column, Table

WIDE = 400
"""Characters of a line of cost.txt, enough that no cell of its tables is wrapped."""
NAMES = tuple(quantity.name for quantity in QUANTITIES)
SCALARS = ("name", "kind", "levels", "tip_size_m", "elements", "cpu_s", "two_cores_s", "peak_memory_MB")
COLUMNS = (*SCALARS, *(f"{kind}_{name}" for kind in ("value", "error") for name in NAMES), "front")
SUMMARY = "fem-impact/cost-summary/6"
"""Schema of the stored form of several scenes' costs."""


def summarise(costs: Mapping[str, CostStudy]) -> dict[str, Any]:
    """Return the stored form of several scenes' costs, with one date and the versions for all."""
    shared = ("created_utc", "versions")
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
        numbers = (values.get(name) for values in (one.value, one.error) for name in NAMES)
        rows.append([*(getattr(one, key) for key in SCALARS), *numbers, " ".join(one.front)])
    write_text(out / "cost.txt", text_table(cost) + "\n")
    write_text(out / "cost.csv", Table.of(COLUMNS, rows).csv())


COST_COLUMNS = (
    Column("setting", left=True),
    Column("cpu_s", "processor time, s", digits=3),
    Column("elements"),
    Column("peak_memory_MB", "memory, MB"),
)


def text_table(cost: CostStudy, names: Sequence[str] = NAMES) -> str:
    """Return the tables of `cost_tables` one below the other, each under its caption."""
    shown = (f"{caption}\n{table.terminal(WIDE)}" for _, caption, table in cost_tables(cost, names))
    return "\n\n".join(shown)


def cost_tables(cost: CostStudy, names: Sequence[str] = NAMES) -> list[tuple[str, str, Table]]:
    """Return name, caption and table: errors of the settings, the levels one by one, changes by variants.

    The first starts with the limit of each quantity; an asterisk marks the Pareto front of that quantity.
    Tables without rows are left out.
    """
    listed = [name for name in NAMES if name in names and name in cost.limits]
    columns = (*COST_COLUMNS, *map(Column, listed))
    settings = [one for one in cost.settings if one.kind != "variant"]
    tables = (
        (
            "errors",
            "Errors in %; of levels the band that they tell, or their distance from the limit if that is "
            "more; *: no other setting is both quicker and more accurate",
            columns,
            [*_limit_rows(cost, listed), *(_line(one, listed) for one in settings)],
        ),
        (
            "levels",
            "Each level: processor time of all its runs, and the means of what they gave",
            (Column("places"), Column("level"), Column("mm"), *COST_COLUMNS[1:3], *map(Column, listed)),
            _level_rows(cost, listed),
        ),
        (
            "variants",
            "Changes of the default run, in %",
            columns,
            [_line(one, listed) for one in cost.settings if one.kind == "variant"],
        ),
    )
    return [(name, caption, Table(head, tuple(rows))) for name, caption, head, rows in tables if rows]


def _limit_rows(cost: CostStudy, names: Sequence[str]) -> list[tuple[Cell, ...]]:
    """Return the rows above the settings: unit, limit and its half-width of each quantity."""
    units = {quantity.name: quantity.unit for quantity in QUANTITIES}
    costs = ("",) * (len(COST_COLUMNS) - 1)
    return [
        ("unit", *costs, *(units[name] for name in names)),
        ("limit", *costs, *(cost.limits[name].value for name in names)),
        ("its band, %", *costs, *(f"{100 * cost.limits[name].error:.2g}" for name in names)),
    ]


def _level_rows(cost: CostStudy, names: Sequence[str]) -> list[tuple[Cell, ...]]:
    keys = {quantity.name: quantity.keys for quantity in QUANTITIES}
    return [
        (
            *(places, n, f"{1e3 * level.size:.3g}", level.cpu_s, elements_of(level)),
            *(level.mean(keys[name]) for name in names),
        )
        for places, levels in cost.levels.items()
        for n, level in enumerate(levels.meshes, 1)
    ]


def _line(setting: Judged, names: Sequence[str]) -> tuple[Cell, ...]:
    """Return name and cost of a setting, and its errors in per cent."""
    memory = setting.peak_memory_MB
    costs = (setting.cpu_s, setting.elements, None if memory is None else round(memory))
    shown = [
        None
        if (error := setting.error[name]) is None
        else f"{'*' if name in setting.front else ''}{100 * error:.3g}"
        for name in names
    ]
    return (setting.name, *costs, *shown)
