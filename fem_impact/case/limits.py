"""Say where a scene leaves what was measured, so that nobody reads a prediction as a comparison."""

import math
from dataclasses import replace

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.registry import is_wanted
from fem_impact.case.layers import flows_below
from fem_impact.case.plates import is_wider, thin_plate
from fem_impact.case.shaft import coned, gives_elsewhere, lands_on_ridge, part_flows
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import Limitation, limitations
from fem_impact.physics.contact import FLAT
from fem_impact.scene import library
from fem_impact.scene.impact import BESIDE, FIRST, Impact
from fem_impact.scene.own_mesh import OwnMesh
from fem_impact.scene.shipped import replace as change
from fem_impact.scene.types import Scene
from fem_impact.scene.units import format_quantity
from fem_impact.tables.text import plain
from rigid import Faceted, Turned

BESIDE_AXIS = 1e-3  # of the diameter, within which an upright body stands over its mass centre
# Smallest and largest of the 13 measured sets (Tables 2 to 6 of the paper), SI units.
LENGTHS = (0.08, 0.24)
DIAMETER = 0.019
SPEEDS = (1.30, 6.10)
ANGLES = (math.radians(17.0), math.radians(60.0))
TURNING = "outside the measured range: the measured rods did not turn before impact"
ELASTIC_SEGMENTS = (
    "idealised: only the first segment of the projectile may yield; the others and joints stay elastic"
)
FACETS = (
    "idealised: the flat facets of the user's mesh are the projectile's surface; cells that are split at "
    "the contact keep them"
)
BONDED_LAYERS = (
    "idealised: layers are bonded; closed formulas (for the choice of effects, the restitution of the "
    "rigid fidelity, and the heat of the contact) know the first layer alone"
)
TIPS = {("A", 0.007), ("B", 0.003)}
SLOPE = (
    "No impact.slope is stated, so the rod's axis counts as vertical and the barrier slopes by {:.3g} "
    'degrees{}. On level ground state impact.slope = "0 deg".'
)


def scene_limitations(bodies: Bodies, meshed_through: bool) -> tuple[Limitation, ...]:
    """Return each way in which the scene leaves the measured range, or its model is idealised.

    ``meshed_through`` says whether a plate that bends is meshed through its thickness.
    """
    scene, mesh = bodies.scene, bodies.scene.projectile.own_mesh
    speed = round(math.hypot(scene.relative.v_n, scene.relative.v_t), 3)
    unmeasured = limitations(
        "range",
        _outside(scene.projectile.length, LENGTHS, "length"),
        _section(scene),
        _outside(speed, SPEEDS, "speed"),
        _outside(abs(scene.impact.angle), ANGLES, "angle"),
        _fall(scene),
        TURNING if scene.impact.omega else "",
        _steels(scene),
        _barrier(scene),
        _surface(bodies),
        _sliding(bodies),
    )
    needed = "friction", "rod-plasticity", "barrier-elastoplastic"
    missing = [name for name in needed if name not in bodies.effects]
    masses = [mesh.masses(own)[1] for own in (True, False)] if mesh is not None else []
    idealised = limitations(
        "model",
        ELASTIC_SEGMENTS if scene.projectile.segments else "",
        FACETS if mesh is not None else "",
        *(f"left out of the body: {one}" for one in masses if one),
        BONDED_LAYERS if scene.barrier.layers else "",
        thin_plate(bodies, meshed_through),
        coned(bodies),
        f"idealised: without {', '.join(missing)}; no test corresponds to it" if missing else "",
        _unstated_slope(scene.impact),
    )
    return (*unmeasured, *idealised)


def _unstated_slope(impact: Impact) -> str:
    """Say how the barrier of a followed body slopes where that follows from its angle alone."""
    if impact.until == FIRST or impact.slope is not None or impact.angle == 0.0:
        return ""
    beside = ", though the rod does not move along its axis" if abs(impact.beside) > BESIDE else ""
    return SLOPE.format(math.degrees(impact.angle), beside)


def assumed_part(mesh: OwnMesh | None) -> str:
    """Return that a mesh counts as a part of a body though nothing says so; nothing where it does not."""
    part = mesh.body().assumed if mesh is not None else ""
    if not part:
        return ""
    return (
        f"The mesh is taken as a {part} of the body, as it lies on one side of a plane of symmetry and "
        f'projectile.mesh_symmetry is not stated. State mesh_symmetry = "{part}", or "whole" if the file '
        "holds all of the body."
    )


