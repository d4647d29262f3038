"""``taylor``: a yielding bar on a frictionless rigid wall.

Printed: final length 21.42 to 21.43 mm and foot radius 7.22 to 7.23 mm for copper of 32.4 mm, 3.2 mm, 227
m/s, E 117 GPa, nu .35, rho 8930, yield 400 MPa, hardening 100 MPa, 80 us (Foulk et al. 2021, Simo 1992). A
law without rate has no length of its own, so a larger bar of the same shape ends in the same shape. Any other
bar is held to an axisymmetric code (`references.axisymmetric`), 21.46 and 7.20 mm for the printed one.

Without hardening nothing keeps the foot from thinning: its cells at the axis end at a hundredth of their
height, and the foot is a lip that grows with finer rows. The bar of Abaqus' benchmark manual (impact of a
copper rod: 110 GPa, 0.3, 8970 kg/m3, 314 MPa without hardening), final length and foot radius, mm:

=========================================  ==============  ==============  ==============
cells over the radius                      2               3               4
=========================================  ==============  ==============  ==============
reference, square cells (6: 18.63, 9.39)   18.895, 8.976   18.745, 9.257   18.686, 9.325
solver, 20 slices                                          18.961, 9.175   18.812, 9.276
solver, 48 slices                                          18.862, 9.397   18.711, 9.521
solver, 96 slices                                                          18.687, 9.588
=========================================  ==============  ==============  ==============

So lengths differ by the cells over the radius and by the slices. Length and foot of any bar are judged within
what halving the solver's slices and halving the reference's cells change together: the errors of both if they
are of first order. Of the printed bar the slices' error of the length is (20, 48, 96: 0.165, 0.033, 0.014 mm
beside the reference), the reference's is of second (2, 3, 4, 6 cells: 21.506, 21.470, 21.465, 21.460 mm).
"""

from dataclasses import replace

import numpy as np

import meshes
from fem_impact.arrays import Array
from fem_impact.evidence.problems import setups
from fem_impact.evidence.problems.bodies import FreeBody, body_model, placed
from fem_impact.evidence.problems.problem import Check, Solved, Values, defaults, within
from fem_impact.evidence.references.axisymmetric import Metal, taylor_bar
from fem_impact.evidence.references.rod_end import bar_speed
from fem_impact.physics.hardening import linear_hardening
from fem_impact.solid.model import Model
from fem_impact.solid.state import State

PRINTED = defaults("taylor")
COPPER = ("speed", "E", "nu", "rho", "yield_stress", "hardening")  # of them those that size leaves
TIME = 80e-6
FINAL, FOOT = 21.42e-3 / PRINTED["length"], 7.22e-3 / PRINTED["radius"]
SLENDER, HARDEST = (3.0, 20.0), 1.6  # length over radius; rho v^2 over the yield stress
CRUSHED = 2e-3  # of the first step: at the foot of a bar without hardening it falls to 0.014 and stays there
CAUTION = 0.8  # the whole bar flows: with the full step coarse cells near the foot came to grow unstable
CELLS = 4  # over the radius in the reference
TRIPS = 3.0  # round trips of the elastic wave that are followed at least


def _time(p: Values) -> float:
    """Return how long the bar is followed, s: its momentum over the force of its yield stress."""
    stops = p["rho"] * p["speed"] * p["length"] / p["yield_stress"]
    printed = PRINTED["rho"] * PRINTED["speed"] * PRINTED["length"] / PRINTED["yield_stress"]
    return p["time"] or max(TIME * stops / printed, TRIPS * 2 * p["length"] / bar_speed(p["E"], p["rho"]))


def _model(p: Values, slices: float) -> Model:
    R, slab = p["radius"], p["length"] / slices
    flat = np.array([[0.0, 0.0], [R, 0.0]])
    bar = meshes.rod(flat, p["length"], int(p["across"]), slice_length=slab, nose=False)
    mesh, law = meshes.RodMesh.plain(bar.mesh), linear_hardening(p["yield_stress"], p["hardening"])
    points = placed(bar.mesh.points, 0.0, 0.0)
    velocity, yields = np.array([0.0, 0.0, -p["speed"]]), np.ones(len(bar.mesh.cells), dtype=bool)
    metal = p["E"], p["nu"], p["rho"]
    model = body_model(FreeBody(mesh, points, velocity, *metal, law=law, yields=yields, friction=0.0))
    return replace(model, steps={"rod": CAUTION * model.step})


def strike(p: Values, slices: float) -> tuple[Array, float, State, int]:
    """Return length and foot radius, m, the ledger's residual over E_0, the end's state and number of cells.

    The section is a polygon of the round one's area.
    """
    model = _model(p, slices)
    state, energy = model.initial_state(), setups.Until(model.ledger(), _time(p), every=50)
    setups.follow(model, state, energy, every=2, crushed=CRUSHED)
    points, x = model.geometry.rod_points, state.x[model.layout.rod]
    foot = x[points[:, 2] < 1e-9 * p["radius"]]
    swell = float(np.hypot(points[:, 0], points[:, 1]).max()) / p["radius"]
    shape = np.array([np.ptp(x[:, 2]), np.hypot(foot[:, 0], foot[:, 1]).max() / swell])
    return shape, energy.ledger.worst / energy.ledger.start, state, len(model.geometry.rod.mesh.cells)


def _beside(shape: Array, exact: Array, near: Array, note: str = "") -> list[Check]:
    names = (f"{name}{note}" for name in ("final length", "foot radius"))
    numbers = zip(names, shape.tolist(), exact.tolist(), near.tolist(), strict=True)
    return [Check(name, "m", found, wanted, apart, "absolute") for name, found, wanted, apart in numbers]


def _reference(p: Values, cells: int) -> Array:
    """Return the reference's length and foot radius, m, with so many cells over the radius."""
    slope = p["hardening"] / p["yield_stress"]
    metal = Metal(p["E"], p["nu"], p["rho"], p["yield_stress"], slope)
    return np.array(taylor_bar(metal, p["length"], p["radius"], p["speed"], _time(p), cells))


def solve(p: Values) -> Solved:
    """Strike the wall and compare the final shape.

    Raises
    ------
    SceneError
        If the bar is too stubby or slender, or too fast.
    RunError
        If cells are crushed.
    """
    setups.slender(p, "radius", *SLENDER)
    fastest = float(np.sqrt(HARDEST * p["yield_stress"] / p["rho"]))
    why = f"cells are crushed where rho v^2 is over {HARDEST:g} yield stresses."
    within(p, "speed", 0.0, fastest, "m/s", why)
    shape, missed, state, cells = strike(p, p["slices"])
    coarse, *_ = strike(p, p["slices"] // 2)
    exact = _reference(p, CELLS)
    near = abs(shape - coarse) + abs(exact - _reference(p, CELLS // 2))
    checks = _beside(shape, exact, near)
    # the printed shape beside it, where the bar has its shape and copper
    scale, length = p["radius"] / PRINTED["radius"], PRINTED["length"]
    alike = abs(p["length"] - scale * length) < 1e-9 * length and p["time"] in (0.0, TIME * scale)
    if alike and all(p[name] == PRINTED[name] for name in COPPER):
        printed = np.array([FINAL * p["length"], FOOT * p["radius"]])
        checks += _beside(shape, printed, near, ", printed")
    checks.append(Check("energy ledger / E_0", "1", missed, 0.0, 1e-3, "at most"))
    return Solved(tuple(checks), state.step, cells)
