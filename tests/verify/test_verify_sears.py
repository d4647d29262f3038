"""A rod with a round end along its axis, through the solver."""

import pytest

from fem_impact.verify.catalogue import verify

SHORT = {"length": 0.08, "speed": 4.0, "cells": 2}


def test_a_short_rod():
    assert verify("sears", SHORT).passed


def test_the_edge_of_the_study():
    found = verify("sears", SHORT | {"tip_radius": "3 mm", "block": 0, "speed": 2.0})
    assert found.passed
    assert abs(found.checks[0].error) < 0.02


@pytest.mark.validation
@pytest.mark.parametrize("change", [{}, {"length": 0.08, "speed": 4.0}, {"tip_radius": "3 mm"}])
def test_a_rod_is_sears(change):
    found = verify("sears", change)
    assert found.passed
    assert found.checks[0].tolerance < 0.02
