"""An item of an effect of one's own that changes velocities and books in an account of its own."""

from dataclasses import dataclass, replace
from math import exp

import numpy as np
import pytest

from fem_impact.case import case, choose
from fem_impact.case.case import Case
from fem_impact.case.effects import registry
from fem_impact.case.effects.registry import EFFECTS
from fem_impact.case.effects.slots import Effect
from fem_impact.options import RunOptions
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.shipped import replace as changed
from fem_impact.solid.build import build
from fem_impact.solid.march import march
from fem_impact.solid.observers import Watch
from fem_impact.tables.table import read_csv


@dataclass
class Drag:
    """An item: every step it takes a share of the velocities, and books it with their mean."""

    effect = "air-drag"  # whose run time it counts to
    accounts = ("air",)  # one that no other item books in
    every = 1
    moving = ("taken",)
    mass: np.ndarray
    inverse_mass: np.ndarray
    rate: float
    taken: float = 0.0

    def resolve(self, state):
        n = len(self.mass)
        kicked = state.v[:n].copy()
        old = kicked - state.kick * self.inverse_mass * state.force[:n]
        lost = kicked * -np.expm1(-self.rate * state.kick)
        state.v[:n] -= lost
        self.taken += 0.5 * float(self.mass * lost @ (old + kicked - lost))

    def energies(self, state):
        return (self.taken,)


RATE = 5e3  # 1/s


def coarse_scene():
    return replace_all(
        load("quick"),
        {
            "effects": ["vibration", "barrier-rigid"],
            "accuracy.tip_size": "1.6 mm",
            "accuracy.across": 6,
            "accuracy.unresolved": "report",
            "projectile.length": "60 mm",
        },
    )


def drag_of(bodies, rate):
    n = bodies.layout.rod_size
    free = bodies.inverse_mass[:n] > 0
    return Drag(np.where(free, bodies.mass[:n], 0.0), bodies.inverse_mass[:n], rate)


def test_an_own_item_closes_the_ledger():
    scene = coarse_scene()
    model = build(Case.of(scene)).coasting()
    model = replace(model, impulses=[drag_of(model, RATE)])
    watch, state = Watch(model.ledger(), every=10), model.initial_state()

    class End:
        every = 1

        def observe(self, state):
            return state.step >= 500

    march(model, state, [watch, End()])
    assert watch.ledger.worst < 1e-12 * watch.ledger.start
    flown = state.time - 0.5 * state.dt  # velocities stand half a step behind
    kept = watch.accounts["kinetic_rod"] / watch.ledger.start
    assert kept == pytest.approx(exp(-2 * RATE * flown), rel=1e-6)
    assert kept < 0.9


def test_a_run_with_an_own_item_comes_to_its_end(monkeypatch, tmp_path):
    """What an entry point does; the item's account and run time are its own."""
    drag = Effect(
        *("air-drag", "Air slows the rod.", "No air.", "rate tau", 0.01, "chosen"),
        number=lambda bodies: 50.0 * bodies.estimate.duration,
        fill=lambda bodies, spec: None,
        fidelities=("solid",),
        impulses=lambda builder: [drag_of(builder.meshed, 50.0)],
    )
    monkeypatch.setitem(EFFECTS, drag.name, drag)
    for module in (registry, choose, case):
        monkeypatch.setattr(module, "NAMES", (*registry.NAMES, drag.name))
    scene = changed(coarse_scene(), "effects", ["vibration", "barrier-rigid", drag.name])
    outcome = simulate(scene, options=RunOptions(tmp_path))
    assert outcome.validity.finished and abs(outcome.energy.residual) < 1e-4
    history = read_csv(tmp_path / "history.csv")
    held = history.numbers("E_kinetic_rod_J")
    assert 0.005 * held[0] < history.numbers("E_air_J")[-1] < 0.05 * held[0]
    assert outcome.energy.vibration > 0  # what comes after the march was computed too
