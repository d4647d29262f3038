"""``oblique-sphere``: an elastic sphere strikes a rigid plane obliquely with Coulomb friction.

The reference is Maw, Barber & Fawcett's incremental contact of two bodies of like material. On a rigid
plane a normal load also shifts the skin sideways, so blows that stick for most of the contact differ (seen:
0.19 in tangential restitution at 5 degrees, f = 0.092) and are refused.
"""

from __future__ import annotations

from math import cos, pi, sin

from fem_impact.errors import SceneError
from fem_impact.verify import steel
from fem_impact.verify.hertz_sphere import sphere_model
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.reference.hertz import contact_modulus, hertz
from fem_impact.verify.reference.sphere import oblique_sphere
from fem_impact.verify.tips import run_strike

__all__ = ["PROBLEM"]

RESTITUTION, RATIO = 0.02, 0.01
SLIDES = 3.0  # least psi_1 = 2 (1 - nu) v_t / (f (2 - nu) v_n)
AFTER = 1.15  # contact times that are followed


def solve(p: Values) -> Solved:
    """Compare tangential restitution of the centre, spin and impulse ratio."""
    R, E_star = p["radius"], contact_modulus(p["E"], p["nu"])
    mass = 4 / 3 * pi * R**3 * p["rho"]
    v_n, v_t = p["speed"] * cos(p["angle"]), p["speed"] * sin(p["angle"])
    if 2 * (1 - p["nu"]) * v_t < SLIDES * p["f"] * (2 - p["nu"]) * v_n:
        words = "sticks for most of the contact, where a rigid plane differs from the reference."
        raise SceneError(words, key="angle", value=p["angle"], remedy="Take a larger angle or a lower f.")
    exact = oblique_sphere(E_star, p["nu"], R, mass, p["f"], v_n, v_t)
    normal = hertz(E_star, R, mass, v_n)
    model = sphere_model(p, normal.radius, v_n, v_t, p["f"])
    found = run_strike(model, AFTER * normal.duration, normal.duration)
    m = found.motion
    mu = (m.V_t + v_t) / (m.V_n + v_n)
    checks = (
        Check("tangential restitution", "1", -m.V_t / v_t, exact.centre_t / v_t, RESTITUTION, "absolute"),
        Check("spin R Omega / v_t", "1", -R * m.Omega / v_t, exact.spin / v_t, 0.05, "absolute"),
        Check("impulse ratio mu", "1", mu, exact.ratio, RATIO if exact.ratio > 0.999 * p["f"] else 0.05),
        Check("largest energy / E_0", "1", found.most, 1.0, 1e-3, "at most"),
    )
    return Solved(checks, found.state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "oblique-sphere",
    "an elastic sphere strikes a plane obliquely with friction: reversal, spin, impulse ratio",
    (
        Parameter("radius", "radius of the sphere", 2.5e-3, 1e-4, 1.0, "length"),
        steel.speed("speed", "approach speed", 3.9),
        Parameter("angle", "path to the normal", 20 * pi / 180, 0.01, 1.5, "angle"),
        Parameter("f", "Coulomb friction", 0.092, 0.001, 5.0),
        *steel.elastic(380e9, 0.23, 4000.0),
        Parameter("cells", "cells over the contact radius", 8, 2, 20),
        steel.across(8),
    ),
    solve,
)
