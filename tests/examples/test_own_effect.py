"""An effect as in docs/tutorials/extend.md: number and slot, and an item with its own account."""

from dataclasses import dataclass, replace
from math import exp

import numpy as np
import pytest
from own_package.my_impact_parts import LUNAR_GRAVITY as EFFECT
from own_package.my_impact_parts import MOON

from fem_impact.case import case, choose
from fem_impact.case.case import Case
from fem_impact.case.choose import neglected
from fem_impact.case.effects import registry as effect_names
from fem_impact.case.effects.registry import EFFECTS
from fem_impact.options import RunOptions
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.shipped import replace as changed
from fem_impact.solid import run
from fem_impact.solid.build import build
from fem_impact.solid.elastic import Weight
from fem_impact.solid.march import march
from fem_impact.solid.observers import Watch
from fem_impact.tables.table import read_csv


@pytest.fixture
def moon(monkeypatch):
    """What two lines in `effects/registry.py` do."""
    names = (*effect_names.NAMES, EFFECT.name)
    monkeypatch.setitem(EFFECTS, EFFECT.name, EFFECT)
    for module in (effect_names, choose, case):
        monkeypatch.setattr(module, "NAMES", names)


def scene_with(*effects, **changes):
    return replace_all(load("quick"), {"effects": ["auto", *effects], **changes})


def test_an_added_effect_is_chosen_by_its_number(moon):
    fast, slow = scene_with(), scene_with(**{"impact.v_n": "-5 mm/s", "impact.v_t": "-5 mm/s"})
    assert EFFECT.name not in Case(fast).active
    assert EFFECT.name in Case(slow).active
    (choice,) = [choice for choice in Case(slow).choices if choice.name == EFFECT.name]
    assert choice.sentence == "The Moon pulls the rod down."
    left_out = changed(slow, "effects", ["auto", f"-{EFFECT.name}"])
    assert any(EFFECT.name in words for words in neglected(Case(left_out).choices))


def test_it_is_built_when_it_is_on_and_only_then(moon):
    coarse = {"accuracy.tip_size": "1.6 mm", "accuracy.across": 6, "projectile.length": "60 mm"}
    on, off = (scene_with("barrier-rigid", *names, **coarse) for names in ((EFFECT.name,), ()))
    model = build(Case.of(on))
    (weight,) = [item for item in model.forces if isinstance(item, Weight)]
    places = model.layout.rod[model.layout.rod[:, 0] < model.layout.rod_size]
    pull = np.hypot(*weight.weight[places[:, [0, 2]]].sum(axis=0))
    assert pull == pytest.approx(MOON * on.projectile.rigid_body.mass / 2, rel=1e-9)  # half the rod is meshed
    assert not [item for item in build(Case.of(off)).forces if isinstance(item, Weight)]


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


def with_drag(model, rate):
    n = model.layout.rod_size
    free = model.inverse_mass[:n] > 0
    drag = Drag(np.where(free, model.mass[:n], 0.0), model.inverse_mass[:n], rate)
    return replace(model, impulses=[*model.impulses, drag])


def test_an_own_item_closes_the_ledger():
    scene = coarse_scene()
    model = with_drag(build(Case.of(scene)).coasting(), RATE)
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
    """What `build` would do for a filled slot; the item's account and run time are its own."""
    monkeypatch.setattr(run, "build", lambda planned: with_drag(build(planned), 50.0))
    outcome = simulate(coarse_scene(), options=RunOptions(tmp_path))
    assert outcome.validity.finished and abs(outcome.energy.residual) < 1e-4
    history = read_csv(tmp_path / "history.csv")
    held = history.numbers("E_kinetic_rod_J")
    assert 0.005 * held[0] < history.numbers("E_air_J")[-1] < 0.05 * held[0]
    assert outcome.energy.vibration > 0  # what comes after the march was computed too
