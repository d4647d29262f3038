"""From a scene file, or the same tables in Python, to a checked `Scene`."""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache, partial
from math import inf
from pathlib import Path
from typing import Any

from fem_impact.errors import ResultError, SceneError, UsageError
from fem_impact.scene import curve, fields, library, own_mesh, shapes, tables, types
from fem_impact.scene.barrier import Barrier, Layer
from fem_impact.scene.impact import NUMBERS, WAYS, Following, Impact, the_way
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.measured import differing
from fem_impact.scene.projectile import Face, ProjectileSpec, Region, Segment
from fem_impact.scene.surface_table import of_known, pair_surface, read_surface
from fem_impact.scene.units import parse_number, parse_quantity, parse_share

_LARGEST_FILE = 1_000_000
_TOML = 'A scene is a TOML file: key = value lines under [section] headings, text in "quotes".'


def read_toml(path: str | Path) -> types.Scene:
    """Read one scene file."""
    return read_dict(read_tables(Path(path)), str(path))


def read_tables(path: Path) -> dict[str, Any]:
    """Return the tables of a scene file unchecked, with its own files found from its place."""
    data: dict[str, Any] = curve.beside(_load(path), path.parent)
    tests, rod = data.get("measured"), data.get("projectile")
    if isinstance(tests, str) and tests.endswith(types.OWN):
        data["measured"] = str((path.parent / tests).resolve())
    if isinstance(rod, dict) and isinstance(rod.get("mesh"), str):
        rod["mesh"] = str((path.parent / rod["mesh"]).resolve())
    if isinstance(rod, dict) and isinstance(rod.get("profile"), str):  # the points of its file take its place
        try:
            points = shapes.read_points(path.parent / rod["profile"])
        except ResultError as error:
            raise SceneError(str(error), key="projectile.profile", source=str(path)) from None
        rod["profile"] = shapes.written_points(points)
    return data


def read_dict(data: Mapping[str, Any], source: str = "scene") -> types.Scene:
    """Check nested tables and make the scene; ``source`` is named in every message."""
    try:
        return read_scene(data)
    except SceneError as error:
        raise error.under("", source) from None


def _load(path: Path) -> dict[str, Any]:
    """Return the tables of a file that is small enough to be a scene."""
    try:
        with path.open("rb") as file:
            raw = file.read(_LARGEST_FILE + 1)
        text = raw.decode("utf-8-sig")
    except FileNotFoundError:
        raise UsageError(
            "there is no such file.", source=str(path), remedy=library.nearest_scene(path.stem)
        ) from None
    except IsADirectoryError:
        inside = path / "scene.toml"
        remedy = f"Name the file, such as {inside}." if inside.is_file() else "Name a scene file."
        raise SceneError("is a directory, not a scene file.", source=str(path), remedy=remedy) from None
    except UnicodeDecodeError:
        raise SceneError("is not UTF-8 text.", source=str(path), remedy=_TOML) from None
    except (OSError, ValueError) as error:
        raise SceneError(f"cannot be read ({error}).", source=str(path)) from None
    if len(raw) > _LARGEST_FILE:
        raise SceneError("is larger than a megabyte.", source=str(path), remedy=_TOML)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise SceneError(f"is not readable as TOML: {error}.", source=str(path), remedy=_TOML) from None


SMOOTH = Surface("custom", 0.0, 0.0, 0.0, "no surface is stated and no friction effect named")
SEGMENT = '{to = "50 mm", material = "rod-steel"}'
TOP = ("id", "title", "measured", "restitution", "effects")
"""Keys of a scene above its sections, `PARTS`."""
OPTIONAL = ("accuracy", "save", "heating", "strikes")
"""Sections that may be left out."""


