"""``sears``: a rod with a rounded end strikes along its axis: force, contact time, vibration that stays.

The reference is Sears' delay equation: Hertz' contact before a one-dimensional rod. It is the limit of a
contact small against the rod's radius; the end of a real rod is stiffer than Hertz' half-space by about as
much as a sphere's is (see ``hertz``), and the vibration left depends steeply on the contact time. It is
therefore held to the delay equation with the one E* that has the computed contact time; the plain
equation is shown as well and allowed to miss by the difference of the two more.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

import meshes
from fem_impact.modes import flight, rod_modes
from fem_impact.solid.march import evaluate
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.verify import steel
from fem_impact.verify.bodies import Block, Body, body_model, placed
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.reference.hertz import contact_modulus
from fem_impact.verify.reference.sears import AxialImpact, sears
from fem_impact.verify.tips import block_under, contact_zone, levels_for_radius, run_strike

__all__ = ["PROBLEM"]

FORCE, TIME, VIBRATION = 0.04, 0.02, 5e-4
AFTER = 1.1  # contact times that are followed
STIFFER = (0.5, 2.0)  # range of the contact stiffness over Hertz'
PARABOLA = 200  # points of the meridian


def _meridian(radius: float, tip: float) -> NDArray[np.float64]:
    """Return a paraboloid's meridian with the wanted radius of curvature at the pole."""
    rho = np.linspace(0.0, radius, PARABOLA)
    return np.stack([rho, rho**2 / (2 * tip)], axis=1)


def _model(p: Values, touch: float) -> Model:
    """Return the rod; with its round end it is as heavy as a flat cylinder of the length."""
    R, tip, across = p["diameter"] / 2, p["tip_radius"], int(p["across"])
    base = 2 * R / across
    levels = levels_for_radius(base, touch, p["cells"])
    length = p["length"] + R**2 / (4 * tip)
    rod = meshes.rod(_meridian(R, tip), length, across, zone=contact_zone(touch, touch), levels=levels)
    points = placed(rod.mesh.points, 0.0, 0.0)
    velocity = np.zeros_like(points)
    velocity[:, 2] = -p["speed"]
    block = None
    if p["block"]:
        under = block_under(touch, base, levels)
        block = Block(under, base / 2**levels, p["barrier_E"], p["nu"], p["rho"])
    rho = p["rho"] * pi * R**2 * p["length"] / (2 * float(np.sum(meshes.volume(rod.mesh))))
    return body_model(Body(rod, points, velocity, p["E"], p["nu"], rho, friction=0.0, block=block))


def _vibration(model: Model, state: State) -> float:
    """Return the energy of the rod's free vibration, J, by modal projection."""
    n = model.layout.rod_size
    evaluate(model, state)
    modes = rod_modes(model.rod_stiffness, model.mass[:n], model.inverse_mass[:n] == 0)
    return flight(modes, state.v[:n], state.force[:n]).energy


def _timed(rod: tuple[float, float, float, float], E_star: float, p: Values, duration: float) -> AxialImpact:
    """Return the delay equation's impact of the given contact time, s, by another contact stiffness."""

    def late(factor: float) -> float:
        return sears(*rod, factor * E_star, p["tip_radius"], p["speed"]).duration - duration

    factor = float(brentq(late, *STIFFER, xtol=1e-3))
    return sears(*rod, factor * E_star, p["tip_radius"], p["speed"])


def solve(p: Values) -> Solved:
    """Compare force, time, restitution and vibration with the delay equation."""
    E_star = contact_modulus(p["E"], p["nu"], p["barrier_E"] if p["block"] else float("inf"), p["nu"])
    rod = (p["E"], p["rho"], p["length"], p["diameter"] / 2)
    exact = sears(*rod, E_star, p["tip_radius"], p["speed"])
    touch = (3 * exact.force * p["tip_radius"] / (4 * E_star)) ** (1 / 3)
    model = _model(p, touch)
    found = run_strike(model, AFTER * exact.duration, exact.duration)
    E_0 = 0.5 * found.motion.mass * p["speed"] ** 2
    same = _timed(rod, E_star, p, found.duration)
    vibration, shift = _vibration(model, found.state) / E_0, abs(same.vibration - exact.vibration)
    checks = (
        Check("largest force", "N", found.force, exact.force, FORCE),
        Check("contact time", "s", found.duration, exact.duration, TIME),
        Check("force, same contact time", "N", found.force, same.force, FORCE),
        Check("vibration / E_0, same contact time", "1", vibration, same.vibration, VIBRATION, "absolute"),
        Check("vibration / E_0", "1", vibration, exact.vibration, VIBRATION + shift, "absolute"),
        Check("largest energy / E_0", "1", found.most, 1.0, 1e-3, "at most"),
    )
    return Solved(checks, found.state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "sears",
    "a rod with a round end strikes along its axis: force, contact time, vibration",
    (
        steel.length(),
        steel.diameter(),
        Parameter("tip_radius", "radius of the round end at its pole", 7e-3, 1e-4, 1.0, "length"),
        steel.speed("speed", "approach speed", 2.0),
        *steel.elastic(),
        Parameter("block", "1: an elastic block, 0: a rigid plane", 1, 0, 1, multiple=1),
        Parameter("barrier_E", "Young's modulus of the block", 206e9, 1e6, 2e12, "stress"),
        Parameter("cells", "cells over the contact radius", 6, 2, 20),
        steel.across(8),
    ),
    solve,
)
