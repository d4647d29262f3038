"""The axisymmetric cone against the elastic cone in closed form, and what does not depend on its size."""

from math import pi, radians, tan

import pytest

from fem_impact.evidence.references import axisymmetric as cone
from fem_impact.evidence.references.axisymmetric import Metal

STEEL = Metal(206e9, 0.29, 7850.0, 320e6, 643.75, 0.1033)
ANGLE = radians(70.3)


@pytest.mark.long
def test_a_cone_that_does_not_yield_is_sneddons(monkeypatch):
    """p = E* cot / 2 and a / d = 2 tan / pi (Sneddon 1965, doi:10.1016/0020-7225(65)90019-4), a flat cone."""
    monkeypatch.setattr(cone, "SLOW", 3e-5)
    flat = radians(85.0)
    elastic = Metal(206e9, 0.29, 7850.0, 40e9)
    fine, coarse = (cone.indent(elastic, flat, cells=n).coefficients() for n in (12, 6))
    pressure, radius = 2 * fine - coarse
    assert pressure == pytest.approx(206e9 / (1 - 0.29**2) / tan(flat) / 2, rel=0.03)
    assert radius == pytest.approx(2 * tan(flat) / pi, rel=0.03)


@pytest.mark.slow
def test_pressure_and_radius_change_with_the_cells_by_their_first_order_error_alone():
    found = {n: cone.indent(STEEL, ANGLE, 0.2, n).coefficients() for n in (4, 6, 8)}
    limits = 2 * found[8] - found[4], found[8] + 3 * (found[8] - found[6])
    assert limits[0] == pytest.approx(limits[1], rel=0.02)


@pytest.mark.long
def test_friction_raises_the_pressure_and_holds_the_bulge_back():
    plain, rough = (cone.indent(STEEL, ANGLE, f, 5).coefficients() for f in (0.0, 0.2))
    assert 1.05 * plain[0] < rough[0] < 1.2 * plain[0]
    assert rough[1] < plain[1]


@pytest.mark.long
def test_flow_stress_shifts_the_pressure_in_proportion_where_everything_flows():
    double = Metal(2 * STEEL.E, STEEL.nu, STEEL.rho, 2 * STEEL.yield_stress, STEEL.slope, STEEL.exponent)
    assert cone.indent(double, ANGLE, 0.2, 5).coefficients() == pytest.approx(
        cone.indent(STEEL, ANGLE, 0.2, 5).coefficients() * [2, 1], rel=1e-6
    )