def read_scene(data: tables.Table) -> types.Scene:
    """Make a scene from its tables; keys in messages are dotted from the top."""
    if not isinstance(data, Mapping):
        raise SceneError("a scene must be a table of tables.", value=data)
    tables.check_keys(data, (*TOP, *PARTS))
    effects = fields.check_names(data.get("effects", "auto"))
    # only a list of effects without friction needs no surface
    rubs = "friction" in effects or ("auto" in effects and "-friction" not in effects)
    restitution = parse_number(data["restitution"], "restitution") if "restitution" in data else None
    parts: dict[str, Callable[[], Any]] = {
        "id": lambda: tables.needed(data, "id", '"my-rod", a name for the scene')
    }
    parts |= {
        name: partial(tables.within, data, name, read_part, {} if name in OPTIONAL else None)
        for name, read_part in PARTS.items()
    }
    if "surface" not in data:
        parts["surface"] = lambda: None
    # all parts read; of several complaints a misspelt key comes before what is missing for it
    read: dict[str, Any] = {}
    complaints: list[SceneError] = []
    for name, part in parts.items():
        try:
            read[name] = part()
        except SceneError as error:
            complaints.append(error)
    if complaints:
        raise min(complaints, key=lambda error: error.problem != tables.UNKNOWN_KEY)
    if read["surface"] is None:
        pair = read["projectile"].material, read["barrier"].struck
        of_pair = partial(of_known, lambda: pair_surface(*pair))
        read["surface"] = tables.within(data, "surface", of_pair, {}) if rubs or "surface" in data else SMOOTH
    scene = types.Scene(
        **read,
        title=data.get("title", data.get("id")),
        effects=effects,
        measured=data.get("measured"),
        restitution=restitution,
    )
    _check_measured(scene)
    return scene


def _check_measured(scene: types.Scene) -> None:
    """Refuse the name of a measured set beside another rod, impact, barrier or state of the surfaces."""
    if scene.measured is None:
        return
    if scene.own_tests:
        if not scene.own_tests.is_file():
            remedy = "Name a CSV file, from the place of the scene's file."
            raise SceneError("there is no such file.", key="measured", value=scene.measured, remedy=remedy)
        return
    tip = library.other_tip(scene.measured)
    if other := differing(scene, _published(scene.measured, scene.projectile.tip == tip.get("tip"))):
        raise SceneError(
            f"names a set that was measured with another {' and '.join(other)}.",
            key="measured",
            value=scene.measured,
            remedy='Leave out "measured".',
        )


@cache
def _published(name: str, as_other: bool) -> types.Scene:
    """Return the scene of a measured set, with the other tip that its rows may be read with if so wanted."""
    stated = {key: value for key, value in library.stated(name).items() if key != "measured"}
    tip = library.other_tip(name) if as_other else {}
    return read_scene(stated | {"projectile": stated["projectile"] | tip})


def _projectile(table: tables.Table) -> ProjectileSpec:
    """Read a rod with a tip, a named shape, a profile or a mesh, with a bore and segments or without."""
    if tube := {key: table[key] for key in ("inner_diameter", "inner_diameter_m") if key in table}:
        return _tube({key: value for key, value in table.items() if key not in tube}, tube)
    own = {
        "bore": shapes.stated_points(table.get("bore", ()), "bore"),
        "segments": tables.listed(table["segments"], "segments", _segment, SEGMENT)
        if "segments" in table
        else (),
    }
    known = {key: value for key, value in table.items() if key not in own}
    _refuse_length(known)
    # refuse other words for a bore, and say how it is stated
    for key in known:
        if any(word in key for word in ("inner", "wall", "hollow")):
            remedy = 'State inner_diameter = "14 mm", or a bore by points (place from the tip, radius).'
            raise SceneError(tables.UNKNOWN_KEY, key=key, value=known[key], remedy=remedy)
    if own["segments"]:
        if "material" in known:
            raise SceneError("stands beside segments, which have their own.", key="material")
        known["material"] = table["segments"][0]["material"]
    if "mesh" in known:
        return _of_mesh(known, own)
    if "profile" in known:
        mine = ("profile", "profile_smooth", "material")
        tables.check_keys(known, mine, (*mine, *own, "inner_diameter"))
        points = shapes.stated_points(known["profile"], "profile")
        shape = shapes.Profile(points, known.get("profile_smooth", False))
        return ProjectileSpec.turned(shape, tables.within(known, "material", library.read_material), **own)
    return _named_shape(known, own) if "shape" in known else _rod(known, own)


