import numpy as np
import pytest
from mesh_shapes import area_vectors, flux_volume

import meshes

LOW, HIGH = (-8e-3, 0.0, -6e-3), (8e-3, 8e-3, 0.0)
ZONE = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), [-1.5e-3, -1e-3, -1.2e-3], [1.5e-3, 1e-3, 1e-3])


@pytest.fixture(scope="module")
def fine():
    return meshes.block(LOW, HIGH, 2e-3, [ZONE] * 3)


def test_base_block_has_equal_cells_and_exact_volume():
    mesh = meshes.block(LOW, HIGH, 2.1e-3)
    quality = meshes.quality(mesh)
    assert len(mesh.cells) == 8 * 4 * 3
    assert quality.volume == pytest.approx(16e-3 * 8e-3 * 6e-3, rel=1e-13)
    assert flux_volume(mesh) == pytest.approx(quality.volume, rel=1e-13)
    assert quality.min_scaled_jacobian == pytest.approx(1.0)
    assert quality.min_edge == pytest.approx(2e-3)


def test_sides_are_tagged_by_what_they_are(fine):
    area = np.linalg.norm(area_vectors(fine), axis=1)
    totals = [area[fine.face_tag == tag].sum() for tag in (meshes.SKIN, meshes.SYMMETRY, meshes.OUTER)]
    outer = 16e-3 * 8e-3 + 16e-3 * 6e-3 + 2 * 8e-3 * 6e-3
    assert totals == pytest.approx([16e-3 * 8e-3, 16e-3 * 6e-3, outer], rel=1e-12)
    skin = area_vectors(fine)[fine.face_tag == meshes.SKIN]
    assert (skin[:, 2] > 0.0).all()


def test_grid_at_the_contact_is_regular(fine):
    top = fine.points[np.unique(fine.faces_with(meshes.SKIN))]
    near = top[ZONE.distance(top) == 0.0]
    steps = [np.diff(np.unique(near[:, axis].round(12))) for axis in (0, 1)]
    assert len(near) == (len(steps[0]) + 1) * (len(steps[1]) + 1)
    assert np.concatenate(steps) == pytest.approx(0.25e-3, rel=1e-9)


def test_cells_at_the_zone_are_finest(fine):
    touching = ZONE.gap(fine.points[fine.cells], np.full(len(fine.cells), 1e-9)) == 0.0
    assert touching.any()
    assert (fine.level[touching] == 3).all()


def test_thin_skin_halves_rows_towards_the_top_and_moves_nothing_else(fine):
    thin = meshes.with_thin_skin(fine, 0.25e-3, 3)
    assert thin.points[:, :2] == pytest.approx(fine.points[:, :2], abs=1e-15)
    under = fine.points[(fine.points[:, :2] == 0.0).all(axis=1)][:, 2].argsort()[::-1]
    column = thin.points[(fine.points[:, :2] == 0.0).all(axis=1)][under, 2]
    row = -np.diff(column[:6]) / 0.25e-3
    assert column[0] == 0.0
    assert row == pytest.approx([0.125, 0.25, 0.5, 1.0, 1.0], abs=1e-12)
    rise = 0.25e-3 * meshes.thin_skin_rise(3)
    assert thin.points[:, 2].min() == pytest.approx(fine.points[:, 2].min() + rise, rel=1e-12)
    assert meshes.quality(thin).min_scaled_jacobian > 0.9


def test_thin_skin_keeps_the_ties(fine):
    thin = meshes.with_thin_skin(fine, 0.25e-3, 3)
    assert np.abs(thin.tie @ thin.points - thin.points).max() < 1e-18
    assert meshes.quality(meshes.with_thin_skin(fine, 0.25e-3, 0)).volume == pytest.approx(
        meshes.quality(fine).volume, rel=1e-13
    )


@pytest.mark.parametrize(
    ("low", "high", "size", "words"),
    [
        ((0.0, 0.0, -1.0), (1.0, 1.0, 0.5), 0.5, "n = 0"),
        ((0.0, 0.1, -1.0), (1.0, 1.0, 0.0), 0.5, "b = 0"),
        ((1.0, 0.0, -1.0), (0.0, 1.0, 0.0), 0.5, "low < high"),
        ((0.0, 0.0, -1.0), (1.0, 1.0, 0.0), 0.0, "size must be positive"),
    ],
)
def test_impossible_blocks_are_refused(low, high, size, words):
    with pytest.raises(meshes.MeshError, match=words):
        meshes.block(low, high, size)


def test_columns_are_half_as_wide_at_the_ends_of_a_contact_and_sides_stay(fine):
    cell, ends = 0.25e-3, (-0.9e-3, 1.1e-3)
    columns, places = meshes.drawn_to_ends(ends, cell, (LOW[0], HIGH[0]))
    drawn = meshes.with_columns_at(fine, columns, places)
    assert drawn.points[:, 1:] == pytest.approx(fine.points[:, 1:], abs=1e-15)
    assert drawn.points[:, 0].min() == pytest.approx(LOW[0]) and drawn.points[:, 0].max() == HIGH[0]
    line = (fine.points[:, 1:] == 0.0).all(axis=1) & (np.abs(fine.points[:, 0]) < 2e-3)
    t = np.sort(drawn.points[line, 0])
    width, middle = np.diff(t) / cell, 0.5 * (t[1:] + t[:-1])
    away = np.abs(middle[:, None] - ends).min(axis=1) / cell
    stretch = width[away > 3.0]
    assert len(stretch) and stretch == pytest.approx(stretch[0])
    assert width[away < 1.0] == pytest.approx(0.5 * stretch[0], rel=0.02)
    assert 1.0 < stretch[0] < 1.5
    assert meshes.quality(drawn).min_scaled_jacobian > 0.7
    assert np.abs(drawn.tie @ drawn.points - drawn.points).max() < 1e-15


def test_columns_drawn_to_ends_near_a_side_stay_in_the_block():
    columns, places = meshes.drawn_to_ends((-0.7e-3, 0.3e-3), 0.25e-3, (-1e-3, 1e-3))
    for along in (columns, places):
        assert along[[0, -1]] == pytest.approx([-1e-3, 1e-3]) and (np.diff(along) > 0.0).all()


def test_columns_widen_evenly_towards_the_sides(fine):
    margin, widest = 4e-3, 3.0
    wide = meshes.with_wide_edges(fine, margin, widest)
    (low, _, _), (high, side, _) = wide.points.min(axis=0), wide.points.max(axis=0)
    more = 0.5 * (widest - 1.0) * margin
    assert (low, high, side) == pytest.approx((LOW[0] - more, HIGH[0] + more, HIGH[1] + more))
    t, b = fine.points[:, 0], fine.points[:, 1]
    inside = (t > LOW[0] + margin) & (t < HIGH[0] - margin) & (b < HIGH[1] - margin) & ~fine.is_hanging
    assert inside.any() and wide.points[inside] == pytest.approx(fine.points[inside], abs=1e-15)
    line = np.sort(wide.points[(fine.points[:, 1:] == 0.0).all(axis=1), 0])
    assert line[-1] - line[-2] == pytest.approx(5e-3)  # of 2 mm, 1 to 3 times as wide along the margin
    assert (wide.points[b == 0.0, 1] == 0.0).all()
    assert np.abs(wide.tie @ wide.points - wide.points).max() < 1e-15
