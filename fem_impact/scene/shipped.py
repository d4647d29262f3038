"""Scenes by id or from a file, and copies of them with changed values."""

import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

from fem_impact.errors import SceneError, UsageError, did_you_mean
from fem_impact.scene import fields
from fem_impact.scene.impact import FIRST, one_way, restated
from fem_impact.scene.library import CHANGED, material, nearest_scene, own_name, shipped, stated
from fem_impact.scene.material import JohnsonCookRate, Material, tested_at
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.read import read_dict, read_scene, read_tables, read_toml
from fem_impact.scene.shapes import BY_LENGTH, NEEDS, REPLACED, SIZES, TIP
from fem_impact.scene.types import OWN, Scene, material_table, to_dict
from fem_impact.scene.units import DIMENSIONS, parse_quantity


def load(id_or_path: str | Path | Mapping[str, Any]) -> Scene:
    """Return a shipped scene by its id, or read a scene from a file or from a table with a file's keys.

    Numbers and arrays of numpy may stand in the table, and paths of mesh files as `Path`; a path that is not
    absolute counts from the working folder.

    Raises
    ------
    UsageError
        For an unknown id or a missing file.
    SceneError
        For any mistake in the file or table.

    Examples
    --------
    >>> load("t5b").projectile.length
    0.08
    """
    if isinstance(id_or_path, Mapping):
        return read_dict(plain_value(id_or_path), "scene")
    name = os.fspath(id_or_path)
    if name in shipped():
        return _shipped(name)
    if not (name.endswith(".toml") or "/" in name or os.sep in name or os.path.lexists(name)):
        raise UsageError(
            "is neither a shipped scene nor a file.", key="scene", value=name, remedy=nearest_scene(name)
        )
    return read_toml(Path(name))


def load_to_change(id_or_path: str | Path, changes: Mapping[str, Any]) -> Scene:
    """Return a scene that is to be changed; what a change replaces in its file is not refused.

    Raises
    ------
    UsageError, SceneError
        As `load`, for what the changes do not mend.
    """
    try:
        return load(id_or_path)
    except SceneError:
        if not changes:
            raise
    path = Path(id_or_path)
    data = read_tables(path)
    for key, value in _ordered(changes):
        with suppress(SceneError):  # what stands in no table of the file is told when it is changed
            _change(data, key, value)
    if isinstance(data.get("impact"), dict):
        data["impact"] = one_way(data["impact"], moved(changes))
    return read_dict(data, f"{path} with --set")


@cache
def _shipped(name: str) -> Scene:
    return read_dict(stated(name), f"shipped scene {name}")


LENGTH = {"projectile.length", "projectile.length_m"}
SETS = ["mesh_materials"], ["mesh_surfaces"]
"""Ends of the paths of tables whose keys are names in a mesh file, whatever they end with."""
BODIES = ("projectile", "impact", "barrier")
TITLED = (*BODIES, "surface")
"""Tables of which a title tells the changes."""
PAIR = ("friction", "friction_low", "friction_high", "source")
_CHANGED = ", changed: "
_LONGEST = 300  # characters of a title
# longest first: "_rad_per_s" before "_s"
_SUFFIXES = sorted((f"_{dimension.suffix}" for dimension in DIMENSIONS.values()), key=len, reverse=True)


def replace(scene: Scene, key: str, value: Any) -> Scene:
    """Return a checked copy of the scene with one dotted key changed; see `replace_all`.

    Examples
    --------
    >>> replace(load("t5b"), "projectile.length", "120 mm").projectile.length
    0.12
    """
    return replace_all(scene, {key: value})


def replace_all(scene: Scene, changes: Mapping[str, Any], source: str = "") -> Scene:
    """Return a checked copy of the scene with dotted keys changed, checked together at the end.

    A new angle leaves a fall a fall, see `restated`. A changed friction makes the surface custom, a changed
    property renames its material, and with a changed rod, impact or surface state, or a material of another
    name, the scene is not a measured set, which the title says: a name never stands for other values.
    Friction, values of materials, effects and accuracy are the model's side and leave ``measured`` as it is.
    The surface of a pair of materials follows changed bodies. A value may be a path or a number or array of
    numpy. ``source`` is named in every message.

    Raises
    ------
    SceneError
        A key is none of a scene, a change takes out what another one states, or the scene is refused.
    """
    try:
        return read_scene(_changed(scene, changes))
    except SceneError as error:
        raise error.under("", source) from None


