"""Twelve bodies unlike the rods of the paper, each at five angles; speed and friction are drawn."""

from collections.abc import Sequence
from typing import Any

from fem_impact.evidence.data import read_stated
from fem_impact.evidence.studies.coverage.families import Projectile, metres


def _points(points: Sequence[Sequence[float]]) -> list[list[str]]:
    """Return points (z, r), mm, as in a scene's file."""
    return [[metres(1e-3 * z), metres(1e-3 * r)] for z, r in points]


def _body(stated: dict[str, Any]) -> Projectile:
    """Return a body from its table of data/twelve.toml."""
    if "mesh" in stated:
        sizes = {name: 1e-3 * size for name, size in stated["sizes"].items()}
        return Projectile(sizes["length"], sizes["width"], 0.8, body=stated["mesh"], sizes=sizes)
    keys = stated.get("keys") or {"profile": _points(stated["profile"])}
    if hole := stated.get("hole"):
        keys["bore"] = _points([(0.0, hole), (stated["length"], hole)])
    return Projectile(1e-3 * stated["length"], 1e-3 * stated["diameter"], stated["filled"], keys)


TWELVE = {
    name: (_body(stated), tuple(stated["angles"]))
    for name, stated in read_stated("studies/data/twelve.toml").items()
}
"""Bodies by name, and the angles, deg, at which each strikes."""
