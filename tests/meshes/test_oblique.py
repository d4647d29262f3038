"""A body that lies askew in its file: its axis stated or found, its plane of symmetry found."""

import decks
import numpy as np
import pytest
from own_bodies import box, taper
from scipy.spatial.transform import Rotation

import meshes
from meshes import MeshError, Stated, own_body, read_own

TETRAHEDRA = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
MOVED = np.array([0.3, -0.2, 0.1])


def turn(seed):
    """Return a random turn whose third row, the body's axis, points to falling z."""
    found = Rotation.random(random_state=seed).as_matrix()
    return found if found[2, 2] > 0 else np.diag([1.0, -1.0, -1.0]) @ found


def laid(points, of):
    """Return points laid askew and moved: the tip, at -z, points along minus the third row."""
    return points @ of + MOVED


def whole_cylinder():
    """Return a round bar of 10 mm by 60 mm with cells of an O-grid, all of it."""
    half = meshes.turned(np.array([[0.0, 0.0], [5e-3, 0.0], [5e-3, 60e-3], [0.0, 60e-3]]), 8).mesh
    points, cells = half.points, half.cells
    off = points[:, 1] > 1e-9
    new = np.where(off, len(points) + np.cumsum(off) - 1, np.arange(len(points)))
    image = points[off] * [1.0, -1.0, 1.0]
    mirrored = new[cells][:, [4, 5, 6, 7, 0, 1, 2, 3]]
    return np.concatenate([points, image]), np.concatenate([cells, mirrored])


def moments(half):
    """Return volume, mass centre and second moments, m, of a half, and its size."""
    part = meshes.cell_moments(half)
    sums = [part.volume.sum(), part.z.sum(), part.xx.sum(), part.zz.sum()]
    return np.array([*sums / sums[0], *np.ptp(half.points, axis=0)])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("how", ["found", "stated"])
@pytest.mark.parametrize("body", ["tapered", "square", "round", "flat"])
def test_an_oblique_body_is_the_upright_one(body, how, seed):
    made = {
        "tapered": lambda: taper(end=0.6, whole=True),
        "square": lambda: taper(end=1.0, whole=True),
        "round": whole_cylinder,
        "flat": lambda: box(4, 2, 10, (-6e-3, -3e-3, 0), (6e-3, 3e-3, 60e-3)),
    }
    points, cells = made[body]()
    of = turn(seed)
    tip = "-axis" if how == "found" else tuple(-of[2])
    found = own_body(laid(points, of), cells, Stated(tip=tip))
    plain = moments(own_body(points, cells).half)
    got = moments(found.half)
    if body == "flat" and not np.allclose(got, plain):  # its other plane of symmetry lay nearer to y
        plain = moments(own_body(points[:, [1, 0, 2]], cells[:, [0, 3, 2, 1, 4, 7, 6, 5]]).half)
    assert got == pytest.approx(plain, rel=1e-9)
    assert f"its tip points along ({-of[2, 0]:.4g}, " in found.told[0]
    assert ("least inertia" in found.told[0]) == (how == "found")


def test_plus_axis_takes_the_other_end():
    points, cells = taper(end=0.6, whole=True)
    of = turn(1)
    low, high = (own_body(laid(points, of), cells, Stated(tip=tip)).half for tip in ("-axis", "+axis"))
    wide = [np.ptp(half.points[half.points[:, 2] < 1e-9, 0]) for half in (low, high)]
    assert wide == pytest.approx([0.6 * 12e-3, 12e-3], rel=1e-9)


@pytest.mark.parametrize("ending", [".inp", ".bdf"])
def test_tetrahedra_are_cut_in_their_plane_of_symmetry(tmp_path, ending):
    points, cells = box(4, 3, 20, (-6e-3, -3e-3, 0), (6e-3, 3e-3, 60e-3))
    of = turn(2)
    tetrahedra = cells[:, TETRAHEDRA].reshape(-1, 4)
    path = decks.write(tmp_path / f"askew{ending}", 1e3 * laid(points, of), tetrahedra)
    found = read_own(path, 1e-3, Stated(tip="-axis"))
    size = sorted(np.ptp(found.half.points, axis=0) * [1, 2, 1])
    assert size == pytest.approx([6e-3, 12e-3, 60e-3], rel=1e-3)
    assert 2 * meshes.volume(found.half) == pytest.approx(6e-3 * 12e-3 * 60e-3, rel=1e-3)


def test_a_half_whose_axis_leans_within_its_plane_stays_a_half():
    points, cells = taper(end=0.6)
    lean = Rotation.from_euler("y", 30, degrees=True).as_matrix()
    askew = points @ lean.T
    down = tuple(-lean[:, 2])
    found = own_body(askew, cells, Stated("half", down))
    assert moments(found.half) == pytest.approx(moments(own_body(points, cells).half), rel=1e-9)
    with pytest.raises(MeshError, match=r"stated as mesh_symmetry = \"half\"|across the plane y = 0"):
        own_body(points @ turn(3), cells, Stated("half", tuple(-turn(3)[2])))


def test_a_body_without_an_axis_asks_for_a_direction():
    cube = box(2, 2, 2, (-5e-3, -5e-3, 0), (5e-3, 5e-3, 10e-3))
    with pytest.raises(MeshError, match=r"no axis of its own.*mesh_tip = \[0, 0, -1\]"):
        own_body(*cube, Stated(tip="-axis"))
    with pytest.raises(MeshError, match="cannot point along"):
        own_body(*cube, Stated(tip=(0.0, 0.0, 0.0)))


def test_a_body_without_a_plane_of_symmetry_is_refused():
    points, cells = box(4, 4, 10, (-6e-3, -6e-3, 0), (6e-3, 6e-3, 60e-3))
    angle = 20.0 * points[:, 2]  # twisted by more than a radian
    x, y = points[:, 0] + 2e-3 * (points[:, 1] > 1e-3), points[:, 1]
    points[:, 0], points[:, 1] = x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)
    with pytest.raises(MeshError, match=r"across the plane y = 0|is not symmetric about the plane y = 0"):
        own_body(laid(points, turn(0)), cells, Stated(tip="-axis"))
