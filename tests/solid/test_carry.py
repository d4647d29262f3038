"""What a rod keeps from one strike to the next: stresses and modes that turn with it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import solid_scenes

from fem_impact.case.case import Case
from fem_impact.fem.eigen import no_modes
from fem_impact.fem.flight import FreeVibration
from fem_impact.fem.geometry import tail_corners
from fem_impact.fem.hexmodes import LANES
from fem_impact.fem.stable import SAFETY
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.carry import carry, dented, turned_stress
from fem_impact.solid.frame import turned, turned_at
from fem_impact.solid.rodview import RodState
from fem_impact.solid.separation import SAMPLES, Separation
from fem_impact.solid.stepguard import zone_step

YIELDING = "vibration", "friction", "rod-plasticity", "barrier-elastoplastic"


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


def pressed(model):
    """Places (n, 3), m, of the plate's nodes: its first cell under the tip keeps two fifths of its height."""
    x, h = model.geometry.barrier.points.copy(), model.geometry.tip_size
    near = np.exp(-((x[:, 0] / (3 * h)) ** 2) - (x[:, 1] / (1.5 * h)) ** 2)
    return x - np.outer(0.6 * h * near * np.clip(1 + x[:, 2] / h, 0, 1), [0.0, 0.0, 1.0])


def struck(model):
    """What a later strike reads of a last run that ended at rest, without vibration."""
    modes, state = no_modes(model.mass[: model.layout.rod_size]), model.initial_state()
    view = RodState.of(model, modes)
    flight = FreeVibration(modes, np.zeros(0), np.zeros(0))
    return SimpleNamespace(model=model, state=state, view=view, flight=flight, motion=view.rigid(state))


def assert_begins_stably(begun, whole, body):
    """Its first step is the stated share of what its deformed cells allow, less than whole ones do."""
    allowed = min(zone_step(zone, begun, begun.start[0]) for zone in begun.zones if zone.body == body)
    assert allowed < 0.95 * whole.steps[body] / SAFETY
    assert begun.steps[body] <= SAFETY * allowed * (1 + 1e-6)
    assert begun.initial_state().dt_next <= SAFETY * allowed * (1 + 1e-6)
    others = {name: step for name, step in whole.steps.items() if name != body}
    assert {name: step for name, step in begun.steps.items() if name != body} == others


def test_a_strike_on_a_deep_dent_begins_at_the_step_of_its_cells():
    made, last = (solid_scenes.model(*YIELDING, length=0.08) for _ in range(2))
    end = struck(last)
    end.state.x[last.layout.barrier] = pressed(last)
    assert_begins_stably(dented(made, end), made, "barrier")
    assert dented(made, struck(made)).steps == pytest.approx(made.steps)


@pytest.mark.parametrize("angle", [0.0, 0.3])
def test_a_strike_with_a_squeezed_tip_begins_at_the_step_of_its_cells(angle):
    made, last = (solid_scenes.model(*YIELDING, length=0.08) for _ in range(2))
    end = struck(last)
    x = last.geometry.rod_points.copy()
    x[x[:, 2] < 2.4e-3, 2] *= 0.5
    end.state.x[last.layout.rod] = x
    begun = carry(made, end.view, end, angle, end.motion, end.flight)
    assert_begins_stably(begun, made, "rod")
    whole = struck(made)
    again = carry(made, whole.view, whole, angle, whole.motion, whole.flight)
    assert again.steps == pytest.approx(made.steps)
