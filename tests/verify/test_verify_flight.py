"""Conservation laws through whole runs."""

import pytest

from fem_impact.verify import verify


def test_a_free_spin_costs_nothing():
    found = verify("free-spin", {"time": "0.4 ms", "length": "60 mm"})
    assert found.passed
    assert found.cost.steps > 5000


def test_momentum_of_a_spinning_rod():
    found = verify("momentum", {"length": "50 mm"})
    assert found.passed
    gained = {c.name: c.computed for c in found.checks}
    assert gained["normal momentum gained"] > 0.05
    assert abs(gained["angular momentum gained"]) > 1e-6


@pytest.mark.validation
@pytest.mark.parametrize("changes", [{}, {"angle": "30 deg", "omega": -60.0, "v_n": 3.0, "length": "0.12 m"}])
def test_momentum_at_other_angles_and_spins(changes):
    assert verify("momentum", changes).passed


@pytest.mark.validation
def test_a_long_free_spin():
    assert verify("free-spin").passed