def _sliding(bodies: Bodies) -> str:
    """Return where a law of friction over speed is used beyond its grid."""
    law, speed = bodies.scene.surface.sliding_law, abs(bodies.contact.sliding)
    if law is None or "friction" not in bodies.effects:
        return ""
    used = (
        (speed, law.speed, "speed", "sliding speed"),
        (bodies.estimate.pressure, law.pressure, "stress", "contact pressure"),
        (bodies.scene.heating.ambient, law.temperature, "temperature", "temperature"),
    )
    beyond = [
        f"a {words} of {format_quantity(value, dimension)}"
        for value, points, dimension, words in used
        if points and not points[0] <= value <= points[-1]
    ]
    return f"beyond the law of friction, whose last value is used: {', '.join(beyond)}" if beyond else ""


def _outside(value: float, ends: tuple[float, float], dimension: str) -> str:
    low, high = (format_quantity(end, dimension) for end in ends)
    slack = 1e-9 * abs(ends[1])
    if ends[0] - slack <= value <= ends[1] + slack:
        return ""
    number, unit = format_quantity(value, dimension).split(" ", 1)
    return (
        f"outside the measured range: {dimension} {plain(float(number), 4)} {unit}, measured {low} to {high}"
    )


def _section(scene: Scene) -> str:
    rod = scene.projectile
    if (
        rod.is_rod
        and math.isclose(rod.diameter, DIAMETER)
        and any(rod.tip == tip and math.isclose(rod.tip_radius, radius) for tip, radius in TIPS)
    ):
        return ""
    return "outside the measured range: measured were 19 mm rods with a 7 mm nose (A) or a 3 mm edge (B)"


def _fall(scene: Scene) -> str:
    impact = scene.impact
    if abs(impact.beside) <= BESIDE or impact != scene.relative:
        return ""
    beside, angle = (math.degrees(a) for a in (abs(impact.beside), impact.angle))
    why = f"; the measured rods moved along theirs. Are v_n and v_t those of {angle:.4g} deg?"
    if impact.slope is not None and abs(impact.beside + impact.angle - impact.slope) <= BESIDE:
        why = ", as it falls straight down on the slope stated; the measured rods fell along theirs"
    return f"outside the measured range: the body moves {beside:.2g} deg beside its axis{why}"


def _steels(scene: Scene) -> str:
    known = library.materials()
    plates = {material.name for _, material in scene.barrier.strata}
    same = scene.projectile.material == known["rod-steel"] and scene.barrier.material == known["plate-steel"]
    same = same and len(plates) == 1
    return "" if same else "outside the measured range: other materials than the measured steels"


def _barrier(scene: Scene) -> str:
    barrier = scene.barrier
    ways = {
        "had layers": barrier.layers,
        "bent": barrier.bends,
        "was free": barrier.mass is not None,
        "moved": barrier.v_n or barrier.v_t,
    }
    unlike = [f"no measured barrier {way}" for way, holds in ways.items() if holds]
    return f"outside the measured range: {' or '.join(unlike)}" if unlike else ""


def _surface(bodies: Bodies) -> str:
    stated = bodies.scene.surface
    known = replace(stated, sliding_law=None) in library.surfaces().values()
    if known or stated.state == "pair" or "friction" not in bodies.effects:  # of a pair an input says more
        return ""
    f, source = stated.friction, stated.source
    return f"friction f = {f:g} is not the value of a shipped state of the surface ({source})"


def require_shallow(bodies: Bodies) -> None:
    """Refuse an indentation as deep as the rod's radius (SceneError): no local contact, no small strains."""
    scene = bodies.scene
    depth, radius = bodies.estimate.depth, scene.projectile.diameter / 2
    if depth > radius:
        way = scene.impact.stated[0]
        raise SceneError(
            f"would press the tip {depth * 1e3:.2g} mm deep, more than the rod's radius "
            f"({radius * 1e3:.3g} mm): the whole end would flow and break, which the model does not hold.",
            key=f"impact.{way}",
            value=f"{getattr(scene.impact, way):.4g} {'m' if way == 'height' else 'm/s'}",
            remedy="Give a lower speed or stronger materials.",
        )


