"""The cost of a scene as a table, as CSV and as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.cost.judge import Judged, best_pair, front
from fem_impact.cost.measure import CostStudy
from fem_impact.cost.quantities import QUANTITIES, TARGETED
from fem_impact.figures.style import PALETTE, QUIET, figure
from fem_impact.files.atomic import write_text
from fem_impact.tables.csv import write_table
from fem_impact.tables.markdown import table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["summary_markdown", "text_table", "work_precision", "write_cost"]


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


def write_cost(cost: CostStudy, out: Path, names: tuple[str, ...]) -> None:
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


def text_table(cost: CostStudy, names: Sequence[str] = NAMES) -> str:
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


LOOKS = {
    "rigid": ("rigid", "s", "purple"),
    "modal": ("modal", "D", "orange"),
    "mesh": ("one mesh", "o", "blue"),
    "pair": ("two meshes, extrapolated", "^", "green"),
    "numerics": ("other elements or step", "x", "vermilion"),
}
"""Words, marker and colour of each kind of setting."""


def work_precision(settings: Sequence[Judged], names: Sequence[str], path: Path) -> None:
    """Draw relative error against CPU time, both logarithmic, of some quantities."""
    rows = (len(names) + 1) // 2
    with figure(path, "wide", 0.6 + 2.7 * rows) as drawn:
        panels = drawn.subplots(rows, min(2, len(names)), squeeze=False, sharex=True).ravel()
        for panel, name in zip(panels, names, strict=False):
            _panel(panel, [one for one in settings if one.error[name] and one.kind in LOOKS], name)
        for panel in panels[len(names) :]:
            panel.set_visible(False)
        drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(LOOKS) + 1)


def _panel(axes: Axes, settings: Sequence[Judged], name: str) -> None:
    best = front(settings, [name])
    axes.plot(*_points(best, name), color=QUIET, label="no other beats it")
    for kind, (words, marker, colour) in LOOKS.items():
        of = [one for one in settings if one.kind == kind]
        axes.plot(*_points(of, name), marker, color=PALETTE[colour], label=words, markersize=5)
    axes.set(title=name, xscale="log", yscale="log", xlabel="CPU time, s", ylabel="error, %")
    axes.tick_params(labelbottom=True)  # though panels share their x axis: one may have none below it
    _plain(axes)
    axes.grid(alpha=0.5)


def _plain(axes: Axes) -> None:
    """Write plain numbers at the ticks, and within one decade at round steps instead of powers of ten."""
    from matplotlib.ticker import MaxNLocator, NullFormatter

    low, high = axes.get_ylim()
    if high < 10 * low:
        axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def _points(settings: Sequence[Judged], name: str) -> tuple[list[float], list[float]]:
    return [one.cpu_s for one in settings], [100 * (one.error[name] or 0.0) for one in settings]


WANTED = 0.02
Scenes = dict[str, tuple[dict[str, Any], list[Judged]]]  # limits of the quantities, and settings


def summary_markdown(document: dict[str, Any]) -> str:
    """Return two tables of one row a scene: what its best pair of meshes gives, and what every setting costs.

    A cell of the second reads: errors of the targeted quantities with their scatter in per cent, CPU time
    in s.
    """
    scenes = {
        name: (cost["quantities"], [Judged(**setting) for setting in cost["settings"]])
        for name, cost in document["scenes"].items()
    }
    columns = _columns([settings for _, settings in scenes.values()])
    head = ["set", *(f"{name}, limit" for name in TARGETED), *columns]
    body = [
        [name, *_limits(q), *(_markdown_cell(s, column) for column in columns)]
        for name, (q, s) in scenes.items()
    ]
    machine = document["machine"]
    note = (
        f"Measured {document['created_utc'][:10]}, CPU times in s on a machine with a triad of "
        f"{machine['triad_GB_per_s']:.3g} GB/s and a CSR product of "
        f"{machine['csr_ns_per_element_step']:.3g} ns an element-step."
    )
    return f"{_pairs(scenes)}\n\n{table(head, body)}\n\n{note}\n"


def _pairs(scenes: Scenes) -> str:
    """Return the table of each scene's best pair for each quantity, and how many meet `WANTED`."""
    ran = {
        scene: (q, settings) for scene, (q, settings) in scenes.items() if any(one.band for one in settings)
    }
    columns = [[_best(name, *of) for of in ran.values()] for name in TARGETED]
    head = ["set", *(words for name in TARGETED for words in (name, "% (scatter)", "meshes, mm", "off", "s"))]
    body = [
        [scene, *(cell for told, _ in row for cell in told)]
        for scene, *row in zip(ran, *columns, strict=True)
    ]
    words = " and ".join(
        f"{name} in {sum(met for _, met in column)}" for name, column in zip(TARGETED, columns, strict=True)
    )
    return f"{table(head, body)}\n\nTo {100 * WANTED:g} % by its own band: {words} of {len(ran)} sets."


def _best(name: str, quantities: dict[str, Any], settings: list[Judged]) -> tuple[list[str], bool]:
    """Return cells of the best pair for a quantity, and whether it meets `WANTED`: then its band is bold."""
    pair = best_pair(settings, (name,), WANTED)
    assert pair is not None  # scenes without a pair are left out
    limit, scale = quantities[name], quantities[name]["scale"]
    both = pair.band[name] * scale + limit["uncertainty"]
    off = abs((pair.value[name] or 0.0) - limit["limit"]) / both if both else 0.0
    found = f"{pair.value[name] or 0.0:.4f} ± {pair.band[name] * scale:.4f}"
    met = pair.band[name] <= WANTED
    band = f"**{_percent(pair.band[name])}**" if met else _percent(pair.band[name])
    sizes = pair.name.removeprefix("solid ").removesuffix(" mm extrapolated")
    scatter = f"({_percent(pair.scatter[name])})"
    return [found, f"{band} {scatter}", sizes, f"{off:.1f}", f"{pair.two_cores_s:.3g}"], met


def _columns(groups: list[list[Judged]]) -> list[str]:
    """Return names of settings from cheap to dear, without pairs and those that leave an effect out."""
    kinds = ("rigid", "modal", "mesh", "numerics")
    named = {one.name: one for settings in groups for one in settings if one.kind in kinds}
    return sorted(named, key=lambda name: (kinds.index(named[name].kind), -(named[name].tip_size_m or 0)))


def _limits(quantities: dict[str, Any]) -> list[str]:
    return [f"{quantities[name]['limit']:.3g} ± {quantities[name]['uncertainty']:.1g}" for name in TARGETED]


def _markdown_cell(settings: list[Judged], name: str) -> str:
    found = [one for one in settings if one.name == name]
    if not found:
        return ""
    words = " / ".join(_off(found[0], quantity) for quantity in TARGETED)
    return f"{words}, {found[0].cpu_s:.2g} s"


def _off(setting: Judged, quantity: str) -> str:
    """Return the error, and the scatter that is known."""
    error, scatter = setting.error[quantity], setting.scatter.get(quantity)
    words = "-" if error is None else _percent(error)
    return words if scatter is None else f"{words} ± {_percent(scatter)}"


def _percent(error: float) -> str:
    return f"{100 * error:.2g}" if error < 0.995 else f"{100 * error:.0f}"
