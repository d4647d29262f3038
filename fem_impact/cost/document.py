"""Output of measured costs: JSON, CSV, text, Markdown tables, and the plot of error against time."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fem_impact.cost.judge import Judged, best_pair, front
from fem_impact.cost.measure import CostStudy
from fem_impact.cost.quantities import QUANTITIES, TARGETED
from fem_impact.figures.panels import Look, Panel, Picture, Series
from fem_impact.figures.still import draw
from fem_impact.files.atomic import write_text
from fem_impact.tables.table import Cell, Column, Table

WIDE = 400
"""Characters of a line of cost.txt, enough that no cell of its tables is wrapped."""
NAMES = tuple(quantity.name for quantity in QUANTITIES)
SCALARS = ("name", "kind", "fidelity", "tip_size_m")
COSTS = ("wall_s", "cpu_s", "two_cores_s", "element_steps", "peak_memory_MB")
NUMBERS = tuple(f"{kind}_{name}" for kind in ("value", "error", "scatter", "band") for name in NAMES)
COLUMNS = (*SCALARS, *COSTS, *NUMBERS, "front")
LOOKS: dict[str, tuple[str, Look, str]] = {
    "rigid": ("rigid", "squares", "purple"),
    "modal": ("modal", "diamonds", "orange"),
    "mesh": ("one mesh", "points", "blue"),
    "pair": ("two meshes, extrapolated", "triangles", "green"),
    "numerics": ("other elements or step", "crosses", "vermilion"),
}
"""Label, look and colour of each kind of setting."""
WANTED = 0.02
"""Largest band over scale of a pair of meshes that meets the requirement in the table of scenes."""

Scenes = dict[str, tuple[dict[str, Any], list[Judged]]]
"""Limits of the quantities, and settings, by scene."""


def write_cost(cost: CostStudy, out: Path, names: tuple[str, ...]) -> None:
    """Write cost.json, cost.csv, cost.txt and the plot of the targeted quantities, cost.svg."""
    write_text(out / "cost.json", json.dumps(cost.to_dict(), indent=1, allow_nan=False) + "\n")
    rows: list[list[Cell]] = []
    for one in cost.settings:
        fields = [getattr(one, key) for key in (*SCALARS, *COSTS)]
        by_name = (one.value, one.error, one.scatter, one.band)
        numbers = (values.get(name) for values in by_name for name in NAMES)
        rows.append([*fields, *numbers, " ".join(one.front)])
    write_text(out / "cost.txt", text_table(cost) + "\n")
    draw(cost_picture(cost.settings, names), out / "cost.svg")  # with its data, for which the table stands
    write_text(out / "cost.csv", Table.of(COLUMNS, rows).csv())


COST_COLUMNS = (
    Column("setting", left=True),
    Column("wall_s", "wall s", digits=3),
    Column("cpu_s", "CPU s", digits=3),
    Column("element_steps", "el.-steps", digits=2),
    Column("peak_memory_MB", "MB"),
)


def text_table(cost: CostStudy, names: Sequence[str] = NAMES) -> str:
    """Return limits and orders, then one line a setting: times, and the error of quantities in per cent.

    An asterisk marks the Pareto front of that quantity. Further tables give the scatter over the places of
    the barrier's grid, the bands of the pairs of meshes, and the changes by leaving an effect out.
    """
    listed = [name for name in NAMES if name in names and name in cost.truth]
    columns = (*COST_COLUMNS, *map(Column, listed))
    judged = [_line(one, one.error, listed, one.front) for one in cost.settings if one.kind != "effect"]
    lines = [Table(columns, (*_limit_rows(cost, listed), *judged)).terminal(WIDE)]
    lines += [
        "errors in %, the limit's uncertainty included; *: no other setting is both quicker and more accurate"
    ]
    blocks = (
        (
            "scatter between places of the barrier's grid in %, as standard error",
            [_line(one, one.scatter, listed) for one in cost.settings if one.kind in ("mesh", "pair")],
        ),
        (
            "bands of the extrapolations in %, scatter included",
            [_line(one, one.band, listed) for one in cost.settings if one.band],
        ),
        (
            "changes in % by leaving an effect out, on the same mesh",
            [_line(one, one.error, listed) for one in cost.settings if one.kind == "effect"],
        ),
    )
    for title, rows in blocks:
        lines += ["", title, Table(columns, tuple(rows)).terminal(WIDE)] if rows else []
    return "\n".join(lines)


def _limit_rows(cost: CostStudy, names: Sequence[str]) -> list[tuple[Cell, ...]]:
    """Return the rows above the settings: unit, limit, its uncertainty and order of each quantity."""
    units = {quantity.name: quantity.unit for quantity in QUANTITIES}
    truth = [cost.truth[name] for name in names]
    costs = ("",) * (len(COST_COLUMNS) - 1)
    return [
        ("unit", *costs, *(units[name] for name in names)),
        ("limit", *costs, *(t.value for t in truth)),
        ("uncertainty of the limit, %", *costs, *(f"{100 * t.uncertainty / t.scale:.2g}" for t in truth)),
        ("observed order", *costs, *(None if t.order is None else f"{t.order:.2f}" for t in truth)),
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


def cost_picture(settings: Sequence[Judged], names: Sequence[str]) -> Picture:
    """Return relative error against CPU time, both logarithmic, of some quantities."""
    panels = tuple(
        _panel([one for one in settings if one.error[name] and one.kind in LOOKS], name) for name in names
    )
    return Picture("cost", "Error by the limit's uncertainty against time, a point a setting.", panels)


def _panel(settings: Sequence[Judged], name: str) -> Panel:
    best = Series("no other beats it", *_points(front(settings, [name]), name), "line", "grey")
    kinds = (
        Series(label, *_points([one for one in settings if one.kind == kind], name), look, colour)
        for kind, (label, look, colour) in LOOKS.items()
    )
    return Panel(name, "CPU time, s", "error, %", (best, *kinds), logarithmic=True)


def _points(settings: Sequence[Judged], name: str) -> tuple[list[float], list[float]]:
    return [one.cpu_s for one in settings], [100 * (one.error[name] or 0.0) for one in settings]


def summary_markdown(document: dict[str, Any]) -> str:
    """Return two tables with a row per scene: results of its best pair of meshes, and all settings.

    A cell of the second table is: errors of the targeted quantities with their scatter in per cent, CPU time
    in s.
    """
    scenes = {
        name: (cost["quantities"], [Judged(**setting) for setting in cost["settings"]])
        for name, cost in document["scenes"].items()
    }
    # in order of cost, without pairs and settings that leave an effect out
    kinds = ("rigid", "modal", "mesh", "numerics")
    named = {one.name: one for _, settings in scenes.values() for one in settings if one.kind in kinds}
    columns = sorted(named, key=lambda name: (kinds.index(named[name].kind), -(named[name].tip_size_m or 0)))
    head = ["set", *(f"{name}, limit" for name in TARGETED), *columns]
    body = [
        [
            name,
            *(f"{q[of]['limit']:.3g} ± {q[of]['uncertainty']:.1g}" for of in TARGETED),
            *(_markdown_cell(settings, column) for column in columns),
        ]
        for name, (q, settings) in scenes.items()
    ]
    machine = document["machine"]
    note = (
        f"Measured {document['created_utc'][:10]}, CPU times in s on a machine with a triad of "
        f"{machine['triad_GB_per_s']:.3g} GB/s and a CSR product of "
        f"{machine['csr_ns_per_element_step']:.3g} ns an element-step."
    )
    return f"{_pairs(scenes)}\n\n{Table.of(head, body).markdown()}\n\n{note}\n"


def _pairs(scenes: Scenes) -> str:
    """Return the table of each scene's best pair for each quantity, and how many meet `WANTED`."""
    paired = {
        scene: (q, settings) for scene, (q, settings) in scenes.items() if any(one.band for one in settings)
    }
    columns = [[_best(name, *measured) for measured in paired.values()] for name in TARGETED]
    head = ["set", *(title for name in TARGETED for title in (name, "% (scatter)", "meshes, mm", "off", "s"))]
    body = [
        [scene, *(cell for cells, _ in row for cell in cells)]
        for scene, *row in zip(paired, *columns, strict=True)
    ]
    counts = " and ".join(
        f"{name} in {sum(met for _, met in column)}" for name, column in zip(TARGETED, columns, strict=True)
    )
    sentence = f"To {100 * WANTED:g} % by its own band: {counts} of {len(paired)} sets."
    return f"{Table.of(head, body).markdown()}\n\n{sentence}"


