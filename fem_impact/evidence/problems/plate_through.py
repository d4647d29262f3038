"""``thin-plate``: an elastic sphere on plates meshed through their thickness, free underneath and at rest."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sqrt

from fem_impact.evidence.problems import setups as steel
from fem_impact.evidence.problems.plate_strike import FORCE, RESTITUTION, TIME, unit_of_time
from fem_impact.evidence.problems.problem import Check, Problem, Solved, Values, within
from fem_impact.evidence.problems.setups import TipImpact, run_strike
from fem_impact.evidence.problems.spheres import (
    Plate,
    ball_mass,
    parameters,
    plain_hertz,
    small_contact,
    sphere_model,
)
from fem_impact.evidence.references.zener import zener_impact
from fem_impact.physics.plate import plate_impedance, pulse_wave
from fem_impact.scene.parameter import Parameter

FARTHER = 2.0  # distance of the edges in the run that another is compared with
WIDER = 0.002  # of e, by that
LEFT = 0.1  # of the energy of the bending waves, that the plate still holds after `LONG` contact times
ENERGY = 1e-4
LONG, AFTER = 4.0, 1.1  # contact times that are followed
LOCAL = "the plate is a half-space under the contact, and gives way as a whole by its impedance"


@dataclass(frozen=True, slots=True)
class PlateStrike:
    """An impact: e; what its ledger misses over E_0; the share of the waves that the plate holds; cells."""

    found: TipImpact
    e: float
    missed: float
    held: float
    cells: int


def _thickness(p: Values) -> float:
    """Return the thickness, m, of the plate of Zener's number; the impedance grows as its square."""
    impedance = ball_mass(p) / (p["number"] * unit_of_time(p))
    return sqrt(impedance / plate_impedance(p["E"], p["nu"], p["rho"], 1.0))


def _plate(p: Values, time: float) -> Plate:
    """Return the plate for a contact of ``time``, s."""
    thickness = _thickness(p)
    speed, edges = pulse_wave(p["E"], p["nu"], p["rho"], thickness, time)
    return Plate(thickness, edges, speed)


def _strike(p: Values, plate: Plate | None, end: float) -> PlateStrike:
    """Return an impact on a meshed plate, or on a half-space with its impedance, until ``end``, s."""
    touch, E_0 = plain_hertz(p, p["speed"]), 0.5 * ball_mass(p) * p["speed"] ** 2
    impedance = None if plate else ball_mass(p) / (p["number"] * unit_of_time(p))
    model = sphere_model(p, touch, p["speed"], impedance=impedance, plate=plate)
    found = run_strike(model, end, touch.duration)
    ledger = model.ledger()
    ledger.start = E_0
    spent = ledger.sample(found.state)
    held = spent["kinetic_barrier"] + spent["strain_barrier"]
    missed = abs(spent["residual"]) / E_0
    e, cells = found.motion.V_n / p["speed"], len(model.geometry.rod.mesh.cells)
    return PlateStrike(found, e, missed, held / (held + spent["plate"]), cells)


def _small(p: Values) -> tuple[tuple[Check, ...], PlateStrike]:
    """Compare a plate that is thick beside its contact with Zener's equation."""
    exact, T = zener_impact(p["number"]), unit_of_time(p)
    one = _strike(p, _plate(p, exact.duration * T), AFTER * exact.duration * T)
    force, at = ball_mass(p) * p["speed"] / T * exact.peak, _width(p)
    checks = (
        Check(f"e, {at}", "1", one.e, exact.restitution, RESTITUTION, "absolute"),
        Check(f"largest force, {at}", "N", one.found.force, force, FORCE),
        Check(f"contact time, {at}", "s", one.found.duration, exact.duration * T, TIME),
        Check(f"energy ledger / E_0, {at}", "1", one.missed, 0.0, ENERGY, "at most"),
    )
    return checks, one


def _wide(p: Values) -> tuple[Check, ...]:
    """Compare a plate that is thin beside its contact with a wider one, and with a half-space that bends."""
    time, at = zener_impact(p["number"]).duration * unit_of_time(p), _width(p)
    plate = _plate(p, time)
    one = _strike(p, plate, LONG * time)
    wider = _strike(p, replace(plate, edges=FARTHER * plate.edges), AFTER * time)
    local = _strike(p, None, AFTER * time)
    return (
        Check(f"e, its edges {FARTHER:g} times as far, {at}", "1", one.e, wider.e, WIDER, "absolute"),
        Check.shown(f"e without a mesh through the plate, {at}", "1", one.e, local.e, LOCAL),
        Check(
            f"held after {LONG:g} contact times / bending waves, {at}", "1", one.held, 0.0, LEFT, "at most"
        ),
        Check(f"energy ledger / E_0, {at}", "1", one.missed, 0.0, ENERGY, "at most"),
    )


def _width(p: Values) -> str:
    return f"contact {2 * plain_hertz(p, p['speed']).radius / _thickness(p):.2g} of the thickness wide"


def solve(p: Values) -> Solved:
    """Strike a plate that is thick beside the contact, and faster one that is thin beside it.

    Raises
    ------
    SceneError
        If the slow contact is no spot on the sphere, or the speeds are in no order.
    """
    small_contact(p)
    within(p, "fast", 1.01 * p["speed"], 1e3, "m/s", "above the slow speed.")
    checks, slow = _small(p)
    return Solved((*checks, *_wide({**p, "speed": p["fast"]})), slow.found.state.step, slow.cells)


PROBLEM = Problem(
    "thin-plate",
    "an elastic sphere strikes infinite plates meshed through: Zener's equation, and edges twice as far",
    parameters(
        9.5e-3,
        steel.speed("speed", "approach speed, slow: the plate is thick beside its contact", 0.3),
        steel.speed("fast", "approach speed, fast: the plate is thin beside its contact", 30.0),
        Parameter("number", "Zener's lambda of either plate", "", 0.05, 2.0, default=0.5),
        *steel.elastic(210e9),
        cells=3,
        across=8,
    ),
    solve,
)
