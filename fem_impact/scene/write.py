"""From a `Scene` to its complete written form: tables, TOML text and digest."""

import hashlib
import json
import os
from collections.abc import Iterable
from math import inf
from pathlib import Path
from typing import Any

import tomli_w

from fem_impact.scene import fields
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import FIRST, Impact
from fem_impact.scene.material import Flow, Material, Surface, TableFlow
from fem_impact.scene.own_mesh import OwnMesh
from fem_impact.scene.parameter import Parameter
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.shapes import HEIGHT, RADIUS, NamedShape, Point, Profile, sizes_of
from fem_impact.scene.sliding import written
from fem_impact.scene.types import OWN, Accuracy, Scene


def to_dict(scene: Scene) -> dict[str, Any]:
    """Return every value of the scene, defaults too, quantities with their units."""
    top: dict[str, Any] = {"id": scene.id, "title": scene.title, "effects": list(scene.effects)}
    if scene.measured is not None:
        top["measured"] = scene.measured
    if scene.restitution is not None:
        top["restitution"] = scene.restitution
    models = {"fidelity": scene.strikes.fidelity} if scene.strikes.fidelity else {}
    if strikes := models | _written(scene.strikes, fields.STRIKES):
        top["strikes"] = strikes
    return top | {
        "projectile": _projectile(scene.projectile),
        "barrier": _barrier(scene.barrier),
        "surface": _surface(scene.surface),
        "impact": _impact(scene.impact),
        "accuracy": _accuracy(scene.accuracy),
        "save": _written(scene.save, fields.SAVE) | ({"fields": "all"} if scene.save.fields == "all" else {}),
        "heating": _written(scene.heating, fields.HEATING),
    }


def to_toml(scene: Scene, folder: Path | None = None) -> str:
    """Return the scene as TOML text that reads back as an equal scene.

    Its files, own tests and mesh, are named as seen from the ``folder``, by default from the root.
    """
    tables = to_dict(scene)
    if folder:
        for place, key, ending in ((tables, "measured", OWN), (tables["projectile"], "mesh", "")):
            if key in place and place[key].endswith(ending):
                place[key] = os.path.relpath(place[key], folder.resolve())
    return tomli_w.dumps(tables)


def digest(scene: Scene) -> str:
    """Return the SHA-256 of the scene's canonical JSON."""
    text = json.dumps(to_dict(scene), sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def _surface(surface: Surface) -> dict[str, Any]:
    stated = {"state": surface.state, "source": surface.source}
    law = {"sliding_law": written(surface.sliding_law)} if surface.sliding_law else {}
    return stated | _written(surface, fields.SURFACE) | law


def _projectile(rod: ProjectileSpec) -> dict[str, Any]:
    if rod.segments:
        parts = [
            {"to": HEIGHT.write(part.to), "material": material_table(part.material)} for part in rod.segments
        ]
        made: dict[str, Any] = {"segments": parts}
    else:
        made = {"material": material_table(rod.material)}
    bore = {"bore": _points(rod.bore)} if rod.bore else {}
    return _shape(rod) | bore | made


def _shape(rod: ProjectileSpec) -> dict[str, Any]:
    shape = rod.shape
    if isinstance(shape, NamedShape):
        pairs = zip(sizes_of(shape.name, shape.by_length), shape.sizes, strict=True)
        return {"shape": shape.name, **{size.key: size.write(value) for size, value in pairs}}
    if isinstance(shape, Profile):
        return {"profile": _points(shape.points), "profile_smooth": shape.smooth}
    if isinstance(shape, OwnMesh):
        tip = list(shape.tip) if isinstance(shape.tip, tuple) else shape.tip
        named = {"mesh_symmetry": shape.symmetry, "mesh_tip": tip, "mesh_sets": list(shape.sets)}
        file = {"mesh": shape.path, "mesh_unit": shape.unit, "mesh_content": shape.content}
        regions = {one.name: material_table(one.material) for one in rod.regions}
        faces = {one.name: _surface(one.surface) for one in rod.faces}
        sets = {"mesh_materials": regions, "mesh_surfaces": faces}
        return file | {key: value for key, value in (named | sets).items() if value}
    return {"tip": rod.tip, **_written(rod, fields.PROJECTILE)}


def _points(points: Iterable[Point]) -> list[list[Any]]:
    return [[HEIGHT.write(z), RADIUS.write(r)] for z, r in points]


def _barrier(barrier: Barrier) -> dict[str, Any]:
    """Write what differs from a half-space at rest."""
    plain = Barrier(barrier.material)
    words = {key: getattr(barrier, key) for key in ("boundary", "support")}
    written = words | _written(barrier, fields.BARRIER)
    other = {key: value for key, value in written.items() if getattr(barrier, key) != getattr(plain, key)}
    layers = [
        {**_written(one, fields.LAYER), "material": material_table(one.material)} for one in barrier.layers
    ]
    return {**other, **({"layers": layers} if layers else {}), "material": material_table(barrier.material)}


def _impact(impact: Impact) -> dict[str, Any]:
    """Write the velocities as they are stated."""
    stated = ("angle", *impact.stated, "omega", "slope")
    known = (*fields.IMPACT, fields.SLOPE, fields.HEIGHT, fields.SPEED)
    until = {} if impact.until == FIRST else {"until": impact.until}
    return _written(impact, tuple(p for p in known if p.key in stated)) | until


def _accuracy(accuracy: Accuracy) -> dict[str, Any]:
    written = _written(accuracy, fields.ACCURACY) | {"element": accuracy.element}
    for key in ("yielding_element", "fine_zone", "unresolved"):
        if getattr(accuracy, key) != getattr(Accuracy(), key):
            written[key] = getattr(accuracy, key)
    if accuracy.target is None:
        return written
    rest = {key: value for key, value in written.items() if key not in fields.MESH}
    return {"target": f"{accuracy.target_of or ''} {100 * accuracy.target:.12g} %".lstrip(), **rest}


def material_table(material: Material) -> dict[str, Any]:
    """Return a material as the table that a scene states."""
    law = {"law": material.law} if material.law != "tensile" else {}
    rate = material.rate
    rates = {"rate": {"law": rate.law, **_written(rate, fields.RATES[rate.law])}} if rate else {}
    flow = {"flow": _flow(material.flow)} if material.flow else {}
    skin = material.skin
    skins = {"skin": {**_written(skin, fields.SKIN), "shape": skin.shape}} if skin else {}
    words = {"family": material.family} if material.family else {}
    sources = {"sources": dict(material.sources)} if material.sources else {}
    numbers = _written(material, fields.MATERIAL)
    return {"name": material.name, **words, **numbers, **law, **flow, **rates, **skins, **sources}


def _flow(flow: Flow) -> dict[str, Any]:
    if isinstance(flow, TableFlow):
        points = [[strain, fields.FLOW_STRESS.write(stress)] for strain, stress in flow.points]
        return {"law": flow.law, "points": points}
    return {"law": flow.law, **_written(flow, fields.FLOWS[flow.law])}


def _written(part: object, wanted: tuple[Parameter, ...]) -> dict[str, Any]:
    values = {parameter: getattr(part, parameter.key) for parameter in wanted}
    return {p.key: p.write(value) for p, value in values.items() if value not in (None, inf)}
