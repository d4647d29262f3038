"""``hardness``: a rigid cone is pressed into a block that yields: mean pressure, Vickers' number beside it.

Conventions: the cone displaces as much as Vickers' pyramid (136 degrees between opposite faces) at the same
depth: half its angle is 70.3 degrees. The mean pressure is the force over the projected area of the true
contact, whose edge is where the face comes to touch, its bulge included. Vickers' number counts the faces of
the pyramid, larger by 1/.927: HV = .927 p / 9.80665 MPa. The flow curve is the static one.

Solver and reference move the cone at the same slow speed. Both are carried on from two meshes to cells of no
size, with an error of first order in the cell: pressure acts at nodes and ends within a cell. The closed
form of Vickers' number (`fem_impact.physics.indentation`) is held to the reference, bare and under a layer.
"""

from dataclasses import dataclass, field
from functools import cache
from math import ceil, radians, sqrt, tan

import numpy as np

import meshes
from fem_impact.arrays import Array
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.errors import RunError, SceneError
from fem_impact.evidence.problems import setups
from fem_impact.evidence.problems.bodies import Block, FreeBody, body_model, placed
from fem_impact.evidence.problems.problem import Check, Solved, Values
from fem_impact.evidence.references.axisymmetric import FROM, REACH, Indentation, Metal, cone_speed, indent
from fem_impact.physics.hardening import KGF_PER_MM2, TABOR, TABOR_STRAIN, Hardening, Skin, power_hardening
from fem_impact.physics.indentation import FACES, FRICTION, FRICTIONS, share, vickers
from fem_impact.scene.library import material
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.march import march
from fem_impact.solid.state import State
from fem_impact.solid.stepguard import StepGuard
from meshes import Zone

PRESSURE, RADIUS = 0.03, 0.03
YIELDING = 2.5  # half-width and depth of the cells that may yield, over the radius of the cone at the face
LEVELS = 2  # halvings of the block's cells
WIDE = 1.35  # radius of the cone's body over its radius at the face: what is piled up touches it too
RADIUS_M = 1e-3  # m, of the cone at the face, at the end; nothing depends on it
PYRAMID = radians(70.3)  # half the angle of the cone that displaces as much
LAYERS = Skin(0.35, 2.0), Skin(0.35, 2.0, "exponential")  # depths over the radius of the cone at the face
MIDDLE = sqrt((1 + FROM + FROM**2) / 3)  # mean depth of the cone over the last, where the pressure is read
BARE, LAYERED = 0.02, 0.05  # of the closed form
STEELS = ("plate-steel", "rod-steel")
TENSILE = "the flow curve is that of the tensile test; no flow curve was fitted to the hardness"
RULE = "Tabor's rule, for pyramids in practice"


@dataclass(slots=True)
class _Watch:
    """Notes where the nodes of the block's face are first pressed; stops at a depth, m."""

    contact: SurfaceContact
    speed: float
    depth: float
    every: int = 1
    touched: list[tuple[float, float]] = field(default_factory=list)
    seen: set[int] = field(default_factory=set)

    def observe(self, state: State) -> bool:
        """Note the depth and the radius of nodes whose first impulse has come."""
        first = len(self.contact.rod.places)
        pressed = np.flatnonzero(self.contact.points.memory[first:].any(axis=1))
        for node in set(pressed.tolist()) - self.seen:
            t, b, _ = state.x[self.contact.barrier.places[node]]
            self.touched.append((self.speed * state.time, float(np.hypot(t, b))))
            self.seen.add(node)
        return self.speed * state.time >= self.depth


def press(p: Values, law: Hardening, friction: float, cells: int) -> tuple[Indentation, int, int]:
    """Press the cone in through the solver; return what it met, steps and cells.

    Raises
    ------
    RunError
        If a cell folds or is crushed.
    """
    speed = cone_speed(metal_of(p, law))
    # the block, fine where it may yield, its faces as far as the reference's
    cell, wide, half = RADIUS_M / cells, WIDE * RADIUS_M, YIELDING * RADIUS_M
    base = cell * 2**LEVELS
    far = ceil(REACH * RADIUS_M / base) * base
    fine = Zone(np.zeros(3), np.eye(3), np.array([-half, 0.0, -half]), np.array([half, half, 0.0]))
    under = meshes.block([-far, 0.0, -far], [far, far, 0.0], base, [fine] * LEVELS)
    # the cone just over the block, moving down at a speed, m/s, that nothing changes
    line = np.array([[0.0, 0.0], [wide, wide / tan(p["angle"])]])
    cone = meshes.rod(line, 1.2 * wide, 2 * round(wide / cell))
    points = placed(cone.mesh.points, 0.0, 0.0)
    metal = p["E"], p["nu"], p["rho"]
    block = Block(under, cell, *metal, law)
    velocity = np.array([0.0, 0.0, -speed])
    model = body_model(FreeBody(cone, points, velocity, *metal, friction=friction, block=block, driven=True))
    if not isinstance(model.contact, SurfaceContact):
        raise TypeError("a cone on a block touches a surface")
    state, force, guard = model.initial_state(), setups.force_recorder(model), StepGuard(model, 20)
    watch = _Watch(model.contact, speed, RADIUS_M / tan(p["angle"]))
    march(model, state, [force, guard, watch])
    if guard.reason:
        raise RunError(guard.reason)
    indentation = Indentation([speed * t for t in force.times], force.values, sorted(watch.touched))
    return indentation, state.step, len(model.geometry.barrier.cells) if model.geometry.barrier else 0


