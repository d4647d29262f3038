"""Oblique drops of an elastic rod beside modes, Hertz and friction."""

import pytest

from fem_impact.verify import verify


def test_a_coarse_tip_on_a_rigid_plane():
    found = verify("oblique-rod", {"elastic_barrier": 0, "tip_size": "0.8 mm", "across": 6})
    assert found.passed
    values = {c.name: c.computed for c in found.checks}
    assert 0.10 < values["bending energy / E_0"] < 0.13
    assert values["impulse ratio mu"] == pytest.approx(0.34, abs=1e-3)


@pytest.mark.validation
@pytest.mark.parametrize(
    ("f", "e", "bending"), [(0.0, 0.853, 0.058), (0.34, 0.396, 0.114), (0.55, 0.733, 0.036)]
)
def test_the_long_rod_on_an_elastic_block(f, e, bending):
    found = verify("oblique-rod", {"f": f})
    assert found.passed
    values = {c.name: c.computed for c in found.checks}
    assert values["restitution e"] == pytest.approx(e, abs=0.06)
    assert values["bending energy / E_0"] == pytest.approx(bending, rel=0.25)


@pytest.mark.validation
def test_the_short_rod_on_an_elastic_block():
    found = verify("oblique-rod", {"f": 0.0, "length": "80 mm", "v_n": 2.97, "v_t": 2.97})
    assert found.passed
    assert found.checks[2].computed == pytest.approx(0.014, abs=0.003)
