"""``sears``: a rod with a rounded end strikes a frictionless rigid plane along its axis."""

from __future__ import annotations

from math import inf, pi, radians

import numpy as np
from numpy.typing import NDArray

import meshes
from fem_impact.errors import SceneError
from fem_impact.verify import steel
from fem_impact.verify.bodies import Body, body_model, placed
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.reference.hertz import contact_modulus
from fem_impact.verify.reference.sears import sears
from fem_impact.verify.tips import contact_zone, levels_for_radius, run_strike, vibration

__all__ = ["PROBLEM"]

Array = NDArray[np.float64]

FORCE, TIME, VIBRATION = 0.04, 0.02, 5e-4
CAP = radians(25.0)  # polar angle at which the round cap goes over into its tangent cone
AFTER = 1.1


def _meridian(p: Values) -> Array:
    """Return a round cap that ends in a flat cone, so that hardly any mass is missing."""
    R, r = p["diameter"] / 2, p["tip_radius"]
    cap = min(CAP, float(np.arcsin(min(1.0, 0.9 * R / r))))
    turn = np.linspace(0.0, cap, 60)
    line = np.stack([r * np.sin(turn), r * (1 - np.cos(turn))], axis=1)
    side = line[-1, 1] + (R - line[-1, 0]) * np.tan(cap)
    return np.concatenate([line, [[R, side]]])


def _volume(line: Array) -> float:
    """Return the volume, m3, under a meridian (sum of cone frustums) up to its last height."""
    a, b, h = line[:-1, 0], line[1:, 0], np.diff(line[:, 1])
    return float((pi / 3 * h * (a * a + a * b + b * b)).sum())


def solve(p: Values) -> Solved:
    """Compare with the delay equation of a rod of the same mass."""
    R, v, line = p["diameter"] / 2, p["speed"], _meridian(p)
    length = p["length"] - line[-1, 1] + _volume(line) / (pi * R**2)
    E_star = contact_modulus(p["E"], p["nu"], inf)
    exact = sears(p["E"], p["rho"], length, R, E_star, p["tip_radius"], v)
    radius = (0.75 * exact.force * p["tip_radius"] / E_star) ** (1 / 3)
    if radius > p["tip_radius"] * np.sin(CAP):
        raise SceneError("makes the contact wider than the round cap.", key="speed", value=v)
    across = int(p["across"])
    levels = levels_for_radius(p["diameter"] / across, radius, p["cells"])
    rod = meshes.rod(line, p["length"], across, zone=contact_zone(radius, radius), levels=levels)
    points = placed(rod.mesh.points, 0.0, 0.0)
    speed = np.zeros_like(points)
    speed[:, 2] = -v
    model = body_model(Body(rod, points, speed, p["E"], p["nu"], p["rho"], friction=0.0))
    found = run_strike(model, AFTER * exact.duration, exact.duration)
    E_0 = 0.5 * found.motion.mass * v**2
    share = vibration(model, found.state) / E_0
    checks = (
        Check("largest force", "N", found.force, exact.force, FORCE),
        Check("contact time", "s", found.duration, exact.duration, TIME),
        Check("restitution", "1", found.motion.V_n / v, exact.restitution, 5e-3, "absolute"),
        Check("vibration / E_0", "1", share, exact.vibration, VIBRATION, "absolute"),
        Check("largest energy / E_0", "1", found.most, 1.0, 1e-3, "at most"),
    )
    return Solved(checks, found.state.step, len(rod.mesh.cells))


PROBLEM = Problem(
    "sears",
    "a rod with a rounded end strikes a rigid plane along its axis: force, time, vibration",
    (
        steel.length(),
        steel.diameter(),
        Parameter("tip_radius", "radius of the round end", 7e-3, 1e-3, 1.0, "length"),
        steel.speed("speed", "approach speed", 2.0),
        *steel.elastic(),
        Parameter("cells", "cells over the contact radius", 4, 2, 20),
        steel.across(8),
    ),
    solve,
)
