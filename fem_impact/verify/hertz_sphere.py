"""``hertz``: an elastic sphere strikes a frictionless rigid plane."""

from __future__ import annotations

from math import pi

import numpy as np

import meshes
from fem_impact.solid.model import Model
from fem_impact.verify import steel
from fem_impact.verify.bodies import Body, body_model, placed, unsliced
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.reference.hertz import contact_modulus, hertz
from fem_impact.verify.tips import contact_zone, levels_for_radius, run_strike

__all__ = ["PROBLEM", "sphere_model"]

TOLERANCE = 0.02
AFTER = 1.15  # contact times that are followed


def sphere_model(p: Values, contact_radius: float, v_n: float, v_t: float, f: float) -> Model:
    """Return a ball just above the plane, fine around its pole, moving down at v_n and along t at -v_t."""
    R, across = p["radius"], int(p["across"])
    levels = levels_for_radius(2 * R / across, contact_radius, p["cells"])
    zone = contact_zone(contact_radius, contact_radius)
    mesh = unsliced(meshes.sphere(R, across, zone=zone, levels=levels))
    points = placed(mesh.mesh.points, 0.0, 0.0)
    velocity = np.zeros_like(points)
    velocity[:, 0], velocity[:, 2] = -v_t, -v_n
    # flat cells inside the round skin lack volume: the true mass is what strikes
    rho = p["rho"] * 4 / 3 * pi * R**3 / (2 * float(np.sum(meshes.volume(mesh.mesh))))
    return body_model(Body(mesh, points, velocity, p["E"], p["nu"], rho, friction=f, turning=f > 0))


def solve(p: Values) -> Solved:
    """Compare force, time and restitution with Hertz."""
    R, v = p["radius"], p["speed"]
    exact = hertz(contact_modulus(p["E"], p["nu"]), R, 4 / 3 * pi * R**3 * p["rho"], v)
    model = sphere_model(p, exact.radius, v, 0.0, 0.0)
    found = run_strike(model, AFTER * exact.duration, exact.duration)
    checks = (
        Check("largest force", "N", found.force, exact.force, TOLERANCE),
        Check("contact time", "s", found.duration, exact.duration, TOLERANCE),
        Check("restitution", "1", found.motion.V_n / v, 1.0, 0.01, "absolute"),
        Check("largest energy / E_0", "1", found.most, 1.0, 1e-3, "at most"),
    )
    return Solved(checks, found.state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "hertz",
    "an elastic sphere strikes a frictionless rigid plane: force and time of contact",
    (
        Parameter("radius", "radius of the sphere", 9.5e-3, 1e-4, 1.0, "length"),
        steel.speed("speed", "approach speed", 0.5),
        *steel.elastic(210e9),
        Parameter("cells", "cells over the contact radius", 8, 2, 20),
        steel.across(8),
    ),
    solve,
)
