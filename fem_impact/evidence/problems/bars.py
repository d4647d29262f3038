"""``wall-bar``, ``tilted-bar``, ``bar``: bars on rigid planes, which a scene has as meshes of its own.

A round one without lateral strain strikes a wall, and bounces between two; a square one strikes a wall or a
tilted plate.

The tilted bar flies along its axis onto a rigid plate tilted by 20 degrees.

Printed, 4 x 4 x 48 plain hexahedra at 3 m/s: a normal rebound of 1.403 m/s without friction in two public
codes, about 1.91 m/s with f = 0.2. Their contacts are springs under nodes, and friction pulls at springs a
tenth as stiff. The same mesh on such springs (`NodeSprings`, CalculiX' stiffness) gives both numbers within
1.5 %.

Hard contact differs from them, with friction by 4 to 6 % on any mesh, and the springs are why: a third of the
impulse sticks, and these springs give back what they stored. An explicit code of bricks (`references.bricks`)
that gives the printed numbers on those springs goes to the hard contact with stiffer ones, so at all
parameters its springs of 20 E / cell decide. They differ from hard contact by what goes with the root of
their give, which softer ones (6 E / cell) tell, and by the mass of half a cell that stops dead. Normal
rebounds of plain hexahedra, m/s, bricks in a fixed attitude (turning takes 0.005):

==============================  ==================  ==================  ==================
contact                         4 cells, f = 0, .2  8 cells, f = 0, .2  12 cells, f = 0, .2
==============================  ==================  ==================  ==================
springs 2.6e13 N/m3, 1 / 20     1.421, 1.75         -                   -
springs 2.6e13 N/m3, 1 / 10     1.421, 1.900        -                   -
springs 2.6e13 N/m3, 1          1.421, 2.152        -                   -
springs 2 E / cell, 1           1.375, 2.077        1.392, 2.052        1.401, 2.039
springs 6 E / cell, 1           1.352, 2.047        1.375, 2.025        1.387, 2.014
springs 20 E / cell, 1          1.342, 2.039        1.368, 2.016        1.381, 2.004
hard                            1.329, 2.037        1.358, 2.011        1.373, 1.999
==============================  ==================  ==================  ==================
"""

from dataclasses import dataclass, field, replace
from math import cos, pi, radians, sin, sqrt
from typing import ClassVar

import numpy as np

import meshes
from fem_impact.arrays import Array, Bools, Ints
from fem_impact.evidence.problems import setups
from fem_impact.evidence.problems.problem import Check, Solved, Values, defaults, within
from fem_impact.evidence.references.bricks import Bar, rebound, spring_force, wall_stress
from fem_impact.evidence.references.rod_end import FOLLOWED, BarImpact, bar_speed, chain_restitution, strike
from fem_impact.physics.contact import pressure_speed
from fem_impact.scene.fields import Element
from fem_impact.scene.impact import Impact
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from meshes import OUTER, SKIN, HexMesh


def node_areas(mesh: HexMesh, faces: Bools) -> Array:
    """Return the area (n,), m2, that each node has in some of the outer faces (k,)."""
    corners = mesh.faces[faces]
    a, b = (mesh.points[corners[:, 2 + i]] - mesh.points[corners[:, i]] for i in (0, 1))
    area = 0.5 * np.linalg.norm(np.cross(a, b), axis=1)
    return np.asarray(
        np.bincount(corners.ravel(), np.repeat(area / 4, 4), len(mesh.points)), dtype=np.float64
    )


@dataclass(slots=True)
class NodeSprings:
    """Springs between the rigid plane n = 0 and the nodes of a body.

    Attributes
    ----------
    nodes : (k, 3) unknowns; stiffness : (k,) N/m, along the normal
    stick : tangential over normal stiffness; f : Coulomb's coefficient
    anchor : (k, 2) where each node holds on to the plane, m
    """

    body: ClassVar[str] = "rod"
    effect: ClassVar[str] = "contact"
    accounts: ClassVar[tuple[str, ...]] = ()
    moving: ClassVar[tuple[str, ...]] = ("anchor",)
    nodes: Ints
    stiffness: Array
    stick: float
    f: float
    anchor: Array = field(init=False)

    def __post_init__(self) -> None:
        self.anchor = np.zeros((len(self.nodes), 2))

    def add(self, state: State) -> None:
        """Add the springs' forces; where friction gives way, the anchor follows."""
        place = state.x[self.nodes]
        pull, press, self.anchor = spring_force(place, self.anchor, self.stiffness, self.stick, self.f)
        state.force[self.nodes] += np.column_stack([pull, press])

    def energies(self, state: State) -> tuple[float, ...]:
        """Return nothing: what springs hold and lose is no part of the ledger."""
        return ()


