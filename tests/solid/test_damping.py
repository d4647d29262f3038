"""Material damping: the closed-form decay of a mode, what it leaves alone, and its account."""

from dataclasses import replace
from math import exp

import numpy as np
import pytest
import solid_scenes

from fem_impact.evidence.problems.setups import rigid_of
from fem_impact.solid.elastic import ModalDamping
from fem_impact.solid.march import march

LOSS = 0.05
EFFECTS = ("vibration", "barrier-rigid", "large-rotation", "material-damping")


class Until:
    every = 1

    def __init__(self, end, ledger):
        self.end, self.ledger = end, ledger

    def observe(self, state):
        self.accounts = self.ledger.sample(state) if state.step % 50 == 0 else self.accounts
        return state.time >= self.end


@pytest.fixture(scope="module")
def rung():
    """A short rod that turns at -200 rad/s, flies and rings in its first mode, for four periods."""
    model = solid_scenes.model(*EFFECTS, length=0.06, tip=3.2e-3, v_n=-1.0, v_t=-1e-9, omega=-200.0)
    (damping,) = (item for item in model.impulses if isinstance(item, ModalDamping))
    model = replace(model, impulses=[replace(damping, loss=LOSS)])
    state, modes = model.initial_state(), damping.modes
    state.v[: len(modes.mass)] += 0.02 * modes.shape[:, 0]
    watch = Until(4 * 2 * np.pi / modes.omega[0], model.ledger())
    march(model, state, [watch])
    return model, state, watch


def test_a_mode_decays_by_its_loss_factor(rung):
    model, state, _ = rung
    damping = model.impulses[0]
    kept = exp(-LOSS * damping.modes.omega[0] * state.time)
    assert kept < 0.3
    started = 0.02**2  # of the whole rod: the shapes are normalised by half of it
    assert 2 * damping.taken == pytest.approx(started * (1 - kept), rel=0.01)


def test_its_account_closes_the_ledger(rung):
    _, _, watch = rung
    assert watch.accounts["damping"] > 2e-4
    assert abs(watch.accounts["residual"]) < 1e-3 * watch.accounts["damping"]


def test_rigid_motion_is_left_alone(rung):
    model, state, _ = rung
    motion = rigid_of(model, state)
    assert motion.V_n == pytest.approx(-1.0, abs=1e-9)
    assert motion.Omega == pytest.approx(-200.0, rel=1e-4)


def test_a_struck_rod_loses_what_it_damps():
    plain = solid_scenes.run("vibration", "barrier-rigid", "large-rotation", length=0.08, tip=1.6e-3)
    damped = solid_scenes.run(*EFFECTS, length=0.08, tip=1.6e-3)
    assert 0 < damped.accounts["damping"] < 0.1 * plain.flight.energy
    assert damped.flight.energy < plain.flight.energy
    assert damped.worst < 1e-6 * damped.E_0
