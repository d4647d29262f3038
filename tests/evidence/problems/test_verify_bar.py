"""A bar on a wall through the solver."""

import pytest

from fem_impact.evidence.problems.problem import verify


def test_one_strike_and_a_few_bounces():
    found = verify("bar", {"bounces": 20})
    assert found.passed
    values = {c.name: c.computed for c in found.checks}
    assert values["plateau of the wall force"] == pytest.approx(23512, rel=1e-4)


def test_another_bar():
    assert verify("bar", {"E": "70 GPa", "rho": 2700, "length": 0.5, "speed": 10.0, "bounces": 0}).passed


def test_closing_loss_is_of_first_order_in_the_slice():
    """The lumped end node, half a slice, stops dead: h / (2 L) of the energy, .0050 at 100 slices."""
    losses = []
    for slices in (50, 100, 200):
        found = verify("bar", {"slices": slices, "bounces": 0})
        assert found.passed
        losses.append(next(c.computed for c in found.checks if c.name.startswith("closing loss")))
    assert losses == pytest.approx([0.01, 0.005, 0.0025], rel=1e-6)
