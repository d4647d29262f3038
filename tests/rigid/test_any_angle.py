"""Bodies on either side of their axis and on their side: mirror images, and the middle of what lies flat."""

from math import cos, pi, radians, sin

import numpy as np
import pytest

from rigid import Faceted, Projectile, Turned, corner_arms, critical_ratio
from rigid.turned import CORNER

L, R, RHO = 0.08, 0.0095, 7850.0
ARC = np.linspace(0.0, pi / 2, 13)
BODIES = {
    "A": Projectile(L, 2 * R, "A", 0.007, RHO),
    "B": Projectile(L, 2 * R, "B", 0.003, RHO),
    "plain": Projectile(L, 2 * R, "plain", 0.0, RHO),
    "tube": Turned([(0, 0), (R, 0), (R, L)], [(L, RHO)], [(0.006, 0), (0.006, L)]),
    "round": Turned(
        [*zip(R * np.sin(ARC), R * (1 - np.cos(ARC)), strict=True), (R, L)],
        [(L, RHO)],
    ),
}


def wedge(side):
    """A bar that leans to the side: a shape without a plane of symmetry across x."""
    x = np.array([-0.006, 0.004, 0.009, -0.001])
    z = np.array([0.0, 0.0, 0.04, 0.04])
    points = np.array([[side * a, y, b] for y in (0.0, 0.005) for a, b in zip(x, z, strict=True)])
    quads = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]]
    return Faceted(points, np.array(quads), np.array([[0.0, 0.04, 0.02, side * 3e-5, 4e-4, 1e-6, 1e-5]]))


PAIRS = {name: (body, body) for name, body in BODIES.items()} | {"mesh": (wedge(1.0), wedge(-1.0))}


@pytest.mark.parametrize("degrees", [0.5, 20.0, 45.0, 60.0, 77.0, 89.9, 90.0])
@pytest.mark.parametrize("name", PAIRS)
def test_at_the_opposite_angle_a_body_touches_as_its_mirror_image(name, degrees):
    (body, mirror), alpha = PAIRS[name], radians(degrees)
    (x, z), (u, w) = body.contact_point(alpha), mirror.contact_point(-alpha)
    assert (u, w) == pytest.approx((-x, z), abs=1e-15)
    assert mirror.arms(-alpha) == pytest.approx((-body.arms(alpha)[0], body.arms(alpha)[1]), abs=1e-15)
    there, here = mirror.touch(-alpha), body.touch(alpha)
    assert there == pytest.approx((-here.x, here.z, here.length), abs=1e-15)
    assert mirror.tip_curvature(-alpha) == pytest.approx(body.tip_curvature(alpha), rel=1e-12)
    down, up = body.reaches(alpha, 1e-4)
    assert mirror.reaches(-alpha, 1e-4) == pytest.approx((up, down), abs=1e-15)


def test_the_lowest_point_of_a_negative_angle_is_the_lowest_of_the_outline():
    line = BODIES["B"].meridian(4001)
    both = np.vstack([line * [-1, 1], line])
    for alpha in np.radians([-80.0, -45.0, -10.0]):
        x, z = BODIES["B"].contact_point(alpha)
        heights = both @ (-sin(alpha), cos(alpha))
        assert z * cos(alpha) - x * sin(alpha) == pytest.approx(heights.min(), abs=1e-9)
        assert x < 0


def test_a_side_that_lands_touches_in_its_middle():
    for side in (1, -1):
        assert BODIES["plain"].touch(side * pi / 2) == pytest.approx((side * R, L / 2, L))
        assert BODIES["tube"].touch(side * pi / 2) == pytest.approx((side * R, L / 2, L))
        assert BODIES["B"].touch(side * pi / 2) == pytest.approx((side * R, (0.003 + L) / 2, L - 0.003))
        assert BODIES["round"].touch(side * pi / 2) == pytest.approx((side * R, (R + L) / 2, L - R))


def test_a_face_a_cone_and_a_side_of_a_mesh_touch_in_their_middle():
    assert BODIES["B"].touch(0.0) == pytest.approx((0.0, 0.0, 2 * (R - 0.003)))
    nose = BODIES["A"].nose
    (rho, z), end = nose.arc_end, BODIES["A"].z_side
    cone = BODIES["A"].touch(radians(60.0))
    assert cone == pytest.approx(((rho + R) / 2, (z + end) / 2, np.hypot(R - rho, end - z)))
    leaning = pi / 2 - np.arctan(0.005 / 0.04)  # its side x > 0 lies flat there
    assert wedge(1.0).touch(leaning) == pytest.approx((0.0065, 0.02, np.hypot(0.005, 0.04)))


def test_a_step_of_a_smooth_curve_is_a_point():
    steps = np.diff(BODIES["round"].outline, axis=0)
    flat = float(np.arctan2(steps[5, 1], steps[5, 0]))
    assert BODIES["round"].touch(flat).length == 0
    assert BODIES["round"].touch(0.0) == (0.0, 0.0, 0.0)


def test_a_shoulder_between_straight_sides_is_an_edge_however_little_it_turns():
    """Taken as a curve it touched beside the body, where the arm d_c was half as long."""
    body = Turned(np.array([[0.0, 0.0], [0.8 * R, 0.0], [R, L / 3], [R, L]]), [(L, RHO)])
    turn = np.arctan2(0.2 * R, L / 3)
    alpha = pi / 2 - 0.5 * turn
    assert 0.0 < turn < CORNER
    assert body.contact_point(alpha) == pytest.approx((R, L / 3), rel=1e-12)
    assert body.tip_curvature(alpha) == 0.0


def test_arms_of_a_corner_and_the_critical_ratio_change_their_signs():
    d_c, d_d = corner_arms(L, 2 * R, [0.3, -0.3])
    assert (d_c[1], d_d[1]) == (-d_c[0], d_d[0])
    assert d_c[0] == pytest.approx(float(BODIES["plain"].arms(0.3).d_c))
    ratio = [critical_ratio(-1.5, -s, e=0.3, d_c=s * 0.02, d_d=0.03, k2=5e-4, omega=s * 7.0) for s in (1, -1)]
    assert ratio[1] == -ratio[0]
