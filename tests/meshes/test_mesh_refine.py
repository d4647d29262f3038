import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh_shapes import area_vectors, contact_zone, edge_radius, flux_volume, interior

import meshes
from meshes.gauss import GRADIENTS, jacobians
from meshes.hexmesh import CORNERS, EDGES, FACES
from meshes.split import FACE_EDGES, Birth

small = st.floats(0.0, 1.0)


@st.composite
def refined_blocks(draw):
    centre = [6.0 * draw(small) - 3.0, 3.0 * draw(small), -3.0 * draw(small)]
    turn = draw(st.floats(0.0, np.pi))
    axes = [[np.cos(turn), 0.0, np.sin(turn)], [0.0, 1.0, 0.0], [-np.sin(turn), 0.0, np.cos(turn)]]
    half = np.array([draw(small) for _ in range(3)])
    shares = draw(st.lists(st.floats(0.2, 1.0), min_size=1, max_size=3))
    zones = [meshes.Zone(centre, axes, -share * half, share * half) for share in shares]
    return meshes.block((-3.0, 0.0, -3.0), (3.0, 3.0, 0.0), 1.0, zones, buffer=draw(st.integers(0, 2)))


@pytest.fixture(scope="module")
def rod():
    return meshes.rod(edge_radius(), 0.06, zones=[contact_zone(edge_radius())] * 3).mesh


def boxes_touch(mesh):
    x = mesh.points[mesh.cells]
    low, high = x.min(axis=1), x.max(axis=1)
    return ((low[:, None] <= high[None] + 1e-9) & (high[:, None] >= low[None] - 1e-9)).all(axis=2)


@settings(max_examples=25, deadline=None)
@given(refined_blocks())
def test_touching_cells_differ_by_one_level_at_most(mesh):
    level = mesh.level.astype(int)
    apart = np.abs(level[:, None] - level[None])
    assert (apart[boxes_touch(mesh)] <= 1).all()


@settings(max_examples=25, deadline=None)
@given(refined_blocks())
def test_ties_are_weights_of_free_nodes_and_reproduce_linear_fields(mesh):
    weights = np.asarray(mesh.tie.sum(axis=1)).ravel()
    assert np.abs(weights - 1.0).max() < 1e-14
    assert not mesh.is_hanging[mesh.tie.indices].any()
    assert mesh.tie.data.min() > 0.0
    assert np.abs(mesh.tie @ mesh.points - mesh.points).max() < 3e-15


@settings(max_examples=25, deadline=None)
@given(refined_blocks())
def test_refined_blocks_stay_closed_and_keep_their_volume(mesh):
    assert np.abs(area_vectors(mesh).sum(axis=0)).max() < 1e-12
    assert meshes.volume(mesh) == pytest.approx(54.0, rel=1e-12)
    assert flux_volume(mesh) == pytest.approx(54.0, rel=1e-12)


def test_hanging_nodes_exist_exactly_where_the_level_changes():
    zone = meshes.Zone([0.25, 0.25, -0.25], np.eye(3), np.full(3, -0.1), np.full(3, 0.1))
    mesh = meshes.block((0.0, 0.0, -2.0), (2.0, 2.0, 0.0), 1.0, [zone])
    # One corner cell split: of its 19 new nodes those on its three inner faces hang.
    assert np.bincount(mesh.level).tolist() == [7, 8]
    assert mesh.is_hanging.sum() == 3 + 9
    assert len(mesh.points) == 27 + 19


def test_ties_of_the_curved_nose_reproduce_linear_fields(rod):
    gradient = np.array([[1.0, -2.0, 0.5], [0.3, 0.7, -1.1], [2.0, 0.1, 0.9]])
    field = rod.points @ gradient.T + np.array([0.1, -0.2, 0.3])
    assert rod.is_hanging.sum() > 100
    assert np.abs(rod.tie @ field - field).max() < 1e-13


