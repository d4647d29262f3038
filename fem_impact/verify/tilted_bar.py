"""``tilted-bar``: the square bar flies along its axis onto a rigid plate tilted by 20 degrees.

Printed, 4 x 4 x 48 plain hexahedra at 3 m/s: a normal rebound of 1.403 m/s without friction in two public
codes, about 1.91 m/s with f = 0.2. Their contacts are springs under nodes, and friction pulls at springs a
tenth as stiff. The same mesh on such springs (`NodeSprings`, CalculiX' stiffness) gives both numbers within
1 % and is judged by them at either friction. Without friction the hard contact of the project is judged too.

With friction hard contact differs, and the sticking springs are why: a third of the impulse sticks, and these
springs give back what they stored. Rebounds on the printed mesh, m/s, by the springs' stiffness in N/m3:

=======================  =====  =======
contact                  f = 0  f = 0.2
=======================  =====  =======
springs 2.6e13, 1 / 20   1.416  1.750
springs 2.6e13, 1 / 10   1.416  1.899
springs 2.6e13, 1        1.416  2.152
springs 2.6e14, 1        1.353  2.012
hard                     1.329  2.037
hard, 12 cells           1.380  1.993
=======================  =====  =======

A single row of nodes is stiffer than an edge: hard contact comes nearer to the printed 1.403 with smaller
cells (1.36, 1.38, 1.39 at 8, 12, 16 across). The answer is in proportion to the speed, which small rotations
hardly disturb.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians, sin, sqrt

import numpy as np

from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.verify import steel
from fem_impact.verify.bodies import Body, body_model, placed, rigid_of, unsliced
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.springs import NodeSprings, node_areas
from fem_impact.verify.square_bar import KINDS, NU, RHO, E, element, square_bar
from fem_impact.verify.watch import Until

__all__ = ["PROBLEM"]

ANGLE, SPEED = radians(20), 3.0
PRINTED, REBOUND = {0.0: 1.403, 0.2: 1.91}, 0.03  # m/s, by friction; tolerance
PRINTED_MESH = {"cells": 4, "element": 0}
HARD = "the printed one has springs for friction that store and give back"
TIME = 4e-4  # s; the bar leaves after 130 us
CLOSED = 1e-6


def _model(p: Values) -> Model:
    across = int(p["cells"])
    mesh = square_bar(across, 12 * across)
    velocity = np.zeros_like(mesh.points)
    velocity[:, 0], velocity[:, 2] = -p["speed"] * sin(p["angle"]), -p["speed"] * cos(p["angle"])
    points, kind = placed(mesh.points, p["angle"], 0.0), KINDS[int(p["element"])]
    return body_model(
        Body(unsliced(mesh), points, velocity, E, NU, RHO, kind=kind, friction=p["f"], turning=True)
    )


def _on_springs(p: Values) -> float:
    """Return the normal rebound, m/s, of the printed mesh on the springs of public codes."""
    model = _model({**p, **PRINTED_MESH})
    mesh = model.geometry.rod.mesh
    area = node_areas(mesh, (mesh.points[mesh.faces, 2] == 0.0).all(axis=1))
    nodes, stiffness = model.layout.rod[area > 0], p["stiffness"] * area[area > 0]
    stiffest = float(max(stiffness * model.inverse_mass[nodes[:, 2]]))
    step = 1 / sqrt((2 / model.step) ** 2 + stiffest)  # half the largest stable one: springs open and close
    springs = NodeSprings(nodes, stiffness, p["stick"], p["f"])
    sprung = replace(model, forces=[*model.forces, springs], impulses=[], steps={"rod": step})
    march(sprung, state := sprung.initial_state(), [Until(sprung.ledger(), TIME)])
    return rigid_of(sprung, state).V_n


def _printed(p: Values, rebound: float) -> list[Check]:
    """Return the rebounds beside the printed ones, where there is one."""
    if p["f"] not in PRINTED or abs(p["angle"] - ANGLE) > 1e-9:
        return []
    printed, name = PRINTED[p["f"]] * p["speed"] / SPEED, "normal rebound, hard contact"
    return [
        Check("normal rebound, springs of public codes", "m/s", _on_springs(p), printed, REBOUND),
        Check.shown(name, "m/s", rebound, printed, HARD)
        if p["f"]
        else Check(name, "m/s", rebound, printed, REBOUND),
    ]


def solve(p: Values) -> Solved:
    """Compare the rebound where it is printed; momentum, its moment and energy must balance everywhere."""
    model = _model(p)
    state, watch = model.initial_state(), Until(model.ledger(), TIME)
    start = rigid_of(model, state)
    march(model, state, [watch])
    end, book = rigid_of(model, state), model.book
    turned = end.spin - start.spin
    allowed = 1e-4 * end.inertia * abs(end.Omega)
    checks = [
        *_printed(p, end.V_n),
        Check("normal momentum gained", "N s", end.mass * (end.V_n - start.V_n), 2 * book.impulse[1], CLOSED),
        Check("angular momentum gained", "N m s", turned, -2 * book.impulse[2], allowed, "absolute"),
        Check("energy ledger / E_0", "1", watch.ledger.worst / watch.ledger.start, 0.0, CLOSED, "at most"),
        Check("impulse ratio", "1", book.impulse[0] / book.impulse[1], p["f"], CLOSED, "at most"),
    ]
    return Solved(tuple(checks), state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "tilted-bar",
    "a square bar flies onto a tilted plate, beside two public codes",
    (
        steel.speed("speed", "speed along the bar's axis", SPEED),
        Parameter(
            "angle", "bar's axis to the plate's normal; printed is 20 degrees", ANGLE, 0.02, 1.2, "angle"
        ),
        Parameter("f", "Coulomb friction; printed are 0 and 0.2", 0.0, 0.0, 5.0),
        Parameter("cells", "cells across the bar, even; 12 times as many along it", 12, 4, 24, multiple=2),
        element(2),
        Parameter("stiffness", "of the public codes' springs, N/m3", 2.6e13, 1e13, 3e14),
        Parameter("stick", "their tangential over their normal stiffness", 0.1, 0.01, 1.0),
    ),
    solve,
)
