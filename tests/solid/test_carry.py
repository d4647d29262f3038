"""What a rod keeps from one strike to the next: stresses and modes that turn with it."""

from dataclasses import replace

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.fem.eigen import no_modes
from fem_impact.fem.geometry import tail_corners
from fem_impact.fem.hexmodes import LANES
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.carry import turned, turned_at, turned_stress
from fem_impact.solid.rodview import RodState
from fem_impact.solid.separation import SAMPLES, Separation


def test_stresses_turn_as_tensors_do():
    rng = np.random.default_rng(1)
    stress = rng.normal(size=(2, 8, 6 * LANES))
    angle = 0.7
    R = turned(np.eye(3), angle).T
    found = turned_stress(stress, angle).reshape(2, 8, 6, LANES)
    for block, point, lane in ((0, 0, 0), (1, 5, LANES - 1)):
        tt, bb, nn, tb, bn, nt = stress.reshape(2, 8, 6, LANES)[block, point, :, lane]
        S = R @ np.array([[tt, tb, nt], [tb, bb, bn], [nt, bn, nn]]) @ R.T
        wanted = S[0, 0], S[1, 1], S[2, 2], S[0, 1], S[1, 2], S[0, 2]
        assert found[block, point, :, lane] == pytest.approx(wanted, abs=1e-12)


def test_a_quarter_turn_brings_n_to_t():
    assert turned(np.array([[0.0, 0.0, 1.0]]), np.pi / 2) == pytest.approx(np.array([[1.0, 0.0, 0.0]]))
    vector, places = np.arange(7.0), np.array([[4, 5, 6]])
    assert turned_at(vector, places, np.pi / 2) == pytest.approx([0, 1, 2, 3, 6, 5, -4])


@pytest.mark.parametrize("angle", [-0.05, 0.1])
def test_the_tail_of_a_rod_that_has_turned_comes_down_when_it_is_there(angle):
    effects = {"effects": ["vibration", "barrier-rigid"], "accuracy.levels": 1, "accuracy.tip_size": "1 mm"}
    case = Case.of(replace_all(load("quick"), effects), "solid")
    model = build(case)
    view, state = RodState.of(model, no_modes(model.mass[: model.layout.rod_size])), model.initial_state()
    centre = view.rigid(state).centre
    state.x[view.places] = centre + turned(state.x[view.places] - centre, angle)
    tail, speed = tail_corners(case.bodies), 100.0
    motion = replace(view.rigid(state), V_n=-speed, V_t=0.0, Omega=0.0)
    wanted = (centre + turned(tail - centre, angle))[:, 2].min() / speed
    found = Separation(model, view, 1.0, 4e-3, tail)._tail_strikes(state, motion)
    assert found == pytest.approx(wanted, abs=2 * 4e-3 / SAMPLES)
