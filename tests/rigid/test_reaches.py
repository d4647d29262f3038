"""How far a tip goes along the barrier a little above its lowest point."""

from math import cos, radians, sin, sqrt, tan

import numpy as np
import pytest

from rigid import Faceted, Projectile, Turned

ANGLE, HEIGHT = radians(20.0), 0.5e-3


def test_a_sharp_edge_opens_by_the_slopes_of_face_and_side():
    sharp = HEIGHT / tan(ANGLE), HEIGHT * tan(ANGLE)
    assert Projectile(0.2, 0.02, "plain", 0.0, 7850.0).reaches(ANGLE, HEIGHT) == pytest.approx(sharp)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (0, 1) for z in (0, 20.0)]) / 100
    bar = Faceted(corners, np.array([[0, 2, 6, 4]]), np.array([[0, 0.2, 0.1, 0, 0.01, 1e-5 / 3, 1e-3]]))
    assert bar.reaches(ANGLE, HEIGHT) == pytest.approx(sharp)


def test_a_ball_opens_by_its_chord():
    """The meridian is a polygon: its chord is shorter by a thousandth."""
    ball = Projectile(0.2, 0.02, "B", 0.01, 7850.0)
    half = sqrt(2 * 0.01 * HEIGHT - HEIGHT**2)
    assert ball.reaches(radians(45.0), HEIGHT) == pytest.approx((half, half), rel=5e-3)


@pytest.mark.parametrize(("wall", "down"), [(1e-3, cos(ANGLE) * 1e-3), (4e-3, HEIGHT / tan(ANGLE))])
def test_a_face_ends_at_its_bore(wall, down):
    inner = 0.01 - wall
    tube = Turned([(0, 0), (0.01, 0), (0.01, 0.2)], [(0.2, 7850.0)], [(inner, 0), (inner, 0.2)])
    assert tube.reaches(ANGLE, HEIGHT) == pytest.approx((down, HEIGHT * tan(ANGLE)))


def test_a_body_that_ends_below_the_height_is_as_wide_as_it_is():
    flat = Turned([(0, 0), (0.01, 0), (0.01, 1e-4)], [(1e-4, 7850.0)])
    down, up = flat.reaches(radians(1.0), 1e-3)
    assert down == pytest.approx(0.02 * cos(radians(1.0)) - 1e-4 * sin(radians(1.0)))
    assert up == pytest.approx(1e-4 * sin(radians(1.0)))
