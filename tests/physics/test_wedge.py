"""A wedge under a load on its edge: what its stress balances, and the energy that it holds."""

import numpy as np
import pytest

from fem_impact.physics.wedge import wedge_compliance


@pytest.mark.parametrize("half", [0.3, np.pi / 4, 1.2])
def test_the_stresses_balance_the_load_and_their_energies_are_the_compliances(half):
    theta = np.linspace(-half, half, 20001)
    for part, sign, of in zip(wedge_compliance(half), (1, -1), (np.cos, np.sin), strict=True):
        stress = 2.0 * of(theta) / (2.0 * half + sign * np.sin(2.0 * half))  # times r, of a load of 1
        assert np.trapezoid(stress * of(theta), theta) == pytest.approx(1.0, rel=1e-6)
        assert part == pytest.approx(np.trapezoid(stress**2, theta) * np.pi / 2, rel=1e-6)
