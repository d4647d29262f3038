"""The inputs of a scene: every value that enters a model, with where it comes from."""

from dataclasses import MISSING, fields
from math import inf
from typing import Any

from fem_impact.scene.library import CHANGED, materials, melting_of, source_of
from fem_impact.scene.material import Material
from fem_impact.scene.types import Scene, material_table, to_dict
from fem_impact.tables.table import Table
from fem_impact.tables.text import plain

STATED = "the scene"
DEFAULT = "the default"
"""Source of a value that a scene need not state, and that it does not state otherwise."""
UNSOURCED = "no source stated"
WORDS = ("name", "law", "family", "sources")  # of a material
MOST_POINTS = 6  # of a profile, a bore or a curve that is written out; longer ones stand in the scene


def inputs(scene: Scene) -> Table:
    """Return the table of inputs of projectile, barrier, impact and surface.

    Columns: ``input``, the dotted key as `replace` takes it (a part of a list by its number, from 1);
    ``value`` with its unit; ``source``, `STATED` or `DEFAULT` for values that no shipped table holds.
    """
    tables, surface = to_dict(scene), scene.surface
    rows = list[tuple[str, str, str]]()
    for name in ("projectile", "barrier", "impact"):
        part = getattr(scene, name)
        kept = {
            f"{name}.{field.name}"
            for field in fields(part)
            if field.default is not MISSING and getattr(part, field.name) == field.default
        }
        stated = _rows(name, tables[name])
        rows += [(key, value, DEFAULT if key in kept else source) for key, value, source in stated]
    low, high = surface.friction_low, surface.friction_high
    friction = f"{surface.friction:g} ({low:g} to {high:g})" if low < high else f"{surface.friction:g}"
    rows.append(("surface.friction", friction, surface.source))
    if law := surface.sliding_law:
        ends = f"times {law.factor[0]:g} at rest, times {law.factor[-1]:g} at {law.speed[-1]:g} m/s and more"
        rows.append(("surface.sliding_law", f"{law.name} {ends}".strip(), law.source))
    for body, (name, limit) in melting(scene).items():
        own = getattr(scene.heating, f"{body}_melting") is None
        rows += [(f"heating.{body}_melting", f"{limit:g} K", source_of(name, "melting") if own else STATED)]
    return Table.of(("input", "value", "source"), rows, left=range(3))


def _source(material: dict[str, Any], key: str) -> str:
    """Return where a value of a material is from: as stated, or as shipped where it still is that value."""
    if key in WORDS:
        return STATED
    shipped = materials().get(material["name"].removesuffix(CHANGED))
    if shipped and material_table(shipped).get(key) == material[key]:
        return material.get("sources", {}).get(key) or source_of(shipped.name, key)
    return str(material.get("sources", {}).get(key, UNSOURCED))


def melting(scene: Scene) -> dict[str, tuple[str, float]]:
    """Return name and temperature, K, at which rod and barrier begin to melt, of those where it is known."""
    metals = {"rod": scene.projectile.material.name, "barrier": scene.barrier.struck.name}
    stated = {body: getattr(scene.heating, f"{body}_melting") for body in metals}
    found = {body: stated[body] or melting_of(name) for body, name in metals.items()}
    return {body: (metals[body].removesuffix(CHANGED), limit) for body, limit in found.items() if limit}


def first_melting(scene: Scene) -> tuple[float, str]:
    """Return the lowest known melting point, K, and its metal's name; infinite where none is known."""
    return min(((limit, name) for name, limit in melting(scene).values()), default=(inf, ""))


def materials_of(scene: Scene) -> dict[str, Material]:
    """Return every material of a scene by the dotted key of its section."""
    rod, barrier = scene.projectile, scene.barrier
    parts = {f"projectile.segments[{at}].material": part.material for at, part in enumerate(rod.segments, 1)}
    regions = {f"projectile.mesh_materials.{one.name}": one.material for one in rod.regions}
    layers = {f"barrier.layers[{at}].material": part.material for at, part in enumerate(barrier.layers, 1)}
    return {
        **(parts or {"projectile.material": rod.material}),
        **regions,
        **layers,
        "barrier.material": barrier.material,
    }


def _rows(key: str, value: Any, source: str = STATED) -> list[tuple[str, str, str]]:
    """Return (input, value, source) of each value below a key; laws and a skin are one value each."""
    if isinstance(value, dict) and key.endswith((".rate", ".flow", ".skin")):
        return [(key, ", ".join(f"{name} {_words(part)}" for name, part in value.items()), source)]
    if isinstance(value, dict):
        # a section with a density is a material, of which only the numbers have a source
        sources = {name: _source(value, name) if "rho" in value else STATED for name in value}
        return [
            row
            for name, part in value.items()
            if name != "sources"
            for row in _rows(f"{key}.{name}", part, sources[name])
        ]
    if value and isinstance(value, list) and isinstance(value[0], dict):
        return [row for number, part in enumerate(value, 1) for row in _rows(f"{key}[{number}]", part)]
    return [(key, rounded_text(_words(value)), source)]


def _words(value: Any) -> str:
    """Return a value as text: few points of an outline or a curve as ordinates at places."""
    if not isinstance(value, list):
        return ("yes" if value else "no") if isinstance(value, bool) else str(value)
    if len(value) > MOST_POINTS:
        return f"{len(value)} points"
    parts = (
        f"{one[1]} at {one[0]}" if isinstance(one, list) and len(one) == 2 else str(one) for one in value
    )
    return ", ".join(parts)


def rounded_text(value: str, digits: int = 10) -> str:
    """Return a value whose number is long in so many digits: the scene keeps all, the rest is of its unit.

    Examples
    --------
    >>> rounded_text("6.283185307179586 rad/s", 4), rounded_text("33.333 deg", 4), rounded_text("rest")
    ('6.283 rad/s', '33.333 deg', 'rest')
    """
    number, blank, unit = value.partition(" ")
    try:
        return f"{plain(float(number), digits)}{blank}{unit}" if len(number) > 12 else value
    except ValueError:
        return value
