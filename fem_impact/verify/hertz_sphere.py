"""``hertz``: an elastic sphere strikes a frictionless barrier, rigid or a block of its own kind.

Hertz' law is the limit of a small contact; a sphere of finite size is stiffer by a share of about .6 a / R on
a rigid plane and half of it on its like. The finite sphere decides; the closed form is shown beside it.
"""

from __future__ import annotations

from fem_impact.verify import steel
from fem_impact.verify.problem import Check, Problem, Solved, Values
from fem_impact.verify.reference.finite_sphere import ball_impact
from fem_impact.verify.reference.hertz import HertzImpact, contact_modulus
from fem_impact.verify.reference.radiation import radiated_energy
from fem_impact.verify.spheres import ball_mass, modulus, parameters, plain_hertz, small_contact, sphere_model
from fem_impact.verify.tips import Strike, run_strike

__all__ = ["PROBLEM"]

TOLERANCE, RADIATED, ENERGY = 0.02, 0.15, 1e-3
AFTER = 1.15  # contact times that are followed


def _radiated(p: Values, found: Strike, exact: HertzImpact) -> Check:
    """Compare what left through the block's boundary with the half-space's, or nothing on a plane."""
    E_0 = 0.5 * ball_mass(p) * p["speed"] ** 2
    if p["block"]:
        share = radiated_energy(exact, p["E"], p["nu"], p["rho"]) / E_0
        return Check("radiated energy / E_0", "1", found.radiated / E_0, share, RADIATED)
    return Check("radiated energy / E_0", "1", found.radiated / E_0, 0.0, 0.0, "absolute")


def solve(p: Values) -> Solved:
    """Compare force, time and energies with a finite sphere and with Hertz.

    Raises
    ------
    SceneError
        If the contact is too small or too large.
    """
    small_contact(p)
    v = p["speed"]
    plain = plain_hertz(p, v)
    own = contact_modulus(p["E"], p["nu"])
    exact = ball_impact(modulus(p), own, p["nu"], p["radius"], ball_mass(p), v)
    model = sphere_model(p, plain, v)
    found = run_strike(model, AFTER * plain.duration, plain.duration)
    note = f"for a / R far below 1, here {plain.radius / p['radius']:.3f}"
    checks = (
        Check("largest force", "N", found.force, exact.force, TOLERANCE),
        Check("contact time", "s", found.duration, exact.duration, TOLERANCE),
        Check.shown("largest force, Hertz", "N", found.force, plain.force, note),
        Check.shown("contact time, Hertz", "s", found.duration, plain.duration, note),
        _radiated(p, found, exact),
        Check("rebound + radiated energy / E_0", "1", found.kept(v), 1.0, ENERGY, "absolute"),
        Check("largest energy / E_0", "1", found.most, 1.0, ENERGY, "at most"),
    )
    return Solved(checks, found.state.step, len(model.geometry.rod.mesh.cells))


PROBLEM = Problem(
    "hertz",
    "an elastic sphere strikes a frictionless barrier: force, time of contact, radiated energy",
    parameters(9.5e-3, steel.speed("speed", "approach speed", 1.0), *steel.elastic(210e9)),
    solve,
)
