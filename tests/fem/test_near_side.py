"""A body that comes down nearly on its side is meshed so that its lowest place touches first."""

import numpy as np
import pytest

import meshes
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.fem.body import MeshedBodies
from fem_impact.scene.shipped import load, replace_all

SIDE = np.array([[0, 0], [9.5, 0], [9.5, 80]]) * 1e-3


@pytest.mark.parametrize(("body", "angle"), [("t5b", 89.5), ("t5b", -89.9), ("tube", 89.8), ("ogive", 89.8)])
def test_a_landing_nearly_on_the_side_is_meshed(body, angle):
    """It was refused: "the meshed rod's side, a polygon, strikes 61 um before its tip"."""
    landing = {"impact.angle": f"{angle} deg", "impact.v_n": "-1.5 m/s", "impact.v_t": "-0.2 m/s"}
    bodies = MeshedBodies(Case(replace_all(load(body), landing | {"accuracy.tip_size": "1 mm"})))
    points = bodies.geometry.rod_points
    lowest = points[points[:, 2].argmin()]
    assert np.linalg.norm(lowest) < 1e-3, "within a cell of the place that touches first"
    rod, body = bodies.true_rod, bodies.case.bodies.body
    centre = (rod.mass * rod.mesh.points[rod.mesh.cells, 2]).sum() / rod.mass.sum()
    assert centre == pytest.approx(body.z_c, abs=1e-3 * body.length), "mass lies where it is"


def test_both_lines_of_a_flush_body_lie_on_its_surface_and_its_centre_on_the_axis():
    """With one of them the centre lay 85 um beside the axis, and energy balanced to 1.3e-4 alone."""
    plain, flush = (meshes.turned(SIDE, 6, flush=asked).mesh for asked in (False, True))
    assert np.abs(plain.points[:, 0]).max() > 1.01 * 9.5e-3
    assert np.abs(flush.points[:, 0]).max() == pytest.approx(9.5e-3, rel=1e-12)
    of, whole = meshes.cell_moments(flush), meshes.cell_moments(plain)
    assert of.x.sum() / of.volume.sum() == pytest.approx(0.0, abs=1e-12)
    assert of.volume.sum() == pytest.approx(whole.volume.sum(), rel=1e-3), "the section keeps its area"


@pytest.mark.parametrize("angle", [85.0, -89.5])
def test_a_nose_that_ends_before_the_contact_is_refused(angle):
    """It ended in a fault of numpy."""
    rigid = {"effects": ["friction", "barrier-rigid"], "accuracy.tip_size": "2 mm"}
    bodies = MeshedBodies(Case(replace_all(load("ogive"), rigid | {"impact.angle": f"{angle} deg"})))
    with pytest.raises(SceneError, match="deforms as a whole"):
        assert bodies.geometry
