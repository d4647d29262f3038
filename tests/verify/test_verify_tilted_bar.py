"""The square bar on a tilted plate."""

import pytest

from fem_impact.verify import verify


def rebound(**changes):
    found = verify("tilted-bar", changes)
    assert all(c.passed for c in found.checks if c.name != "normal rebound")
    return next((c for c in found.checks if c.name == "normal rebound"), None)


def test_the_rebound_comes_nearer_with_smaller_cells_and_grows_with_the_speed():
    coarse, fine, slow = rebound(cells=4), rebound(cells=6), rebound(cells=4, speed=1.5)
    assert -0.06 < coarse.error < fine.error - 0.005 < 0
    assert slow.error == pytest.approx(coarse.error, abs=5e-3)


def test_friction_and_other_angles_balance():
    assert 0.03 < rebound(cells=4, f=0.2).error < 0.08
    assert rebound(cells=4, f=0.35, angle="35 deg") is None


@pytest.mark.validation
@pytest.mark.parametrize("f", [0.0, 0.2])
def test_the_rebound_of_public_codes(f):
    assert verify("tilted-bar", {"f": f}).passed
