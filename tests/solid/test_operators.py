"""Fast products against assembled matrices, and ties that do no work."""

import tracemalloc

import numpy as np
import pytest
import scipy.sparse as sp
import solid_shapes as shapes

import meshes
from fem_impact.fem.elements import element_stiffness, lame_constants, lumped_mass
from fem_impact.fem.slices import SliceOperator
from fem_impact.fem.sparse import Hanging, NodeProduct, assemble, assemble_mass, element_batches, tie_operator

LAME = lame_constants(shapes.E, shapes.NU)


def _slices(across=6, length=30e-3):
    rod = meshes.rod(np.array([[0.0, 0.0], [9.5e-3, 0.0]]), length, across, nose=False)
    section = np.full(len(rod.mesh.points), -1)
    section[rod.body_nodes[:, :2].T] = np.arange(len(rod.body_nodes))
    first = rod.mesh.cells[rod.body_cells[:, 0]]
    K = element_stiffness(rod.mesh.points, first, LAME, "incompatible")
    return rod, SliceOperator.of(K, section[first[:, :4]], section[first[:, 4:]])


def test_slices_are_the_assembled_matrix():
    rod, operator = _slices()
    n_section, layers = rod.body_nodes.shape
    assert layers > 5
    places = np.empty((len(rod.mesh.points), 3), int)
    places[rod.body_nodes] = (
        np.arange(3 * n_section * layers).reshape(3, n_section, layers).transpose(1, 2, 0)
    )
    whole = assemble(
        rod.mesh.points, rod.mesh.cells, LAME, "incompatible", tie_operator(rod.mesh.tie, places, places.size)
    )
    d = np.random.default_rng(1).normal(size=(3 * n_section, layers))
    y = np.full_like(d, np.nan)
    operator.apply(d, y)
    exact = (whole @ d.ravel()).reshape(d.shape)
    assert abs(y - exact).max() < 1e-12 * abs(exact).max()


def test_blocks_are_the_sparse_matrix():
    mesh, points = shapes.refined_patch(seed=2)
    places = np.random.default_rng(3).permutation(3 * len(points)).reshape(-1, 3)
    some = mesh.cells[::3]
    T = tie_operator(mesh.tie, places, places.size)
    K = assemble(points, some, LAME, "bbar", T)
    product = NodeProduct.of(K, places[~mesh.is_hanging])
    x = np.random.default_rng(4).normal(size=places.size)
    y = np.ones(places.size)
    product.multiply(x)
    product.add_to(y)
    assert len(product.places) < (~mesh.is_hanging).sum()
    assert abs(y - 1 - K @ x).max() < 1e-12 * abs(K @ x).max()


def _unheld(seed):
    """Return the product of a refined patch that nothing holds, its free points, their places and matrix."""
    mesh, points = shapes.refined_patch(seed)
    places = np.random.default_rng(seed).permutation(3 * len(points)).reshape(-1, 3)
    K = assemble(points, mesh.cells, LAME, "incompatible", tie_operator(mesh.tie, places, places.size))
    free = places[~mesh.is_hanging]
    product = NodeProduct.of(K, free)

    def times(x):
        y = np.zeros(len(x))
        product.multiply(x)
        product.add_to(y)
        return y

    return times, points[~mesh.is_hanging], free, K


def test_blocks_tell_force_and_energy_from_their_origin():
    _, _, free, K = _unheld(seed=15)
    x, origin, y = np.random.default_rng(16).normal(size=(3, K.shape[0]))
    product, given, force = NodeProduct.of(K, free, origin), y.copy(), K @ (x - origin)
    product.multiply(x)
    product.add_to(y, -0.5)
    assert abs(given - 0.5 * force - y).max() < 1e-12 * abs(force).max()
    assert product.energy == pytest.approx(0.5 * (x - origin)[free.ravel()] @ force[free.ravel()], rel=1e-12)


def test_blocks_work_both_ways():
    times, _, _, K = _unheld(seed=12)
    x, z = np.random.default_rng(13).normal(size=(2, K.shape[0]))
    assert z @ times(x) == pytest.approx(x @ times(z), rel=1e-13)


@pytest.mark.parametrize("axis", range(6))
def test_blocks_let_a_rigid_motion_free(axis):
    times, points, free, K = _unheld(seed=14)
    motion, x = np.eye(6)[axis], np.zeros(K.shape[0])
    x[free] = motion[:3] + np.cross(motion[3:], points)
    assert abs(times(x)).max() < 1e-12 * abs(K).max() * abs(x).max()


