"""The two examples of README's "Make it yours": a hemispherical tip and an aluminium rod."""

import math

import pytest

from fem_impact.estimates import projectile
from fem_impact.scene import load, replace_all
from fem_impact.solid.geometry import build_geometry
from rigid import SHAPES, Nose


@pytest.fixture
def ball(monkeypatch):
    monkeypatch.setitem(SHAPES, "ball", lambda radius, r: Nose(radius, 0.0, r, math.pi / 2))


def test_an_added_tip_is_turned_meshed_and_touches_where_it_should(ball):
    scene = replace_all(
        load("t5b"),
        {"projectile.tip": "ball", "projectile.tip_radius": "9.5 mm", "accuracy.tip_size": "1.2 mm"},
    )
    rod = projectile(scene)
    cylinder, half_ball = math.pi * 0.0095**2 * (0.08 - 0.0095), 2 / 3 * math.pi * 0.0095**3
    assert rod.mass == pytest.approx(7850 * (cylinder + half_ball), rel=1e-12)
    rho, z = rod.contact_point(math.pi / 4)
    assert (rho, 0.0095 - z) == pytest.approx((0.0095 * math.sqrt(0.5),) * 2)
    built = build_geometry(scene, 1e-5, meshed_barrier=False)
    assert built.rod_points[:, 2].min() == pytest.approx(1e-5)


def test_a_tip_nobody_added_is_refused():
    with pytest.raises(ValueError, match='"A", "B" or "plain"'):
        load("t5b").replace("projectile.tip", "ball")


def test_an_own_material_is_a_table_of_the_scene():
    aluminium = {
        "name": "Al 6082-T6",
        "E": "70 GPa",
        "nu": 0.33,
        "rho": "2700 kg/m3",
        "yield_stress": "260 MPa",
        "ultimate_stress": "310 MPa",
    }
    scene = load("t5b").replace("projectile.material", aluminium)
    assert projectile(scene).mass == pytest.approx(2700 / 7850 * projectile(load("t5b")).mass)
    assert scene.measured == "t5b"
