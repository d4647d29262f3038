"""Shares of the run time: which item is which effect, and how often it acts. Times are made up."""

from functools import partial

import pytest
import solid_scenes

from fem_impact.solid import shares
from fem_impact.solid.elastic import ModalDamping
from fem_impact.solid.heatwatch import HeatWatch


def told(monkeypatch, *effects, heat=False, item=1.0, step=10.0):
    """Shares of a step that takes ten times as long as an item, or as half of the frame's turning."""
    monkeypatch.setattr(shares, "_shortest", lambda act: item if isinstance(act, partial) else 1.0)
    model = solid_scenes.model(*effects, length=0.06)
    watch = HeatWatch(model) if heat else None
    return model, shares.run_time_shares(model, model.initial_state(), step, watch)


def test_each_item_is_booked_for_its_effect(monkeypatch):
    _, found = told(monkeypatch, "vibration", "rod-plasticity", "barrier-rigid", "gravity")
    assert found == pytest.approx({"vibration": 0.1, "rod-plasticity": 0.1, "gravity": 0.1})


def test_a_yielding_block_is_block_and_zone(monkeypatch):
    _, found = told(monkeypatch, "friction", "barrier-elastoplastic", "radiation", heat=True)
    expected = {"nose": 0.2, "barrier-elastoplastic": 0.2, "radiation": 0.1, "contact-heating": 0.1}
    assert found == pytest.approx(expected)


def test_the_turning_frame_is_taken_from_the_rod(monkeypatch):
    _, found = told(monkeypatch, "vibration", "barrier-rigid", "large-rotation", item=3.0)
    assert found == pytest.approx({"vibration": 0.3 - 0.2, "large-rotation": 0.2})


def test_a_share_that_the_clock_does_not_resolve_is_not_known(monkeypatch):
    """No share is negative: the turning took longer than the rod that it is a part of, or a step no time."""
    effects = ("vibration", "barrier-rigid", "large-rotation")
    _, found = told(monkeypatch, *effects)
    assert found == {"vibration": None, "large-rotation": pytest.approx(0.2)}
    _, found = told(monkeypatch, *effects, item=3.0, step=0.0)
    assert found == {"vibration": None, "large-rotation": None}


def test_shares_of_a_processor_that_has_become_slower_are_no_more_than_the_whole(monkeypatch):
    """Seen in a run of 108 steps: 1.03 of the step."""
    _, found = told(monkeypatch, "vibration", "rod-plasticity", "barrier-rigid", item=9.0)
    assert found == pytest.approx({"vibration": 0.5, "rod-plasticity": 0.5})


def test_damping_acts_every_few_steps(monkeypatch):
    model, found = told(monkeypatch, "vibration", "barrier-rigid", "material-damping")
    (damping,) = (item for item in model.impulses if isinstance(item, ModalDamping))
    assert damping.every > 1
    assert found["material-damping"] == pytest.approx(0.1 / damping.every)
