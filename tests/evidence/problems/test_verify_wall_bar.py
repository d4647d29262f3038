"""The square bar that five public codes agree on."""

import pytest

from fem_impact.errors import SceneError
from fem_impact.evidence.problems.problem import verify

OTHER = {"length": "0.12 m", "side": "15 mm", "E": "70 GPa", "nu": 0.4, "rho": 2700, "cells": 6, "speed": 7.0}


@pytest.mark.slow
def test_the_wall_stress_of_public_codes():
    found = verify("wall-bar", {"element": 0})
    assert found.passed
    assert len(found.checks) == 2
    assert all(abs(check.error) < 1e-6 for check in found.checks)


@pytest.mark.parametrize("element", [0, 1, 2])
def test_another_bar_is_that_of_the_reference(element):
    found = verify("wall-bar", {**OTHER, "element": element})
    assert len(found.checks) == 1
    assert abs(found.checks[0].error) < 1e-9


@pytest.mark.parametrize("problem", ["wall-bar", "tilted-bar"])
def test_a_bar_too_stubby_is_refused(problem):
    with pytest.raises(SceneError, match=r"2.5 to 40 times the side"):
        verify(problem, {"length": "40 mm"})


@pytest.mark.validation
@pytest.mark.parametrize("element", [1, 2])
def test_other_elements_and_another_speed(element):
    found = verify("wall-bar", {"element": element, "speed": 1.7})
    assert all(abs(check.error) < 1e-6 for check in found.checks)