PRINTED_BAR = defaults("wall-bar")
ALONG = 12  # times as many cells along the printed bar as across it
SLENDER = 2.5, 40.0  # length over side
KINDS: tuple[Element, ...] = ("full", "bbar", "incompatible")


def is_printed(p: Values) -> bool:
    """Return whether size and material are the printed ones."""
    return all(p[name] == PRINTED_BAR[name] for name in ("side", "length", "E", "nu", "rho"))


def counts(p: Values) -> tuple[int, int]:
    """Return how many cells of the printed proportion lie across and along the bar.

    Raises
    ------
    SceneError
        If the bar is too stubby or too slender.
    """
    setups.slender(p, "side", *SLENDER)
    longer = p["length"] / p["side"] * PRINTED_BAR["side"] / PRINTED_BAR["length"]
    return int(p["cells"]), round(ALONG * p["cells"] * longer)


def square_bar(p: Values) -> HexMesh:
    """Return half the bar, b >= 0, standing on n = 0."""
    across, along = counts(p)
    # the block's cells are as cubic as its size says: build it as such and scale it to the bar
    block = meshes.block([-across / 2, 0.0, -float(along)], [across / 2, across / 2, 0.0], 1.0)
    points = block.points * np.array([p["side"] / across, p["side"] / across, p["length"] / along])
    points[:, 2] += p["length"]
    points[np.abs(points[:, 2]) < 1e-9 * p["length"], 2] = 0.0
    return replace(block, points=points, face_tag=np.where(block.face_tag == OUTER, SKIN, block.face_tag))


def twin(p: Values) -> Bar:
    """Return the same bar, of the same elements, for the reference's own explicit code."""
    return Bar(p["side"], p["length"], counts(p), p["E"], p["nu"], p["rho"], KINDS[int(p["element"])])


STEP = 0.25925918  # over cell edge / speed of dilatational waves: the printed 70 ns
PRINTED_STRESS = (120.576703e6, 120.5744e6, 120.5780e6)  # Pa at 3 m/s, of these kinds
TOLERANCE = (1e-6, 1e-4, 1e-4)
PRINTED_SPEED, PRINTED_CELLS = 3.0, 12
WINDOW = (0.15, 0.85)  # of the duration, over which a plateau is averaged


def _square_bar(p: Values, angle: float, effects: tuple[str, ...], f: float = 0.0) -> Model:
    """Return the bar of a scene that flies along its axis, which is inclined to the normal by ``angle``."""
    impact = Impact(angle, -p["speed"] * cos(angle), -p["speed"] * sin(angle))
    return setups.meshed_bar_model(p, square_bar(p), impact, effects, f, KINDS[int(p["element"])])


def solve_wall(p: Values) -> Solved:
    """Run the bar with one kind of element in the solver and in the reference's code of bricks."""
    kind = int(p["element"])
    start, end = (share * 2 * p["length"] / bar_speed(p["E"], p["rho"]) for share in WINDOW)
    step = STEP * p["side"] / p["cells"] / pressure_speed(setups.steel(p))
    model = replace(_square_bar(p, 0.0, ("barrier-rigid",)), steps={"rod": step})
    state = model.initial_state()
    # the stress on the held end at the present positions, Pa; half the section is modelled
    rows = model.layout.rod[model.geometry.rod.mesh.points[:, 2] < 1e-9, 2]
    wall = setups.Recorder(lambda state: -2 * float(state.force[rows].sum()) / p["side"] ** 2, 0.0, end)
    march(model, state, [wall])
    stress, name = wall.mean(start, end), f"mean wall stress, {KINDS[kind]} hexahedra"
    exact = wall_stress(twin(p), p["speed"], state.dt, start, end)
    checks = [Check(name, "Pa", stress, exact, TOLERANCE[kind])]
    if is_printed(p) and p["cells"] == PRINTED_CELLS:
        printed = PRINTED_STRESS[kind] * p["speed"] / PRINTED_SPEED
        checks.append(Check(f"{name}, printed", "Pa", stress, printed, TOLERANCE[kind]))
    return Solved(tuple(checks), state.step, len(model.geometry.rod.mesh.cells))


ANGLE, SPEED = radians(20), 3.0
PRINTED, REBOUND = {0.0: 1.403, 0.2: 1.91}, 0.015  # m/s, by friction; its springs' stiffness is not printed
PRINTED_MESH = {"cells": 4, "element": 0}
SPRINGS = "normal rebound, springs of public codes"
HARD = "the printed one has springs that store and give back, on 4 cells"
TIME = 2.5  # round trips of a wave that are followed: bars leave after 1.4 and may come again after 3
FASTEST = 0.01  # over c0
STIFF, SOFTER = 20.0, 6.0  # stiffness of springs that are nearly hard, over E / cell
CLOSED, LEDGER = 1e-6, 1e-5


