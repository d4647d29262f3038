"""Guided waves in the solver's slices."""

from fem_impact.verify import verify


def test_waves():
    assert verify("waves").passed


def test_waves_of_another_metal():
    assert verify("waves", {"E": "70 GPa", "nu": 0.33, "rho": 2700, "diameter": 0.05}).passed


def test_error_falls_with_the_cell_from_below():
    """Lumped masses make waves slow; the section's one outer ring keeps it from full second order."""
    errors = [[c.error for c in verify("waves", {"across": n}).checks] for n in (8, 16)]
    longitudinal = [row[-2] for row in errors]
    assert longitudinal[0] < longitudinal[1] < 0
    assert longitudinal[0] / longitudinal[1] > 2.0


def test_coarse_slices_are_refused_a_pass():
    found = verify("waves", {"aspect": 2.0})
    assert not found.passed
