"""A yielding sphere through the solver."""

import pytest

from fem_impact.evidence.problems.problem import problem, verify
from fem_impact.evidence.problems.thornton_tip import judged_slope


@pytest.mark.long
def test_restitution_falls_with_speed():
    found = verify("thornton", {"cells": 3})
    values = {c.name: c for c in found.checks}
    assert abs(values["slope of ln e over ln v"].error) < 0.08
    assert abs(values["e, and with finer cells"].error) < 0.15
    assert values["energy ledger / E_0"].passed


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"slowest": 0.25, "fastest": 2.0}, "only from 2.25 to 10.8 m/s"),
        ({"fastest": 20.0}, "only from 2.25 to 10.8 m/s"),
        ({"E": 5e9}, "never fully plastic"),
        ({"hardening": 2e10}, "does not harden"),
    ],
)
def test_a_slope_outside_the_plastic_range_is_not_judged(changes, words):
    found = judged_slope(problem("thornton").values(changes), -0.19)
    assert found.kind == "shown"
    assert words in found.note


def test_a_wrong_slope_within_the_plastic_range_fails():
    values = problem("thornton").values({})
    assert not judged_slope(values, -0.19).passed
    assert judged_slope(values, -0.22).passed
