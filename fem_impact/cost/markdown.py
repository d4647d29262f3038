"""The stored costs as a table for README."""

from __future__ import annotations

from typing import Any

from fem_impact.cost.judge import Judged
from fem_impact.cost.pairs import best_pair, verdict
from fem_impact.cost.quantities import TARGETED
from fem_impact.study.markdown import table

__all__ = ["summary_markdown"]

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
    body = [[name, *_limits(q), *(_cell(s, column) for column in columns)] for name, (q, s) in scenes.items()]
    machine = document["machine"]
    note = (
        f"Measured {document['created_utc'][:10]}, CPU times in s on a machine with a triad of "
        f"{machine['triad_GB_per_s']:.3g} GB/s and a CSR product of "
        f"{machine['csr_ns_per_element_step']:.3g} ns an element-step."
    )
    return f"{_pairs(scenes)}\n\n{table(head, body)}\n\n{note}\n"


def _pairs(scenes: Scenes) -> str:
    """Return the table of the best pair of each scene, and how many meet `WANTED`."""
    found = {name: best_pair(settings, TARGETED, WANTED) for name, (_, settings) in scenes.items()}
    rows = [(name, scenes[name][0], pair) for name, pair in found.items() if pair]
    head = ["set", "meshes, mm", *TARGETED, "off the limit, of both bands", "s on two cores"]
    body = [[name, _sizes(pair), *_verdicts(q, pair), f"{pair.two_cores_s:.3g}"] for name, q, pair in rows]
    met = {name: sum(pair.band[name] <= WANTED for *_, pair in rows) for name in TARGETED}
    words = " and ".join(f"{name} in {count}" for name, count in met.items())
    return f"{table(head, body)}\n\nTo {100 * WANTED:g} % by its own band: {words} of {len(rows)} sets."


def _sizes(pair: Judged) -> str:
    return pair.name.removeprefix("solid ").removesuffix(" mm extrapolated")


def _verdicts(quantities: dict[str, Any], pair: Judged) -> list[str]:
    told = [verdict(pair, quantities, name, WANTED) for name in TARGETED]
    away = [abs((pair.value[name] or 0.0) - quantities[name]["limit"]) for name in TARGETED]
    both = [
        pair.band[name] * quantities[name]["scale"] + quantities[name]["uncertainty"] for name in TARGETED
    ]
    shares = [f"{gap / band:.1f}" if band else "-" for gap, band in zip(away, both, strict=True)]
    return [*told, " / ".join(shares)]


def _columns(groups: list[list[Judged]]) -> list[str]:
    """Return names of settings from cheap to dear, without pairs and those that leave an effect out."""
    kinds = ("rigid", "modal", "mesh", "numerics")
    named = {one.name: one for settings in groups for one in settings if one.kind in kinds}
    return sorted(named, key=lambda name: (kinds.index(named[name].kind), -(named[name].tip_size_m or 0)))


def _limits(quantities: dict[str, Any]) -> list[str]:
    return [f"{quantities[name]['limit']:.3g} ± {quantities[name]['uncertainty']:.1g}" for name in TARGETED]


def _cell(settings: list[Judged], name: str) -> str:
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
