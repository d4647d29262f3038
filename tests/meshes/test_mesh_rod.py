import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mesh_shapes import RADIUS, SHAPES, contact_zone, edge_radius, frustums, interior, plain

import meshes
from meshes.quality import aspects, edge_lengths, scaled_jacobians
from meshes.surface import closest_on

LENGTH = 0.06


@pytest.fixture(scope="module", params=sorted(SHAPES))
def fine(request):
    meridian = SHAPES[request.param]
    zone = contact_zone(meridian)
    return meridian, zone, meshes.rod(meridian, LENGTH, zones=[zone] * 3)


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_volume_converges_to_the_solid_of_revolution(name):
    exact = 0.5 * frustums(SHAPES[name], LENGTH)
    error = [
        1.0 - meshes.volume(meshes.rod(SHAPES[name], LENGTH, across).mesh) / exact for across in (8, 16, 32)
    ]
    assert 0.0 < error[2] < 0.3 * error[1] < 0.3 * 0.5 * error[0]
    assert error[2] < 3e-3


def test_body_is_identical_slices_that_no_refinement_touches(fine):
    _, _, rod = fine
    mesh = rod.mesh
    layers = mesh.points[rod.body_nodes]
    step = np.diff(layers, axis=1)
    assert np.abs(step - np.array([0.0, 0.0, rod.slice_length])).max() < 1e-15
    assert layers[0, 0, 2] == rod.body_start
    assert layers[0, -1, 2] == pytest.approx(LENGTH, rel=1e-14)
    assert not mesh.is_hanging[rod.body_nodes].any()
    assert (mesh.level[rod.body_cells] == 0).all()


def test_body_cells_join_consecutive_layers(fine):
    _, _, rod = fine
    cells = rod.mesh.cells[rod.body_cells]
    for side, corners in ((0, slice(0, 4)), (1, slice(4, 8))):
        for k in (0, cells.shape[1] - 1):
            assert np.isin(cells[:, k, corners], rod.body_nodes[:, k + side]).all()
    shift = rod.body_nodes[0, 1] - rod.body_nodes[0, 0]
    assert (np.diff(cells, axis=1) == shift).all()


def test_nose_joins_the_body_without_a_gap(fine):
    _, _, rod = fine
    mask = interior(rod.mesh)
    first = rod.body_nodes[:, 0]
    place = rod.mesh.points[first]
    inside = (np.hypot(place[:, 0], place[:, 1]) < 0.99 * RADIUS) & (place[:, 1] > 0.0)
    assert inside.sum() > 5
    assert mask[first[inside]].all()


def test_free_nose_nodes_lie_on_the_exact_surface(fine):
    meridian, _, rod = fine
    mesh = rod.mesh
    skin = np.unique(mesh.faces_with(meshes.SKIN))
    skin = skin[~mesh.is_hanging[skin]]
    place = mesh.points[skin]
    place = place[place[:, 2] < rod.body_start - 1e-9]
    rho_z = np.stack([np.hypot(place[:, 0], place[:, 1]), place[:, 2]], axis=1)
    line = np.concatenate([meridian, [[RADIUS, LENGTH]]])
    assert len(place) > 200
    assert np.linalg.norm(closest_on(line, rho_z) - rho_z, axis=1).max() < 1e-12


def test_symmetry_plane_is_exact(fine):
    _, _, rod = fine
    mesh = rod.mesh
    plane = np.unique(mesh.faces_with(meshes.SYMMETRY))
    assert (mesh.points[plane, 1] == 0.0).all()
    others = np.setdiff1d(np.arange(len(mesh.points)), plane)
    assert mesh.points[others, 1].min() > 1e-5


def test_refined_zone_has_good_cells_and_no_slivers(fine):
    _, zone, rod = fine
    mesh = rod.mesh
    nominal = 2.0 * RADIUS / 8 / 2**3
    touching = zone.gap(mesh.points[mesh.cells], np.full(len(mesh.cells), 1e-8)) == 0.0
    assert (mesh.level[touching] == 3).all()
    assert scaled_jacobians(mesh).min() > 0.5
    assert edge_lengths(mesh).min() > 0.53 * nominal
    assert edge_lengths(mesh)[touching].max() < 1.8 * nominal
    assert aspects(mesh).max() < 3.3


def test_contact_patch_of_the_rounded_edge_is_a_regular_grid():
    meridian = edge_radius()
    zone = contact_zone(meridian, half=1.2e-3)
    mesh = meshes.rod(meridian, LENGTH, zones=[zone] * 3).mesh
    skin = mesh.faces_with(meshes.SKIN)
    node, count = np.unique(skin, return_counts=True)
    on_patch = (zone.distance(mesh.points[node]) == 0.0) & (mesh.points[node, 1] > 0.0)
    assert on_patch.sum() > 10
    assert (count[on_patch] == 4).all()
    assert not mesh.is_hanging[node[on_patch]].any()


