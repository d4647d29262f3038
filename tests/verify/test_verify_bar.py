"""A bar on a wall through the solver."""

import pytest

from fem_impact.verify import verify


def test_one_strike_and_a_few_bounces():
    found = verify("bar", {"bounces": 20})
    assert found.passed
    values = {c.name: c.computed for c in found.checks}
    assert values["plateau of the wall force"] == pytest.approx(23512, rel=1e-4)


def test_another_bar():
    assert verify("bar", {"E": "70 GPa", "rho": 2700, "length": 0.5, "speed": 10.0, "bounces": 0}).passed


def test_few_slices_lose_more_on_closing():
    """The lumped end node stops dead: the loss is of first order in the slice."""
    losses = [1 - verify("bar", {"slices": n, "bounces": 0}).checks[3].computed for n in (50, 100)]
    assert losses[0] / losses[1] == pytest.approx(2.0, abs=0.5)


@pytest.mark.validation
def test_a_thousand_bounces():
    assert verify("bar").passed