def metal_of(p: Values, law: Hardening) -> Metal:
    """Return the metal of the reference."""
    return Metal(p["E"], p["nu"], p["rho"], law.yield_stress, law.slope, law.exponent)


def _limit(coarse: Array, fine: Array) -> Array:
    """Return what two meshes, one with half the other's cells, tend to with smaller ones."""
    return 2 * fine - coarse


@cache
def _reference(
    metal: Metal, angle: float, friction: float, cells: int, skin: Skin | None = None
) -> tuple[float, float]:
    """Return the mean pressure, Pa, and the contact radius over the depth in axisymmetric elements."""
    coarse, fine = (
        indent(metal, angle, friction, n, skin.mean if skin else None).coefficients()
        for n in (cells, 2 * cells)
    )
    pressure, radius = _limit(coarse, fine)
    return float(pressure), float(radius)


def _vickers(p: Values, friction: float) -> list[Check]:
    """Return Vickers' numbers of the measured steels: measured, in closed form and by the reference."""
    checks = []
    for name in STEELS:
        of, at = material(name), f"of {name}, f = {friction:g}"
        law, cells = hardening_of(of), int(p["cells"]) // 2
        steel_metal = metal_of({"E": of.E, "nu": of.nu, "rho": of.rho}, law.power)
        pressure, _ = _reference(steel_metal, p["angle"], friction, cells)
        hardness = FACES * pressure / KGF_PER_MM2
        if of.hardness:
            checks.append(Check.shown(f"HV {at}", "1", hardness, of.hardness, TENSILE))
        if p["angle"] != PYRAMID or friction not in FRICTIONS:
            continue
        checks.append(Check(f"closed form, HV {at}", "1", vickers(of.E, law, friction), hardness, BARE))
        for skin in LAYERS if friction == FRICTION else ():
            layered, wide = _reference(steel_metal, PYRAMID, friction, cells, skin)
            part = share(law, skin, wide * MIDDLE / tan(PYRAMID))
            closed, by = 1 + (skin.factor - 1) * part, layered / pressure
            checks.append(Check(f"closed form, {skin.shape} layer over none, {at}", "1", closed, by, LAYERED))
    return checks


def flow_curve(p: Values) -> Hardening:
    """Return the flow curve of the block.

    Raises
    ------
    SceneError
        If no power law reaches the ultimate stress.
    """
    try:
        return power_hardening(p["E"], p["yield_stress"], p["ultimate_stress"])
    except ValueError as error:
        raise SceneError(str(error), key="ultimate_stress", value=p["ultimate_stress"]) from None


def solve(p: Values) -> Solved:
    """Compare mean pressure and contact radius with the axisymmetric code, without and with friction.

    Raises
    ------
    SceneError
        If no power law reaches the ultimate stress.
    """
    law, size, checks = flow_curve(p), (0, 0), list[Check]()
    cells = int(p["cells"])
    frictions = (0.0, p["f"]) if p["f"] else (0.0,)
    for f in frictions:
        coarse, fine = (press(p, law, f, n) for n in (cells // 2, cells))
        limits = _limit(coarse[0].coefficients(), fine[0].coefficients())
        exact, at = _reference(metal_of(p, law), p["angle"], f, cells // 2), f"f = {f:g}"
        flow = float(law.flow_stress(TABOR_STRAIN))
        checks += [
            Check(f"mean pressure, {at}", "Pa", float(limits[0]), exact[0], PRESSURE),
            Check(f"contact radius / depth, {at}", "1", float(limits[1]), exact[1], RADIUS),
            Check.shown(f"HV / flow stress at 8 %, {at}", "1", FACES * exact[0] / flow, TABOR, RULE),
            *_vickers(p, f),
        ]
        size = fine[1:]
    return Solved(tuple(checks), *size)
