"""Meshes of bodies of revolution: no folded cell, the right volume, one closed surface."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import meshes
import rigid
from meshes import Zone
from meshes.common import MeshError
from meshes.ends import POOR
from meshes.hexmesh import SKIN
from meshes.quality import quality
from meshes.section import bored_section
from meshes.turned import WORST


def sphere_tip(radius, turn=90.0):
    angle = np.radians(np.linspace(0.0, turn, 91))
    return np.stack([radius * np.sin(angle), radius * (1 - np.cos(angle))], axis=1)


R = 9.5e-3
BALL = np.concatenate([sphere_tip(R), np.array([0.0, 2 * R]) + sphere_tip(R)[-2::-1] * [1.0, -1.0]])
SHAPES = {
    "ball": BALL,
    "hemisphere": np.concatenate([sphere_tip(R), [[R, 0.1]]]),
    "sphere-cone": np.concatenate([sphere_tip(3e-3, 70.0), [[R, 0.02], [R, 0.1]]]),
    "truncated cone": np.array([[0, 0], [4e-3, 0], [R, 0.02], [R, 0.1]]),
    "rounded edge": np.concatenate([[[0, 0]], sphere_tip(1e-3) + np.array([R - 1e-3, 0.0]), [[R, 0.1]]]),
    "flat": np.array([[0, 0], [R, 0], [R, 0.1]]),
    "barrel": np.array([[0, 0], [6e-3, 0], [R, 0.05], [6e-3, 0.1]]),
    "heavy tail": np.concatenate([sphere_tip(4e-3, 80.0), [[4e-3, 0.05], [R, 0.06], [R, 0.1]]]),
}


def volume_of(line):
    r, z = line.T
    return np.pi / 3 * ((r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2) * np.diff(z)).sum()


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_make_fair_meshes_of_their_volume(name):
    for across in (8, 12):
        body = meshes.turned(SHAPES[name], across)
        found = quality(body.mesh)
        assert found.min_scaled_jacobian > 0.4
        assert found.aspect < 6.0
        # the flat faces of the mesh cut off the round surface: of a 16- or 24-sided polygon at most
        assert 0.0 < 1 - 2 * found.volume / volume_of(SHAPES[name]) < (0.04 if across == 8 else 0.018)


def test_a_long_tube_has_higher_cells_behind_its_tip_and_equal_slices_up_to_its_tail():
    tube, bore = np.array([[0, 0], [R, 0], [R, 2.0]]), np.array([[7e-3, 0.0], [7e-3, 2.0]])
    zone = Zone(np.array([R, 0.0, 0.0]), np.eye(3), np.full(3, -1e-3), np.full(3, 1e-3))
    body = meshes.turned(tube, 8, [zone, zone], bore=bore)
    heights = np.unique(np.round(body.mesh.points[body.body_nodes[0], 2], 12))
    assert np.ptp(np.diff(heights)) < 1e-11
    assert body.slice_length == pytest.approx(2.0 / 500, rel=0.02)
    assert body.body_start < 8 * 2 * R
    edge = np.unique(np.round(body.mesh.points[np.hypot(*body.mesh.points[:, :2].T) > R - 1e-9, 2], 12))
    assert np.diff(edge[edge < R]).max() < 1.2 * 2 * R / 8
    short = meshes.turned(tube * [1, 0.3], 8, [zone, zone], bore=bore * [1, 0.3])
    assert short.slice_length == pytest.approx(2 * R / 8, rel=0.02)


def test_the_thinnest_wall_may_be_a_quotient_of_stated_radii():
    assert len(bored_section(16, 0.95 + 1e-16 * 8).unit)
    with pytest.raises(MeshError, match=r"give 0\.2 to 0\.95 of it"):
        bored_section(16, 0.951)


@pytest.mark.parametrize(("outer", "z"), [([10.0, 10.0, 6.01], 80), ([10.0, 6.01, 10.0], 40)])
def test_a_wall_that_grows_thin_behind_the_tip_is_refused(outer, z):
    """The front alone was looked at: a tube of 40 % wall at the tip could end in 0.2 %."""
    line = np.array([[0.0, 0.0], [outer[0], 0.0], [outer[1], 40.0], [outer[2], 80.0]]) * 1e-3
    bore = np.array([[6.0, 0.0], [6.0, 80.0]]) * 1e-3
    with pytest.raises(
        meshes.MeshError, match=rf"a wall of 0\.00166 of the outer radius.* at z = 0\.0{z // 10} m"
    ):
        meshes.turned(line, 8, bore=bore)
    line[:, 0] = np.maximum(line[:, 0], [0.0, 6.4e-3, 6.4e-3, 6.4e-3])
    assert len(meshes.turned(line, 8, bore=bore).mesh.cells) > 100


def test_a_refined_tip_lies_on_the_exact_surface():
    line = SHAPES["sphere-cone"]
    place = np.array([3e-3 * np.sin(0.7), 0.0, 3e-3 * (1 - np.cos(0.7))])
    zone = Zone(place, np.eye(3), np.full(3, -5e-4), np.full(3, 5e-4))
    body = meshes.turned(line, 8, [zone, zone])
    free = body.mesh.free_skin
    near = free[np.linalg.norm(body.mesh.points[free] - place, axis=1) < 6e-4]
    rho, z = np.hypot(*body.mesh.points[near, :2].T), body.mesh.points[near, 2]
    away = np.abs(np.hypot(rho, z - 3e-3) - 3e-3)
    assert len(near) > 8
    assert away.max() < 1e-6
    assert quality(body.mesh).min_scaled_jacobian > 0.3


@pytest.mark.parametrize("bored", [False, True])
def test_a_sharp_rim_is_round_where_its_cells_are_split(bored):
    """Not the chord of the coarse cells, on which the middle between two of its nodes lies."""
    bore = np.array([[6e-3, 0.0], [6e-3, 0.1]]) if bored else None
    zone = about([R, 0.0, 0.0], 2e-3)
    body = meshes.turned(SHAPES["flat"], 8, [zone] * 3, bore=bore)
    free = body.mesh.points[body.mesh.free_skin]
    near = free[(zone.distance(free) == 0.0) & (free[:, 2] == 0.0)]
    rho = np.hypot(*near[:, :2].T)
    pitch = 2 * R / 8 / 2**3
    assert (np.abs(rho - R) < 1e-12).sum() >= 4
    assert not ((rho > R - 0.3 * pitch) & (rho < R - 1e-9)).any()


@pytest.mark.parametrize("name", ["sphere-cone", "rounded edge", "flat"])
def test_the_cylinder_behind_a_nose_is_made_of_equal_slices(name):
    """Sections up to the end of a nose grid are round; slices have the area of the circle."""
    body = meshes.turned(SHAPES[name], 8)
    layers = body.mesh.points[body.body_nodes]
    step = np.diff(layers, axis=1)
    assert np.abs(step - [0.0, 0.0, body.slice_length]).max() < 1e-12
    assert body.body_cells.shape[1] == layers.shape[1] - 1 > 20
    corners = body.mesh.cells[body.body_cells]
    for k in range(body.body_cells.shape[1]):
        assert np.isin(corners[:, k, :4], body.body_nodes[:, k]).all()
        assert np.isin(corners[:, k, 4:], body.body_nodes[:, k + 1]).all()
    assert not meshes.turned(SHAPES["barrel"], 8).body_cells.size


@pytest.mark.parametrize(("size", "some"), [(3e-4, True), (6e-3, False)])
def test_the_rear_of_a_ball_may_move_as_one_rigid_body(size, some):
    """It is the grid of its round tail, unless the cells of the contact's zone reach into it."""
    zone = Zone(np.zeros(3), np.eye(3), np.full(3, -size), np.full(3, size))
    body = meshes.turned(BALL, 8, [zone, zone, zone])
    behind = body.mesh.points[body.mesh.cells[body.rest_cells]]
    assert bool(len(behind)) == some
    assert len(body.interface) == len(np.unique(body.interface)) and bool(len(body.interface)) == some
    if some:
        assert behind[:, :, 2].min() == pytest.approx(body.mesh.points[body.interface, 2].min())
        assert not body.mesh.level[body.rest_cells].any()