shapes = st.tuples(
    st.floats(2.5e-3, 25e-3), st.floats(0.02, 1.0), st.floats(4.0, 12.0), st.sampled_from([6, 8, 10, 12])
)


@pytest.mark.long
@settings(max_examples=30, deadline=None)
@given(shapes, st.floats(0.0, np.pi / 2.0), st.integers(0, 3))
@example((0.0095, 0.191875, 6.0, 6), 5 * np.pi / 36, 2)  # the flattest of 3900 edges scanned: .379
def test_edges_of_every_size_give_good_cells(shape, alpha, levels):
    radius, share, slender, across = shape
    meridian = edge_radius(radius, max(0.2e-3, share * radius) if share < 1.0 else radius, 200)
    zone = contact_zone(meridian, alpha, 0.15 * radius)
    rod = meshes.rod(meridian, slender * radius, across, zones=[zone] * levels)
    assert scaled_jacobians(rod.mesh).min() > 0.35  # unrefined .5: surface nodes of split cells move outwards
    assert edge_lengths(rod.mesh).min() > 0.4 * 2.0 * radius / across / 2**levels


@settings(max_examples=20, deadline=None)
@given(st.floats(0.1, 0.95), st.floats(15.0, 65.0), st.sampled_from([6, 8, 12]))
def test_balls_and_cones_of_every_size_give_positive_cells(ball, degrees, across):
    turn = np.linspace(0.0, np.deg2rad(degrees), 100)
    arc = np.stack([ball * np.sin(turn), ball - ball * np.cos(turn)], axis=1)
    rise = (1.0 - arc[-1, 0]) * np.tan(np.deg2rad(degrees))
    meridian = RADIUS * np.concatenate([arc, [[1.0, arc[-1, 1] + rise]]])
    rod = meshes.rod(meridian, 12.0 * RADIUS, across)
    assert scaled_jacobians(rod.mesh).min() > 0.15


def test_edges_of_the_body_are_met_by_nodes():
    meridian = SHAPES["sphere and cone"]
    mesh = meshes.rod(meridian, LENGTH).mesh
    rho = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    at_edge = (np.abs(rho - RADIUS) < 1e-12) & (np.abs(mesh.points[:, 2] - meridian[-1, 1]) < 1e-12)
    assert at_edge.sum() == 9


def test_long_rod_is_divided_evenly_by_the_wanted_slice():
    rod = meshes.rod(plain(), 2.0, slice_length=10e-3)
    assert rod.slice_length == pytest.approx(10e-3, rel=0.01)
    assert rod.mesh.points[:, 2].max() == pytest.approx(2.0, rel=1e-14)


def test_slices_alone_make_a_flat_bar():
    rod = meshes.rod(plain(), LENGTH, 8, 3e-3, nose=False)
    assert rod.body_start == 0.0
    assert rod.body_cells.shape == (24, 20)
    assert rod.body_cells.size == len(rod.mesh.cells)
    assert meshes.volume(rod.mesh) == pytest.approx(0.5 * np.pi * RADIUS**2 * LENGTH, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"across": 7}, "even number"),
        ({"across": 4}, "at least 6"),
        ({"length": 5e-3}, "longer rod"),
        ({"slice_length": 0.0}, "slice_length must be positive"),
        ({"nose": False, "zones": [contact_zone(plain())]}, "keep the nose"),
        ({"meridian": np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]])}, "turns back"),
        ({"meridian": np.array([[0.1, 0.0], [1.0, 0.0]])}, "pole"),
        ({"meridian": np.zeros(3)}, "two rows"),
    ],
)
def test_impossible_rods_are_refused(change, words):
    with pytest.raises(meshes.MeshError, match=words):
        meshes.rod(**{"meridian": plain(), "length": LENGTH, **change})


@pytest.mark.parametrize("degrees", [17.0, 25.0, 37.0, 45.0, 60.0])
@pytest.mark.parametrize(("across", "levels"), [(8, 2), (12, 2), (8, 3)])
def test_the_contact_lies_in_the_middle_of_a_cell_between_cells_of_one_size(degrees, across, levels):
    meridian = edge_radius()
    zone = contact_zone(meridian, np.deg2rad(degrees))
    mesh = meshes.rod(meridian, LENGTH, across, zones=[zone] * levels).mesh
    place = zone.local(mesh.points[mesh.free_skin])
    along = np.sort(place[(place[:, 1] == 0.0) & (np.abs(place[:, 2]) < 0.5e-3), 0])
    size = 2.0 * RADIUS / across / 2**levels
    first = int(np.searchsorted(along, 0.0))
    assert along[first] == pytest.approx(-along[first - 1], rel=0.3)
    assert np.diff(along[first - 2 : first + 2]) == pytest.approx([size] * 3, rel=0.16)
