"""The hardening law: through yield, elastic slope and the nominal ultimate stress."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from fem_impact.physics.hardening import Hardening, linear_hardening, power_hardening


def nominal_strength(law):
    """Largest load over the first section: found on the curve, not from Considere's formula."""
    found = minimize_scalar(
        lambda p: -float(law.flow_stress(p)) * np.exp(-p),
        bounds=(0, 1),
        method="bounded",
        options={"xatol": 1e-12},
    )
    return max(-found.fun, float(law.flow_stress(0.0)))


@pytest.mark.parametrize(
    ("E", "low", "high"), [(219e9, 546e6, 592e6), (206e9, 320e6, 446e6), (206e9, 320e6, 330e6)]
)
def test_through_yield_and_nominal_ultimate_stress(E, low, high):
    law = power_hardening(E, low, high)
    assert law.flow_stress(0.0) == low
    assert nominal_strength(law) == pytest.approx(high, rel=1e-6)
    # leaves the elastic line with the elastic slope times n
    assert (law.flow_stress(1e-9) - low) / 1e-9 == pytest.approx(E * law.exponent, rel=1e-3)


@given(st.floats(100e6, 800e6), st.floats(1.0, 2.5))
def test_any_steel(low, ratio):
    law = power_hardening(210e9, low, ratio * low)
    assert nominal_strength(law) == pytest.approx(ratio * low, rel=1e-5)
    assert (np.diff(law.flow_stress(np.linspace(0, 1, 50))) >= 0).all()


def test_perfect_and_linear():
    assert power_hardening(200e9, 300e6, 300e6).flow_stress([0.0, 0.5]) == pytest.approx([300e6, 300e6])
    assert linear_hardening(300e6, 2e9).flow_stress(0.1) == pytest.approx(500e6)


@pytest.mark.parametrize("ultimate", [290e6, 30e9])
def test_impossible_ultimate_stress(ultimate):
    with pytest.raises(ValueError, match="must lie between the yield stress"):
        power_hardening(200e9, 300e6, ultimate)


@pytest.mark.parametrize("numbers", [(0.0, 1.0, 1.0), (-1.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, -0.1)])
def test_impossible_laws(numbers):
    with pytest.raises(ValueError, match=r"positive|softening"):
        Hardening(*numbers)