def _tube(table: tables.Table, inner: tables.Table) -> ProjectileSpec:
    """Read a projectile with a straight bore from tip to tail, which is stated by its diameter."""
    if other := next((key for key in ("bore", "mesh") if key in table), ""):
        problem = f"stands beside a {other}, which has its own."
        raise SceneError(problem, key="inner_diameter", remedy="Keep one of the two.")
    radius = tables.numbers_of(inner, fields.TUBE)["inner_diameter"] / 2
    solid = _projectile(table)
    return replace(solid, bore=((0.0, radius), (solid.length, radius)))


LENGTH_OF = {
    "profile": ("that of its last point", "profile"),
    "mesh": ("that of the cells in its file", "mesh"),
    "ball": ("its diameter", "diameter"),
}
"""What gives a projectile its length where that is not stated, and the key of it."""


def _refuse_length(table: tables.Table) -> None:
    """Refuse the length of a projectile that has its own."""
    kind = next((key for key in ("mesh", "profile") if key in table), table.get("shape"))
    key = next((key for key in ("length", "length_m") if key in table), None)
    if key and isinstance(kind, str) and kind in LENGTH_OF:
        own, instead = LENGTH_OF[kind]
        remedy = f"Leave it out, or change projectile.{instead} instead."
        problem = f"is not stated for a {kind}: its length is {own}."
        raise SceneError(problem, key=key, value=table[key], remedy=remedy)


def _of_mesh(table: tables.Table, own: dict[str, Any]) -> ProjectileSpec:
    tables.check_keys(table, (*own_mesh.KEYS, "material"))
    if own["bore"]:
        raise SceneError("stands beside a mesh, which has its own.", key="bore", remedy="Leave it out.")
    mesh, stated = own_mesh.stated(table), table.get("mesh_materials", {})
    if not isinstance(stated, Mapping):
        remedy = 'Write mesh_materials = { CORE = "lead" }, a set of the file and its material.'
        raise SceneError("must be a table.", key="mesh_materials", value=stated, remedy=remedy)
    if stated and own["segments"]:
        raise SceneError("stands beside segments.", key="mesh_materials", remedy="State one of them.")
    regions = tuple(Region(name, _region(stated[name], name)) for name in stated)
    faces = tables.within(table, "mesh_surfaces", _faces) if "mesh_surfaces" in table else ()
    material = tables.within(table, "material", library.read_material)
    own_mesh.face_regions(mesh, tuple(face.name for face in faces))  # refused here, with file and key
    return ProjectileSpec.meshed(mesh, material, own["segments"], regions, faces)


def _faces(table: tables.Table) -> tuple[Face, ...]:
    """Read the surface of each set whose outer faces have a state of their own; one law holds for all."""
    for name in table:
        if isinstance(table[name], Mapping) and "sliding_law" in table[name]:
            remedy = "State it in [surface]: it multiplies f of every face."
            raise SceneError("stands beside that of the scene.", key=f"{name}.sliding_law", remedy=remedy)
    surfaces = {name: tables.within(table, name, read_surface) for name in table}
    for name, surface in surfaces.items():
        if surface is None:  # the state is that of the pair
            remedy = "Leave it out, or name another state, such as custom."
            raise SceneError("is the state of the scene's surface.", key=f"{name}.state", remedy=remedy)
    return tuple(Face(name, surface) for name, surface in surfaces.items() if surface)


def _region(material: Any, name: str) -> Material:
    try:
        return tables.within({"material": material}, "material", library.read_material)
    except SceneError as error:
        raise error.under(f"mesh_materials.{name}") from None


def _named_shape(table: tables.Table, own: dict[str, Any]) -> ProjectileSpec:
    """Read a shape by name; those that are rods with a published kind of tip become such rods."""
    name = table["shape"]
    shapes.refuse_tip(table)
    by_length = shapes.stated_by_length(name, table)
    sizes = tables.numbers_of(table, shapes.sizes_of(name, by_length), ("shape", "material"))
    material = tables.within(table, "material", library.read_material)
    if name not in shapes.TIPS:
        return ProjectileSpec.turned(
            shapes.NamedShape(name, tuple(sizes.values()), by_length), material, **own
        )
    radius = {"flat": 0.0, "hemisphere": sizes["diameter"] / 2}.get(name) or sizes.get("edge_radius", 0.0)
    return ProjectileSpec(
        sizes["length"], sizes["diameter"], "B" if radius else "plain", radius, material, **own
    )


