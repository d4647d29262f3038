"""The scene: what the user states about rod, barrier, surface, impact, effects and accuracy.

SI units inside. Every part checks itself when it is made, so a scene from a file and a scene from Python
are the same object and pass the same checks. `to_dict` and `to_toml` write a scene, `digest` names it.
"""

import hashlib
import json
import os
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from typing import Any, get_args

import tomli_w

from fem_impact.errors import SceneError, UsageError
from fem_impact.scene import fields
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.fields import Fields, Parameter
from fem_impact.scene.impact import FIRST, NUMBERS, WAYS, Following, Impact
from fem_impact.scene.material import JohnsonCookFlow, JohnsonCookRate, Material, Surface, TableFlow
from fem_impact.scene.own_mesh import OwnMesh
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.shapes import HEIGHT, NamedShape, Profile, sizes_of, written_points
from fem_impact.scene.sliding import written

MEASURED_SETS = (
    *("t2", "t3-machined", "t3-contaminated", "t3-cleaned", "t4"),
    *("t5a", "t5b", "t5c", "t5d", "t6-17", "t6-25", "t6-37", "t6-60"),
)

OWN = ".csv"
"""End of a name in ``measured`` that is a file of the user's own tests, not a published set."""


@dataclass(frozen=True, slots=True)
class Accuracy:
    """What the answer may cost: element size at the tip and margin of the block in m, latest time in s.

    ``step`` is the time step over the largest stable one. ``element`` names the operator of cells that
    cannot yield: with incompatible modes, fully integrated, or with mean dilatation (B-bar).
    ``yielding_element`` names that of cells that may yield; plain full integration locks there, it is meant
    for comparisons with codes that have it.
    ``fine_zone`` says where the finest cells lie: right under the contact, with larger ones around them, or
    all over the zone in which cells may yield, which shows what the grading saves; or under the contact and
    so flat that three rows lie in each hardened skin.
    ``unresolved`` says whether coefficients and shares of a contact that the mesh does not resolve are
    withheld (null, with the reason) or reported all the same.
    ``grid_shift`` is the place of a meshed barrier's grid along t, in cells at the contact.
    ``across`` that is not stated follows from the projectile, see `Scene.across`; ``max_time`` from the rod's
    bending and the contact time, see `Case.max_time`.
    ``levels`` is the number of meshes of a finite-element run, of which the last counts.
    ``offsets`` is the number of places of a meshed barrier's grid at which each level but the first runs.
    ``target`` is the wanted relative error; levels then go on until it is reached, by ``target_of`` alone if
    that is stated, else by e and E_vib.
    """

    tip_size: float | None = None
    barrier_size: float | None = None
    mass_scaling: float = 4.0
    across: int | None = None
    grid_shift: float = 0.0
    block_margin: float = 6e-3
    max_time: float | None = None
    step: float = 0.9
    element: fields.Element = "incompatible"
    yielding_element: fields.YieldingElement = "bbar"
    fine_zone: fields.FineZone = "graded"
    unresolved: fields.Unresolved = "withhold"
    target: float | None = None
    target_of: fields.TargetOf | None = None
    levels: int = fields.LEVELS
    offsets: int | None = None

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.ACCURACY)
        fields.check_choice(self.element, get_args(fields.Element), "element")
        fields.check_choice(self.yielding_element, get_args(fields.YieldingElement), "yielding_element")
        fields.check_choice(self.fine_zone, get_args(fields.FineZone), "fine_zone")
        fields.check_choice(self.unresolved, get_args(fields.Unresolved), "unresolved")
        if self.target_of is not None:
            fields.check_choice(self.target_of, get_args(fields.TargetOf), "target")
        if self.target is not None and not (isinstance(self.target, float) and 0.0 < self.target <= 1.0):
            raise SceneError("must be a share above 0 and at most 1.", key="target", value=self.target)
        if self.target is not None and self.levels == 1:
            problem = "is one mesh, which tells no error, beside a target, the wanted error."
            remedy = "Give at least 2, or leave out the target."
            raise SceneError(problem, key="levels", value=1, remedy=remedy)


@dataclass(frozen=True, slots=True)
class Heating:
    """What contact heating is judged by: K, W/(m K), J/(kg K); None: that of the body's material."""

    ignition: float = 703.15
    ambient: float = 293.15
    rod_conductivity: float | None = None
    rod_heat_capacity: float | None = None
    barrier_conductivity: float | None = None
    barrier_heat_capacity: float | None = None
    rod_melting: float | None = None
    barrier_melting: float | None = None

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.HEATING)
        if self.ambient >= self.ignition:
            problem = f"must lie below the temperature that the contact must not reach, {self.ignition:g} K."
            remedy = "A lower ambient, or a higher ignition."
            raise SceneError(problem, key="ambient", value=f"{self.ambient:g} K", remedy=remedy)


