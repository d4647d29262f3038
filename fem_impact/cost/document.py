"""The cost of a scene as a table, as CSV and as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from fem_impact.cost.judge import Judged
from fem_impact.cost.measure import Cost
from fem_impact.cost.plot import work_precision
from fem_impact.cost.quantities import QUANTITIES
from fem_impact.output import write_table, write_text

__all__ = ["text_table", "write_cost"]

NAMES = tuple(quantity.name for quantity in QUANTITIES)
SCALARS = ("name", "kind", "fidelity", "tip_size_m")
COSTS = ("wall_s", "cpu_s", "two_cores_s", "element_steps", "peak_memory_MB")
COLUMNS = (
    *SCALARS,
    *COSTS,
    *(f"value_{name}" for name in NAMES),
    *(f"error_{name}" for name in NAMES),
    *(f"scatter_{name}" for name in NAMES),
    *(f"band_{name}" for name in NAMES),
    "front",
)


def write_cost(cost: Cost, out: Path, names: tuple[str, ...]) -> None:
    """Write cost.json, cost.csv, cost.txt and the plot of the targeted quantities, cost.svg."""
    write_text(out / "cost.json", json.dumps(cost.to_dict(), indent=1, allow_nan=False) + "\n")
    write_table(out / "cost.csv", COLUMNS, [_row(setting) for setting in cost.settings])
    write_text(out / "cost.txt", text_table(cost) + "\n")
    work_precision(cost.settings, names, out / "cost.svg")


def _row(setting: Judged) -> list[str | float | int | None]:
    data = setting.to_dict()
    errors = [setting.error[name] for name in NAMES]
    values = [setting.value[name] for name in NAMES]
    own = [held.get(name) for held in (setting.scatter, setting.band) for name in NAMES]
    return [*(data[key] for key in (*SCALARS, *COSTS)), *values, *errors, *own, " ".join(setting.front)]


def text_table(cost: Cost, names: Sequence[str] = NAMES) -> str:
    """Return limits and orders, then one line a setting: times, and the error of quantities in per cent.

    An asterisk marks the Pareto front of that quantity. What the places of the barrier's grid tell of each
    setting follows, the bands of the pairs of meshes, and what leaving an effect out changes.
    """
    width = max(len(setting.name) for setting in cost.settings)
    shown = [q for q in QUANTITIES if q.name in names and q.name in cost.truth]
    truth = [cost.truth[quantity.name] for quantity in shown]
    head = f"{'setting':<{width}} {'wall s':>8} {'CPU s':>8} {'el.-steps':>10} {'MB':>6}"
    above = {
        head: [quantity.name for quantity in shown],
        "unit": [quantity.unit for quantity in shown],
        "limit": [f"{t.value:.4g}" for t in truth],
        "uncertainty of the limit, %": [f"{100 * t.uncertainty / t.scale:.2g}" for t in truth],
        "observed order": ["-" if t.order is None else f"{t.order:.2f}" for t in truth],
    }
    lines = [f"{words:<{len(head)}}{_cells(texts)}" for words, texts in above.items()]
    pick = partial(_line, width=width, names=[quantity.name for quantity in shown])
    lines += [pick(setting) for setting in cost.settings if setting.kind != "effect"]
    lines += ["errors in %, the limit's uncertainty included; * on the Pareto front"]
    meshes = [setting for setting in cost.settings if setting.kind in ("mesh", "pair")]
    lines += _block("scatter of the grid's places in %, as standard error", meshes, "scatter", pick)
    pairs = [setting for setting in cost.settings if setting.band]
    lines += _block("bands of the extrapolations in %, scatter included", pairs, "band", pick)
    left_out = [setting for setting in cost.settings if setting.kind == "effect"]
    lines += _block("changes in % by leaving an effect out, on the same mesh", left_out, "error", pick)
    return "\n".join(line.rstrip() for line in lines)


def _cells(texts: Iterable[str]) -> str:
    """Return numbers flush right, with room for an asterisk behind each."""
    return "".join(f"{text:>11}" if text.endswith("*") else f"{text:>10} " for text in texts)


def _block(title: str, settings: Sequence[Judged], field: str, line: Callable[[Judged], str]) -> list[str]:
    """Return a line a setting with the numbers of one field, below a title; nothing without settings."""
    lines = [line(replace(s, error=dict(getattr(s, field)), front=[])) for s in settings]
    return ["", title, *lines] if lines else []


def _line(setting: Judged, width: int, names: Sequence[str]) -> str:
    steps = "-" if setting.element_steps is None else f"{setting.element_steps:.2g}"
    memory = "-" if setting.peak_memory_MB is None else f"{setting.peak_memory_MB:.0f}"
    head = f"{setting.name:<{width}} {setting.wall_s:>8.3g} {setting.cpu_s:>8.3g} {steps:>10} {memory:>6}"
    return head + _cells(_cell(setting, name) for name in names)


def _cell(setting: Judged, name: str) -> str:
    error = setting.error[name]
    return "-" if error is None else f"{100 * error:.3g}{'*' if name in setting.front else ''}"
