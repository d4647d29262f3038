"""A sphere that strikes obliquely and slides, through the solver."""

import pytest

from fem_impact.errors import SceneError
from fem_impact.verify import verify


def test_a_sphere_that_slides_throughout_has_the_ratio_of_its_friction():
    found = verify("oblique-sphere", {"angle": "50 deg", "cells": 3})
    values = {c.name: c for c in found.checks}
    assert values["impulse ratio mu"].computed == pytest.approx(0.092, rel=0.01)
    assert abs(values["tangential restitution"].error) < 0.02


def test_a_sphere_that_sticks_is_refused():
    with pytest.raises(SceneError, match="sticks"):
        verify("oblique-sphere", {"angle": "5 deg"})


@pytest.mark.validation
@pytest.mark.parametrize(("degrees", "e"), [(20, 0.594), (40, 0.781)])
def test_alumina(degrees, e):
    found = verify("oblique-sphere", {"angle": f"{degrees} deg"})
    assert found.passed
    assert found.checks[0].computed == pytest.approx(e, abs=0.02)