def _segment(table: tables.Table) -> Segment:
    tables.check_keys(table, ("to", "material"))
    end = parse_quantity(table["to"], "length", "to") if "to" in table else inf
    return Segment(end, tables.within(table, "material", library.read_material))


def _layer(table: tables.Table) -> Layer:
    return Layer(
        **tables.numbers_of(table, fields.LAYER, ("material",)),
        material=tables.within(table, "material", library.read_material),
    )


def _rod(table: tables.Table, own: dict[str, Any]) -> ProjectileSpec:
    stated = table.get("tip")
    shapes.refuse_as_tip(stated)
    # a tip that is missing or none is told before the radius that it would need
    instead = {} if shapes.is_rounded(stated) else {"tip_radius": 0.0}
    numbers = tables.numbers_of(table, fields.PROJECTILE, ("tip", "material"), instead)
    tip = tables.needed(table, "tip", '"A", "B" or "plain"')
    return ProjectileSpec(
        tip=tip, material=tables.within(table, "material", library.read_material), **numbers, **own
    )


def _barrier(table: tables.Table) -> Barrier:
    given = tables.values_of(table, fields.BARRIER, ("boundary", "support"), ("material", "layers"))
    if "layers" in table:
        example = '{thickness = "2 mm", material = "rod-steel"}'
        given["layers"] = tables.listed(table["layers"], "layers", _layer, example)
        tables.needed(table, "material", '"plate-steel", for what lies under the layers')
    return Barrier(tables.within(table, "material", library.read_material), **given)


def _impact(table: tables.Table) -> Impact:
    """Read a motion that a height, a speed or velocities state, and how far it is followed."""
    given = {p.key for p in NUMBERS if {p.key, p.si_key} & set(table)}
    shown = [*(p.key for p in NUMBERS), "until"]
    tables.check_keys(table, (*shown, *(p.si_key for p in NUMBERS)), shown)
    way = the_way(given)
    made: dict[tuple[str, ...], Callable[..., Impact]] = {WAYS[0]: Impact.dropped, WAYS[1]: Impact.thrown}
    stated = (fields.ANGLE, fields.OMEGA, fields.SLOPE, *(p for p in NUMBERS if p.key in way))
    return made.get(way, Impact)(**tables.values_of(table, stated, ("until",)))


def _accuracy(table: tables.Table | str) -> types.Accuracy:
    """Read a mesh, or a wanted error written alone or as the key ``target``."""
    if isinstance(table, str):
        return types.Accuracy(**_wanted(table, ""))
    choices = ("element", "yielding_element", "fine_zone", "unresolved")
    stated = tables.values_of(table, fields.ACCURACY, choices, ("target",))
    if "target" not in table:
        return types.Accuracy(**stated)
    mesh = [name for p in fields.ACCURACY if p.key in fields.MESH for name in (p.key, p.si_key)]
    if key := next((key for key in table if key in mesh), ""):
        problem = "stands beside a target, which chooses the mesh."
        raise SceneError(problem, key=key, remedy="Keep one of the two.")
    return types.Accuracy(**stated, **_wanted(table["target"], "target"))


def _wanted(text: Any, key: str) -> dict[str, Any]:
    """Read a wanted error such as ``"2 %"``, or ``"e 2 %"`` of one number alone."""
    of, _, share = text.partition(" ") if isinstance(text, str) and text[:1].isalpha() else ("", "", text)
    return {"target": parse_share(share or text, key), "target_of": of or None}


PARTS: Mapping[str, Callable[[Any], Any]] = {
    "projectile": _projectile,
    "barrier": _barrier,
    "surface": read_surface,
    "impact": _impact,
    "accuracy": _accuracy,
    "save": lambda table: types.Save(**tables.values_of(table, fields.SAVE, ("fields",))),
    "heating": lambda table: types.Heating(**tables.numbers_of(table, fields.HEATING)),
    "strikes": lambda table: Following(**tables.values_of(table, fields.STRIKES, ("fidelity",))),
}
"""What reads each section of a scene."""
