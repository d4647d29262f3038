"""The copper bar of Taylor's test."""

import pytest

from fem_impact.verify import verify


def test_a_coarse_bar_is_near():
    found = verify("taylor", {"slices": 20, "across": 6})
    length, foot, ledger = found.checks
    assert abs(length.error) < 0.35e-3
    assert abs(foot.error) < 0.25e-3
    assert ledger.passed


@pytest.mark.validation
def test_the_bar_reaches_the_printed_shape():
    assert verify("taylor").passed
