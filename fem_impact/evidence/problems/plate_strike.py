"""``plate``: an elastic sphere strikes infinite thin plates, whose bending waves take energy (Zener)."""

from __future__ import annotations

from math import exp, log

from fem_impact.evidence.problems import setups as steel
from fem_impact.evidence.problems.problem import Check, Problem, Solved, Values, within
from fem_impact.evidence.problems.setups import TipImpact, run_strike
from fem_impact.evidence.problems.spheres import (
    ball_mass,
    modulus,
    parameters,
    plain_hertz,
    small_contact,
    sphere_model,
)
from fem_impact.evidence.references.zener import zener_impact
from fem_impact.scene.parameter import Parameter

RESTITUTION, FORCE, TIME, ENERGY = 0.02, 0.03, 0.03, 1e-3
STRIKES = 3
AFTER = 1.1  # contact times that are followed


def unit_of_time(p: Values) -> float:
    """Return T = (m / (k sqrt(v)))^(2/5), s, with k = 4/3 E* sqrt(R)."""
    stiffness = 4 / 3 * modulus(p) * p["radius"] ** 0.5
    return float((ball_mass(p) / (stiffness * p["speed"] ** 0.5)) ** 0.4)


def _strike(p: Values, inelasticity: float) -> tuple[TipImpact, float, int]:
    """Return an impact on a plate of Zener's lambda, what its ledger misses over E_0, and cells."""
    T, plain = unit_of_time(p), plain_hertz(p, p["speed"])
    model = sphere_model(p, plain, p["speed"], impedance=ball_mass(p) / (inelasticity * T))
    end = AFTER * zener_impact(inelasticity).duration * T
    found = run_strike(model, end, plain.duration)
    ledger = model.ledger()
    ledger.start = 0.5 * ball_mass(p) * p["speed"] ** 2
    missed = abs(ledger.sample(found.state)["residual"]) / ledger.start
    return found, missed, len(model.geometry.rod.mesh.cells)


def _checks(p: Values, inelasticity: float, found: TipImpact, residual: float) -> tuple[Check, ...]:
    exact, T, v = zener_impact(inelasticity), unit_of_time(p), p["speed"]
    force = ball_mass(p) * v / T * exact.peak
    at = f"lambda {inelasticity:.3g}"
    return (
        Check(f"e, {at}", "1", found.motion.V_n / v, exact.restitution, RESTITUTION, "absolute"),
        Check(f"largest force, {at}", "N", found.force, force, FORCE),
        Check(f"contact time, {at}", "s", found.duration, exact.duration * T, TIME),
        Check(f"energy ledger / E_0, {at}", "1", residual, 0.0, ENERGY, "at most"),
    )


def solve(p: Values) -> Solved:
    """Compare restitution, force and contact time with Zener's equation, on plates of several thicknesses.

    Raises
    ------
    SceneError
        If the contact is no spot on the sphere, or the numbers are in no order.
    """
    small_contact(p)
    within(p, "most", 1.01 * p["least"], 2.0, "", "above the least, and the sphere leaves the plate soon.")
    low, high = log(p["least"]), log(p["most"])
    numbers = [exp(low + (high - low) * i / (STRIKES - 1)) for i in range(STRIKES)]
    runs = [(number, *_strike(p, number)) for number in numbers]
    checks = tuple(check for n, found, residual, _ in runs for check in _checks(p, n, found, residual))
    return Solved(checks, max(found.state.step for _, found, _, _ in runs), runs[0][3])


PROBLEM = Problem(
    "plate",
    "an elastic sphere strikes infinite thin plates: bending waves lower e as Zener's equation says",
    parameters(
        9.5e-3,
        steel.speed("speed", "approach speed", 1.0),
        Parameter("least", "Zener's lambda of the thickest plate", "", 1e-3, 1.0, default=0.05),
        Parameter("most", "Zener's lambda of the thinnest plate", "", 1e-3, 2.0, default=1.0),
        *steel.elastic(210e9),
        cells=4,
        across=8,
    ),
    solve,
)