def test_no_cell_straddles_a_plane():
    z = 0.0321
    body = meshes.turned(SHAPES["barrel"], 8, planes=[z])
    heights = body.mesh.points[body.mesh.cells][:, :, 2]
    assert not ((heights.min(axis=1) < z - 1e-9) & (heights.max(axis=1) > z + 1e-9)).any()


def test_slices_are_of_the_last_segment_even_where_rows_of_two_are_as_high():
    """All had the stiffness of the first: a rod of two metals was unstable, or rang as one of the first."""
    line = np.concatenate([sphere_tip(10e-3), [[10e-3, 0.3]]])
    for planes in ([0.15, 0.3], [0.1, 0.15, 0.3]):
        body = meshes.turned(line, 8, planes=planes)
        assert body.slice_length == pytest.approx(2.5e-3)
        lowest = body.mesh.points[body.mesh.cells[body.body_cells], 2].min()
        assert lowest == pytest.approx(0.15) and body.body_cells.shape[1] == 60


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (np.array([[0, 0], [R, 0.05], [R, 0.1]]), "too sharp"),
        (
            np.array([[0, 0], [4e-3, 0], [4e-3, 0.05], [R, 0.05], [R, 0.051], [4e-3, 0.051], [4e-3, 0.1]]),
            "steps from",
        ),
        (np.array([[0, 0], [R, 0], [5e-3, 0.05], [R, 0.05], [0, 0.05]]), "rim of no thickness"),
        (np.array([[0, 0], [1e-3, 0], [2e-3, 0], [1e-3, 5e-324]]), "shrinks at z = 0"),
        (np.array([[0, 0], [R, 0], [5e-3, 0.05], [R, 0.05 + 1e-15]]), "rim of no thickness"),
    ],
)
def test_what_hexahedra_cannot_fill_is_refused(line, told):
    with pytest.raises(meshes.MeshError, match=told):
        meshes.turned(line, 8)


