"""``thornton``: an elastic sphere that yields strikes a rigid frictionless plane at several speeds.

While the contact is fully plastic and still small, restitution falls as speed to the power -1/4. Below, part
of the contact is elastic and e falls more slowly; above, the tip is flattened and e falls faster.
The slope is judged only if all speeds lie between; otherwise it is shown with the reason.
"""

from math import exp, floor, log, log2, pi, sqrt

import numpy as np

from fem_impact.evidence.problems import setups
from fem_impact.evidence.problems.problem import Check, Solved, Values, within
from fem_impact.evidence.problems.spheres import ball_mass
from fem_impact.evidence.references import hertz
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.material import Material
from fem_impact.solid.model import Model

SLOPE, SLOPE_TOLERANCE, CONVERGED = -0.25, 0.05, 0.03
FIRST = 1.6  # peak pressure of first yield over yield stress
NAME = "slope of ln e over ln v"
SPEEDS = 4
LARGE = 0.35  # contact radius over the sphere's
ACROSS = 8  # least cells over the diameter
FINER = 1.5
LONGEST, APART = 6.0, 0.1  # over the time of the indentation: when a run ends, how long it must be free


def _indentation(p: Values, v: float) -> tuple[float, float]:
    """Return contact radius, m, and duration, s, of a rigid plane pressed in by a constant pressure."""
    mass, pressure = ball_mass(p), hertz.MEAN * p["yield_stress"]
    radius = hertz.plastic_radius(p["yield_stress"], p["radius"], mass, v)
    return radius, pi / 2 * sqrt(mass / (2 * pi * p["radius"] * pressure))


def _model(p: Values, v: float, cells: float) -> Model:
    R, touch = p["radius"], _indentation(p, v)[0]
    # about the same cells over the contact radius at every speed: halvings, then the base mesh for the rest
    levels = max(0, floor(log2(2 * R * cells / (touch * ACROSS))))
    across = max(2 * round(R * cells / touch / 2**levels), ACROSS)
    metal = Material(
        "problem", p["E"], p["nu"], p["rho"], p["yield_stress"], p["yield_stress"], hardening=p["hardening"]
    )
    effects, size = ("rod-plasticity", "barrier-rigid"), touch / cells / setups.WIDER
    return setups.falling(setups.ball(p, metal), Barrier(metal), effects, v, tip_size=size, across=across)


def _restitution(p: Values, v: float, cells: float) -> tuple[float, float, int, int]:
    """Return e, the worst residual of the ledger over E_0, steps and cells of one run."""
    model, time = _model(p, v, cells), _indentation(p, v)[1]
    state, book = model.initial_state(), model.book
    energy = setups.Until(
        model.ledger(), LONGEST * time, lambda: bool(state.time - APART * time > book.last_touch > 0), 20
    )
    setups.follow(model, state, energy, every=20)
    worst = energy.ledger.worst / energy.ledger.start
    return setups.rigid_of(model, state).V_n / v, worst, state.step, len(model.geometry.rod.mesh.cells)


def judged_slope(p: Values, slope: float) -> Check:
    """Judge the slope where the contact is fully plastic and small at all speeds, else show it."""
    if p["hardening"] > 0:
        return Check.shown(NAME, "1", slope, SLOPE, "the law is that of a material that does not harden")
    E_star = hertz.contact_modulus(p["E"], p["nu"])
    low, high = hertz.plastic_speeds(p["yield_stress"], E_star, p["radius"], ball_mass(p))
    if low <= p["slowest"] and p["fastest"] <= high:
        return Check(NAME, "1", slope, SLOPE, SLOPE_TOLERANCE, "absolute")
    if low > high:
        return Check.shown(NAME, "1", slope, SLOPE, "this material is never fully plastic in a small contact")
    note = f"fully plastic and small only from {low:.3g} to {high:.3g} m/s; set slowest and fastest within"
    return Check.shown(NAME, "1", slope, SLOPE, note)


def solve(p: Values) -> Solved:
    """Compare the slope of ln e over ln v and its convergence; show e beside two published laws.

    Raises
    ------
    SceneError
        If a speed is too low or too high for a plastic contact.
    """
    # refuse speeds whose contact is elastic, no spot on the sphere, or in no order
    mass, E_star = ball_mass(p), hertz.contact_modulus(p["E"], p["nu"])
    first = hertz.yield_speed(FIRST * p["yield_stress"], E_star, p["radius"], mass)
    unit = hertz.plastic_radius(p["yield_stress"], p["radius"], mass, 1.0) / p["radius"]
    most = (LARGE / unit) ** 2
    within(p, "slowest", first, most, "m/s", "slower nothing yields, faster the sphere is crushed.")
    within(p, "fastest", 1.1 * p["slowest"], most, "m/s", "above the slowest, and the sphere not crushed.")
    low, high = log(p["slowest"]), log(p["fastest"])
    speeds = [exp(low + (high - low) * i / (SPEEDS - 1)) for i in range(SPEEDS)]
    runs = [_restitution(p, v, p["cells"]) for v in speeds]
    slope = float(np.polyfit(np.log(speeds), np.log([run[0] for run in runs]), 1)[0])
    middle = speeds[SPEEDS // 2]
    fine = _restitution(p, middle, FINER * p["cells"])
    full = hertz.yield_speed(hertz.MEAN * p["yield_stress"], E_star, p["radius"], mass)
    law, fit = hertz.thornton_restitution(middle, full), hertz.fitted_restitution(middle, first)
    checks = (
        judged_slope(p, slope),
        Check("e, and with finer cells", "1", runs[SPEEDS // 2][0], fine[0], CONVERGED),
        Check.shown("e beside Thornton", "1", fine[0], law, "pressure cut off at 2.8 Y, elastic recovery"),
        Check.shown("e beside the finite-element fit", "1", fine[0], fit, "ascribed, not checked in print"),
        Check("energy ledger / E_0", "1", max(run[1] for run in (*runs, fine)), 0.0, 1e-3, "at most"),
    )
    return Solved(checks, fine[2], fine[3])
