"""A body bounded by facets beside the turned body that it was cut from, and its own mistakes."""

import numpy as np
import pytest
from own_bodies import box

from meshes import SKIN, Stated, cell_moments, own_body, turned
from rigid import Faceted, ShapeError, Turned, shapes

RHO = 2700.0
CONE = shapes.cone(0.12, 0.02, np.radians(20.0), 4e-3, 0.0)


def of_mesh(half):
    part = cell_moments(half)
    quads = half.faces_with(SKIN)
    nodes, facets = np.unique(quads, return_inverse=True)
    moments = [RHO * moment for moment in (part.volume, part.x, part.z, part.xx, part.zz)]
    parts = np.column_stack([part.low, part.high, *moments])
    return Faceted(half.points[nodes], facets.reshape(quads.shape), parts)


@pytest.fixture(scope="module")
def pair():
    return of_mesh(turned(CONE, 24).mesh), Turned(CONE, ((0.12, RHO),))


def test_mass_centre_and_inertia_are_those_of_the_round_body(pair):
    facets, smooth = pair
    assert facets.mass == pytest.approx(smooth.mass, rel=2e-3)
    assert facets.z_c == pytest.approx(smooth.z_c, rel=1e-3)
    assert facets.k2 == pytest.approx(smooth.k2, rel=2e-3)
    assert abs(facets.x_c) < 1e-9
    assert facets.gamma == pytest.approx(smooth.gamma, rel=5e-3)


@pytest.mark.parametrize("degrees", [0.0, 15.0, 40.0])
def test_it_touches_where_the_round_body_does(pair, degrees):
    facets, smooth = pair
    alpha = np.radians(degrees)
    for mine, theirs in zip(facets.arms(alpha), smooth.arms(alpha), strict=True):
        assert mine == pytest.approx(theirs, abs=4e-4)
    places, angles = facets.contact_point(np.array([alpha, 0.1])), np.array([alpha, 0.1])
    assert [float(part[0]) for part in places] == [float(part) for part in facets.contact_point(alpha)]
    assert places[0].shape == angles.shape


def test_radii_of_a_fine_tip_are_near_those_of_its_sphere(pair):
    ball = of_mesh(turned(shapes.ball(0.02), 40).mesh)
    assert ball.tip_curvature(0.3) == pytest.approx(0.01, rel=0.1)
    assert ball.curvature_around(0.3) == pytest.approx(0.01, rel=0.1)


