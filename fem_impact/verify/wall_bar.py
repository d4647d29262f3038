"""``wall-bar``: a square bar whose end stops dead; five public codes give the same wall stress.

Measured there with plain 8-point hexahedra on 12 x 12 x 144 cells, 19 x 19 x 240 mm, E 206 GPa, nu 0.29,
rho 7850, 3 m/s, step 70 ns: mean wall stress over 0.15 to 0.85 of 2 L / c0, sampled at t = k dt. Stress is
linear in the speed, so other speeds have the printed stress in proportion.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem_impact.solid.elements import Kind
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.verify import steel
from fem_impact.verify.bodies import Body, body_model, unsliced
from fem_impact.verify.problem import Check, Problem, Solved, Values
from fem_impact.verify.reference.bar import bar_speed
from fem_impact.verify.square_bar import KINDS, LENGTH, NU, RHO, SIDE, E, element, square_bar

__all__ = ["PROBLEM"]

STEP = 7e-8  # s
CELLS = (12, 144)  # across and along
PRINTED = (120.576703e6, 120.5744e6, 120.5780e6)  # Pa at 3 m/s, of these kinds
TOLERANCE = (1e-6, 1e-4, 1e-4)
PRINTED_SPEED = 3.0
WINDOW = (0.15, 0.85)


class _WallStress:
    """Sums the force on the held end; the bar is followed to the end of the window."""

    every = 1

    def __init__(self, model: Model, end: float) -> None:
        held = model.geometry.rod_points[:, 2] < 1e-9
        self.rows = model.layout.rod[held, 2]
        self.end = end
        self.times: list[float] = []
        self.values: list[float] = []

    def observe(self, state: State) -> bool:
        """Take the stress at the present positions, Pa; half the section is modelled."""
        self.times.append(state.time)
        self.values.append(-2 * float(state.force[self.rows].sum()) / SIDE**2)
        return state.time > self.end

    def mean(self, start: float, end: float) -> float:
        """Return the mean over a window of time."""
        t = np.array(self.times)
        return float(np.array(self.values)[(t >= start) & (t <= end)].mean())


def _model(kind: Kind, speed: float) -> Model:
    mesh = square_bar(*CELLS)
    held = np.zeros(mesh.points.shape, dtype=bool)
    held[mesh.points[:, 2] == 0.0, 2] = True
    velocity = np.zeros_like(mesh.points)
    velocity[:, 2] = -speed
    body = Body(unsliced(mesh), mesh.points, velocity, E, NU, RHO, kind=kind, held=held)
    return replace(body_model(body), steps={"rod": STEP})


def solve(p: Values) -> Solved:
    """Run the public codes' bar with one kind of element."""
    kind, crossing = int(p["element"]), 2 * LENGTH / bar_speed(E, RHO)
    model = _model(KINDS[kind], p["speed"])
    state = model.initial_state()
    wall = _WallStress(model, WINDOW[1] * crossing)
    march(model, state, [wall])
    stress = wall.mean(WINDOW[0] * crossing, WINDOW[1] * crossing)
    printed = PRINTED[kind] * p["speed"] / PRINTED_SPEED
    checks = (Check(f"mean wall stress, {KINDS[kind]} hexahedra", "Pa", stress, printed, TOLERANCE[kind]),)
    return Solved(checks, state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "wall-bar",
    "a square bar whose end stops dead, beside five public codes",
    (
        steel.speed("speed", "speed of the bar", PRINTED_SPEED),
        element(2),
    ),
    solve,
)