@dataclass(frozen=True, slots=True)
class Save:
    """What is kept of a run: frames of the fields, rows of the histories, samples of the axial strain.

    ``fields``: ``shown`` holds what films and pages show, displacement, von Mises stress and plastic strain;
    ``all`` velocity and the stress tensor too. ``gauge`` is the distance of a strain gauge from the tip, m,
    None without one, ``gauge_across`` its place in radii from the axis, None for 1: the side that faces the
    barrier.
    """

    frames: int = 120
    history_every: int = 20
    strain_samples: int = 1
    gauge: float | None = None
    gauge_across: float | None = None
    fields: Fields = "shown"

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.SAVE)
        fields.check_choice(self.fields, get_args(fields.Fields), "fields")


@dataclass(frozen=True, slots=True)
class Scene:
    """One impact, completely stated.

    ``measured`` names the published set it repeats, or the CSV file of a user's own tests, if any;
    ``restitution`` (energetic, 0 to 1) is what the rigid fidelity takes instead of Thornton's law.
    ``effects`` is what was stated, with or without ``"auto"``; the case tells what the model has.
    """

    id: str
    title: str
    projectile: ProjectileSpec
    barrier: Barrier
    surface: Surface
    impact: Impact
    effects: tuple[str, ...] = ("auto",)
    accuracy: Accuracy = Accuracy()
    save: Save = Save()
    heating: Heating = Heating()
    strikes: Following = Following()  # noqa: RUF009
    measured: str | None = None
    restitution: float | None = None

    def __post_init__(self) -> None:
        fields.check_id(self.id)
        fields.check_text(self.title, "title")
        object.__setattr__(self, "effects", fields.check_names(self.effects))
        if self.measured is not None and self.own_tests is None:
            other = f"the path of a CSV file of your own tests (*{OWN})"
            fields.check_choice(self.measured, MEASURED_SETS, "measured", other)
        if self.restitution is not None:
            fields.check_numbers(self, fields.TOP)
        try:
            _check_approach(self)
        except SceneError as error:
            raise error.worded(self.projectile.named) from None
        size, rod = self.accuracy.tip_size, self.projectile
        largest = rod.diameter / 4
        if size is not None and size > largest:
            raise SceneError(
                f"is too coarse for a {rod.called} of {rod.diameter * 1e3:g} mm diameter.",
                key="accuracy.tip_size",
                value=f"{size * 1e3:.3g} mm",
                remedy=f"Give at most {largest * 1e3:g} mm.",
            )

    @property
    def own_tests(self) -> Path | None:
        """The file of the user's own tests that ``measured`` names, None where it names none."""
        if isinstance(self.measured, str) and self.measured.endswith(OWN):
            return Path(self.measured)
        return None

    @property
    def across(self) -> int:
        """Cells over the diameter of the projectile: those that are stated, or as many as its wall needs."""
        return self.accuracy.across or self.projectile.across

    @property
    def materials(self) -> dict[str, Material]:
        """The materials of both bodies by the section that states them."""
        return {"projectile": self.projectile.material, "barrier": self.barrier.material}

    @property
    def first_impact(self) -> "Scene":
        """The scene without what follows its first impact."""
        return replace(self, impact=replace(self.impact, until=FIRST), strikes=Following())

    @property
    def untargeted(self) -> "Scene":
        """The scene without the error that it asks for, which a model without a mesh cannot reach."""
        return replace(self, accuracy=replace(self.accuracy, target=None))

    @property
    def relative(self) -> Impact:
        """The impact as seen from the barrier before it, which a moving barrier changes."""
        impact, barrier = self.impact, self.barrier
        if barrier.v_n == barrier.v_t == 0.0:
            return impact
        v_n, v_t = impact.v_n - barrier.v_n, impact.v_t - barrier.v_t
        return Impact(impact.angle, v_n, v_t, impact.omega, slope=impact.slope, until=impact.until)


def _check_approach(scene: Scene) -> None:
    """Refuse a rod that does not come down on the barrier, as seen from it."""
    seen, moving = scene.impact, scene.barrier.v_n or scene.barrier.v_t
    if seen.stated != WAYS[2] and not moving and not fields.V_N.allows(seen.v_n):
        raise SceneError(
            "lays the axis along the barrier: a rod that moves along it never strikes.",
            key="impact.angle",
            value=fields.ANGLE.write(seen.angle),
            remedy=f"Give v_n and v_t in place of {seen.stated[0]}, or another angle.",
        )
    for parameter in (fields.V_N, fields.V_T):
        key = parameter.key
        seen_speed = getattr(seen, key) - getattr(scene.barrier, key)
        if moving and not parameter.allows(seen_speed):
            problem = f"is {seen_speed:.4g} m/s as seen from the barrier, which moves too."
            value, own = f"{getattr(seen, key):.4g} m/s", getattr(scene.barrier, key)
            limits = f"above {own + parameter.low:.6g} m/s and below {own + parameter.high:.6g} m/s"
            remedy = f"Give a velocity {limits}: the barrier moves at {own:.4g} m/s."
            raise SceneError(problem, key=f"impact.{key}", value=value, remedy=remedy)
        try:
            parameter.checked(seen_speed)
        except SceneError as error:
            raise error.under("impact") from None


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
        if scene.own_tests:
            tables["measured"] = os.path.relpath(scene.own_tests, folder.resolve())
        if mesh := scene.projectile.own_mesh:
            tables["projectile"]["mesh"] = os.path.relpath(mesh.path, folder.resolve())
    return tomli_w.dumps(tables)