def _best(name: str, quantities: dict[str, Any], settings: list[Judged]) -> tuple[list[str], bool]:
    """Return cells of the best pair for a quantity, and whether it meets `WANTED`: then its band is bold."""
    pair = best_pair(settings, (name,), WANTED)
    assert pair is not None  # scenes without a pair are left out
    limit, scale = quantities[name], quantities[name]["scale"]
    both = pair.band[name] * scale + limit["uncertainty"]
    off = abs((pair.value[name] or 0.0) - limit["limit"]) / both if both else 0.0
    value = f"{pair.value[name] or 0.0:.4f} ± {pair.band[name] * scale:.4f}"
    met = pair.band[name] <= WANTED
    band = f"**{_percent(pair.band[name])}**" if met else _percent(pair.band[name])
    sizes = pair.name.removeprefix("solid ").removesuffix(" mm extrapolated")
    scatter = f"({_percent(pair.scatter[name])})"
    return [value, f"{band} {scatter}", sizes, f"{off:.1f}", f"{pair.two_cores_s:.3g}"], met


def _markdown_cell(settings: list[Judged], name: str) -> str:
    """Return errors with scatter, in per cent, and CPU time of a setting; empty where it was not run."""
    setting = next((one for one in settings if one.name == name), None)
    if setting is None:
        return ""
    errors = []
    for quantity in TARGETED:
        error, scatter = setting.error[quantity], setting.scatter.get(quantity)
        shown = "-" if error is None else _percent(error)
        errors.append(shown if scatter is None else f"{shown} ± {_percent(scatter)}")
    return f"{' / '.join(errors)}, {setting.cpu_s:.2g} s"


def _percent(error: float) -> str:
    return f"{100 * error:.2g}" if error < 0.995 else f"{100 * error:.0f}"
