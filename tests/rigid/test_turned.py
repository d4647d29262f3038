"""Bodies of any profile against closed forms: mass, centre, inertia, and the point that touches first."""

from __future__ import annotations

import numpy as np
import pytest

import rigid
from rigid import shapes

RHO, R, L = 7850.0, 0.01, 0.1


def solid(outline):
    return rigid.Turned(outline, [(outline[-1, 1], RHO)])


def test_a_ball_weighs_and_turns_as_a_ball():
    ball = solid(shapes.ball(2 * R))
    assert ball.mass == pytest.approx(RHO * 4 / 3 * np.pi * R**3, rel=1e-4)
    assert ball.k2 == pytest.approx(0.4 * R**2, rel=1e-4)
    assert ball.z_c == pytest.approx(R, rel=1e-9)
    # whatever the inclination, it touches below its centre
    assert np.abs(ball.arms(np.linspace(0, 1.5, 9)).d_c).max() < 1e-4 * R


def test_a_cone_weighs_and_turns_as_a_cone():
    cone = solid(np.array([[0.0, 0.0], [R, L]]))
    assert cone.mass == pytest.approx(RHO * np.pi * R**2 * L / 3, rel=1e-12)
    assert cone.z_c == pytest.approx(0.75 * L, rel=1e-12)
    # about the centre across the axis: 3/20 r^2 + 3/80 h^2
    assert cone.k2 == pytest.approx(0.15 * R**2 + 3 / 80 * L**2, rel=1e-12)


def test_a_tube_of_two_metals_is_the_sum_of_its_parts():
    bore = np.array([[0.6 * R, 0.0], [0.6 * R, L]])
    tube = rigid.Turned([(0, 0), (R, 0), (R, L)], [(0.3 * L, RHO), (L, 2700.0)], bore)
    area, ring = np.pi * R**2 * (1 - 0.36), R**2 * (1 + 0.36) / 4
    parts = [(RHO * area * 0.3 * L, 0.15 * L, 0.3 * L), (2700 * area * 0.7 * L, 0.65 * L, 0.7 * L)]
    mass = sum(m for m, _, _ in parts)
    centre = sum(m * z for m, z, _ in parts) / mass
    inertia = sum(m * (ring + l**2 / 12 + (z - centre) ** 2) for m, z, l in parts)
    assert tube.mass == pytest.approx(mass, rel=1e-12)
    assert tube.z_c == pytest.approx(centre, rel=1e-12)
    assert tube.k2 == pytest.approx(inertia / mass, rel=1e-12)


@pytest.mark.parametrize(("tip", "radius"), [("A", 0.007), ("B", 0.003), ("B", 0.0095), ("plain", 0.0)])
def test_a_rod_as_a_profile_is_the_rod(tip, radius):
    rod = rigid.Projectile(0.08, 0.019, tip, radius, RHO)
    same = solid(shapes.of_nose(rod.nose, rod.length))
    for name in ("mass", "z_c", "k2", "gamma", "diameter", "length", "face"):
        assert getattr(same, name) == pytest.approx(getattr(rod, name), rel=1e-4)
    alpha = np.radians([1.0, 17.0, 45.0, 59.0, 70.0])
    assert np.allclose(same.contact_point(alpha), rod.contact_point(alpha), atol=1e-6)
    assert np.allclose(same.arms(alpha), rod.arms(alpha), atol=2e-5)
    for angle in alpha:
        assert same.tip_curvature(angle) == pytest.approx(rod.tip_curvature(angle), rel=1e-3)
    assert same.moments_behind(0.05) == pytest.approx(rod.moments_behind(0.05), rel=1e-12)


def test_an_ogive_is_tangent_to_its_tip_and_to_the_cylinder():
    line = shapes.ogive(0.2, 0.02, 3.0, 0.002)
    slope = np.arctan2(*np.diff(line, axis=0).T[::-1])
    assert (np.diff(slope) > -1e-12).all()
    assert np.degrees(np.diff(slope)).max() < 1.0  # no edge anywhere
    assert slope[-2] == pytest.approx(np.pi / 2, abs=0.01)
    # sharp: the length of the nose is sqrt(calibre - 1/4) diameters
    start = shapes.ogive(0.2, 0.02, 3.0, 1e-7)[-2, 1]
    assert start == pytest.approx(0.02 * np.sqrt(2.75), rel=1e-3)


