"""Where a point stands over a deformed surface: random patches, ragged patches, the symmetry plane."""

import numpy as np
import pytest
import solid_scenes

from fem_impact.solid.contact.patch import (
    bilinear,
    edge_neighbours,
    locate,
    make_patch,
    nearest_quads,
    vertex_normals,
)
from fem_impact.solid.contact.surface import SurfaceContact

H = 0.5e-3


def sheet(seed, counts=(9, 6), share=0.1, height=0.1e-3, spoil=True):
    """Half patch b >= 0 with pushed nodes; b = 0 stays a straight edge."""
    rng = np.random.default_rng(seed)
    i, j = np.meshgrid(np.arange(counts[0] + 1), np.arange(counts[1] + 1), indexing="ij")
    points = np.stack([i - counts[0] / 2, j, 0 * i], axis=-1).reshape(-1, 3) * H
    push = rng.uniform(-1, 1, points.shape) * [share * H, share * H, height]
    push[points[:, 1] == 0, 1] = 0.0
    node = (i * (counts[1] + 1) + j)[:-1, :-1].ravel()
    quads = np.stack([node, node + counts[1] + 1, node + counts[1] + 2, node + 1], axis=1)
    if spoil:  # any order of quads, any first corner
        quads = np.array([np.roll(q, rng.integers(4)) for q in rng.permutation(quads)])
    return points + push, quads


def patch_of(points, quads, seed=0):
    places = np.random.default_rng(seed).permutation(points.size).reshape(-1, 3)
    x = np.empty(points.size)
    x[places] = points
    return make_patch(quads, places, points), x


def _at(x, patch, q, xi, eta):
    return np.array(bilinear(xi, eta)) @ x[patch.places[patch.quads[q]]]


def _foot(x, patch, start, target):
    """Return the place on the patch that is found under a target."""
    found, a, b = locate(x, patch.places, patch.quads, patch.neighbours, start, *target[:2])
    assert found >= 0
    assert max(abs(a), abs(b)) <= 1.0
    return _at(x, patch, found, a, b)


@pytest.mark.parametrize("seed", range(8))
def test_points_inside_are_found_from_anywhere(seed):
    rng = np.random.default_rng(seed)
    patch, x = patch_of(*sheet(seed))
    for _ in range(20):
        q, xi, eta = rng.integers(len(patch.quads)), *rng.uniform(-1, 1, 2)
        start, target = rng.integers(len(patch.quads)), _at(x, patch, q, xi, eta)
        assert _foot(x, patch, start, target) == pytest.approx(target, abs=1e-9 * H)


@pytest.mark.parametrize("seed", range(8))
def test_points_are_found_from_next_door(seed):
    """What a run does: a node moves on by less than a quad."""
    rng = np.random.default_rng(seed)
    patch, x = patch_of(*sheet(seed, share=0.15))
    for q in range(len(patch.quads)):
        target = _at(x, patch, q, *rng.uniform(-1, 1, 2))
        for start in patch.neighbours[q][patch.neighbours[q] >= 0]:
            assert _foot(x, patch, start, target) == pytest.approx(target, abs=1e-9 * H)


@pytest.mark.parametrize("seed", range(8))
def test_points_on_the_symmetry_plane_are_found(seed):
    rng = np.random.default_rng(seed)
    points, quads = sheet(seed)
    patch, x = patch_of(points, quads)
    edge = np.sort(points[points[:, 1] == 0, 0])
    for t in [*rng.uniform(edge[0], edge[-1], 10), *edge[1:-1]]:
        for b in (0.0, -1e-13, 1e-13):
            found, a, e = locate(
                x, patch.places, patch.quads, patch.neighbours, rng.integers(len(quads)), t, b
            )
            assert found >= 0, (t, b)
            assert _at(x, patch, found, a, e)[:2] == pytest.approx([t, 0.0], abs=1e-5 * H)


@pytest.mark.parametrize("seed", range(8))
def test_points_outside_are_refused(seed):
    rng = np.random.default_rng(seed)
    points, quads = sheet(seed)
    patch, x = patch_of(points, quads)
    low, high = points.min(axis=0), points.max(axis=0)
    for t, b in (
        (low[0] - 0.1 * H, 1e-3),
        (high[0] + 0.1 * H, 0.0),
        (0.0, high[1] + 0.1 * H),
        (0.0, -0.01 * H),
        (9.0, 9.0),
    ):
        found, _, _ = locate(x, patch.places, patch.quads, patch.neighbours, rng.integers(len(quads)), t, b)
        assert found == -1


def test_badly_shaped_quads_know_their_own_points():
    for seed in range(40):
        rng = np.random.default_rng(seed)
        patch, x = patch_of(*sheet(seed, share=0.22))
        for q in range(len(patch.quads)):
            target = _at(x, patch, q, *rng.uniform(-1, 1, 2))
            found, a, b = locate(x, patch.places, patch.quads, patch.neighbours, q, *target[:2])
            assert found >= 0
            assert _at(x, patch, found, a, b) == pytest.approx(target, abs=1e-6 * H)


