"""Parameters that many problems share, with the rod steel of the study as default."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, log2

import numpy as np

import meshes
from fem_impact.case.plates import ROWS
from fem_impact.evidence.problems.bodies import rigid_of
from fem_impact.evidence.problems.problem import Values, within
from fem_impact.evidence.problems.watch import ForceRecorder, Until
from fem_impact.fem.flight import RigidMotion
from fem_impact.scene.material import Material
from fem_impact.scene.parameter import Parameter
from fem_impact.scene.shipped import load
from fem_impact.scene.types import Scene
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from meshes import HexMesh, Zone


def length(default: float = 0.24) -> Parameter:
    """Return the rod's length."""
    return Parameter("length", "length of the rod", "length", 0.02, 2.0, default=default)


def diameter() -> Parameter:
    """Return the rod's diameter."""
    return Parameter("diameter", "diameter of the rod", "length", 1e-3, 0.2, default=0.019)


def elastic(E: float = 219e9, nu: float = 0.29, rho: float = 7850.0) -> tuple[Parameter, ...]:
    """Return Young's modulus, Poisson's ratio and density."""
    return (
        Parameter("E", "Young's modulus", "stress", 1e6, 2e12, default=E),
        Parameter("nu", "Poisson's ratio", "", 0.0, 0.49, default=nu),
        Parameter("rho", "density", "density", 10.0, 3e4, default=rho),
    )


def across(default: int = 8, low: int = 6) -> Parameter:
    """Return the number of cells over the diameter, even."""
    return Parameter("across", "cells over the diameter, even", "", low, 24, default=default, even=True)


def speed(name: str, words: str, default: float, high: float = 1e3) -> Parameter:
    """Return a speed, above 0."""
    return Parameter(name, words, "speed", 1e-4, high, default=default)


def friction(default: float) -> Parameter:
    """Return Coulomb's coefficient."""
    return Parameter("f", "Coulomb friction", "", 0.0, 5.0, default=default)


def slender(p: Values, across: str, low: float, high: float) -> None:
    """Refuse a length that is not ``low`` to ``high`` times a size across the body.

    Raises
    ------
    SceneError
        If the body is too stubby or too slender.
    """
    within(p, "length", low * p[across], high * p[across], "m", f"{low:g} to {high:g} times the {across}.")


MARGIN = 16.0  # the block reaches so many contact radii beyond its fine zone; 8 are 0.3 % too soft
REACH = 1.3  # half-width of the fine zone over the contact radius
SMOOTHING = 0.05  # window of the peak force over the contact time


@dataclass(frozen=True, slots=True)
class TipImpact:
    """End of a strike.

    Attributes
    ----------
    force, duration : largest force, N; contact time, s
    motion : rigid motion after it
    radiated, closing : energy that left through the block's boundary, and that closing nodes lost, J
    most : largest energy on the way over E_0
    """

    force: float
    duration: float
    motion: RigidMotion
    radiated: float
    closing: float
    most: float
    state: State

    def kept(self, speed: float) -> float:
        """Return the energy of the rebound and what was radiated over that of the approach at ``speed``."""
        return (self.motion.kinetic + self.radiated) / (0.5 * self.motion.mass * speed**2)


def contact_zone(radius: float, depth: float) -> Zone:
    """Return the fine zone around the pole at the origin for a contact radius, m."""
    half = REACH * radius
    return Zone(np.zeros(3), np.eye(3), np.array([-half, 0.0, -depth]), np.array([half, half, depth]))


def block_reach(radius: float, base: float) -> float:
    """Return how far the faces of a block lie from the middle of a contact of ``radius``, m."""
    return REACH * radius + max(MARGIN * radius, 2 * base)


def block_under(radius: float, base: float, levels: int, slide: float = 0.0) -> HexMesh:
    """Return a block whose cells of edge ``base`` are split as often as the tip's, for a contact radius.

    The tip moves on by ``slide``, m, towards -t while it touches.
    """
    half = REACH * radius
    around = block_reach(radius, base) - half
    low, high = np.array([-half - slide, 0.0, -radius]), np.array([half, half, 0.0])
    zone = Zone(np.zeros(3), np.eye(3), low, high)
    low, high = low - around, high + around
    low[1] = high[2] = 0.0
    return meshes.block(low, high, base, [zone] * levels)


def plate_under(radius: float, base: float, levels: int, thickness: float, edges: float) -> HexMesh:
    """Return a plate of ``thickness``, m, fine like `block_under`, whose edges are ``edges``, m, away."""
    rows, half = max(ROWS, round(thickness / base)), REACH * radius
    depth = rows * base  # before its rows are drawn to the thickness
    low, high = np.array([-half, 0.0, -radius * depth / thickness]), np.array([half, half, 0.0])
    zone = Zone(np.zeros(3), np.eye(3), low, high)
    mesh = meshes.block([-edges, 0.0, -depth], [edges, edges, 0.0], base, [zone] * levels)
    mesh = meshes.with_free_bottom(mesh)
    return meshes.with_rows_at(mesh, np.array([0.0, depth]), np.array([0.0, thickness]))


def levels_for_radius(base: float, radius: float, cells: float) -> int:
    """Return how often cells of edge ``base`` are split to have so many over the contact radius."""
    return max(0, ceil(log2(base * cells / radius) - 0.1))


def run_strike(model: Model, end: float, expected: float) -> TipImpact:
    """March until ``end`` s and read the contact."""
    state, force = model.initial_state(), ForceRecorder(model)
    energy = Until(model.ledger(), end, every=20)
    march(model, state, [force, energy])
    start, stop = force.span
    peak = force.peak(SMOOTHING * expected)
    spent = energy.ledger.sample(state)
    motion = rigid_of(model, state)
    return TipImpact(peak, stop - start, motion, spent["radiated"], spent["closing"], energy.most, state)


def rod_scene(p: Values, effects: tuple[str, ...]) -> Scene:
    """Return a scene from parameters; absent ones take the values of a frictionless drop.

    Used are length, diameter, tip_radius, E, nu, rho, barrier_E, angle, v_n, v_t (approach speeds above 0),
    omega, f, tip_size, across, max_time.
    """
    base = load("t5b")
    rod = Material("steel", p["E"], p["nu"], p["rho"], 1e9, 1e9)
    plate = replace(rod, E=p.get("barrier_E", p["E"]))
    f = p.get("f", 0.0)
    return replace(
        base,
        id="verify",
        title="a rod of the verification",
        measured=None,
        projectile=replace(
            base.projectile,
            length=p["length"],
            diameter=p["diameter"],
            tip="B",
            tip_radius=p["tip_radius"],
            material=rod,
        ),
        barrier=replace(base.barrier, material=plate),
        surface=replace(base.surface, state="custom", friction=f, friction_low=f, friction_high=f),
        impact=replace(
            base.impact, angle=p["angle"], v_n=-p["v_n"], v_t=-p["v_t"], omega=p.get("omega", 0.0)
        ),
        effects=effects,
        accuracy=replace(
            base.accuracy, tip_size=p["tip_size"], across=int(p["across"]), max_time=p["max_time"]
        ),
        save=replace(base.save, frames=0),
    )
