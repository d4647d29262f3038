"""``bar``: a bar without lateral strain strikes a rigid wall, and bounces between two walls."""

from dataclasses import dataclass, replace
from math import pi
from typing import ClassVar

import numpy as np

import meshes
from fem_impact.evidence.problems import setups
from fem_impact.evidence.problems.problem import Check, Solved, Values, within
from fem_impact.evidence.references.rod_end import FOLLOWED, BarImpact, bar_speed, chain_restitution, strike
from fem_impact.scene.impact import Impact
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State

PLATEAU, DURATION, GROWTH, CLOSING, CHAIN = 0.005, 0.01, 1e-3, 1e-6, 1e-6
WINDOW = (0.15, 0.85)  # of the duration, over which the plateau is averaged
FLIGHT = 0.3  # time between two walls over the duration of a strike
FASTEST = 0.05  # over c0
COARSER = 5  # the bar between two walls has so many times fewer slices


def _model(p: Values, slices: int, across: int) -> Model:
    """Return a scene's bar on the wall, a mesh of its own: a chain has equal links up to its ends."""
    flat = np.array([[0.0, 0.0], [p["diameter"] / 2, 0.0]])
    slab = p["length"] / slices
    bar = meshes.rod(flat, p["length"], across, slice_length=slab, nose=False).mesh
    drop = Impact(0.0, -p["speed"], 0.0)
    return setups.meshed_bar_model({**p, "nu": 0.0}, bar, drop, ("barrier-rigid",))


@dataclass(slots=True)
class Ceiling:
    """A second rigid wall at n = height: the solver's plane contact, seen upside down."""

    effect: ClassVar[str] = "contact"
    accounts: ClassVar[tuple[str, ...]] = ()
    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ()
    wall: PlaneContact
    height: float
    bounces: int = 0

    def resolve(self, state: State) -> None:
        """Turn the wall's own nodes upside down, let them touch, turn them back."""
        n, before = self.wall.nodes[:, 2], self.wall.book.step.active
        for vector in (state.v, state.force):
            vector[n] *= -1
        state.x[n] = self.height - state.x[n]
        self.wall.resolve(state)
        self.bounces += int(self.wall.book.step.active > 0 and before == 0)
        for vector in (state.v, state.force):
            vector[n] *= -1
        state.x[n] = self.height - state.x[n]

    def energies(self, state: State) -> tuple[float, ...]:
        """Return nothing: this wall's closing loss is left to the energy that is checked."""
        return ()


def _one_strike(p: Values, exact: BarImpact) -> tuple[list[Check], int, int]:
    slices = int(p["slices"])
    model = _model(p, slices, int(p["across"]))
    state, force = model.initial_state(), setups.force_recorder(model)
    energy = setups.Until(model.ledger(), FOLLOWED * exact.duration)
    march(model, state, [force, energy])
    plateau = force.mean(WINDOW[0] * exact.duration, WINDOW[1] * exact.duration, force.span[0])
    closing = energy.ledger.sample(state)["closing"] / energy.ledger.start
    spans = model.book.intervals
    chain = chain_restitution(slices, model.step * slices * bar_speed(p["E"], p["rho"]) / p["length"])
    checks = [
        Check("plateau of the wall force", "N", plateau, exact.force, PLATEAU),
        Check("duration", "s", spans[-1].end - spans[0].start, exact.duration, DURATION),
        Check("contacts", "1", force.touches, 1, 0.0, "absolute"),
        # a bar that strains along itself alone is a chain of its slices' masses
        Check("restitution", "1", setups.rigid_of(model, state).V_n / p["speed"], chain, CHAIN, "absolute"),
        Check("largest energy / E_0", "1", energy.most, 1.0, GROWTH, "at most"),
        # half a slice of mass stops dead at the wall
        Check("closing loss / E_0", "1", closing, 0.5 / slices, CLOSING),
    ]
    return checks, state.step, len(model.geometry.rod.mesh.cells)


def solve(p: Values) -> Solved:
    """Strike once, then bounce.

    Raises
    ------
    SceneError
        If the bar is so fast that it is squeezed by more than a few per cent.
    """
    within(
        p,
        "speed",
        0.0,
        FASTEST * bar_speed(p["E"], p["rho"]),
        "m/s",
        "the reference holds for small strains.",
    )
    exact = strike(p["E"], p["rho"], pi * p["diameter"] ** 2 / 4, p["length"], p["speed"])
    checks, steps, elements = _one_strike(p, exact)
    if p["bounces"]:
        # bounce for the time that so many bounces without loss would take
        slices = max(4, int(p["slices"]) // COARSER)
        gap = FLIGHT * exact.duration * p["speed"]
        model = _model(p, slices, 6)
        top = model.geometry.rod_points[:, 2] > 0.999 * p["length"]
        smooth = PlaneContact(model.layout.rod[top], model.inverse_mass, np.zeros(int(top.sum())))
        ceiling = Ceiling(smooth, p["length"] + gap)
        walled = replace(model, impulses=[*model.impulses, ceiling])
        state = walled.initial_state()
        state.x[model.layout.rod[:, 2]] += 0.5 * gap
        energy = setups.Until(walled.ledger(), p["bounces"] * (1 + FLIGHT) * exact.duration)
        march(walled, state, [energy])
        checks += [
            Check("touches both walls", "1", float(ceiling.bounces > 0), 1.0, 0.0, "absolute"),
            Check("largest energy of all bounces / E_0", "1", energy.most, 1.0, GROWTH, "at most"),
        ]
    return Solved(tuple(checks), steps, elements)
