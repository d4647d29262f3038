from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh_shapes import SHAPES, contact_zone

import meshes
from meshes.quality import scaled_jacobians
from meshes.rows import DEEPEST, WORST, drawn_rows
from meshes.surface import closest_on

CELL = 0.25e-3
ZONE = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), [-1.5e-3, -1e-3, -1.2e-3], [1.5e-3, 1e-3, 1e-3])


@pytest.fixture(scope="module")
def block():
    return meshes.block((-8e-3, 0.0, -6e-3), (8e-3, 8e-3, 0.0), 2e-3, [ZONE] * 3)


def tip_of(name):
    meridian = SHAPES[name]
    mesh = meshes.rod(meridian, 0.06, zones=[contact_zone(meridian)] * 3).mesh
    return meridian, mesh, meshes.with_thin_rows(mesh, mesh.finest, 2 * 9.5e-3 / 8 / 8, 2)


@pytest.fixture(scope="module", params=sorted(SHAPES))
def tip(request):
    return tip_of(request.param)


def others(mesh):
    return np.unique(mesh.cells[~mesh.finest])


def test_rows_halve_towards_the_skin_and_the_rest_is_stretched_evenly(block):
    thin = meshes.with_thin_rows(block, block.finest, CELL, 2)
    line = np.flatnonzero((block.points[:, :2] == 0.0).all(axis=1))
    line = line[block.points[line, 2].argsort()[::-1]]
    finest = np.unique(block.cells[block.finest])
    count = min(np.isin(line, finest).sum() - 1, DEEPEST)
    assert count > 4
    rows = -np.diff(thin.points[line[: count + 1], 2]) / CELL
    assert rows[:2] == pytest.approx([0.25, 0.5])
    assert rows[2:] == pytest.approx((count - 0.75) / (count - 2))


def test_many_rows_become_thin_over_so_many_cells_that_none_leans_too_far():
    zone = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), [-2e-3, -2e-3, -2.5e-3], [2e-3, 2e-3, 0.0])
    block = meshes.block((-6e-3, 0.0, -4e-3), (6e-3, 6e-3, 0.0), 2e-3, [zone] * 3)
    thin = meshes.with_thin_rows(block, block.finest, CELL, 5)
    tops = thin.points[thin.points[:, 2] > -CELL]
    first = -tops[(np.hypot(tops[:, 0], tops[:, 1]) < 1e-9) & (tops[:, 2] < 0.0), 2].max()
    assert first == pytest.approx(CELL / 32)
    assert WORST < scaled_jacobians(thin).min() < 0.9


def test_only_nodes_inside_the_finest_cells_move(block):
    thin = meshes.with_thin_rows(block, block.finest, CELL, 2)
    moved = np.flatnonzero(np.abs(thin.points - block.points).max(axis=1) > 1e-15)
    assert len(moved) > 100
    assert not np.isin(moved, others(block)).any()
    assert (block.points[moved, 2] < 0.0).all()
    assert meshes.volume(thin) == pytest.approx(meshes.volume(block), rel=1e-12)


def test_cells_outside_the_part_stay(block):
    part = block.finest & (block.points[block.cells, 0].mean(axis=1) > 0.0)
    thin = meshes.with_thin_rows(block, part, CELL, 2)
    moved = np.abs(thin.points - block.points).max(axis=1) > 1e-15
    assert moved.any()
    assert (block.points[moved, 0] > 0.0).all()


def test_skin_of_a_tip_stays_on_its_surface(tip):
    meridian, mesh, thin = tip
    skin = np.unique(mesh.faces_with(meshes.SKIN))
    moved = skin[np.abs(thin.points - mesh.points)[skin].max(axis=1) > 1e-15]
    place = np.stack([np.hypot(*thin.points[moved, :2].T), thin.points[moved, 2]], axis=1)
    side = np.vstack([meridian, [meridian[-1, 0], 0.06]])
    away = np.linalg.norm(closest_on(side, place) - place, axis=1)
    assert np.max(away, initial=0.0) < 1e-9
    assert meshes.volume(thin) == pytest.approx(meshes.volume(mesh), rel=1e-6)


def test_plane_of_symmetry_stays_flat(tip):
    _, mesh, thin = tip
    plane = np.unique(mesh.faces_with(meshes.SYMMETRY))
    assert (thin.points[plane, 1] == 0.0).all()


def test_hanging_nodes_stay_tied(tip):
    _, mesh, thin = tip
    assert np.abs(mesh.tie @ thin.points - thin.points).max() < 1e-15


def test_first_rows_of_a_tip_are_thin_and_no_cell_is_too_skewed(tip):
    _, mesh, thin = tip
    under = mesh.finest & np.isin(mesh.cells, np.unique(mesh.faces_with(meshes.SKIN))).any(axis=1)
    ratio = meshes.thicknesses(thin)[under] / meshes.thicknesses(mesh)[under]
    assert 0.2 < ratio.min() < 0.35
    worst, before = (scaled_jacobians(m).min(axis=1) for m in (thin, mesh))
    assert (worst >= np.minimum(0.2, before) - 1e-12).all()


def test_sharp_edge_has_thin_rows_under_both_faces():
    base = meshes.block((0.0, 0.0, -8e-3), (8e-3, 4e-3, 0.0), 2e-3)
    tags = np.where(base.face_tag == meshes.SYMMETRY, meshes.SYMMETRY, meshes.SKIN).astype(np.int8)
    zone = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), [0.0, 0.0, -2e-3], [2e-3, 4e-3, 0.0])
    box = meshes.refine(replace(base, face_tag=tags), [zone] * 2)
    thin = meshes.with_thin_rows(box, box.finest, 0.5e-3, 2)
    edge = np.flatnonzero((box.points[:, [0, 2]] == 0.0).all(axis=1) & (box.points[:, 1] == 0.5e-3))
    at_edge = (box.cells == edge[0]).any(axis=1)
    assert np.ptp(thin.points[thin.cells[at_edge]], axis=1)[:, [0, 2]] == pytest.approx(0.125e-3)
    assert meshes.volume(thin) == pytest.approx(meshes.volume(box), rel=1e-12)


def test_rows_that_are_thin_already_are_not_drawn(block):
    thin = meshes.with_thin_skin(block, CELL, 2)
    assert meshes.with_thin_rows(thin, thin.finest, CELL, 2).points == pytest.approx(thin.points, abs=1e-15)


@given(count=st.integers(1, DEEPEST), thin=st.integers(0, 4))
@settings(max_examples=40, deadline=None)
def test_drawn_rows_keep_their_ends_and_grow(count, thin):
    thin = min(thin, count // 2)
    places = drawn_rows(count, thin)
    heights = np.diff(places)
    assert places[[0, -1]] == pytest.approx([0.0, count])
    assert heights[0] == pytest.approx(0.5**thin)
    assert (np.diff(heights) > -1e-12).all()
