"""Friction over sliding speed in all three models: a tip that slides fast has f of that speed."""

import pytest

from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

HALF = {"speed": ["0 m/s", "2 m/s", "9 m/s"], "factor": [1, 0.5, 0.5], "source": "a test"}
FAST = {
    "surface.friction": 0.2,
    "surface.sliding_law": HALF,
    "impact.v_n": "-0.5 m/s",
    "impact.v_t": "-6 m/s",
    "accuracy.tip_size": "1.6 mm",
    "accuracy.across": 6,
    "accuracy.levels": 1,
    "accuracy.unresolved": "report",
    "projectile.length": "60 mm",
}


@pytest.mark.parametrize(
    ("fidelity", "barrier"),
    [("rigid", "rigid"), ("modal", "rigid"), ("solid", "rigid"), ("solid", "elastic")],
)
def test_a_fast_slide_has_the_friction_of_its_speed(fidelity, barrier):
    effects = ["vibration", "friction", f"barrier-{barrier}"]
    outcome = simulate(replace_all(load("quick"), {**FAST, "effects": effects}), fidelity)
    allowed = 0.005 if barrier == "elastic" else 1e-4  # averaged normals of a deformed surface
    assert outcome.restitution.mu == pytest.approx(0.1, abs=allowed)
    assert abs(outcome.energy.residual) < 1e-5


def test_a_yielding_tip_of_the_reduced_model_follows_the_law_and_its_ledger_closes():
    slow = simulate(replace_all(load("quick"), {"surface.sliding_law": "dry-rail"}), "modal")
    plain = simulate(load("quick"), "modal")
    assert slow.restitution.mu < plain.restitution.mu - 0.05
    assert abs(slow.energy.residual) < 1e-5


def test_a_law_that_changes_nothing_changes_nothing():
    same = {"surface.sliding_law": {"speed": ["0 m/s", "9 m/s"], "factor": [1, 1], "source": "a test"}}
    with_law, without = (
        simulate(replace_all(load("quick"), changes), "modal").motion for changes in (same, {})
    )
    assert with_law == without
