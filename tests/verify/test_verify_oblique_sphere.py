"""A sphere that strikes obliquely, sticking and sliding, through the solver."""

import pytest

from fem_impact.verify import verify

COARSE = {"cells": 3, "across": 8}


def test_a_sphere_that_slides_throughout_has_the_ratio_of_its_friction():
    found = verify("oblique-sphere", {**COARSE, "angle": "50 deg"})
    values = {c.name: c for c in found.checks}
    assert values["impulse ratio mu / f"].computed == pytest.approx(1.0, rel=0.01)
    assert abs(values["tangential restitution"].error) < 0.02


def test_a_sphere_that_sticks_gives_its_tangential_energy_back():
    """On the rigid plane, where the two compliances are coupled, the error is 0.19."""
    found = verify("oblique-sphere", {**COARSE, "angle": "5 deg"})
    assert found.checks[0].computed == pytest.approx(found.checks[0].reference, abs=0.06)


@pytest.mark.validation
@pytest.mark.parametrize(("degrees", "e"), [(20, 0.594), (40, 0.781)])
def test_alumina(degrees, e):
    found = verify("oblique-sphere", {"angle": f"{degrees} deg"})
    assert found.passed
    assert found.checks[0].computed == pytest.approx(e, abs=0.02)
