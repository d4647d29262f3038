from itertools import pairwise

import numpy as np
import pytest
from mesh_shapes import RADIUS, edge_radius, plain, sphere_and_cone

from meshes.meridian import Meridian
from meshes.surface import TurnedSurface, closest_on


def test_shoulder_is_the_middle_of_the_arc_and_looks_inwards_at_half_angle():
    meridian = Meridian(edge_radius(rounding=3e-3)).extended(0.02)
    at = meridian.shoulder()
    assert at == pytest.approx(RADIUS - 3e-3 + 3e-3 * np.pi / 4.0, rel=1e-4)
    assert meridian.inward(at, 1e-8) == pytest.approx(np.array([-1.0, 1.0]) / np.sqrt(2.0), abs=2e-3)


def test_shoulder_of_a_sharp_edge_is_the_edge():
    meridian = Meridian(plain()).extended(0.02)
    assert meridian.shoulder() == RADIUS
    assert meridian.inward(RADIUS, 1e-3) == pytest.approx(np.array([-1.0, 1.0]) / np.sqrt(2.0))


def test_shoulder_of_a_pointed_tip_keeps_off_the_axis():
    meridian = Meridian(sphere_and_cone(ball=1e-3)).extended(0.03)
    assert meridian.at(np.array(meridian.shoulder()))[0] == pytest.approx(0.6 * RADIUS)


def test_an_edge_that_touches_keeps_its_row_of_nodes():
    """Near a smooth place the grid moves by half a cell; on the edge of cone and side it does not."""
    cone = Meridian(sphere_and_cone())
    edge = cone.at(cone.arc[-1])
    assert cone.shoulder(edge, 0.5e-3) == cone.shoulder()
    smooth = Meridian(edge_radius(rounding=3e-3))
    assert smooth.shoulder(smooth.at(0.8 * smooth.arc[-1]), 0.5e-3) != smooth.shoulder()


def test_corners_are_the_sharp_edges_only():
    cone = Meridian(sphere_and_cone()).extended(0.03)
    assert cone.at(cone.corners())[0] == pytest.approx(sphere_and_cone()[-1])
    assert len(cone.corners()) == 1
    assert len(Meridian(edge_radius()).extended(0.03).corners()) == 0


def test_closest_points_agree_with_a_dense_sampling():
    line = np.concatenate([edge_radius(count=60), [[RADIUS, 0.03]]])
    points = np.random.default_rng(3).uniform([0.0, -2e-3], [1.1 * RADIUS, 0.02], (60, 2))
    share = np.linspace(0.0, 1.0, 1001)[:, None]
    dense = np.concatenate([a + share * (b - a) for a, b in pairwise(line)])
    best = np.linalg.norm(points[:, None] - dense[None], axis=2).min(axis=1)
    found = np.linalg.norm(closest_on(line, points) - points, axis=1)
    assert (found <= best + 1e-15).all()
    assert found == pytest.approx(best, abs=2e-5)


def test_snap_keeps_the_azimuth_and_the_symmetry_plane():
    meridian = Meridian(edge_radius()).extended(0.03)
    points = np.array([[9.3e-3, 0.0, 0.8e-3], [6.0e-3, 6.6e-3, 1e-3], [0.0, 0.0, 1e-4]])
    moved = TurnedSurface((meridian.line,)).snap(points, np.stack([points - 1e-5, points + 1e-5], axis=1))
    assert moved[0, 1] == 0.0
    assert np.arctan2(moved[1, 1], moved[1, 0]) == pytest.approx(np.arctan2(6.6, 6.0), rel=1e-14)
    assert moved[2] == pytest.approx(np.zeros(3), abs=1e-18)
    assert np.hypot(np.hypot(*moved[0, :2]) - 6.5e-3, moved[0, 2] - 3e-3) == pytest.approx(3e-3, abs=1e-8)
