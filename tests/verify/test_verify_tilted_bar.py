"""The square bar on a tilted plate."""

import pytest

from fem_impact.verify import verify

HARD, SPRINGS = "normal rebound, hard contact", "normal rebound, springs of public codes"


def rebound(name=HARD, **changes):
    found = verify("tilted-bar", changes)
    assert all(c.passed for c in found.checks if c.name not in (HARD, SPRINGS))
    return next((c for c in found.checks if c.name == name), None)


def test_the_rebound_comes_nearer_with_smaller_cells_and_grows_with_the_speed():
    coarse, fine, slow = rebound(cells=4), rebound(cells=6), rebound(cells=4, speed=1.5)
    assert -0.06 < coarse.error < fine.error - 0.005 < 0
    assert slow.error == pytest.approx(coarse.error, abs=5e-3)


def test_friction_and_other_angles_balance():
    assert 0.04 < rebound(cells=4, f=0.2).error < 0.08
    assert rebound(cells=4, f=0.35, angle="35 deg") is None


@pytest.mark.parametrize("f", [0.0, 0.2])
def test_the_contact_springs_of_public_codes_give_their_rebound(f):
    assert abs(rebound(SPRINGS, cells=4, f=f).error) < 0.015


@pytest.mark.parametrize("f", [0.0, 0.2])
def test_stiff_springs_are_the_hard_contact(f):
    """On the same mesh; those of public codes are 6 % off, one up and one down."""
    same = {"cells": 4, "element": 0, "f": f}
    stiff, hard = rebound(SPRINGS, stiffness=2.6e14, stick=1.0, **same), rebound(**same)
    assert stiff.computed == pytest.approx(hard.computed, rel=0.025)
    assert rebound(SPRINGS, **same).computed != pytest.approx(hard.computed, rel=0.05)


@pytest.mark.validation
@pytest.mark.parametrize("f", [0.0, 0.2])
def test_the_rebound_of_public_codes(f):
    assert verify("tilted-bar", {"f": f}).passed
