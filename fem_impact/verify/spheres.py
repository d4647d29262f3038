"""A ball over a rigid plane or a block of its own kind: the parameters and the model of two problems."""

from __future__ import annotations

from math import inf, pi

import numpy as np
from numpy.typing import NDArray

import meshes
from fem_impact.solid.elements import lumped_mass
from fem_impact.solid.model import Model
from fem_impact.verify import steel
from fem_impact.verify.bodies import Block, Body, body_model, placed, unsliced
from fem_impact.verify.problem import Parameter, Values, within
from fem_impact.verify.reference.hertz import HertzImpact, contact_modulus, hertz
from fem_impact.verify.tips import block_under, contact_zone, levels_for_radius

__all__ = ["ball_mass", "modulus", "parameters", "plain_hertz", "small_contact", "sphere_model"]


CONTACT = 5e-3, 0.12  # contact radii over the ball's that the reference covers


def parameters(radius: float, *others: Parameter) -> tuple[Parameter, ...]:
    """Return the list: radius, the problem's own, mesh and barrier."""
    return (
        Parameter("radius", "radius of the sphere", radius, 1e-4, 1.0, "length"),
        *others,
        Parameter("block", "1: a block like the sphere, 0: a rigid plane", 1, 0, 1, multiple=1),
        Parameter("cells", "cells over the contact radius", 8, 2, 20),
        steel.across(16),
    )


def ball_mass(p: Values) -> float:
    """Return the mass of the sphere, kg."""
    return 4 / 3 * pi * p["radius"] ** 3 * p["rho"]


def modulus(p: Values) -> float:
    """Return E* of the sphere with what it strikes, Pa."""
    return contact_modulus(p["E"], p["nu"], p["E"] if p["block"] else inf, p["nu"])


def plain_hertz(p: Values, v_n: float) -> HertzImpact:
    """Return Hertz' impact at an approach speed, m/s."""
    return hertz(modulus(p), p["radius"], ball_mass(p), v_n)


def small_contact(p: Values, share: float = 1.0) -> None:
    """Refuse a ``speed``, ``share`` of it along the normal, whose contact is no spot on the ball.

    Raises
    ------
    SceneError
        If the contact radius is out of the range of the finite ball's reference.
    """
    touch = plain_hertz(p, share * p["speed"]).radius / p["radius"]
    low, high = (p["speed"] * (limit / touch) ** 2.5 for limit in CONTACT)  # the radius goes as v^0.4
    within(p, "speed", low, high, "m/s", f"contact radii of {CONTACT[0]:g} to {CONTACT[1]:g} of the ball's.")


def sphere_model(p: Values, touch: HertzImpact, v_n: float, v_t: float = 0.0, f: float = 0.0) -> Model:
    """Return a ball just above the barrier, fine around its pole, moving down at v_n and along t at -v_t."""
    R, across = p["radius"], int(p["across"])
    base = 2 * R / across
    levels = levels_for_radius(base, touch.radius, p["cells"])
    zone = contact_zone(touch.radius, touch.radius)
    mesh = unsliced(meshes.sphere(R, across, zone=zone, levels=levels))
    points = placed(mesh.mesh.points, 0.0, 0.0)
    velocity = np.zeros_like(points)
    velocity[:, 0], velocity[:, 2] = -v_t, -v_n
    block = None
    if p["block"]:
        under = block_under(touch.radius, base, levels, v_t * touch.duration)
        block = Block(under, base / 2**levels, p["E"], p["nu"], p["rho"])
    denser = _denser(points, mesh.mesh.cells, p)
    E, nu, rho = p["E"], p["nu"], p["rho"]
    return body_model(
        Body(mesh, points, velocity, E, nu, rho, denser, friction=f, block=block, turning=f > 0)
    )


def _denser(points: NDArray[np.float64], cells: NDArray[np.int64], p: Values) -> NDArray[np.float64]:
    """Return densities (cells,) over rho with which half the ball has a ball's mass and moment of inertia.

    Flat cells inside the round skin lack volume, and masses at their corners lie too far out: the moment is
    1.8 % too high with 8 cells across, which takes 0.01 of a sticking ball's tangential restitution. Both are
    mended by a density that is linear in the square of the distance from the centre.
    """
    R, mass = p["radius"], lumped_mass(points, cells, p["rho"])
    arm = (points[cells] - np.array([0.0, 0.0, R])) / R
    out = (arm.mean(axis=1) ** 2).sum(axis=1)
    masses, moments = mass.sum(axis=1), (mass * (arm[:, :, 0] ** 2 + arm[:, :, 2] ** 2)).sum(axis=1)
    sums = [[masses.sum(), masses @ out], [moments.sum(), moments @ out]]
    inner, slope = np.linalg.solve(sums, 0.5 * ball_mass(p) * np.array([1.0, 0.4]))
    return np.asarray(inner + slope * out)
