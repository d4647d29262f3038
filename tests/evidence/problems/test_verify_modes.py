"""Natural frequencies through the solver."""

import pytest

from fem_impact.errors import SceneError
from fem_impact.evidence.problems.problem import verify


def test_modes_of_a_short_bar():
    """Its tolerances notice a shear modulus 0.4 % off, and a tenth of the masses' moment."""
    found = verify("modes", {"length": 0.12})
    assert found.passed
    allowed = {c.name: c.tolerance for c in found.checks}
    assert len(allowed) == 8
    assert allowed["longitudinal 1"] < 2e-4
    assert allowed["bending 1"] < 2e-3
    assert allowed["torsion 1"] < 7e-4


@pytest.mark.long
def test_modes_of_the_short_rod():
    """Row sums at the nodes leave the second bending mode 0.6 % and torsion 2.4 % low."""
    found = verify("modes", {"length": 0.08})
    assert found.passed
    values = {c.name: c.computed for c in found.checks}
    printed = {"bending 1": 12340, "bending 2": 28916, "longitudinal 1": 32913, "torsion 1": 20552}
    for name, frequency in printed.items():
        assert values[name] == pytest.approx(frequency, rel=0.003)


@pytest.mark.slow
def test_cells_of_the_shortest_bar_are_as_small_as_its_waves_need():
    """With 8 cells across, slices as high as they are wide leave the third bending mode 0.9 % low."""
    assert verify("modes", {"length": "47.5 mm"}).passed


@pytest.mark.parametrize("length", ["47 mm", "0.6 m"])
def test_a_bar_too_stubby_or_too_slender_is_refused(length):
    with pytest.raises(SceneError, match=r"2.5 to 30 times the diameter"):
        verify("modes", {"length": length})


@pytest.mark.long
def test_modes_of_another_metal_and_size():
    found = verify(
        "modes", {"length": 0.3, "diameter": 0.04, "E": "70 GPa", "nu": 0.33, "rho": 2700, "across": 8}
    )
    assert found.passed


@pytest.mark.validation
@pytest.mark.parametrize("nu", [0.0, 0.49])
@pytest.mark.parametrize("length", ["47.5 mm", "0.12 m"])
def test_modes_at_the_ends_of_the_range(length, nu):
    assert verify("modes", {"length": length, "nu": nu}).passed


@pytest.mark.validation
def test_modes_of_the_long_rod():
    found = verify("modes")
    assert found.passed
    assert abs(found.checks[0].error) < 1e-3