def unused(scene: Scene, fidelity: str) -> str:
    """Return that a stated restitution is not used, nothing where it is or none is stated."""
    if scene.restitution is None or fidelity == "rigid":
        return ""
    return (
        f"The stated restitution {scene.restitution:g} is that of the rigid model (--fidelity rigid) alone: "
        "here the loss follows from the contact and the materials."
    )


def require_point(bodies: Bodies, fidelity: str) -> None:
    """Refuse a straight part that comes down flat where one point of the tip is followed (SceneError).

    Rigid theory follows the middle of it where the scene states its restitution; finite elements on one mesh
    hold a face that lands upright, and on levels of meshes any part, as the reduced model does.
    """
    if fidelity == "modal" or (fidelity == "rigid" and bodies.scene.restitution is not None):
        return
    body = bodies.body
    if isinstance(body, Faceted):
        _require_tip(bodies, body, fidelity)
    elif isinstance(body, Turned):
        _require_no_flank(bodies, body, fidelity)
    if not bodies.contact.lands_flat or (fidelity == "solid" and bodies.scene.impact.angle == 0):
        return
    law = f"{fidelity} takes the contact law of a round tip"
    follows = "one mesh is fine about one point" if fidelity == "solid" else law
    raise _of_angle(bodies, f"is that of {flat_part(bodies)}, but {follows}.", _any_part(fidelity))


def require_first_part(bodies: Bodies) -> None:
    """Refuse another segment than the first, or a set of a mesh, that touches first (SceneError)."""
    if regions := bodies.rod.regions:
        of = bodies.rod.cell_materials()[bodies.touching_cells]
        if of.all():
            name = regions[int(of[0]) - 1].name
            raise SceneError(
                "touches the barrier first, but only the projectile's material may.",
                key=f"projectile.mesh_materials.{name}",
                remedy="State its material as projectile.material, and those of the other sets here.",
            )
    segments, (_, touch) = bodies.rod.segments, bodies.contact.touch_point
    if segments and touch > segments[0].to:
        raise SceneError(
            f"ends before the place that touches first, {touch * 1e3:.3g} mm from the tip.",
            key="projectile.segments[1].to",
            value=f"{segments[0].to * 1e3:.3g} mm",
            remedy="The first segment must touch: only its material may yield.",
        )


def require_elastic_parts(bodies: Bodies) -> None:
    """Refuse a later segment that would yield: in both models it stays elastic (SceneError)."""
    number, stress = part_flows(bodies)
    if number and is_wanted("rod-plasticity", bodies.scene.effects):
        metal = bodies.rod.segments[number - 1].material
        over = f"{stress / 1e6:.3g} MPa (estimated) over {metal.yield_stress / 1e6:.3g} MPa"
        raise SceneError(
            f"would yield along its length: {over}; only the first segment may yield.",
            key=f"projectile.segments[{number}].material",
            value=metal.name,
            remedy="A lower speed; or state the material without yield_stress, which lets it stay elastic.",
        )


def _require_no_flank(bodies: Bodies, body: Turned, fidelity: str) -> None:
    """Refuse a flank of a turned body that comes down nearly flat (SceneError)."""
    if not _lays_flank(bodies, body):
        return
    angle, deep = bodies.scene.impact.angle, bodies.contact.round_contact.depth
    if bodies.contact.touch_point[0] == body.face == 0 and not body.tip_curvature(angle):
        raise SceneError(
            f"ends in a point that would be pressed in by {deep * 1e3:.2g} mm, as far as to its flanks.",
            key="projectile",
            remedy="Round the point, or cut it off flat.",
        )
    length, height = body.flank(angle)
    lean = round(math.degrees(math.asin(height / length)))
    laid = f"flank of {length * 1e3:.3g} mm"
    laid = f"presses in a {laid}, {lean} deg from level" if lean else f"lays a {laid} along the barrier"
    found = [f"{at} deg" for side in (-1, 1) if (at := _pointed(bodies, body, side)) is not None]
    told = f"Give an angle of {' or '.join(found)}."
    slower = f"Give a lower speed or stronger materials: the tip is pressed in by {deep * 1e3:.2g} mm."
    remedy = f"{told if found and FLAT * deep < length else slower} {_any_part(fidelity)}"
    raise _of_angle(bodies, f"{laid}: a line would touch, not a point.", remedy)