def _hanging(seed=5):
    mesh, points = shapes.refined_patch(seed)
    places = np.random.default_rng(seed).permutation(3 * len(points)).reshape(-1, 3)
    assert mesh.is_hanging.sum() > 20
    return mesh, points, places, Hanging.of([(mesh.tie, places)])


def test_ties_do_no_work():
    mesh, _, places, ties = _hanging()
    rng = np.random.default_rng(6)
    v, f = rng.normal(size=(2, places.size))
    ties.expand(v)
    given = v @ f
    ties.collect(f)
    assert v @ f == pytest.approx(given, rel=1e-12)
    assert abs(f[places[mesh.is_hanging]]).max() == 0.0


def test_ties_keep_force_and_moment():
    _, points, places, ties = _hanging()
    f = np.random.default_rng(7).normal(size=places.size)
    force, moment = f[places].sum(axis=0), np.cross(points, f[places]).sum(axis=0)
    ties.collect(f)
    assert f[places].sum(axis=0) == pytest.approx(force, rel=1e-12)
    assert np.cross(points, f[places]).sum(axis=0) == pytest.approx(moment, rel=1e-10)


def test_ties_follow_a_linear_field():
    mesh, points, places, ties = _hanging()
    H = np.random.default_rng(8).normal(size=(3, 3))
    v = np.empty(places.size)
    v[places] = points @ H
    v[places[mesh.is_hanging]] = np.nan
    ties.expand(v)
    assert v[places] == pytest.approx(points @ H, rel=1e-12)


def test_two_bodies_share_one_tie_list():
    mesh, _, places, one = _hanging()
    two = Hanging.of([(mesh.tie, places), (mesh.tie, places + places.size)])
    v = np.random.default_rng(9).normal(size=places.size)
    both = np.concatenate([v, 2 * v])
    one.expand(v)
    two.expand(both)
    assert both == pytest.approx(np.concatenate([v, 2 * v]), rel=1e-14)


def test_tied_masses_add_up_and_stand_on_free_nodes():
    mesh, points = shapes.refined_patch(seed=10)
    places = np.arange(3 * len(points)).reshape(-1, 3)
    T = tie_operator(mesh.tie, places, places.size)
    mass = assemble_mass(lumped_mass(points, mesh.cells, shapes.RHO), mesh.cells, T)
    exact = shapes.RHO * sum(shapes.volume(points[c]) for c in mesh.cells)
    assert mass[places].sum(axis=0) == pytest.approx([exact] * 3, rel=1e-12)
    assert (mass[places[mesh.is_hanging]] == 0).all()
    assert (mass[places[~mesh.is_hanging]] > 0).all()


def test_rigid_motion_of_a_tied_assembly_is_free():
    mesh, points = shapes.refined_patch(seed=11)
    places = np.arange(3 * len(points)).reshape(-1, 3)
    K = assemble(points, mesh.cells, LAME, "incompatible", tie_operator(mesh.tie, places, places.size))
    assert isinstance(K, sp.csr_matrix)
    u = np.cross([1.0, -2.0, 0.5], points)
    assert abs(K @ u.ravel()).max() < 1e-11 * abs(K).max() * abs(u).max()


def test_assembly_takes_little_more_memory_than_its_result():
    points, cells = shapes.grid((20, 20, 10), 1e-3)
    T = sp.identity(3 * len(points), format="csr")
    tracemalloc.start()
    try:
        whole = assemble(points, cells, LAME, "full", T)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 4 * (whole.data.nbytes + whole.indices.nbytes)


def test_equal_cells_share_their_blocks():
    points, cells = shapes.grid((6, 6, 6), 1e-3)
    places = np.arange(3 * len(points)).reshape(-1, 3)
    matrix = assemble(points, cells, LAME, "bbar", sp.identity(places.size, format="csr"))
    product = NodeProduct.of(matrix, places)
    assert len(product.blocks) < 0.1 * len(product.kinds)
    x, y = np.random.default_rng(4).normal(size=places.size), np.zeros(places.size)
    product.multiply(x)
    product.add_to(y)
    assert y == pytest.approx(matrix @ x, abs=1e-11 * abs(matrix @ x).max())


def test_cells_of_one_shape_have_one_matrix():
    points, cells = shapes.grid((7, 2, 3), 1e-3)
    points = points + 0.24  # whose places are rounded
    made = [K for _, K in element_batches(points, cells, LAME, "full")]
    assert sum(len(np.unique(K, axis=0)) for K in made) == 1
    points[-1] += 1e-12  # the last cell is another by 1e-9 of its edge
    made = [K for _, K in element_batches(points, cells, LAME, "full")]
    assert sum(len(np.unique(K, axis=0)) for K in made) == 2
