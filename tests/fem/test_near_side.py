"""A body that comes down nearly on its side is meshed so that its lowest place touches first."""

import numpy as np
import pytest

import meshes
from fem_impact.case.case import Case
from fem_impact.fem.body import MeshedBodies
from fem_impact.scene.shipped import load, replace_all

SIDE = np.array([[0, 0], [9.5, 0], [9.5, 80]]) * 1e-3


@pytest.mark.parametrize("body", ["t5b", "tube", "ogive"])
@pytest.mark.parametrize("angle", [89.5, 89.8, -89.9])
def test_a_landing_nearly_on_the_side_is_meshed(body, angle):
    """It was refused: "the meshed rod's side, a polygon, strikes 61 um before its tip"."""
    landing = {"impact.angle": f"{angle} deg", "impact.v_n": "-1.5 m/s", "impact.v_t": "-0.2 m/s"}
    bodies = MeshedBodies(Case(replace_all(load(body), landing | {"accuracy.tip_size": "1 mm"})))
    points = bodies.geometry.rod_points
    lowest = points[points[:, 2].argmin()]
    assert np.linalg.norm(lowest) < 1e-3, "within a cell of the place that touches first"
    body = bodies.case.bodies.body
    assert 2 * bodies.true_rod.mass.sum() == pytest.approx(body.mass, rel=1e-9)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_line_of_a_flush_side_lies_on_the_surface_along_all_of_the_body(side):
    contact = np.array([side * 9.5e-3, 0.0, 0.0])
    plain, flush = (
        meshes.turned(SIDE, 8, contact=contact, flush=asked).mesh.points for asked in (False, True)
    )
    assert (side * plain[:, 0]).max() > 1.01 * 9.5e-3
    assert (side * flush[:, 0]).max() == pytest.approx(9.5e-3, rel=1e-12)
    assert (-side * flush[:, 0]).max() == pytest.approx((-side * plain[:, 0]).max(), rel=1e-12)