def test_patch_constant_stress_loads_no_inner_node_across_level_changes(rod):
    stress = np.array([[3.0, 1.0, -0.5], [1.0, -2.0, 0.7], [-0.5, 0.7, 1.5]])
    jacobian = jacobians(rod)
    gradients = np.einsum("qaj,mqji->mqai", GRADIENTS, np.linalg.inv(jacobian))
    cell_force = np.einsum("mq,mqaj,ij->mai", np.linalg.det(jacobian), gradients, stress)
    force = np.zeros_like(rod.points)
    np.add.at(force, rod.cells, cell_force)
    free = interior(rod) & ~rod.is_hanging
    assert free.sum() > 1000
    assert np.abs((rod.tie.T @ force)[free]).max() < 1e-12 * np.abs(cell_force).max()


def test_nose_with_level_changes_has_no_gaps(rod):
    assert np.abs(area_vectors(rod).sum(axis=0)).max() < 1e-16
    assert flux_volume(rod) == pytest.approx(meshes.volume(rod), rel=1e-12)


def test_two_whole_cells_lie_between_level_changes():
    zone = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), np.full(3, -0.3), np.full(3, 0.3))
    mesh = meshes.block((-12.0, 0.0, -12.0), (12.0, 12.0, 0.0), 1.0, [zone] * 3, buffer=2)
    x = mesh.points[mesh.cells]
    for level in (1, 2):
        inner = np.abs(x[mesh.level > level]).max()
        outer = np.abs(x[mesh.level == level]).max()
        assert outer - inner >= 2 * 0.5**level - 1e-12


def test_building_twice_gives_the_same_bits(rod):
    again = meshes.rod(edge_radius(), 0.06, zones=[contact_zone(edge_radius())] * 3).mesh
    assert again.points.tobytes() == rod.points.tobytes()
    assert again.cells.tobytes() == rod.cells.tobytes()


def test_refused_requests():
    zone = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), np.full(3, -0.1), np.full(3, 0.1))
    mesh = meshes.block((-2.0, 0.0, -2.0), (2.0, 2.0, 0.0), 1.0)
    with pytest.raises(meshes.MeshError, match="refined already"):
        meshes.refine(meshes.refine(mesh, [zone]), [zone])
    with pytest.raises(meshes.MeshError, match="must stay whole"):
        meshes.refine(mesh, [zone], frozen=np.ones(len(mesh.cells), bool))


def test_each_level_has_its_own_zone():
    wide = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), np.full(3, -3.2), np.full(3, 3.2))
    narrow = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), np.full(3, -0.7), np.full(3, 0.7))
    mesh = meshes.block((-12.0, 0.0, -12.0), (12.0, 12.0, 0.0), 1.0, [wide, narrow], buffer=1)
    centres = np.abs(mesh.points[mesh.cells].mean(axis=1)).max(axis=1)
    assert centres[mesh.level == 2].max() < 1.0  # cells that touch the narrow zone alone
    assert centres[mesh.level == 0].min() > 4.0  # none that touches the wide one
    assert set(mesh.level[centres < 4.0]) == {1, 2}


def test_no_levels_change_nothing():
    mesh = meshes.block((-2.0, 0.0, -2.0), (2.0, 2.0, 0.0), 1.0)
    same = meshes.refine(mesh, [])
    assert (same.cells == mesh.cells).all()
    assert (same.points == mesh.points).all()
    assert len(same.faces) == len(mesh.faces)


def test_middles_follow_curved_edges_and_faces():
    corners, faces = CORNERS.astype(float), CORNERS[FACES].mean(axis=1)
    unit = np.concatenate([corners, CORNERS[EDGES].mean(axis=1), faces, [[0.5, 0.5, 0.5]]])
    x, y, z = unit.T
    bent = unit + np.stack([y**2 - z**2, x**2, x**2 * y], axis=1)
    none = np.empty((6, 0), int)
    centres = Birth(20, FACES, 8 + FACE_EDGES, none).middle(bent)
    centre = Birth(26, np.arange(8)[None], np.arange(8, 20)[None], np.arange(20, 26)[None]).middle(bent)
    assert centres == pytest.approx(bent[20:26], abs=1e-15)
    assert centre[0] == pytest.approx(bent[26], abs=1e-15)
