import numpy as np
import pytest

from rigid import Projectile, ShapeError, corner_arms, touch_arms

SIZES = [(0.24, "A", 0.007), (0.24, "B", 0.003), (0.08, "B", 0.003), (0.08, "plain", 0.0)]


def rod(length=0.08, tip="B", tip_radius=0.003, diameter=0.019):
    return Projectile(length, diameter, tip, tip_radius, 7850.0)


def polygon_moments(p):
    """Mass, z_c and k2 from a fine stack of frusta: independent of the package's quadrature."""
    line = np.concatenate([p.meridian(20001), [[p.diameter / 2, p.length]]])
    five = np.linspace(0, 1, 5)  # Boole's rule: exact for the quartics below
    z = five * np.diff(line[:, 1])[:, None] + line[:-1, 1:]
    rho = five * np.diff(line[:, 0])[:, None] + line[:-1, :1]
    w = np.diff(line[:, 1])[:, None] * np.array([7, 32, 12, 32, 7]) / 90
    dm = p.density * np.pi * rho**2 * w
    z_c = (dm * z).sum() / dm.sum()
    return dm.sum(), z_c, (dm * (rho**2 / 4 + (z - z_c) ** 2)).sum() / dm.sum()


@pytest.mark.parametrize("size", SIZES)
def test_mass_properties_match_a_stack_of_frusta(size):
    p = rod(*size)
    np.testing.assert_allclose((p.mass, p.z_c, p.k2), polygon_moments(p), rtol=1e-7)


def test_plain_cylinder_closed_form():
    p = rod(tip="plain", tip_radius=0.0)
    assert p.mass == pytest.approx(7850 * np.pi * 0.0095**2 * 0.08, rel=1e-13)
    assert p.z_c == pytest.approx(0.04, rel=1e-13)
    assert p.k2 == pytest.approx(0.08**2 / 12 + 0.019**2 / 16, rel=1e-13)


def test_full_hemisphere_closed_form():
    """An edge as round as the rod is a hemisphere: mass and centre of a half ball on a cylinder."""
    R, l = 0.0095, 0.08
    p = rod(tip_radius=R)
    ball, body = 2 / 3 * np.pi * R**3, np.pi * R**2 * (l - R)
    assert p.mass == pytest.approx(7850 * (ball + body), rel=1e-12)
    assert p.z_c == pytest.approx((ball * R * 5 / 8 + body * (l + R) / 2) / (ball + body), rel=1e-12)


@pytest.mark.parametrize("size", SIZES)
def test_meridian_runs_from_the_pole_to_the_side(size):
    p = rod(*size)
    line = p.meridian(17)
    assert tuple(line[0]) == (0.0, 0.0)
    assert tuple(line[-1]) == (p.diameter / 2, p.z_side)
    assert np.all(np.diff(line, axis=0) >= 0) and np.all(np.diff(line, axis=0).sum(axis=1) > 0)


def test_meridian_holds_the_tangent_points():
    edge = rod().meridian(9)
    assert np.any(np.all(edge == [0.0095 - 0.003, 0.0], axis=1))
    ball = rod(0.24, "A", 0.007).meridian(9)
    tangent = 0.007 * np.array([np.sin(np.pi / 3), 1 - np.cos(np.pi / 3)])
    assert np.min(np.abs(ball - tangent).sum(axis=1)) < 1e-17
    slope = (ball[-1, 1] - ball[-2, 1]) / (ball[-1, 0] - ball[-2, 0])
    assert slope == pytest.approx(np.tan(np.pi / 3), rel=1e-12)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("degrees", [1.0, 17.0, 45.0, 59.0, 75.0, 89.0])
def test_contact_point_is_the_lowest_of_the_meridian(size, degrees):
    p, a = rod(*size), np.radians(degrees)
    rho, z = p.contact_point(a)
    height = p.meridian(4001) @ [-np.sin(a), np.cos(a)]
    assert -rho * np.sin(a) + z * np.cos(a) == pytest.approx(height.min(), abs=1e-9)
    assert rho <= p.diameter / 2


def test_edge_arms_closed_form():
    p, a, r = rod(), np.radians([17.0, 25.0, 37.0, 60.0]), 0.003
    d_c, d_d = p.arms(a)
    np.testing.assert_allclose(d_c, (p.z_c - r) * np.sin(a) - (0.0095 - r) * np.cos(a), rtol=1e-12)
    np.testing.assert_allclose(d_d, (p.z_c - r) * np.cos(a) + (0.0095 - r) * np.sin(a) + r, rtol=1e-12)


def test_what_lands_flat_acts_at_its_middle_and_an_arm_of_round_off_is_none():
    pin = rod(tip="plain", tip_radius=0.0)
    for angle, height in ((0.0, 0.04), (-np.pi / 2, 0.0095), (np.pi / 2, 0.0095)):
        d_c, d_d = touch_arms(pin.touch(angle), pin.x_c, pin.z_c, angle)
        assert d_c == 0.0
        assert d_d == pytest.approx(height, rel=1e-12)


def test_edge_arms_of_the_published_rod():
    d_c, _ = rod().arms(np.radians([17.0, 25.0, 37.0, 60.0]))
    np.testing.assert_allclose(1e3 * d_c, [4.6, 9.8, 17.1, 28.8], atol=0.2)


def test_plain_rod_has_the_corner_arms_of_eq_6_and_7():
    a = np.linspace(0.1, 1.4, 7)
    plain = rod(tip="plain", tip_radius=0.0)
    np.testing.assert_allclose(plain.arms(a), corner_arms(0.08, 0.019, a), rtol=1e-12)
    np.testing.assert_allclose(plain.corner_arms(a), plain.arms(a), rtol=1e-12)


def test_published_masses_and_where_they_come_from():
    """Tables 4-6 used nearly a plain cylinder; Table 2's 0.500 kg follows from no drawn tip A."""
    assert rod(0.12).mass == pytest.approx(0.262, rel=0.02)
    assert rod(0.08).mass == pytest.approx(0.175, rel=0.02)
    assert rod(0.24, "A", 0.007).mass == pytest.approx(0.524, rel=0.001)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"length": -0.08}, "length must be positive"),
        ({"diameter": float("nan")}, "diameter must be positive"),
        ({"tip": "C"}, "A, B, plain"),
        ({"tip_radius": 0.01}, "the rod's radius"),
        ({"tip_radius": 0.0}, "0 < tip_radius"),
        ({"tip": "plain"}, "sharp edge"),
        ({"length": 0.002}, "the nose is"),
    ],
)
def test_impossible_rods_are_refused(change, words):
    with pytest.raises(ShapeError, match=words):
        rod(**change)


@pytest.mark.parametrize("angle", [-1.6, 1.6, float("nan")])
def test_angles_beyond_a_right_angle_are_refused(angle):
    with pytest.raises(ValueError, match="inclination"):
        rod().arms([0.3, angle])


def test_an_arc_of_one_point_is_refused():
    with pytest.raises(ShapeError, match="at least 2"):
        rod().meridian(1)
