"""Barriers that are free to move, that move, or that bend, in the explicit model, on coarse meshes."""

import re

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.march import advance, evaluate

COARSE = {
    "accuracy.tip_size": "1 mm",
    "accuracy.across": 6,
    "accuracy.max_time": "0.5 ms",
    "accuracy.unresolved": "report",
    "projectile.length": "60 mm",
    "save.frames": 0,
}
PLANE = ["vibration", "friction", "barrier-rigid"]
BLOCK = ["vibration", "friction", "barrier-elastic", "radiation"]
YIELDING = ["vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "radiation"]
PLATE = {"barrier.thickness": "10 mm", "barrier.support": "infinite"}
MOVING = {"barrier.v_n": "0.5 m/s", "barrier.v_t": "0.2 m/s"}
GAINED = np.array([0.5, 0.2, 0.0])
NUMBERS = ("V_n", "V_t", "Omega")


def run(effects, **changes):
    return simulate(replace_all(load("t5b"), {**COARSE, "effects": effects, **changes}), "solid")


def motion(outcome):
    return np.array([getattr(outcome.motion, name) for name in NUMBERS])


def closes(outcome):
    return abs(outcome.energy.residual) < 1e-6


@pytest.fixture(scope="module")
def massive():
    return run(PLANE)


def test_a_very_heavy_barrier_is_a_massive_one(massive):
    heavy = run(PLANE, **{"barrier.mass": "1e9 kg"})
    assert motion(heavy) == pytest.approx(motion(massive), rel=1e-8)


@pytest.mark.parametrize("effects", [PLANE, pytest.param(YIELDING, marks=pytest.mark.long)])
def test_a_free_barrier_takes_the_momentum_that_the_rod_loses(effects):
    outcome = run(effects, **{"barrier.mass": "0.5 kg"})
    m, b = outcome.motion, outcome.barrier
    assert b.momentum_error < 1e-10 and closes(outcome)
    assert m.mass * (m.V_n - m.v_n) == pytest.approx(-0.5 * b.V_bn, rel=1e-9)
    energy = 0.25 * (b.V_bn**2 + b.V_bt**2) / outcome.energy.E_0
    assert outcome.energy.barrier == pytest.approx(energy, rel=1e-12) and energy > 0.1


@pytest.mark.parametrize("whole", [0.5, 0.025])
def test_a_block_on_a_foundation_shares_its_momentum_without_loss(whole):
    """Springs and dashpots between block and foundation pass on what they take.

    The block of the lighter barrier would outweigh it with the usual margin.
    """
    scene = replace_all(load("t5b"), {**COARSE, "effects": BLOCK, "barrier.mass": f"{whole} kg"})
    model = build(Case.of(scene))
    state, mass = model.initial_state(), model.mass
    block, foundation, rod = model.layout.barrier_slice, model.layout.foundation, model.layout.rod
    assert 2 * (mass[block].sum() / 3 + mass[foundation[2]]) == pytest.approx(whole, rel=1e-12)
    state.v[block] = np.random.default_rng(1).normal(size=block.stop - block.start) * (
        model.inverse_mass[block] > 0
    )

    def momentum():
        moved = (mass[block] * state.v[block]).reshape(-1, 3).sum(axis=0) + mass[foundation] * state.v[
            foundation
        ]
        return (moved + (mass[rod] * state.v[rod]).sum(axis=0))[[0, 2]]

    before = momentum()
    for _ in range(30):
        evaluate(model, state)
        advance(model, state)
    assert np.abs(state.v[foundation[[0, 2]]]).min() > 0
    assert momentum() == pytest.approx(before, abs=1e-12 * float(mass[rod].sum()))


def test_only_the_relative_motion_matters():
    still = run(PLANE, **{"barrier.mass": "0.5 kg"})
    seen = {"impact.v_n": "-1.0024 m/s", "impact.v_t": "-1.2821 m/s"}
    moving = run(PLANE, **{"barrier.mass": "0.5 kg", **MOVING, **seen})
    assert motion(moving) == pytest.approx(motion(still) + GAINED, rel=1e-9)
    assert moving.barrier.V_bn == pytest.approx(still.barrier.V_bn + 0.5, rel=1e-9)
    for name in ("e", "E_ln", "E_lt"):
        values = (getattr(one.restitution.edge, name) for one in (moving, still))
        assert next(values) == pytest.approx(next(values), rel=1e-9)
    assert moving.energy.friction == pytest.approx(still.energy.friction, rel=1e-9)


def test_a_block_heavier_than_its_barrier_is_refused_before_it_is_meshed():
    scene = replace_all(load("t5b"), {**COARSE, "effects": BLOCK, "barrier.mass": "1 g"})
    with pytest.raises(SceneError, match=r"barrier\.mass = .*mesh around the contact.*Give more than") as it:
        Case.of(scene, "solid")
    enough = re.search(r"Give more than ([\d.e-]+ kg)", str(it.value))[1]
    light, heavy = (
        replace_all(scene, {"barrier.mass": f"{share * float(enough[:-3])} kg"}) for share in (0.6, 1.2)
    )
    with pytest.raises(SceneError, match="Give more than"):
        Case.of(light, "solid")
    assert build(Case.of(heavy, "solid")).layout.foundation.size


@pytest.mark.parametrize("effects", [PLANE, pytest.param(YIELDING[:-1], marks=pytest.mark.long)])
def test_a_plate_takes_energy_and_the_ledger_closes(effects):
    outcome = run([*effects, "plate-bending"], **PLATE)
    assert closes(outcome) and outcome.energy.plate > 0.1
    assert outcome.barrier.V_bn == 0.0
