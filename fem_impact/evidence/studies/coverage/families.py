"""Families of projectiles whose sizes are drawn at random, and twelve bodies, each at five angles."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from fem_impact.evidence.data import read_stated
from fem_impact.evidence.studies.coverage.bodies import BODIES

Tables = dict[str, Any]
"""Tables of a scene, as in its file."""
Values = Mapping[str, float]
"""Drawn numbers by name: ``diameter``, m, and ``slenderness``, ``first`` and ``second``, shares of ranges."""


@dataclass(frozen=True, slots=True)
class DrawnProjectile:
    """A projectile without its material.

    Attributes
    ----------
    length, diameter : m
    filled : share of the cylinder of that length and diameter that is filled, about
    tables : of its shape, as in a scene's file; none of a mesh
    body, sizes : name and sizes, m, of one of `BODIES`; empty of a body of revolution
    """

    length: float
    diameter: float
    filled: float = 1.0
    tables: Tables = field(default_factory=dict)
    body: str = ""
    sizes: Mapping[str, float] = field(default_factory=dict)


def metres(value: float) -> str:
    """Return a length as in a scene's file."""
    return f"{value:.6g} m"


def between(share: float, low: float, high: float) -> float:
    """Return the number that lies so far from one end to the other."""
    return low + (high - low) * share


def _sized(values: Values, least: float, most: float) -> tuple[float, float]:
    """Return length and diameter, m, with a slenderness between two ends."""
    diameter = values["diameter"]
    return diameter * between(values["slenderness"], least, most), diameter


def _turned(length: float, width: float, filled: float, /, **shape: Any) -> DrawnProjectile:
    return DrawnProjectile(length, width, filled, {"length": metres(length), **shape})


def _tip(length: float, diameter: float, tip: str, radius: float) -> DrawnProjectile:
    return _turned(length, diameter, 1.0, diameter=metres(diameter), tip=tip, tip_radius=metres(radius))


def _rounded_edge(values: Values) -> DrawnProjectile:
    length, diameter = _sized(values, 2.0, 8.0)
    return _tip(length, diameter, "B", between(values["first"], 0.05, 0.9) * diameter / 2)


def _round_nose(values: Values) -> DrawnProjectile:
    length, diameter = _sized(values, 2.0, 8.0)
    return _tip(length, diameter, "A", between(values["first"], 0.3, 1.0) * diameter / 2)


def _sharp(values: Values) -> DrawnProjectile:
    return _tip(*_sized(values, 2.0, 8.0), "plain", 0.0)


def _flat_pin(values: Values) -> DrawnProjectile:
    return _tip(*_sized(values, 0.5, 2.0), "plain", 0.0)


def _tube(values: Values) -> DrawnProjectile:
    length, diameter = _sized(values, 1.5, 6.0)
    wall = between(values["first"], 0.12, 0.3) * diameter
    edge = between(values["second"], 0.1, 0.4) * wall
    inner = diameter / 2 - wall
    return _turned(
        length,
        diameter,
        1.0 - (2 * inner / diameter) ** 2,
        diameter=metres(diameter),
        tip="B",
        tip_radius=metres(edge),
        bore=[[metres(at), metres(inner)] for at in (0.0, length)],
    )


def _profile(diameter: float, filled: float, *points: tuple[float, float]) -> DrawnProjectile:
    """Return a turned body with straight lines between points (z, r), m."""
    profile = [[metres(z), metres(r)] for z, r in points]
    return DrawnProjectile(points[-1][0], diameter, filled, {"profile": profile})


def _stepped(values: Values) -> DrawnProjectile:
    length, diameter = _sized(values, 2.0, 6.0)
    thin, step = between(values["first"], 0.4, 0.8), between(values["second"], 0.2, 0.6) * length
    r = diameter / 2
    points = (0.0, thin * r), (step, thin * r), (step + 0.1 * length, r), (length, r)
    return _profile(diameter, 0.8, *points)


def _tapered(values: Values) -> DrawnProjectile:
    length, diameter = _sized(values, 1.5, 6.0)
    tip = between(values["first"], 0.3, 0.9)
    return _profile(diameter, (1 + tip + tip**2) / 3, (0.0, tip * diameter / 2), (length, diameter / 2))


def _nosed(values: Values) -> DrawnProjectile:
    """Return an ogive or a blunt cone."""
    length, diameter = _sized(values, 2.5, 6.0)
    sphere = between(values["second"] * 2 % 1.0, 0.15, 0.6) * diameter / 2
    sizes = {"diameter": metres(diameter), "nose_radius": metres(sphere)}
    if values["second"] < 0.5:
        return _turned(
            length, diameter, 0.8, shape="ogive", calibre_radius=between(values["first"], 0.7, 3.0), **sizes
        )
    angle = f"{between(values['first'], 20.0, 70.0):.6g} deg"
    return _turned(length, diameter, 0.8, shape="sphere-cone", cone_angle=angle, **sizes)


def _disc(values: Values) -> DrawnProjectile:
    """Return a disc, or a ring where the first share is above a half; twice as wide as other projectiles."""
    length, diameter = (2.0 * size for size in _sized(values, 0.1, 0.35))
    hole = between(values["first"] * 2 % 1.0, 0.3, 0.7) if values["first"] > 0.5 else 0.0
    bore = {"bore": [[metres(at), metres(hole * diameter / 2)] for at in (0.0, length)]} if hole else {}
    return _turned(length, diameter, 1.0 - hole**2, diameter=metres(diameter), tip="plain", **bore)


def _own_mesh(values: Values) -> DrawnProjectile:
    """Return one of `BODIES`, as the first share says."""
    length, width = _sized(values, 1.5, 6.0)
    sizes = {
        "width": width,
        "length": length,
        "thickness": between(values["second"], 0.15, 0.5) * width,
        "bend": between(values["second"], -0.15, 0.15) * length,
        "share": between(values["second"], 0.4, 0.8),
    }
    body = [*BODIES][int(values["first"] * len(BODIES))]
    return DrawnProjectile(length, width, 0.8, body=body, sizes=sizes)


FAMILIES: Mapping[str, Callable[[Values], DrawnProjectile]] = {
    "rounded edge": _rounded_edge,
    "round nose": _round_nose,
    "sharp edge": _sharp,
    "tube": _tube,
    "stepped": _stepped,
    "tapered": _tapered,
    "nosed": _nosed,
    "flat pin": _flat_pin,
    "disc, ring": _disc,
    "own mesh": _own_mesh,
}
"""Functions of drawn numbers to a projectile."""


def _points(points: Sequence[Sequence[float]]) -> list[list[str]]:
    """Return points (z, r), mm, as in a scene's file."""
    return [[metres(1e-3 * z), metres(1e-3 * r)] for z, r in points]


def _body(stated: dict[str, Any]) -> DrawnProjectile:
    """Return a body from its table of data/twelve.toml."""
    if "mesh" in stated:
        sizes = {name: 1e-3 * size for name, size in stated["sizes"].items()}
        return DrawnProjectile(sizes["length"], sizes["width"], 0.8, body=stated["mesh"], sizes=sizes)
    keys = stated.get("keys") or {"profile": _points(stated["profile"])}
    if hole := stated.get("hole"):
        keys["bore"] = _points([(0.0, hole), (stated["length"], hole)])
    return DrawnProjectile(1e-3 * stated["length"], 1e-3 * stated["diameter"], stated["filled"], keys)


TWELVE = {
    name: (_body(stated), tuple(stated["angles"]))
    for name, stated in read_stated("studies/data/twelve.toml").items()
}
"""Bodies by name, and the angles, deg, at which each strikes."""