def require_scene(scene: object) -> None:
    """Refuse what is no scene, such as the name of one (UsageError)."""
    if not isinstance(scene, Scene):
        remedy = 'Load one, of a name, a file or a table: fem_impact.load("t5b").'
        raise UsageError("is not a scene.", key="scene=", value=scene, remedy=remedy)


def digest(scene: Scene) -> str:
    """Return the SHA-256 of the scene's canonical JSON, with that of the file of own tests that it names.

    An outcome holds numbers of those tests, which are others once the file has changed. Raises SceneError
    where that file cannot be read.
    """
    tables = to_dict(scene)
    if scene.own_tests:
        try:
            tables["measured_content"] = hashlib.sha256(scene.own_tests.read_bytes()).hexdigest()
        except OSError as error:
            problem, remedy = f"cannot be read: {error.strerror}.", "Put the file of your own tests there."
            raise SceneError(problem, key="measured", value=scene.measured, remedy=remedy) from None
    text = json.dumps(tables, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def _surface(surface: Surface) -> dict[str, Any]:
    stated = {"state": surface.state, "source": surface.source}
    law = {"sliding_law": written(surface.sliding_law)} if surface.sliding_law else {}
    return stated | _written(surface, fields.SURFACE) | law


def _projectile(rod: ProjectileSpec) -> dict[str, Any]:
    shape = rod.shape
    table: dict[str, Any]
    if isinstance(shape, NamedShape):
        pairs = zip(sizes_of(shape.name, shape.by_length), shape.sizes, strict=True)
        table = {"shape": shape.name, **{size.key: size.write(value) for size, value in pairs}}
    elif isinstance(shape, Profile):
        table = {"profile": written_points(shape.points), "profile_smooth": shape.smooth}
    elif isinstance(shape, OwnMesh):
        table = {"mesh": shape.path, "mesh_unit": shape.unit, "mesh_content": shape.content}
        stated = {
            "mesh_symmetry": shape.symmetry,
            "mesh_tip": list(shape.tip) if isinstance(shape.tip, tuple) else shape.tip,
            "mesh_sets": list(shape.sets),
            "mesh_materials": {one.name: material_table(one.material) for one in rod.regions},
            "mesh_surfaces": {one.name: _surface(one.surface) for one in rod.faces},
        }
        table |= {key: value for key, value in stated.items() if value}
    else:
        table = {"tip": rod.tip, **_written(rod, fields.PROJECTILE)}
    if rod.bore:
        table["bore"] = written_points(rod.bore)
    if rod.segments:
        table["segments"] = [
            {"to": HEIGHT.write(part.to), "material": material_table(part.material)} for part in rod.segments
        ]
    else:
        table["material"] = material_table(rod.material)
    return table


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
    until = {} if impact.until == FIRST else {"until": impact.until}
    return _written(impact, tuple(p for p in NUMBERS if p.key in stated)) | until


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
    table: dict[str, Any] = {"name": material.name}
    if material.family:
        table["family"] = material.family
    table |= _written(material, fields.MATERIAL)
    if material.law != "tensile":
        table["law"] = material.law
    if flow := material.flow:
        table["flow"] = {"law": flow.law, **_written(flow, fields.FLOWS[flow.law])}
        if isinstance(flow, TableFlow):
            points = [[strain, fields.FLOW_STRESS.write(stress)] for strain, stress in flow.points]
            table["flow"]["points"] = points
    if rate := material.rate:
        table["rate"] = {"law": rate.law, **_written(rate, fields.RATES[rate.law])}
        if isinstance(rate, JohnsonCookRate) and isinstance(flow, JohnsonCookFlow):
            if rate.tested == rate.reference:  # it follows from the flow, see `tested_at`
                del table["rate"]["tested"]
    if skin := material.skin:
        table["skin"] = {**_written(skin, fields.SKIN), "shape": skin.shape}
    if material.sources:
        table["sources"] = dict(material.sources)
    return table


def _written(part: object, wanted: tuple[Parameter, ...]) -> dict[str, Any]:
    values = ((parameter, getattr(part, parameter.key)) for parameter in wanted)
    return {p.key: p.write(value) for p, value in values if value not in (None, inf)}