def _tilted(p: Values) -> Model:
    effects = (*(("friction",) if p["f"] else ()), "barrier-rigid", "large-rotation")
    return _square_bar(p, p["angle"], effects, p["f"])


def _time(p: Values) -> float:
    return TIME * 2 * p["length"] / bar_speed(p["E"], p["rho"])


def _on_springs(p: Values) -> tuple[float, float]:
    """Return the solver's normal rebound, m/s, on the springs of public codes, and its step, s."""
    model = _tilted(p)
    mesh = model.geometry.rod.mesh
    area = node_areas(mesh, (mesh.points[mesh.faces, 2] == 0.0).all(axis=1))
    nodes, stiffness = model.layout.rod[area > 0], p["stiffness"] * area[area > 0]
    stiffest = float(max(stiffness * model.inverse_mass[nodes[:, 2]]))
    step = 1 / sqrt((2 / model.step) ** 2 + stiffest)  # half the largest stable one: springs open and close
    springs = NodeSprings(nodes, stiffness, p["stick"], p["f"])
    sprung = replace(model, forces=[*model.forces, springs], impulses=[], steps={"rod": step})
    march(sprung, state := sprung.initial_state(), [setups.Until(sprung.ledger(), _time(p))])
    return setups.rigid_of(sprung, state).V_n, step


def _reference(p: Values, springs: tuple[float, float]) -> float:
    return rebound(twin(p), p["angle"], p["speed"], p["f"], springs, _time(p))


def _rebounds(p: Values, hard: float) -> list[Check]:
    """Return the rebounds beside the reference's, and beside the printed ones where there is one."""
    coarse, name = {**p, **PRINTED_MESH}, "normal rebound, hard contact"
    soft, step = _on_springs(coarse)
    approach, passage = p["speed"] * cos(p["angle"]), 2 * p["length"] / bar_speed(p["E"], p["rho"])
    # springs open and close between steps, of which the impact has so many
    jerks = approach * step / passage
    stiff, softer = (_reference(p, (k * p["E"] * p["cells"] / p["side"], 1.0)) for k in (STIFF, SOFTER))
    tail = abs(stiff - softer) / (sqrt(STIFF / SOFTER) - 1)
    # as in `bar` the energy of half a cell's mass is lost, and half that share of the speed
    closing = 0.25 * approach / counts(p)[1]
    checks = [
        Check(SPRINGS, "m/s", soft, _reference(coarse, (p["stiffness"], p["stick"])), jerks, "absolute"),
        Check(name, "m/s", hard, stiff, tail + closing, "absolute"),
    ]
    slow = p["speed"] <= SPEED  # faster bars turn farther while they touch
    if not (slow and is_printed(p) and p["f"] in PRINTED and abs(p["angle"] - ANGLE) < 1e-9):
        return checks
    printed = PRINTED[p["f"]] * p["speed"] / SPEED
    beside = f"{name}, printed"
    return [
        *checks,
        Check(f"{SPRINGS}, printed", "m/s", soft, printed, REBOUND),
        Check.shown(beside, "m/s", hard, printed, HARD),
    ]


def solve_tilted(p: Values) -> Solved:
    """Compare the rebound; momentum, its moment and energy must balance.

    Raises
    ------
    SceneError
        If the bar is too stubby, too slender or too fast.
    """
    fastest = FASTEST * bar_speed(p["E"], p["rho"])
    within(p, "speed", 0.0, fastest, "m/s", "the reference holds for small strains.")
    model = _tilted(p)
    state, watch = model.initial_state(), setups.Until(model.ledger(), _time(p))
    start = setups.rigid_of(model, state)
    march(model, state, [watch])
    end, book = setups.rigid_of(model, state), model.book
    turned = end.spin - start.spin
    allowed = 1e-4 * end.inertia * abs(end.Omega)
    checks = [
        *_rebounds(p, end.V_n),
        Check("normal momentum gained", "N s", end.mass * (end.V_n - start.V_n), 2 * book.impulse[1], CLOSED),
        Check("angular momentum gained", "N m s", turned, -2 * book.impulse[2], allowed, "absolute"),
        Check("energy ledger / E_0", "1", watch.ledger.worst / watch.ledger.start, 0.0, LEDGER, "at most"),
        Check("impulse ratio", "1", book.impulse[0] / book.impulse[1], p["f"], CLOSED, "at most"),
    ]
    return Solved(tuple(checks), state.step, len(model.geometry.rod.mesh.cells))


PLATEAU, DURATION, GROWTH, CLOSING, CHAIN = 0.005, 0.01, 1e-3, 1e-6, 1e-6
FLIGHT = 0.3  # time between two walls over the duration of a strike
FAST = 0.05  # over c0
COARSER = 5  # the bar between two walls has so many times fewer slices


