"""Shares of the run time: which item is which effect, and how often it acts. Times are made up."""

import pytest
import solid_scenes

from fem_impact.solid import shares
from fem_impact.solid.damping import ModalDamping
from fem_impact.solid.heatwatch import HeatWatch


def told(monkeypatch, *effects, heat=False):
    """Shares of a step that takes ten times as long as anything in it."""
    monkeypatch.setattr(shares, "_shortest", lambda act: 1.0)
    stated, model = solid_scenes.scene(*effects, length=0.06), solid_scenes.model(*effects, length=0.06)
    watch = HeatWatch(model) if heat else None
    return model, shares.run_time_shares(stated, model, model.initial_state(), 10.0, watch)


def test_each_item_is_booked_for_its_effect(monkeypatch):
    _, found = told(monkeypatch, "vibration", "rod-plasticity", "barrier-rigid", "gravity")
    assert found == pytest.approx({"vibration": 0.1, "rod-plasticity": 0.1, "gravity": 0.1})


def test_a_yielding_block_is_block_and_zone(monkeypatch):
    _, found = told(monkeypatch, "friction", "barrier-elastoplastic", "radiation", heat=True)
    expected = {"nose": 0.2, "barrier-elastoplastic": 0.2, "radiation": 0.1, "contact-heating": 0.1}
    assert found == pytest.approx(expected)


def test_the_turning_frame_is_taken_from_the_rod(monkeypatch):
    _, found = told(monkeypatch, "vibration", "barrier-rigid", "large-rotation")
    assert found == pytest.approx({"vibration": 0.1 - 0.2, "large-rotation": 0.2})


def test_damping_acts_every_few_steps(monkeypatch):
    model, found = told(monkeypatch, "vibration", "barrier-rigid", "material-damping")
    (damping,) = (item for item in model.impulses if isinstance(item, ModalDamping))
    assert damping.every > 1
    assert found["material-damping"] == pytest.approx(0.1 / damping.every)