@pytest.mark.parametrize(
    ("head", "edge", "neck"), [(3e-3, 0.0, 3e-3), (1e-3, 5e-4, 3e-3), (5e-3, 2e-3, 7e-3)]
)
def test_a_thin_head_is_refused_as_a_flange_with_a_remedy_that_works(head, edge, neck):
    """A bolt's head of 20 mm across was "too sharp", its flat end to be rounded or cut off flat."""

    def bolt(head):
        chamfer = [[10e-3, edge]] * (edge > 0.0)
        return np.array(
            [[0, 0], [10e-3 - edge, 0], *chamfer, [10e-3, head + edge], [neck, head + edge], [neck, 0.06]]
        )

    with pytest.raises(meshes.MeshError, match=r"end is a flange: .* up to \S+ m from the end") as told:
        meshes.turned(bolt(head), 8)
    thick = float(re.search(r"up to (\S+) m", str(told.value))[1])
    assert len(meshes.turned(bolt(thick - edge), 8).mesh.cells) > 100


def tube(bore, depth, closed="tip", edge=0.0):
    """Outline and bore, m, of a tube of radius R and length 0.1 m, closed at one end by a disc."""
    front = sphere_tip(edge) + np.array([R - edge, 0.0]) if edge else [[R, 0.0]]
    line = np.concatenate([[[0.0, 0.0]], front, [[R, 0.1]]])
    places = (depth, 0.1) if closed == "tip" else (0.04, 0.1 - depth)
    return line, np.array([[bore, z] for z in places])


def about(place, size):
    return Zone(np.asarray(place), np.eye(3), np.full(3, -size), np.full(3, size))


def within(mesh, bore, depth):
    """Nodes of the flat face that closes the bore, inside its edge."""
    rho, z = np.hypot(*mesh.points[:, :2].T), mesh.points[:, 2]
    return (rho < 0.9 * bore) & (np.abs(z - depth) < 1e-9)


@pytest.mark.parametrize("across", [8, 10])
@pytest.mark.parametrize("depth", [1e-3, 2e-3, 4e-3, 5.5e-3, 7e-3])
def test_a_thin_closing_disc_is_as_thick_as_stated(depth, across):
    """Cells of the tip end where the bore begins, however near, and with a fine zone at edge or pole."""
    line, bore = tube(7e-3, depth)
    true = np.pi * (R**2 * depth + (R**2 - 49e-6) * (0.1 - depth))
    for place in ([R, 0.0, 0.0], [0.0, 0.0, 0.0]):
        body = meshes.turned(line, across, [about(place, 1e-3)] * 2, bore=bore)
        found = quality(body.mesh)
        assert found.min_scaled_jacobian > 0.37 and found.aspect < 12.0
        assert 2 * found.volume == pytest.approx(true, rel=0.01)  # a polygon of 16 sides
        assert within(body.mesh, 7e-3, depth).sum() > 8