def test_the_thick_tail_of_an_inclined_body_touches_first():
    line = np.array([[0, 0], [0.004, 0], [0.004, 0.08], [0.02, 0.09], [0.02, 0.1]])
    rho, z = solid(line).contact_point(np.radians([10.0, 85.0]))
    assert z.tolist() == [0.0, 0.09]
    assert rho.tolist() == [0.004, 0.02]


@pytest.mark.parametrize("scale", [1.0, 1.7, 2.5, 0.6, 3.3])
def test_of_a_level_side_the_end_nearest_the_tip_touches_whatever_the_unit(scale):
    """At the other end by round-off, the places of its contacts began there."""
    side = scale * np.array([[0.0, 0.0], [6e-3, 0.0], [8e-3, 2e-3], [8e-3, 0.0123], [0.0, 0.0123]])
    x, z = solid(side).contact_point(np.array([-np.pi / 2, 0.0, np.pi / 2]))
    assert x / scale == pytest.approx([-8e-3, 6e-3, 8e-3])
    assert z / scale == pytest.approx([2e-3, 0.0, 2e-3], abs=1e-12)


def test_smooth_curves_keep_between_their_points_and_are_round_on_the_axis():
    points = np.array([[0.0, 0.0], [4e-3, 1e-3], [7e-3, 5e-3], [9e-3, 60e-3], [6e-3, 80e-3]])
    line = shapes.smooth(points)
    assert line[0].tolist() == [0.0, 0.0]
    assert (np.diff(line[:, 1]) >= 0).all()
    assert line[:, 0].max() == pytest.approx(9e-3)
    body = solid(line)
    assert body.tip_curvature(0.0) > 1e-3
    assert all(np.abs(line - place).sum(axis=1).min() < 1e-12 for place in points)


def test_a_reversed_body_has_its_tail_as_its_tip_and_the_same_inertia():
    line, bore = shapes.cone(L, 2 * R, 0.5, 0.1 * R, 0.0), [[0.2 * R, 0.5 * L], [0.4 * R, L]]
    body = rigid.Turned(line, ((0.3 * L, RHO), (L, 2 * RHO)), bore)
    turned = body.reversed()
    assert turned.outline[:2].tolist() == [[0.0, 0.0], [R, 0.0]]
    assert turned.z_c == pytest.approx(L - body.z_c)
    assert (turned.mass, turned.k2) == pytest.approx((body.mass, body.k2))
    np.testing.assert_allclose(turned.reversed().outline, body.outline, atol=1e-12)


@pytest.mark.parametrize(
    ("outline", "density", "bore", "told"),
    [
        ([[0, 0.0], [R, 0.1], [R, 0.05]], [(0.05, RHO)], None, "turns back"),
        ([[R, 0.0], [R, 0.1]], [(0.1, RHO)], None, "starts on the axis"),
        ([[0, 0], [R, 0], [R, L]], [(0.5 * L, RHO)], None, "last segment ends"),
        ([[0, 0], [R, 0], [R, L]], [(L, -1.0)], None, "densities must be positive"),
        ([[0, 0], [R, 0], [R, L]], [(L, RHO)], [[1.1 * R, 0], [R, L]], "leaves no wall"),
        (
            *([[0, 0], [R, R], [R, L]], [(L, RHO)], [[0.5 * R, 0], [0.5 * R, L]]),
            "at 0 mm leaves no wall under radius 0 mm",
        ),
        ([[0, 0], [R, 0], [0.5 * R, L]], [(L, RHO)], [[0.4 * R, 0], [0.6 * R, L]], "leaves no wall"),
        ([[0, 0], [R, 0], [R, L]], [(L, RHO)], [[0.5 * R, 0], [0.5 * R, 2 * L]], "beyond the tail"),
        ([[0, 0], [np.nan, 0], [R, L]], [(L, RHO)], None, "all finite"),
    ],
)
def test_what_bounds_no_body_is_refused(outline, density, bore, told):
    with pytest.raises(rigid.ShapeError, match=told):
        rigid.Turned(outline, density, bore)
