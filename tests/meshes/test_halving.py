"""Whole bodies with cells across the plane of symmetry: layers of hexahedra, and tetrahedra, cut there."""

import decks
import numpy as np
import pytest
from own_bodies import box, write

import meshes
from meshes import MeshError, Stated, own_body, quality, read_own

SIX = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]


def bar(ny):
    """Return a whole bar of 12 x 12 x 60 mm with so many layers of cells across."""
    return box(2, ny, 10, (-6e-3, -6e-3, 0.0), (6e-3, 6e-3, 60e-3))


def moments(half):
    part = meshes.cell_moments(half)
    return np.array([2 * float(getattr(part, key).sum()) for key in ("volume", "x", "z", "xx", "zz")])


def exact():
    volume = 12e-3**2 * 60e-3
    return np.array([volume, 0.0, volume * 30e-3, volume * 12e-3**2 / 12, volume * 60e-3**2 / 3])


@pytest.mark.parametrize("ny", [1, 3, 5])
def test_an_odd_number_of_layers_is_cut_in_the_middle(ny):
    points, cells = bar(ny)
    found = own_body(points, cells)
    assert moments(found.half) == pytest.approx(exact(), rel=1e-9, abs=1e-18)
    assert len(found.half.cells) == 20 * (ny + 1) // 2
    assert "20 cells across the plane y = 0 are cut there" in found.told
    assert quality(found.half).min_scaled_jacobian == pytest.approx(1.0)


@pytest.mark.parametrize("shake", [0.0, 0.2])
def test_tetrahedra_of_a_whole_body_are_cut_in_the_plane(tmp_path, shake):
    """Their nodes lie on both sides of the plane, inner ones nowhere near a mirror image of each other."""
    points, cells = box(4, 5, 16, (-6.0, -6.0, 0.0), (6.0, 6.0, 60.0))
    inside = (np.abs(points[:, :2]) < 5.9).all(axis=1) & (points[:, 2] > 0.1) & (points[:, 2] < 59.9)
    points[inside] += shake * np.random.default_rng(3).uniform(-2.0, 2.0, (int(inside.sum()), 3))
    path = decks.write(tmp_path / "bar.inp", points, cells[:, SIX].reshape(-1, 4))
    found = read_own(path, 1e-3)
    assert moments(found.half) == pytest.approx(exact(), rel=1e-4, abs=1e-12)
    assert found.half.points[:, 1].min() == 0.0
    assert any("tetrahedra lie across the plane y = 0 and are cut there" in one for one in found.told)
    assert quality(found.half).min_scaled_jacobian > 0.05
    assert {"LOW", "HIGH"} == set(found.sets)
    both = found.sets["LOW"].sum() + found.sets["HIGH"].sum()
    assert both == len(found.half.cells)


def test_tetrahedra_beside_the_plane_are_cut_in_the_middle_of_a_stated_whole(tmp_path):
    points, cells = box(4, 5, 16, (0.0, 0.0, 0.0), (12.0, 12.0, 60.0))
    path = decks.write(tmp_path / "bar.vtu", points, cells[:, SIX].reshape(-1, 4))
    found = read_own(path, 1e-3, Stated("whole"))
    assert moments(found.half) == pytest.approx(exact(), rel=1e-4, abs=1e-12)