def test_split_cells_at_the_edge_of_a_closing_disc_are_no_slivers():
    line, bore = tube(7e-3, 2e-3)
    body = meshes.turned(line, 6, [about([R, 0.0, 0.0], 2e-3)] * 3, bore=bore)
    assert quality(body.mesh).aspect < 12.0


@pytest.mark.parametrize("end", ["tip", "tail"])
def test_a_disc_that_ends_at_the_rounding_closes_either_end(end):
    line, bore = tube(6e-3, 4e-3, end, edge=3e-3)
    if end == "tail":
        line = np.stack([line[::-1, 0], line[-1, 1] - line[::-1, 1]], axis=1)
        line = np.concatenate([[[0.0, 0.0]], line])
    body = meshes.turned(line, 8, [about([R, 0.0, 0.0], 1e-3)], bore=bore)
    assert quality(body.mesh).min_scaled_jacobian > 0.4
    assert within(body.mesh, 6e-3, 4e-3 if end == "tip" else 0.096).sum() > 8


def test_a_bore_within_a_rounding_is_refused_with_its_distance():
    line, bore = tube(4e-3, 2e-3, edge=6e-3)
    with pytest.raises(meshes.ClosedEndError, match="lies 2 mm from the end") as refused:
        meshes.turned(line, 8, bore=bore)
    assert refused.value.distance == 2e-3
    assert meshes.contact_radius(line, np.array([R, 6e-3]), 8, bore) > 0.9 * R


def test_a_wall_that_is_thin_beside_its_cells_is_told():
    line, bore = tube(8.8e-3, 5e-3)
    with pytest.raises(meshes.MeshError, match=r"wall of 0.074 of the outer radius is too thin beside 6"):
        meshes.turned(line, 6, bore=bore)
    assert quality(meshes.turned(line, 12, bore=bore).mesh).min_scaled_jacobian > WORST


def test_split_cells_beside_a_bore_whose_facets_are_wider_than_they_are_do_not_fold():
    """An open tip: nodes that would move onto the bore or the face at its edge stay on their facets."""
    line = np.array([[0.0, 0.0], [7.35e-3, 0.0], [0.01, 4.05e-3], [0.01, 0.2]])
    bore = np.array([[5.88e-3, 0.0], [5.88e-3, 0.19]])
    body = meshes.turned(line, 6, [about([7.35e-3, 0.0, 0.0], 2e-3)] * 3, bore=bore)
    assert quality(body.mesh).min_scaled_jacobian > 0.3


def test_split_cells_of_a_wall_as_thin_as_its_chords_are_deep_keep_the_facets_of_the_bore():
    line = np.array([[0.0, 0.0], [0.0144, 0.0], [0.0144, 0.29]])
    bore = np.array([[0.01225, 0.0], [0.01234, 0.29]])
    for place in ([0.0144, 0.0, 0.0], [0.0, 0.0, 0.0]):
        body = meshes.turned(line, 6, [about(place, 1.44e-3)] * 3, bore=bore)
        assert quality(body.mesh).min_scaled_jacobian > 0.25


@st.composite
def profiles(draw):
    """Any profile: a flat or sharp tip, radii that jump by up to five, a flat or pointed tail."""
    count = draw(st.integers(2, 7))
    radii = draw(st.lists(st.floats(1e-3, 2e-2), min_size=count, max_size=count))
    steps = draw(st.lists(st.floats(0.0, 5e-2), min_size=count - 1, max_size=count - 1))
    z = np.concatenate([[0.0], np.cumsum(steps)])
    line = np.column_stack([radii, z])
    tail = [[0.0, z[-1] + draw(st.floats(0.0, 2e-2))]] if draw(st.booleans()) else []
    line = np.concatenate([[[0.0, 0.0]], line, np.reshape(tail, (-1, 2))])
    return line[np.concatenate([[True], np.hypot(*np.diff(line, axis=0).T) > 1e-9])]


def test_a_bore_that_begins_just_before_an_edge_of_the_surface_makes_no_sliver():
    line = np.array([[0.0, 0.0], [5e-3, 0.0], [R, 7.2e-3], [R, 0.1]])
    body = meshes.turned(line, 8, bore=np.array([[3e-3, 7.19e-3], [3e-3, 0.1]]))
    assert quality(body.mesh).aspect < 10.0


