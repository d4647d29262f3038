"""Restitution of a viscous Hertz' contact: limit, linear contact and order."""

from math import acos, exp, gamma, sqrt

import pytest

from fem_impact.physics.viscous import UNITS, relaxation, viscous_restitution

DEEPEST = 1.25**0.4  # of s'' = -s^1.5 with s'(0) = 1


def linear(eta):
    """Return e of a spring and a dashpot, eta = 2 zeta, that part where their force vanishes."""
    zeta = eta / 2
    return exp(-2 * zeta * acos(zeta) / sqrt(1 - zeta**2))


def test_nothing_is_lost_without_a_loss_factor():
    assert viscous_restitution(0.0) == 1.0


@pytest.mark.parametrize("eta", [1e-4, 1e-3])
def test_a_small_loss_is_the_work_along_the_elastic_path(eta):
    """1 - e is the integral of 1.5 theta sqrt(s) v ds, in and out, with v^2 = 1 - (s / deepest)^2.5."""
    beta = gamma(0.6) * gamma(1.5) / gamma(2.1)
    work = 2 * 1.5 * relaxation(eta, UNITS) * 0.4 * beta * DEEPEST**1.5
    assert 1 - viscous_restitution(eta) == pytest.approx(work, rel=2 * eta)


@pytest.mark.parametrize("eta", [0.02, 0.1, 0.3, 0.6])
def test_it_is_near_a_linear_contact_of_the_same_loss(eta):
    assert linear(eta) - 0.035 < viscous_restitution(eta) < linear(eta)


def test_more_loss_gives_back_less():
    found = [viscous_restitution(eta) for eta in (0.0, 0.01, 0.03, 0.1, 0.3, 1.0)]
    assert found == sorted(found, reverse=True)
    assert found[-1] == pytest.approx(0.275, abs=1e-3)