def _round_bar(p: Values, slices: int, across: int) -> Model:
    """Return a scene's bar on the wall, a mesh of its own: a chain has equal links up to its ends."""
    flat = np.array([[0.0, 0.0], [p["diameter"] / 2, 0.0]])
    slab = p["length"] / slices
    bar = meshes.rod(flat, p["length"], across, slice_length=slab, nose=False).mesh
    drop = Impact(0.0, -p["speed"], 0.0)
    return setups.meshed_bar_model({**p, "nu": 0.0}, bar, drop, ("barrier-rigid",))


@dataclass(slots=True)
class Ceiling:
    """A second rigid wall at n = height: the solver's plane contact, seen upside down."""

    effect: ClassVar[str] = "contact"
    accounts: ClassVar[tuple[str, ...]] = ()
    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ()
    wall: PlaneContact
    height: float
    bounces: int = 0

    def resolve(self, state: State) -> None:
        """Turn the wall's own nodes upside down, let them touch, turn them back."""
        n, before = self.wall.nodes[:, 2], self.wall.book.step.active
        for vector in (state.v, state.force):
            vector[n] *= -1
        state.x[n] = self.height - state.x[n]
        self.wall.resolve(state)
        self.bounces += int(self.wall.book.step.active > 0 and before == 0)
        for vector in (state.v, state.force):
            vector[n] *= -1
        state.x[n] = self.height - state.x[n]

    def energies(self, state: State) -> tuple[float, ...]:
        """Return nothing: this wall's closing loss is left to the energy that is checked."""
        return ()


def _one_strike(p: Values, exact: BarImpact) -> tuple[list[Check], int, int]:
    slices = int(p["slices"])
    model = _round_bar(p, slices, int(p["across"]))
    state, force = model.initial_state(), setups.force_recorder(model)
    energy = setups.Until(model.ledger(), FOLLOWED * exact.duration)
    march(model, state, [force, energy])
    plateau = force.mean(WINDOW[0] * exact.duration, WINDOW[1] * exact.duration, force.span[0])
    closing = energy.ledger.sample(state)["contact_dissipation"] / energy.ledger.start
    spans = model.book.intervals
    chain = chain_restitution(slices, model.step * slices * bar_speed(p["E"], p["rho"]) / p["length"])
    checks = [
        Check("plateau of the wall force", "N", plateau, exact.force, PLATEAU),
        Check("duration", "s", spans[-1].end - spans[0].start, exact.duration, DURATION),
        Check("contacts", "1", force.touches, 1, 0.0, "absolute"),
        # a bar that strains along itself alone is a chain of its slices' masses
        Check("restitution", "1", setups.rigid_of(model, state).V_n / p["speed"], chain, CHAIN, "absolute"),
        Check("largest energy / E_0", "1", energy.most, 1.0, GROWTH, "at most"),
        # half a slice of mass stops dead at the wall
        Check("closing loss / E_0", "1", closing, 0.5 / slices, CLOSING),
    ]
    return checks, state.step, len(model.geometry.rod.mesh.cells)


def solve_bar(p: Values) -> Solved:
    """Strike once, then bounce.

    Raises
    ------
    SceneError
        If the bar is so fast that it is squeezed by more than a few per cent.
    """
    fastest = FAST * bar_speed(p["E"], p["rho"])
    within(p, "speed", 0.0, fastest, "m/s", "the reference holds for small strains.")
    exact = strike(p["E"], p["rho"], pi * p["diameter"] ** 2 / 4, p["length"], p["speed"])
    checks, steps, elements = _one_strike(p, exact)
    if p["bounces"]:
        # bounce for the time that so many bounces without loss would take
        slices = max(4, int(p["slices"]) // COARSER)
        gap = FLIGHT * exact.duration * p["speed"]
        model = _round_bar(p, slices, 6)
        top = model.geometry.rod_points[:, 2] > 0.999 * p["length"]
        smooth = PlaneContact(model.layout.rod[top], model.inverse_mass, np.zeros(int(top.sum())))
        ceiling = Ceiling(smooth, p["length"] + gap)
        walled = replace(model, impulses=[*model.impulses, ceiling])
        state = walled.initial_state()
        state.x[model.layout.rod[:, 2]] += 0.5 * gap
        energy = setups.Until(walled.ledger(), p["bounces"] * (1 + FLIGHT) * exact.duration)
        march(walled, state, [energy])
        checks += [
            Check("touches both walls", "1", float(ceiling.bounces > 0), 1.0, 0.0, "absolute"),
            Check("largest energy of all bounces / E_0", "1", energy.most, 1.0, GROWTH, "at most"),
        ]
    return Solved(tuple(checks), steps, elements)