def _lays_flank(bodies: Bodies, body: Turned) -> bool:
    """Return whether a flank of a turned body comes down nearly flat."""
    size, (length, height) = bodies.contact.round_contact, body.flank(bodies.scene.impact.angle)
    return length > 2 * size.a_t and height < FLAT * size.depth


def _pointed(bodies: Bodies, body: Turned, side: int) -> int | None:
    """Return the nearest angle, whole deg, on one side at which a point touches; None where there is none."""
    stated = math.degrees(bodies.scene.impact.angle)
    for angle in range(math.floor(stated) + (side > 0), 90 * side, side):
        try:
            turned = Bodies(change(bodies.scene, "impact.angle", f"{angle} deg"), bodies.effects)
        except SceneError:  # at this angle the body does not come down on a barrier that moves
            continue
        if angle != stated and not turned.contact.lands_flat and not _lays_flank(turned, body):
            return angle
    return None


def _require_tip(bodies: Bodies, body: Faceted, fidelity: str) -> None:
    """Refuse a mesh that lays its side along the barrier, or stands upright on a tip beside its axis."""
    angle, size = bodies.scene.impact.angle, bodies.contact.round_contact
    remedy = f"Give another angle, or change the mesh. {_any_part(fidelity)}"
    if angle == 0 and body.off_axis() > BESIDE_AXIS * body.diameter:
        problem = f"stands the body on a tip {body.off_axis() * 1e3:.3g} mm beside its mass centre's axis."
        raise _of_angle(bodies, problem, remedy)
    back, ahead, _ = body.spread(angle, FLAT * size.depth, (size.R1, size.R2))
    flank = back if angle < 0 else ahead
    if flank > 2 * size.a_t:
        problem = f"lays {flank * 1e3:.3g} mm of the mesh's side along the barrier: no tip would touch."
        raise _of_angle(bodies, problem, remedy)


def _any_part(fidelity: str) -> str:
    """Return what to use where not a point of the tip touches, in place of a fidelity."""
    if fidelity == "solid":
        return "`fem-impact run` finds what touches, on several meshes (accuracy.levels above 1)."
    return f"Use fidelity solid{', or state restitution' if fidelity == 'rigid' else ''}."


def _of_angle(bodies: Bodies, problem: str, remedy: str) -> SceneError:
    """Return the refusal of the angle of an impact."""
    value = f"{math.degrees(bodies.scene.impact.angle):.4g} deg"
    return SceneError(problem, key="impact.angle", value=value, remedy=remedy)


def flat_part(bodies: Bodies) -> str:
    """Return what of the projectile lands flat."""
    return f"a {'straight side' if bodies.scene.impact.angle else 'flat face'} that lands all at once"


def not_reduced(bodies: Bodies) -> str:
    """Return what the reduced model has no answer for, empty where it has one."""
    obstacles = {
        "a mesh that lands along a ridge": lands_on_ridge(bodies),
        "a plate thinner than its contact is wide": is_wider(bodies),
        "a hardened skin": "machined-skin" in bodies.effects,
    }
    found = next((what for what, holds in obstacles.items() if holds), "")
    return found or flows_below(bodies) or gives_elsewhere(bodies)


def require_own_mesh(bodies: Bodies, fidelity: str) -> None:
    """Refuse what the model cannot do with a user's mesh as the projectile (SceneError)."""
    mesh, scene = bodies.rod.own_mesh, bodies.scene
    if mesh is None:
        return
    if fidelity == "modal" and lands_on_ridge(bodies):
        problem = "lands along a ridge, an edge of the mesh, of which the reduced model has no law."
        raise _of_angle(bodies, problem, "Use fidelity solid, or another angle.")
    if fidelity == "solid" and "machined-skin" in bodies.effects and bodies.contact.rod.skin:
        problem = "has a hardened layer, but how deep a node lies under a mesh's facets is not computed."
        remedy = 'Add "-machined-skin" to effects.'
        raise SceneError(problem, key="effects", value=list(scene.effects), remedy=remedy)
