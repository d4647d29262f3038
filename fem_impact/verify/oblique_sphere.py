"""``oblique-sphere``: an elastic sphere strikes obliquely with Coulomb friction.

Maw, Barber & Fawcett's incremental contact holds for a contact much smaller than the sphere. A ball of finite
size is stiffer along the normal and softer tangentially, which takes 0.020 of the tangential restitution of
the alumina case at 5 degrees and 3.9 m/s (a / R = 0.065), 0.006 at 0.1 m/s and nothing once the contact
slides; the same incremental contact with the ball's own two stiffnesses decides, the plain one is shown.

Kharaz, Gorham & Salman (2001, doi:10.1016/S0032-5910(01)00283-2) struck glass; the printed numbers, and this
problem, are those of two bodies of alumina. Restitution at 5, 20, 40 degrees: solver 0.716, 0.588, 0.782,
ball 0.722, 0.588, 0.781, plain 0.742, 0.594, 0.781, printed 0.740, 0.594, 0.781. So the printed 0.740 at 5
degrees is that of a contact without size; with 4 and 8 cells over the contact radius the solver has 0.713 and
0.716, on the way to the ball's. The sweeps of the contact, which end at 60 in a third of
the steps, change it by less than 1e-5.

Where the sphere slides throughout, mu = f but for the lean of the interface (`sliding_ratio`): on a block
0.4 % less at 3.9 m/s, 1.2 % at 20 m/s with nu = 0, nothing on a rigid plane.

Both bodies must be of like material, which the block is. On a rigid plane (block = 0) a normal load also
shifts the skin sideways, so blows that stick for most of the contact differ: seen were 0.19 in tangential
restitution at 5 degrees, f = 0.092, nu = 0.23. Such blows are shown and not judged, unless nu is near 0.5,
where that coupling vanishes.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, inf, pi, sin

from fem_impact.verify import steel
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.reference.hertz import contact_modulus
from fem_impact.verify.reference.sphere import oblique_ball, oblique_sphere
from fem_impact.verify.reference.tangential import sliding_ratio
from fem_impact.verify.spheres import ball_mass, modulus, parameters, plain_hertz, small_contact, sphere_model
from fem_impact.verify.tips import run_strike

__all__ = ["PROBLEM"]

RESTITUTION, RATIO, SLIPPED = 0.02, 0.01, 0.05
UNCOUPLED = 0.45  # Poisson's ratio from which pressing hardly shifts the skin on a rigid plane
COUPLED = "on a rigid plane pressing shifts the skin sideways unless nu is near 0.5"
AFTER = 1.15  # contact times that are followed


def solve(p: Values) -> Solved:
    """Compare tangential restitution of the centre, spin and impulse ratio.

    Raises
    ------
    SceneError
        If the contact is too small or too large.
    """
    small_contact(p, cos(p["angle"]))
    v_n, v_t = p["speed"] * cos(p["angle"]), p["speed"] * sin(p["angle"])
    R, normal = p["radius"], plain_hertz(p, v_n)
    blow = (p["nu"], R, ball_mass(p), p["f"], v_n, v_t)
    plain = oblique_sphere(modulus(p), *blow)
    exact = oblique_ball(modulus(p), contact_modulus(p["E"], p["nu"]), *blow)
    model = sphere_model(p, normal, v_n, v_t, p["f"])
    found = run_strike(model, AFTER * normal.duration, normal.duration)
    m = found.motion
    mu = (m.V_t + v_t) / (m.V_n + v_n)
    slides = exact.ratio > 0.999 * p["f"]
    ratio = exact.ratio
    if slides and p["block"]:
        pressure = 2 * modulus(p) * normal.radius / (pi * R)
        ratio = sliding_ratio(p["f"], p["nu"], p["E"] / (2 + 2 * p["nu"]), pressure)
    back, note = -m.V_t / v_t, f"for a / R far below 1, here {normal.radius / R:.3f}"
    # away from sliding the ratio tells the same as the restitution: v_t (1 - e_t) / (2 v_n)
    near = RATIO * p["f"] if slides else RESTITUTION * v_t / (2 * v_n)
    compared = [
        Check("tangential restitution", "1", back, exact.centre_t / v_t, RESTITUTION, "absolute"),
        Check("spin R Omega / v_t", "1", -R * m.Omega / v_t, exact.spin / v_t, SLIPPED, "absolute"),
        Check("impulse ratio mu / f", "1", mu / p["f"], ratio / p["f"], near / p["f"], "absolute"),
    ]
    if not (slides or p["block"] or p["nu"] >= UNCOUPLED):
        compared = [replace(check, tolerance=inf, kind="shown", note=COUPLED) for check in compared]
    checks = (
        compared[0],
        Check.shown("tangential restitution, plain", "1", back, plain.centre_t / v_t, note),
        *compared[1:],
        Check("largest energy / E_0", "1", found.most, 1.0, 1e-3, "at most"),
    )
    return Solved(checks, found.state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "oblique-sphere",
    "an elastic sphere strikes obliquely with friction: reversal, spin, impulse ratio",
    parameters(
        2.5e-3,
        steel.speed("speed", "approach speed", 3.9),
        Parameter("angle", "path to the normal", 20 * pi / 180, 0.01, 1.5, "angle"),
        Parameter("f", "Coulomb friction", 0.092, 0.001, 5.0),
        *steel.elastic(380e9, 0.23, 4000.0),
    ),
    solve,
)
