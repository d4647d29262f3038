"""A rigid cone pressed into a yielding block through the solver."""

import pytest

from fem_impact.errors import SceneError
from fem_impact.evidence.problems import hardness_cone
from fem_impact.evidence.problems.problem import defaults, verify
from fem_impact.evidence.references.axisymmetric import indent

VALUES = defaults("hardness")


@pytest.mark.long
@pytest.mark.parametrize("f", [0.0, pytest.param(0.1, marks=pytest.mark.slow)])
def test_both_codes_agree_on_cells_of_one_size(f):
    """Their errors by the cells are then alike: what is left is the hexahedra and their contact."""
    law = hardness_cone.flow_curve(VALUES)
    pressure, radius = hardness_cone.press(VALUES, law, f, 5)[0].coefficients()
    exact = indent(hardness_cone.metal_of(VALUES, law), VALUES["angle"], f, 5).coefficients()
    assert [pressure, radius] == pytest.approx(exact, rel=0.02)


@pytest.mark.slow
def test_a_cone_without_friction_meets_the_axisymmetric_reference():
    found = verify("hardness", {"f": 0.0})
    assert [c.name for c in found.checks if c.judged] == [
        "mean pressure, f = 0",
        "contact radius / depth, f = 0",
    ]
    assert found.passed, [(c.name, c.error) for c in found.checks]
    shown = {c.name: c for c in found.checks if not c.judged}
    assert [shown[f"HV of {steel}-steel, f = 0"].reference for steel in ("plate", "rod")] == [163, 235]


@pytest.mark.validation
def test_the_cone_with_friction_and_on_a_harder_steel():
    assert verify("hardness").passed
    harder = {"E": "219 GPa", "yield_stress": "546 MPa", "ultimate_stress": "592 MPa"}
    assert verify("hardness", harder).passed


def test_an_ultimate_stress_that_no_power_law_reaches_is_refused():
    with pytest.raises(SceneError, match="must lie between the yield stress"):
        verify("hardness", {"ultimate_stress": "300 MPa"})