def _changed(scene: Scene, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of a scene with its changes, and with what follows from them."""
    data = to_dict(scene)
    for key, value in _ordered(changes):
        _change(data, key, plain_value(value))
    for key, value in changes.items():
        there = value_at(data, key)
        if there != value if key == "surface.state" else there is None and value is not None:
            problem = "is taken out again by another change of the same call."
            raise SceneError(problem, key=key, remedy="Keep one of the two.")
    if any(_is_another_impact(scene, key, value) for key, value in changes.items()):
        measured = "" if changes.get("measured") else data.pop("measured", "")
        if "title" not in changes and (measured or _CHANGED in data["title"]):
            published = measured and not measured.endswith(OWN)
            data["title"] = titled(measured if published else data["title"], changes)
    for body, metal in scene.materials.items():
        _follow_flow(data, f"{body}.material", metal, changes)
    bodies_changed = {key.partition(".")[0] for key in changes} & {"projectile", "barrier"}
    if bodies_changed and not changes.keys() & {"surface", *(f"surface.{key}" for key in PAIR)}:
        if data["surface"]["state"] == "pair":  # the surface of a pair of materials follows from them
            for key in PAIR:
                data["surface"].pop(key, None)
    if changes.get("impact.until") == FIRST and not any(key.startswith("strikes") for key in changes):
        data.pop("strikes", None)  # it says how a body is followed
    if new := moved(changes):
        data["impact"] = restated(scene.impact, data["impact"], new)
    if any(key.startswith("projectile.") for key in changes) and "projectile.segments" not in changes:
        segments = data["projectile"].get("segments") if isinstance(data["projectile"], dict) else None
        if segments:
            segments[-1].pop("to", None)  # the last one follows the tail
    if LENGTH & changes.keys() and "projectile.bore" not in changes:
        _open_at_tail(data["projectile"], scene.projectile)
    return data


def _follow_flow(data: dict[str, Any], place: str, metal: Material, changes: Mapping[str, Any]) -> None:
    """Let the rate of the tests of a metal that states none of its own follow its changed flow curve."""
    rate, own = value_at(data, f"{place}.rate"), metal.rate
    changed = (
        any(key.startswith(f"{place}.flow") for key in changes) and f"{place}.rate.tested" not in changes
    )
    if changed and isinstance(rate, dict) and isinstance(own, JohnsonCookRate):
        if own.tested == tested_at(metal.flow, own.reference):
            rate.pop("tested", None)


def named(value: Any) -> str:
    """Return a stated value as a text; a table that has a name, such as a material, is told by it.

    A number is the same text however it is written: 0, 0.0.
    """
    if isinstance(value, float):
        return f"{value:.12g}"
    return str(value.get("name", value)) if isinstance(value, Mapping) else str(value)


def plain_value(value: Any) -> Any:
    """Return a value as a scene's file holds it: paths as texts, numbers and arrays of numpy as Python's."""
    if isinstance(value, Mapping):
        return {key: plain_value(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain_value(part) for part in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def _ordered(changes: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Return changes in an order that their own does not matter to: tables first, then what gives others.

    A law or a state takes out the numbers of the old one, a friction its interval; a source and a name are
    given anew with changed numbers.
    """
    ranks = {"state": 0, "law": 0, "tip": 1, "friction": 1, "source": 3, "name": 3}

    def place(change: tuple[str, Any]) -> tuple[int, int]:
        *path, last = change[0].split(".")
        return len(path), ranks.get(last, 2)

    return sorted(changes.items(), key=place)


def value_at(data: Mapping[str, Any], key: str) -> Any:
    """Return the value of a dotted key in the tables of a scene, None where it has none."""
    value: Any = data
    for name in key.split("."):
        value = value.get(name) if isinstance(value, Mapping) else None
    return value


def alters(scene: Scene, key: str, value: Any, other: str) -> bool:
    """Return whether a changed key alters the value of another one, as a friction does its interval."""
    data = to_dict(scene)
    before = value_at(data, bare(other))
    _change(data, key, plain_value(value))
    return bool(value_at(data, bare(other)) != before)


def moved(changes: Iterable[str]) -> set[str]:
    """Return the keys of the impact that are changed, without units."""
    return {bare(key.removeprefix("impact.")) for key in changes if key.startswith("impact.")}


def _open_at_tail(rod: Any, was: ProjectileSpec) -> None:
    """Let a bore that is open at the tail follow it; one with another point behind the new tail stays."""
    bore = rod.get("bore")
    if not bore or not was.open_at_tail:
        return
    stated = rod.get("length", f"{rod.get('length_m')} m")
    if parse_quantity(stated, "length", "projectile.length") > was.bore[-2][0]:
        rod["bore"] = [*bore[:-1], [stated, bore[-1][1]]]


def _change(data: dict[str, Any], key: str, value: Any) -> None:
    *path, last = key.split(".")
    if path[-2:] in (["material", "rate"], ["material", "flow"], ["material", "skin"]):
        metal = _section(data, path[:-1], key)
        if last == "law" or path[-1] not in metal:
            metal[path[-1]] = {}  # another law leaves none of the old one's numbers
    if not path and last not in data:
        # refuse a key without its section that one of a section comes near to, such as ``lenght``
        sections = ((name, table) for name, table in data.items() if isinstance(table, dict))
        whole = {inner: f"{name}.{inner}" for name, table in sections for inner in table}
        near = get_close_matches(key, whole, 1, 0.8)
        if near:
            remedy = f"Did you mean {whole[near[0]]}?"
            raise SceneError("is not a key of a scene.", key=key, remedy=remedy)
    table = _section(data, path, key)
    for other in _replaced(table, path, last, value):
        table.pop(other, None)
    table[last] = value
    if path == ["surface"] and last.startswith("friction"):  # the name of a state stands for no other values
        table |= {"state": "custom", "source": "set by the user"}
        if last == "friction":
            table |= {"friction_low": value, "friction_high": value}
    if "material" in path and last != "name":
        metal = _section(data, path[: path.index("material") + 1], key)
        metal["name"] = f"{metal['name'].removesuffix(CHANGED)}{CHANGED}"
    if path == ["accuracy"]:
        mesh = [key for key in table if key.removesuffix("_m") in fields.MESH]
        for other in mesh if last == "target" else ["target"] if last in mesh else []:
            table.pop(other, None)  # a mesh replaces a target, and a target a mesh


def _replaced(table: Mapping[str, Any], path: list[str], last: str, value: Any) -> list[str]:
    """Return the keys of a table that a new value takes the place of."""
    # an SI key replaces the key with a unit, and the other way round: ``length_m`` and ``length``
    same = [key for key in table if bare(key) == bare(last) and path[-1:] not in SETS]
    if path == ["surface"] and last == "state" and value != table.get("state"):
        return [*same, *PAIR]
    if path != ["projectile"]:
        return same
    if bare(last) in (BY_LENGTH, *REPLACED):  # one of them states the form of a nose
        return [*same, *({BY_LENGTH, *REPLACED} - {bare(last)})]
    if bare(last) == "inner_diameter":
        return [*same, "bore"]  # it states the bore
    if last == "tip" and value == "plain":
        return [*same, *TIP[1:]]  # it has no radius
    if last == "shape":  # it has its own tip and sizes
        unneeded = {size.key for size in SIZES} - {*NEEDS[value], BY_LENGTH} if str(value) in NEEDS else ()
        return [*same, *TIP, *(key for key in table if bare(key) in unneeded)]
    return same


def bare(key: str) -> str:
    """Return a key without the suffix of its SI unit."""
    return next((key.removesuffix(suffix) for suffix in _SUFFIXES if key.endswith(suffix)), key)


def _is_another_impact(scene: Scene, key: str, value: Any) -> bool:
    body, *names = key.split(".")
    if body not in BODIES or len(names) > 1:
        return key == "surface.state"
    stated = {names[0]: value} if names else value  # a whole table states several
    if not isinstance(stated, Mapping) or not {*stated} <= {"material", "boundary"}:
        return True
    if "material" not in stated or body == "impact":
        return False
    name = named(stated["material"])
    return (own_name(name) or name) != scene.materials[body].name.removesuffix(CHANGED)


def titled(title: str, changes: Mapping[str, Any]) -> str:
    """Return a title that tells changed values of bodies, surface and impact, after those that it tells."""
    told = ", ".join(
        f"another {key}" if isinstance(value, Mapping) and "name" not in value else f"{key} = {named(value)}"
        for key, value in changes.items()
        if key.split(".")[0] in TITLED
    )
    if not told:
        return title
    return f"{title}{', ' if _CHANGED in title else _CHANGED}{told}"[:_LONGEST]


def _section(data: dict[str, Any], path: list[str], key: str) -> dict[str, Any]:
    table = data
    for name in path:
        if name == "strikes" and table is data:  # scenes that state nothing of it are written without it
            table.setdefault(name, {})
        inner = table.get(name)
        if name == "accuracy" and isinstance(inner, str):
            remedy = "Give the error that is allowed, or a mesh, not both."
            raise SceneError(f"stands beside accuracy = {inner!r}.", key=key, remedy=remedy)
        if name == "material" and isinstance(inner, str):  # of a shipped one its values
            try:
                inner = table[name] = material_table(material(inner))
            except SceneError as error:
                raise error.under(f"{key.partition('.material')[0]}.material") from None
        if not isinstance(inner, dict):
            sections = [k for k, v in table.items() if isinstance(v, Mapping)]
            hint = did_you_mean(name, sections, "Write section.key, such as accuracy.tip_size.")
            raise SceneError("is not a key of a scene.", key=key, remedy=hint)
        table = inner
    return table