def test_neighbours_share_their_edge():
    points, quads = sheet(3)
    patch, _ = patch_of(points, quads)
    sides = 0
    for q, row in enumerate(patch.neighbours):
        for e, other in enumerate(row):
            pair = {patch.quads[q, e], patch.quads[q, (e + 1) % 4]}
            sharing = [k for k in range(len(quads)) if k != q and pair <= set(patch.quads[k])]
            assert ([other] if other >= 0 else []) == sharing
            sides += other < 0
    assert sides == 2 * (9 + 6)
    assert (edge_neighbours(np.array([[0, 1, 2, 3]])) == -1).all()


def test_mirrored_nodes_are_those_on_the_symmetry_plane():
    points, quads = sheet(4)
    patch, x = patch_of(points, quads)
    assert patch.mirrored.sum() == 10
    assert (x[patch.places[patch.mirrored, 1]] == 0).all()


def test_first_quads_are_near():
    under, x = patch_of(*sheet(5, spoil=False))
    points = np.array([[0.3e-3, 0.4e-3, 0.0], [-1.9e-3, 2.4e-3, 0.0], [2.1e-3, 0.0, 0.0]])
    over = make_patch(np.array([[0, 1, 2, 2]]), x.size + np.arange(9).reshape(3, 3), points)
    both = np.concatenate([x, points.ravel()])
    centre = both[under.places[under.quads]].mean(axis=1)
    for q, p in zip(nearest_quads(both, over, under), points, strict=True):
        assert np.hypot(*(centre[q] - p)[:2]) < 0.9 * H


def _normals(points, quads):
    patch, x = patch_of(points, quads)
    normals = np.empty((len(patch.places), 3))
    vertex_normals(x, patch.places, patch.quads, patch.mirrored, normals)
    return normals, x[patch.places]


def test_normals_of_a_plane():
    points, quads = sheet(6, height=0.0)
    points[:, 2] = 0.3 * points[:, 0] + 1e-3
    normals, _ = _normals(points, quads)
    assert normals == pytest.approx(
        np.tile(np.array([-0.3, 0, 1]) / np.sqrt(1.09), (len(normals), 1)), abs=1e-12
    )


def test_normals_of_a_bowl_point_to_its_centre_and_stay_in_the_symmetry_plane():
    radius, (points, quads) = 20e-3, sheet(7, counts=(12, 8), share=0.0)
    points[:, 2] = radius - np.sqrt(radius**2 - points[:, 0] ** 2 - points[:, 1] ** 2)
    normals, at = _normals(points, quads)
    exact = np.array([0, 0, radius]) - at
    exact /= radius
    inside = (abs(at[:, 0]) < 2.5e-3) & (at[:, 1] < 3e-3)
    assert inside.sum() > 40
    assert abs(normals - exact)[inside].max() < 2e-3
    on_plane = at[:, 1] == 0
    assert (normals[on_plane, 1] == 0).all()
    # a normal averaged over one half alone would lean by h/2R = 0.0125
    assert abs(normals - exact)[on_plane & inside].max() < 2e-3


def _model_contact():
    model = solid_scenes.model("vibration", "friction", "barrier-elastic", tip=0.8e-3, across=6)
    contact = model.contact
    assert isinstance(contact, SurfaceContact)
    return model, contact


def _brute(x, patch, t, b):
    """Every quad in turn, from itself, without neighbours to walk to."""
    alone = np.full_like(patch.neighbours, -1)
    return any(locate(x, patch.places, patch.quads, alone, q, t, b)[0] >= 0 for q in range(len(patch.quads)))


@pytest.mark.parametrize("side", ["rod", "barrier"])
def test_walks_on_the_real_patches_miss_nothing(side):
    """Refined zones have ragged borders: whatever one quad holds must be found from the remembered quad."""
    model, contact = _model_contact()
    x, patch = model.start[0], getattr(contact, side)
    rng = np.random.default_rng(8)
    corners = x[patch.places[patch.quads]]
    missed = 0
    for _ in range(300):
        q = rng.integers(len(patch.quads))
        t, b = (np.array(bilinear(*rng.uniform(-1, 1, 2))) @ corners[q])[:2]
        start = int(np.argmin(((corners.mean(axis=1)[:, :2] - [t, b]) ** 2).sum(axis=1)))
        missed += locate(x, patch.places, patch.quads, patch.neighbours, start, t, b)[0] < 0
    assert missed == 0


def test_remembered_quads_of_the_barrier_nodes_miss_nothing():
    model, contact = _model_contact()
    x, rod, first = model.start[0], contact.rod, len(contact.rod.places)
    places = contact.barrier.places
    for i, (t, b) in enumerate(x[places][:, :2]):
        walked = locate(x, rod.places, rod.quads, rod.neighbours, contact.last[first + i], t, b)[0] >= 0
        assert walked == _brute(x, rod, t, b), (t, b)


def test_both_patches_turn_the_same_way():
    model, contact = _model_contact()
    x = model.start[0]
    for patch in (contact.rod, contact.barrier):
        c = x[patch.places[patch.quads]]
        d, e = c[:, 2] - c[:, 0], c[:, 3] - c[:, 1]
        assert (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0] > 0).all()
