"""Guided waves in the solver's slices."""

from math import pi

import pytest

from fem_impact.evidence.problems.problem import verify


def test_waves():
    assert verify("waves").passed


def test_waves_of_another_metal():
    assert verify("waves", {"E": "70 GPa", "nu": 0.33, "rho": 2700, "diameter": 0.05}).passed


@pytest.mark.parametrize("nu", [0.0, 0.49])
def test_long_waves_are_those_of_a_beam(nu):
    found = verify("waves", {"ratio": 0.01, "nu": nu})
    assert found.passed
    slowest = found.checks[1]
    assert slowest.computed == pytest.approx(pi * 0.0025, rel=5e-3)


def test_short_waves_are_shown():
    """Printed at radius / wavelength 0.5: 0.68927 and 0.54478 of c0; here 4 % and 2 % slow."""
    long, flexural = verify("waves", {"ratio": 0.5}).checks[-2:]
    assert (long.kind, flexural.kind) == ("shown", "shown")
    assert long.reference == pytest.approx(0.68927, abs=1e-5)
    assert flexural.reference == pytest.approx(0.54478, abs=1e-5)
    assert -0.05 < long.error < 0
    assert -0.03 < flexural.error < 0


def test_error_falls_with_the_cell_from_below():
    """Lumped masses make waves slow; the section's one outer ring keeps it from full second order."""
    errors = [[c.error for c in verify("waves", {"across": n}).checks] for n in (8, 16)]
    longitudinal = [row[-2] for row in errors]
    assert longitudinal[0] < longitudinal[1] < 0
    assert longitudinal[0] / longitudinal[1] > 2.0


def test_coarse_slices_are_refused_a_pass():
    found = verify("waves", {"aspect": 2.0})
    assert not found.passed