def bar(width=2e-2, length=0.1):
    """A square bar of one cell."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (0, 1) for z in (0, 1.0)])
    corners = corners * [width / 2, width / 2, length]
    faces = np.array([[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [0, 2, 3, 1], [4, 5, 7, 6], [2, 6, 7, 3]])
    m = RHO * width**2 / 2 * length
    moments = [m, 0.0, m * length / 2, m * width**2 / 12, m * length**2 / 3]
    return Faceted(corners, faces, np.array([[0.0, length, *moments]]))


def test_a_straight_line_on_which_no_node_lies_has_no_width():
    """An own mesh ended `assess` at another inclination: its round ends beside the nodes."""
    one, share = bar(), np.array([0.1, 0.9])
    side = np.array([0.01, 0.0]), np.array([0.01, 0.1])
    assert one.half_widths(*side, share) == pytest.approx([0.01, 0.01])
    assert not one.half_widths(*(place - [0.004, 0.0] for place in side), share).any()


def test_a_square_bar_has_its_closed_form_and_stands_on_an_edge():
    one = bar()
    assert one.mass == pytest.approx(RHO * 4e-4 * 0.1, rel=1e-12)
    assert one.k2 == pytest.approx((0.02**2 + 0.1**2) / 12, rel=1e-12)
    alpha = np.radians(30.0)
    assert one.contact_point(alpha) == (pytest.approx(0.01), 0.0)
    d_c, d_d = one.arms(alpha)
    assert (d_c, d_d) == (
        pytest.approx(0.05 * np.sin(alpha) - 0.01 * np.cos(alpha)),
        pytest.approx(0.05 * np.cos(alpha) + 0.01 * np.sin(alpha)),
    )
    assert one.tip_curvature(alpha) == 0.0
    assert one.curvature_around(alpha) == np.inf
    assert one.face == pytest.approx(0.01)
    assert one.spread(alpha, 1e-5, (1e-4, 0.2))[2] == pytest.approx(0.01)
    assert one.spread(0.0, 1e-5, (1e-4, 0.2))[0] == pytest.approx(0.02)
    assert one.spread(1.5707, 1e-4, (1e-4, 0.2))[1] == pytest.approx(0.1, rel=0.02)


def test_sections_of_a_bar_are_its_mass_and_moment_a_metre():
    mass, turning = bar().sections(np.linspace(0.0, 0.1, 6)).T
    assert mass == pytest.approx(RHO * 4e-4, rel=1e-12)
    assert turning == pytest.approx(RHO * 0.02**4 / 12, rel=1e-12)


def test_a_tip_beside_the_axis_is_seen():
    one = bar()
    moved = Faceted(one.points + np.array([3e-3, 0, 0]), one.facets, one.parts)
    assert one.off_axis() == 0.0
    assert moved.off_axis() == pytest.approx(3e-3)


def test_a_part_without_mass_is_refused():
    one = bar()
    with pytest.raises(ShapeError, match="a mass above 0"):
        Faceted(one.points, one.facets, one.parts * [1, 1, 0, 1, 1, 1, 1])


def chamfered(steps):
    """A bar of 20 mm by 100 mm with chamfers of 3 mm at 45 degrees, with nodes all along them."""
    slope = np.linspace(0.0, 3e-3, steps + 1)
    return with_side(np.column_stack([7e-3 + slope, slope]))


def with_side(side):
    """A bar 20 mm wide and 100 mm long with these places (x, z) of its side before z = 100 mm."""
    outline = np.vstack([side, [[1e-2, 0.1], [-1e-2, 0.1]], side[::-1] * [-1, 1]])
    # in a file of six digits
    outline = (outline + 1e-8 * np.cos(7.0 * np.arange(len(outline)))[:, None]).round(8)
    outline[:, 1] -= outline[:, 1].min()
    points = np.concatenate([np.insert(outline, 1, y, axis=1) for y in (0.0, 1e-2)])
    count = len(outline)
    ring = np.arange(count)
    faces = np.stack([ring, np.roll(ring, -1), np.roll(ring, -1) + count, ring + count], axis=1)
    m = RHO * 2e-6
    return Faceted(points, faces, np.array([[0.0, 0.1, m, 0.0, 0.05 * m, 3e-5 * m, 3.3e-3 * m]]))


def test_straight_sides_that_meet_at_a_small_angle_make_an_edge():
    alpha = np.arctan2(0.03, 3e-3) + np.radians(3.0)
    body = with_side(np.array([[7e-3, 0.0], [1e-2, 0.03]]))
    assert body.contact_point(alpha) == pytest.approx((1e-2, 0.03), abs=3e-8)
    assert body.tip_curvature(alpha) == 0.0


@pytest.mark.parametrize("degrees", [10.0, 30.0])
def test_nodes_within_a_straight_flank_change_nothing(degrees):
    alpha = np.radians(degrees)
    coarse, fine = chamfered(1), chamfered(12)
    assert fine.contact_point(alpha) == pytest.approx(coarse.contact_point(alpha), abs=3e-8)
    assert fine.tip_curvature(alpha) == coarse.tip_curvature(alpha) == 0.0
    assert fine.reaches(alpha, 2e-5) == pytest.approx(coarse.reaches(alpha, 2e-5), rel=0.02)
    for height in (1e-5, 1e-4, 1e-3):
        many, few = (body.spread(alpha, height, (1e-4, 0.2)) for body in (fine, coarse))
        assert many == pytest.approx(few, abs=1e-6)


def test_a_body_on_two_feet_touches_beside_its_plane():
    one = bar()
    points = one.points.copy()
    points[(points[:, 1] == 0.0) & (points[:, 2] == 0.0), 2] = 2e-4
    feet, alpha = Faceted(points, one.facets, one.parts), np.radians(10.0)
    assert one.beside(alpha) == 0.0
    assert feet.beside(alpha) == pytest.approx(0.01)
    over = 2e-4 * np.cos(alpha)  # of the middle of the edge over its ends
    assert feet.curvature_around(alpha) == pytest.approx(0.01**2 / (2 * over), rel=1e-9)


def test_the_width_of_a_chamfer_is_that_at_its_height():
    body = chamfered(1)
    assert body.radius(np.array([0.0, 1.5e-3, 3e-3, 50e-3])) == pytest.approx(
        [7e-3, 8.5e-3, 1e-2, 1e-2], abs=1e-4
    )


@pytest.fixture(scope="module")
def channel():
    """Half of a channel 24 x 24 x 3 x 200 mm: a web at x = 0 to 3 mm, a flange at y = 9 to 12 mm."""
    x, y, z = (1e-3 * np.array(places) for places in ([0.0, 3.0, 24.0], [0.0, 9.0, 12.0], [0.0, 200.0]))
    points = np.array([[a, b, c] for a in x for b in y for c in z])
    n = np.arange(18).reshape(3, 3, 2)
    cells = [(0, 0), (0, 1), (1, 1)]  # of the grid of x and y
    faces = [face for i, j in cells for face in _faces(n[i : i + 2, j : j + 2])]
    outer = [face for face in faces if sum(set(face) == set(other) for other in faces) == 1]
    quads = np.array([face for face in outer if points[list(face), 1].any()])  # the plane y = 0 is none
    return Faceted(points, quads, np.array([[0.0, 0.2, 0.1, 9e-4, 0.01, 1e-5, 1.4e-3]]))


def _faces(n):
    ends = [[n[0, 0, k], n[1, 0, k], n[1, 1, k], n[0, 1, k]] for k in (0, 1)]
    ring = [n[0, 0], n[1, 0], n[1, 1], n[0, 1]]
    return ends + [[a[0], b[0], b[1], a[1]] for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]


def test_a_section_and_a_side_hold_no_gaps(channel):
    """The ends of two flanges, 3 mm wide each, touch 18 mm apart; the web is 24 mm wide."""
    alpha, height = np.radians(25.0), 1e-4
    length = sum(channel.reaches(alpha, height))
    assert channel.section(alpha, height) == pytest.approx(6e-3 * length)
    assert channel.section(-alpha, height) == pytest.approx(24e-3 * length)
    share = np.array([0.0, 0.1, 0.2, 0.9, 1.0])
    ends = np.array([0.0, 0.0]), np.array([24e-3, 0.0])
    assert channel.half_widths(*ends, share) == pytest.approx([12e-3, 12e-3, 3e-3, 3e-3, 3e-3])
    along = np.array([24e-3, 0.0]), np.array([24e-3, 0.2])
    assert channel.half_widths(*along, share) == pytest.approx(np.full(5, 3e-3))
    assert not channel.half_widths(np.array([24e-3, 0.0]), np.array([3e-3, 0.2]), share).any()


def test_a_collar_of_a_mesh_has_edges():
    """The convex outline turns by 8 and 5 degrees there, and stood for a cylinder of 60 mm radius."""
    points, cells = box(10, 5, 20, (-10e-3, 0.0, 0.0), (10e-3, 10e-3, 80e-3))
    x, y, z = points[cells].mean(axis=1).T
    collar = (np.abs(x) < 6e-3) & (y < 6e-3) | (z > 28e-3) & (z < 36e-3)
    body = of_mesh(own_body(points, cells[collar], Stated("half")).half)
    touch = np.radians(86.0)
    assert body.contact_point(touch) == pytest.approx((10e-3, 28e-3))
    assert body.tip_curvature(touch) == 0.0
    assert not any(one.radius for side in (1.0, -1.0) for one in body.curves(side))


def test_a_notch_beside_the_plane_of_motion_makes_no_edge_in_it():
    """A slot at y > 8 mm made an edge of a barrel of 150 mm radius."""
    points, cells = box(8, 6, 40, (-10e-3, 0.0, 0.0), (10e-3, 12e-3, 80e-3))
    points[:, 0] *= 1.0 - (points[:, 2] - 40e-3) ** 2 / (2 * 150e-3 * 10e-3)
    x, y, z = points[cells].mean(axis=1).T
    slot = (x > 5e-3) & (y > 8e-3) & (np.abs(z - 40e-3) < 4e-3)
    whole, slotted = (of_mesh(own_body(points, cells[kept], Stated("half")).half) for kept in (x < 1, ~slot))
    near = np.radians(88.47)  # on the nodes at one end of the slot
    assert whole.tip_curvature(near) > 0.1
    assert slotted.tip_curvature(near) == pytest.approx(whole.tip_curvature(near), rel=1e-6)
