"""A sphere on a plane through the solver."""

import pytest

from fem_impact.verify import verify


def test_a_coarse_sphere_is_near_hertz():
    found = verify("hertz", {"cells": 3})
    values = {c.name: c.error for c in found.checks}
    assert abs(values["largest force"]) < 0.06
    assert abs(values["contact time"]) < 0.04
    assert abs(values["restitution"]) < 1e-3


@pytest.mark.validation
def test_a_sphere_is_hertz():
    assert verify("hertz").passed