def test_tetrahedra_of_second_order_keep_the_place_of_their_middles(tmp_path):
    """A bar that is wider halfway between its nodes, by the middles of edges alone."""
    points, cells = box(2, 3, 2, (-6.0, -6.0, 0.0), (6.0, 6.0, 60.0))
    corners = cells[:, SIX].reshape(-1, 4)
    ends = corners[:, [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]]
    pairs, at = np.unique(np.sort(ends.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    middles = points[pairs].mean(axis=1)
    middles[np.isclose(np.abs(middles[:, 0]), 6.0) & np.isin(middles[:, 2], (15.0, 45.0)), 0] *= 1.1
    fine = np.concatenate([corners, len(points) + at.reshape(-1, 6)], axis=1)
    found = read_own(decks.write(tmp_path / "bar.inp", np.vstack([points, middles]), fine), 1e-3)
    # a quarter and three quarters up, half of the facets' nodes are 0.6 mm further out on each side
    assert found.half.points[:, 0].max() == pytest.approx(6.6e-3, abs=1e-5)
    assert moments(found.half)[0] == pytest.approx(1.05 * exact()[0], rel=0.01)


def test_tetrahedra_laid_along_x_are_turned_before_they_are_cut(tmp_path):
    points, cells = box(16, 5, 4, (0.0, -6.0, -6.0), (60.0, 6.0, 6.0))
    path = decks.write(tmp_path / "bar.vtu", points, cells[:, SIX].reshape(-1, 4))
    found = read_own(path, 1e-3, Stated(tip="-x"))
    assert moments(found.half)[[0, 2]] == pytest.approx(exact()[[0, 2]], rel=1e-9)


def test_tetrahedra_of_an_unsymmetric_body_are_refused(tmp_path):
    points, cells = box(4, 5, 16, (-6.0, -6.0, 0.0), (6.0, 6.0, 60.0))
    points[:, 1] *= np.where(points[:, 1] > 0, 1.2, 1.0)
    path = decks.write(tmp_path / "bar.vtu", points, cells[:, SIX].reshape(-1, 4))
    with pytest.raises(
        MeshError, match=r"not symmetric about the plane y = 0: volume and moments of its sides"
    ):
        read_own(path, 1e-3)


def test_tetrahedra_with_faces_on_the_plane_need_no_mirror_images(tmp_path):
    points, cells = box(2, 2, 3, (-6.0, -6.0, 0.0), (6.0, 6.0, 60.0))
    path = decks.write(tmp_path / "bar.vtu", points, cells[:, SIX].reshape(-1, 4))
    found = read_own(path, 1e-3)  # diagonals of both sides run the same way
    assert moments(found.half) == pytest.approx(exact(), rel=1e-4, abs=1e-12)
    assert "half of 72 tetrahedra is taken: all of the body is there, with faces on y = 0" in found.told
    assert not any("taken as a half" in one for one in found.told)


def test_tetrahedra_whose_surface_crosses_the_plane_aslant_are_refused(tmp_path):
    """A roof whose ridge does not lie on nodes: they cannot give way along y."""
    points, cells = box(2, 3, 3, (-6.0, -6.0, 0.0), (6.0, 6.0, 60.0))
    points[:, 0] += 2.0 * (6.0 - np.abs(points[:, 1]))
    points[np.abs(points[:, 1]) < 3.0, 1] *= 0.1
    path = decks.write(tmp_path / "roof.vtu", points, cells[:, SIX].reshape(-1, 4))
    with pytest.raises(MeshError, match=r"would change its volume by|is not symmetric"):
        read_own(path, 1e-3)


def test_hexahedra_that_the_plane_halves_from_edge_to_edge_are_cut(tmp_path):
    """A cube on its corner was refused for cells across its plane; its inertia is that about any axis."""
    points, cells = box(4, 4, 4, (-10e-3, -10e-3, -10e-3), (10e-3, 10e-3, 10e-3))
    path = write(tmp_path / "cube.vtu", points, cells)
    body = read_own(path, 1.0, meshes.Stated(tip=(1.0, 1.0, -1.0)))
    part = meshes.cell_moments(body.half)
    assert 2 * part.volume.sum() == pytest.approx(8e-6, rel=1e-9)
    height = float((part.z.sum()) / part.volume.sum())
    assert height == pytest.approx(10e-3 * np.sqrt(3), rel=1e-9)
    assert 2 * (part.zz.sum() - height**2 * part.volume.sum()) == pytest.approx(
        8e-6 * 20e-3**2 / 12, rel=1e-6
    )
    assert 2 * part.xx.sum() == pytest.approx(8e-6 * 20e-3**2 / 12, rel=1e-6)
    assert body.half.points[:, 1].min() == 0.0
    assert any("16 cells are halved from edge to edge" in one for one in body.told)
