"""``wall-bar``: a square bar whose end stops dead; five public codes give the same wall stress.

Measured there with plain 8-point hexahedra on 12 x 12 x 144 cells, 19 x 19 x 240 mm, E 206 GPa, nu 0.29,
rho 7850, 3 m/s, step 70 ns: mean wall stress over 0.15 to 0.85 of 2 L / c0, sampled at t = k dt. Bars of
other sizes and materials are held to an explicit code of bricks (`reference.bricks`) that gives the printed
numbers to all their digits; stress is linear in the speed.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np

from fem_impact.solid.elements import Kind
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.verify import steel
from fem_impact.verify.bodies import Body, body_model, unsliced
from fem_impact.verify.problem import Check, Problem, Solved, Values
from fem_impact.verify.reference.bar import bar_speed
from fem_impact.verify.reference.bricks import wall_stress
from fem_impact.verify.square_bar import KINDS, is_printed, parameters, square_bar, twin

__all__ = ["PROBLEM"]

STEP = 0.25925918  # over cell edge / speed of dilatational waves: the printed 70 ns
PRINTED = (120.576703e6, 120.5744e6, 120.5780e6)  # Pa at 3 m/s, of these kinds
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
    body = Body(unsliced(mesh), mesh.points, velocity, p["E"], p["nu"], p["rho"], kind=kind, held=held)
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
        printed = PRINTED[kind] * p["speed"] / PRINTED_SPEED
        checks.append(Check(f"{name}, printed", "Pa", stress, printed, TOLERANCE[kind]))
    return Solved(tuple(checks), state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "wall-bar",
    "a square bar whose end stops dead, beside five public codes",
    (steel.speed("speed", "speed of the bar", PRINTED_SPEED), *parameters()),
    solve,
)