@st.composite
def closed_tubes(draw):
    """A tip of any kind, a bore straight or tapered, discs of 1 to 10 mm at one end or both."""
    radius, length = draw(st.floats(3e-3, 2e-2)), draw(st.floats(0.06, 0.3))
    edge = draw(st.floats(0.05, 1.0)) * radius
    face = draw(st.floats(0.2, 1.0)) * radius
    slope = draw(st.floats(0.3, 3.0)) * (radius - face)
    tip = {
        "flat": [[radius, 0.0]],
        "rounded": sphere_tip(edge) + np.array([radius - edge, 0.0]),
        "cone": [[face, 0.0], [radius, slope]] if slope > 0.0 else [[radius, 0.0]],
    }[draw(st.sampled_from(["flat", "rounded", "cone"]))]
    line = np.concatenate([[[0.0, 0.0]], tip, [[radius, length]]])
    if draw(st.booleans()):  # a round tail
        line = np.concatenate([line[:-1], [[0.0, length]] + sphere_tip(radius)[::-1] * [1.0, -1.0]])
    line = line[np.concatenate([[True], np.hypot(*np.diff(line, axis=0).T) > 1e-9])]
    discs = draw(st.tuples(st.floats(1e-3, 1e-2), st.floats(1e-3, 1e-2)))
    first, last = draw(st.sampled_from([(1, 0), (0, 1), (1, 1)]))
    wide = st.floats(0.2, 0.95)
    bore = np.array([[draw(wide), first * discs[0]], [draw(wide), length - last * discs[1]]]) * [radius, 1.0]
    return line, bore


@settings(max_examples=20, deadline=None)
@given(closed_tubes(), st.sampled_from([6, 8, 10, 12]), st.floats(0.0, 1.0), st.integers(1, 3))
def test_a_random_closed_tube_is_refused_unrefined_or_never_folds(tube, across, place, levels):
    """What is meshed without a fine zone is meshed with one, too: `check` tries the first alone."""
    line, bore = tube
    try:
        rigid.Turned(line, [(line[-1, 1], 1.0)], bore)
        meshes.turned(line, across, bore=bore)
    except (rigid.ShapeError, meshes.MeshError):
        return
    front = line[line[:, 1] < 0.3 * line[-1, 1]]
    rho, z = front[round(place * (len(front) - 1))]
    zones = [about([rho, 0.0, z], 0.1 * line[:, 0].max())] * levels
    body = meshes.turned(line, across, zones, bore=bore)
    found = quality(body.mesh)
    assert found.min_scaled_jacobian > 0.05
    true = rigid.Turned(line, [(line[-1, 1], 1.0)], bore).mass
    assert 2 * found.volume == pytest.approx(true, rel=0.12)  # thin walls of polygons with 12 sides


FIN = np.array([[0, 0], [1, 0], [0.5, 2], [1, 2], [0.5, 2], [0, 2.25]]) / 64
"""A profile that turns back upon itself, m."""


@settings(max_examples=60, deadline=None)
@example(FIN, 6)
@given(profiles(), st.sampled_from([6, 8, 12]))
def test_a_random_profile_is_meshed_without_folds_or_refused(line, across):
    try:
        body = meshes.turned(line, across)
    except meshes.MeshError:
        return
    assert quality(body.mesh).min_scaled_jacobian > min(WORST, POOR)
    skin = body.mesh.points[body.mesh.faces_with(SKIN)]
    # every face of the skin lies at the surface: within the sagitta of the polygon and the slices' pitch
    assert np.hypot(skin[..., 0], skin[..., 1]).max() < 1.08 * line[:, 0].max()


@pytest.mark.parametrize("chamfer", np.arange(0.01, 0.31, 0.02))
def test_a_pin_with_a_chamfer_of_45_degrees_of_any_size_is_meshed_with_eight_cells_across(chamfer):
    line = 4e-3 * np.array([[0, 0], [1 - chamfer, 0], [1, chamfer], [1, 20]])
    assert quality(meshes.turned(line, 8).mesh).min_scaled_jacobian > 0.2


def test_a_flange_at_an_end_is_told_how_long_it_must_be():
    def pipe(long):
        return np.array([[0, 0], [82e-3, 0], [82e-3, long], [44.5e-3, long], [44.5e-3, 0.8]])

    with pytest.raises(
        MeshError, match=r"is a flange: behind it the body narrows .* 0\.082 m up to 0\.074 m"
    ):
        meshes.turned(pipe(20e-3), 8)
    assert quality(meshes.turned(pipe(74e-3), 8).mesh).min_scaled_jacobian > WORST
