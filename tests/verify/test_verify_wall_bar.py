"""The square bar that five public codes agree on."""

import pytest

from fem_impact.verify import verify


@pytest.mark.parametrize("element", [0, 2])
def test_the_wall_stress_of_public_codes(element):
    found = verify("wall-bar", {"element": element})
    assert found.passed
    assert abs(found.checks[0].error) < 1e-6


@pytest.mark.validation
def test_mean_dilatation_and_another_speed():
    assert verify("wall-bar", {"element": 1, "speed": 1.7}).passed
