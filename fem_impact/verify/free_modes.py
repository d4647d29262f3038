"""``modes``: natural frequencies of a free round bar, from the eigenproblem and from ringing down."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

import meshes
from fem_impact.modes import rod_modes
from fem_impact.solid.elements import isotropic_stiffness, lumped_mass
from fem_impact.solid.march import march
from fem_impact.solid.masspoints import TWISTING, MassPoints
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import modes_of
from fem_impact.solid.sparse import assemble, tie_operator
from fem_impact.solid.state import State
from fem_impact.verify import steel
from fem_impact.verify.bodies import Body, body_model
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.reference.beam import bending_modes
from fem_impact.verify.reference.cylinder import Frequencies, cylinder_frequencies

__all__ = ["PROBLEM", "Probe", "bar_of", "frequencies"]

Array = NDArray[np.float64]

TOLERANCE = 0.005
COUNT = 14  # modes that are computed
SLENDER = (2.5, 30.0)  # length over diameter; stubbier bars have oval modes among the stretching ones
SLICES = 40  # at least; the third bending wave, 4/7 of the bar, needs 20 of them for 0.3 %
PLUCK = 0.01  # m/s, of the ringing bar
EVERY = 5  # steps between samples


def bar_of(p: Values, velocity: Array | None = None) -> Model:
    """Return the free bar, at rest or with nodal velocities (n, 3), m/s."""
    radius = p["diameter"] / 2
    flat = np.array([[0.0, 0.0], [radius, 0.0]])
    slab = min(p["diameter"] / p["across"], p["length"] / SLICES)
    bar = meshes.rod(flat, p["length"], int(p["across"]), slice_length=slab, nose=False)
    speed = np.zeros_like(bar.mesh.points) if velocity is None else velocity
    return body_model(Body(bar, bar.mesh.points, speed, p["E"], p["nu"], p["rho"]))


def frequencies(model: Model) -> dict[str, Array]:
    """Return bending and longitudinal frequencies, Hz, told apart by what the axis does."""
    points, places = model.geometry.rod_points, model.layout.rod
    found = modes_of(model, COUNT)
    axis = np.hypot(points[:, 0], points[:, 1]) < 1e-9
    across, along = (abs(found.shape[places[axis, c]]).max(axis=0) for c in (0, 2))
    return {
        "bending": found.frequency[across > 10 * along],
        "longitudinal": found.frequency[along > 10 * across],
    }


def _torsion(model: Model, p: Values) -> float:
    """Return the first frequency, Hz, of the motions that the solver's mirrored half leaves out."""
    rod, layout = model.geometry.rod, model.layout
    points, cells, n = rod.mesh.points, rod.mesh.cells, layout.rod_size
    C, T = isotropic_stiffness(p["E"], p["nu"]), tie_operator(rod.mesh.tie, layout.rod, n)
    drawn = MassPoints.of_rod(rod, lumped_mass(points, cells, p["rho"]), p["rho"], TWISTING)
    plain = assemble(points, cells, C, "incompatible", T)
    fixed = np.zeros(n, dtype=bool)
    fixed[layout.rod[np.abs(points[:, 1]) < 1e-12][:, [0, 2]]] = True
    found = rod_modes(drawn.reduced((plain,), layout.body_shape[1]), model.mass[:n], fixed, COUNT)
    axis = layout.rod[np.hypot(points[:, 0], points[:, 1]) < 1e-9, 1]
    turns = abs(found.shape[axis]).max(axis=0) < 0.1 * abs(found.shape).max(axis=0)
    return float(found.frequency[turns][0])


def _ring(p: Values) -> tuple[float, float, int]:
    """Return the first bending and longitudinal frequency, Hz, of a plucked bar, and the steps."""
    beam = bending_modes(p["E"], p["nu"], p["rho"], p["length"], p["diameter"] / 2, 1)
    points = bar_of(p).geometry.rod_points
    s = 2 * points[:, 2] / p["length"] - 1
    w = np.polynomial.legendre.legval(s, beam.deflection[0])
    theta = np.polynomial.legendre.legval(s, beam.angle[0])
    bend = np.stack([w, 0 * w, -points[:, 0] * theta], axis=1)
    stretch = np.stack([0 * w, 0 * w, -np.sin(0.5 * pi * s)], axis=1)
    speed = PLUCK * (bend / abs(w).max() + stretch)
    model = bar_of(p, speed)
    probes = [Probe(model, bend, 4 / float(beam.frequency[0])), Probe(model, stretch, 0.0)]
    march(model, state := model.initial_state(), probes)
    return probes[0].frequency(), probes[1].frequency(), state.step


class Probe:
    """Samples the velocity along a shape until a time."""

    every = EVERY

    def __init__(self, model: Model, shape: Array, end: float) -> None:
        places, mesh = model.layout.rod, model.geometry.rod.mesh
        self.row = np.zeros(model.layout.size)
        self.row[places[~mesh.is_hanging]] = shape[~mesh.is_hanging]
        self.row *= model.mass
        self.end = end
        self.times: list[float] = []
        self.values: list[float] = []

    def observe(self, state: State) -> bool:
        """Sample; velocities stand half a step before the positions."""
        self.times.append(state.time - 0.5 * state.dt)
        self.values.append(float(self.row @ state.v))
        return 0.0 < self.end <= state.time

    def frequency(self) -> float:
        """Return the frequency from the first to the last zero crossing."""
        t, y = np.array(self.times), np.array(self.values)
        k = np.flatnonzero(np.sign(y[1:]) != np.sign(y[:-1]))
        crossing = t[k] - y[k] * (t[k + 1] - t[k]) / (y[k + 1] - y[k])
        return float((len(k) - 1) / (2 * (crossing[-1] - crossing[0])))


def _eigen_checks(found: dict[str, Array], exact: Frequencies) -> list[Check]:
    wanted = {"bending": exact.bending[:3], "longitudinal": exact.longitudinal[:2]}
    return [
        Check(f"{kind} {i + 1}", "Hz", float(computed), float(value), TOLERANCE)
        for kind, values in wanted.items()
        for i, (computed, value) in enumerate(zip(found[kind], values, strict=False))
    ]


def solve(p: Values) -> Solved:
    """Compare both ways of finding frequencies with Rayleigh-Ritz in three dimensions.

    Raises
    ------
    SceneError
        If the bar is too stubby or too slender.
    """
    steel.slender(p, "diameter", *SLENDER)
    exact = cylinder_frequencies(p["E"], p["nu"], p["rho"], p["length"], p["diameter"] / 2)
    model = bar_of(p)
    checks = _eigen_checks(frequencies(model), exact)
    bend, stretch, steps = _ring(p)
    checks += [
        Check("torsion 1", "Hz", _torsion(model, p), float(exact.torsion[0]), TOLERANCE),
        Check("bending 1, ringing", "Hz", bend, float(exact.bending[0]), TOLERANCE),
        Check("longitudinal 1, ringing", "Hz", stretch, float(exact.longitudinal[0]), TOLERANCE),
    ]
    return Solved(tuple(checks), steps, len(model.geometry.rod.mesh.cells))


PARAMETERS: tuple[Parameter, ...] = (
    steel.length(),
    steel.diameter(),
    *steel.elastic(),
    steel.across(low=8),
)
PROBLEM = Problem(
    "modes", "natural frequencies of a free round bar, by eigenproblem and by ringing", PARAMETERS, solve
)
