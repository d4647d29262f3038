"""The contact of public codes: a spring under every node, friction through a second spring that gives way."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import sqrt
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

import meshes
from fem_impact.arrays import Array
from fem_impact.evidence.problems import setups as steel
from fem_impact.evidence.problems.bodies import FreeBody, body_model
from fem_impact.evidence.problems.problem import Check, Problem, Solved, Values
from fem_impact.evidence.references.bricks import Bar, spring_force, wall_stress
from fem_impact.evidence.references.rod_end import bar_speed
from fem_impact.fem.elements import Kind
from fem_impact.scene.parameter import Parameter
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from meshes import OUTER, SKIN, HexMesh


def node_areas(mesh: HexMesh, faces: NDArray[np.bool_]) -> Array:
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
    nodes: NDArray[np.int64]
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


PRINTED_BAR = {"side": 0.019, "length": 0.24, "E": 206e9, "nu": 0.29, "rho": 7850.0}
ALONG = 12  # times as many cells along the printed bar as across it
SLENDER = 2.5, 40.0  # length over side
KINDS: tuple[Kind, ...] = ("full", "bbar", "incompatible")


def parameters() -> tuple[Parameter, ...]:
    """Return size, material, cells across and kind of element."""
    return (
        Parameter("side", "side of the square section", "length", 1e-3, 0.2, default=PRINTED_BAR["side"]),
        steel.length(PRINTED_BAR["length"]),
        *steel.elastic(PRINTED_BAR["E"], PRINTED_BAR["nu"], PRINTED_BAR["rho"]),
        Parameter(
            "cells",
            "cells across the bar, even; 12 times as many along the printed one",
            "",
            4,
            24,
            default=12,
            whole=True,
            even=True,
        ),
        Parameter(
            "element",
            "0: plain 8-point, 1: mean dilatation, 2: incompatible",
            "",
            0,
            2,
            default=2,
            whole=True,
        ),
    )


def is_printed(p: Values) -> bool:
    """Return whether size and material are the printed ones."""
    return all(p[name] == value for name, value in PRINTED_BAR.items())


def counts(p: Values) -> tuple[int, int]:
    """Return how many cells of the printed proportion lie across and along the bar.

    Raises
    ------
    SceneError
        If the bar is too stubby or too slender.
    """
    steel.slender(p, "side", *SLENDER)
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
WINDOW = (0.15, 0.85)


class _WallStress:
    """Sums the force on the held end; the bar is followed to the end of the window."""

    every = 1

    def __init__(self, model: Model, area: float, end: float) -> None:
        self.area = area
        held = model.geometry.rod_points[:, 2] < 1e-9
        self.rows = model.layout.rod[held, 2]
        self.end = end
        self.times: list[float] = []
        self.values: list[float] = []

    def observe(self, state: State) -> bool:
        """Take the stress at the present positions, Pa; half the section is modelled."""
        self.times.append(state.time)
        self.values.append(-2 * float(state.force[self.rows].sum()) / self.area)
        return state.time > self.end

    def mean(self, start: float, end: float) -> float:
        """Return the mean over a window of time."""
        t = np.array(self.times)
        return float(np.array(self.values)[(t >= start) & (t <= end)].mean())


def _step(p: Values) -> float:
    """Return the step, s, that is printed for the printed bar."""
    modulus = p["E"] * (1 - p["nu"]) / ((1 + p["nu"]) * (1 - 2 * p["nu"]))
    return STEP * p["side"] / p["cells"] / sqrt(modulus / p["rho"])


def _model(p: Values, kind: Kind) -> Model:
    mesh = square_bar(p)
    held = np.zeros(mesh.points.shape, dtype=bool)
    held[mesh.points[:, 2] == 0.0, 2] = True
    velocity = np.zeros_like(mesh.points)
    velocity[:, 2] = -p["speed"]
    body = FreeBody(
        meshes.RodMesh.plain(mesh), mesh.points, velocity, p["E"], p["nu"], p["rho"], kind=kind, held=held
    )
    return replace(body_model(body), steps={"rod": _step(p)})


def solve(p: Values) -> Solved:
    """Run the bar with one kind of element in the solver and in the reference's code of bricks."""
    kind = int(p["element"])
    start, end = (share * 2 * p["length"] / bar_speed(p["E"], p["rho"]) for share in WINDOW)
    model = _model(p, KINDS[kind])
    state = model.initial_state()
    wall = _WallStress(model, p["side"] ** 2, end)
    march(model, state, [wall])
    stress, name = wall.mean(start, end), f"mean wall stress, {KINDS[kind]} hexahedra"
    exact = wall_stress(twin(p), p["speed"], state.dt, start, end)
    checks = [Check(name, "Pa", stress, exact, TOLERANCE[kind])]
    if is_printed(p) and p["cells"] == PRINTED_CELLS:
        printed = PRINTED_STRESS[kind] * p["speed"] / PRINTED_SPEED
        checks.append(Check(f"{name}, printed", "Pa", stress, printed, TOLERANCE[kind]))
    return Solved(tuple(checks), state.step, len(model.geometry.rod.mesh.cells))


WALL_BAR = Problem(
    "wall-bar",
    "a square bar whose end stops dead, beside five public codes",
    (steel.speed("speed", "speed of the bar", PRINTED_SPEED), *parameters()),
    solve,
)
