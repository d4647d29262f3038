"""The stored costs as a table for README."""

from __future__ import annotations

from typing import Any

from fem_impact.cost.judge import Judged
from fem_impact.cost.pairs import best_pair
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
