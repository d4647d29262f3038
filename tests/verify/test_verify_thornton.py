"""A yielding sphere through the solver."""

import pytest

from fem_impact.verify import verify


def test_restitution_falls_with_speed():
    found = verify("thornton", {"cells": 3})
    values = {c.name: c for c in found.checks}
    assert abs(values["slope of ln e over ln v"].error) < 0.08
    assert abs(values["e, and with finer cells"].error) < 0.15
    assert values["energy ledger / E_0"].passed


@pytest.mark.validation
def test_a_fully_plastic_contact():
    assert verify("thornton").passed
