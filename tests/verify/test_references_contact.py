"""References of the contact problems against printed numbers and limits."""

from math import pi, sqrt

import numpy as np
import pytest

from fem_impact.verify.reference.finite_sphere import ball_excess, ball_impact, bounce, local_law
from fem_impact.verify.reference.hertz import contact_modulus, hertz, radiated_share
from fem_impact.verify.reference.radiation import radiated_energy

R, RHO, E = 9.5e-3, 7850.0, 210e9
MASS = 4 / 3 * pi * R**3 * RHO


def test_radiation_is_the_printed_one():
    """1.127 (v / c0)^0.6 at nu = 0.29, by Lamb's integral."""
    impact = hertz(contact_modulus(E, 0.29, E, 0.29), R, MASS, 1.0)
    share = radiated_energy(impact, E, 0.29, RHO) / (0.5 * MASS)
    assert share == pytest.approx(radiated_share(1.0, sqrt(E / RHO)), rel=5e-4)


def test_a_law_without_excess_is_hertz():
    plain = hertz(2e11, R, MASS, 1.0)
    a = plain.radius * np.linspace(0.0, 1.3, 4001)[1:]
    found = bounce(*local_law(2e11, R, a, 0 * a), a, MASS, 1.0)
    assert found.force == pytest.approx(plain.force, rel=1e-5)
    assert found.duration == pytest.approx(plain.duration, rel=1e-5)


def test_the_excess_has_a_logarithm_that_vanishes_without_compressibility():
    """Equal steps for equal ratios of a; the stress singularity of a ball goes with 1 - 2 nu."""
    for nu in (0.0, 0.29):
        first, second, third = (ball_excess(a, nu) for a in (0.01, 0.02, 0.04))
        assert third - second == pytest.approx(second - first, rel=0.1)
    assert abs(ball_excess(0.02, 0.4999) - ball_excess(0.01, 0.4999)) < 1e-2


def test_a_small_contact_is_hertz():
    E_star = contact_modulus(E, 0.29)
    plain = hertz(E_star, R, MASS, 1e-3)
    found = ball_impact(E_star, E_star, 0.29, R, MASS, 1e-3)
    assert found.force == pytest.approx(plain.force, rel=2e-3)
    assert found.duration == pytest.approx(plain.duration, rel=2e-3)
