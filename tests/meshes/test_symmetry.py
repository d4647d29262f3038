"""Which part of a body a mesh is: recognised, stated, or refused until it is stated."""

import decks
import numpy as np
import pytest
from own_bodies import box, taper

import meshes
from meshes import MeshError, Stated, own_body

TURNED = [4, 5, 6, 7, 0, 1, 2, 3]
LENGTH, WIDTH = 60e-3, 12e-3


def bar(part):
    """Return a square bar of equal cells, or the part of it that is left of planes of symmetry through 0."""
    low = {"whole": (-1, -1), "half": (-1, 0), "quarter": (0, 0)}[part]
    counts = [2 if side < 0 else 1 for side in low]
    half = WIDTH / 2
    return box(*counts, 5, (low[0] * half, low[1] * half, 0.0), (half, half, LENGTH))


def cylinder(part):
    """Return a round bar of 19 mm by 80 mm, or the part of it that is left of planes of symmetry."""
    half = meshes.turned(np.array([[0.0, 0.0], [9.5e-3, 0.0], [9.5e-3, 80e-3], [0.0, 80e-3]]), 8).mesh
    points, cells = half.points.copy(), half.cells
    if part == "quarter":
        points[np.abs(points[:, 0]) < 1e-9, 0] = 0.0
        kept = points[cells][:, :, 0].min(axis=1) >= 0.0
        assert kept.sum() == len(cells) / 2
        return points, cells[kept]
    return points, cells


def same(half, other):
    """Return whether two halves have the same cells at the same places."""
    places = [part.points[part.cells].mean(axis=1) for part in (half, other)]
    sorted_ = [one[np.lexsort(one.round(9).T)] for one in places]
    return sorted_[0].shape == sorted_[1].shape and np.abs(sorted_[0] - sorted_[1]).max() < 1e-12


@pytest.mark.parametrize("part", ["whole", "half", "quarter"])
def test_each_part_of_a_bar_gives_the_half_of_the_same_body(part):
    found = own_body(*bar(part), Stated(symmetry=part))
    assert same(found.half, own_body(*bar("half")).half)
    assert 2 * meshes.volume(found.half) == pytest.approx(WIDTH**2 * LENGTH, rel=1e-12)
    assert "whole body: 12 x 12 x 60 mm, 8.64 cm3" in found.told


def test_an_eighth_is_mirrored_along_its_axis():
    points, cells = box(1, 1, 5, (0, 0, 0), (WIDTH / 2, WIDTH / 2, LENGTH / 2))
    whole = own_body(*box(2, 1, 10, (-WIDTH / 2, 0, 0), (WIDTH / 2, WIDTH / 2, LENGTH)))
    found = own_body(points, cells, Stated(symmetry="eighth"))
    assert same(found.half, whole.half)
    assert "an eighth of a body that is symmetric about x = 0 and y = 0 and z = 0" in found.told[0]


def test_a_round_quarter_and_a_square_half_leave_no_doubt():
    found = own_body(*cylinder("quarter"))
    assert same(found.half, own_body(*cylinder("half")).half)
    assert "a quarter of a body that is symmetric about x = 0 and y = 0" in found.told[0]
    assert "a half of a body" in own_body(*bar("half")).told[0]
    assert own_body(*bar("whole")).told == ("whole body: 12 x 12 x 60 mm, 8.64 cm3",)


def test_a_half_cut_in_another_plane_is_turned_to_y():
    points, cells = cylinder("half")
    for sign in (1.0, -1.0):
        other = np.stack([sign * points[:, 1], -sign * points[:, 0], points[:, 2]], axis=1)
        found = own_body(other, cells)
        assert same(found.half, own_body(points, cells).half)
        assert "turned about its axis by 90 deg, its plane x = 0 to y = 0" in found.told[0]


@pytest.mark.parametrize(
    ("low", "high", "counts", "sizes"),
    [
        # one corner at the origin
        ((0, 0, 0), (12, 12, 60), (2, 2, 5), ["12 x 12 x 60", "12 x 24 x 60", "24 x 24 x 60"]),
        # a whole bar that stands on y = 0, or half of a wide one
        ((-6, 0, 0), (6, 12, 60), (2, 2, 5), ["12 x 12 x 60", "12 x 24 x 60"]),
        # a half whose body is not as wide as deep
        ((-10, 0, 0), (10, 3, 60), (2, 2, 5), ["20 x 3 x 60", "20 x 6 x 60"]),
        # a whole bar beside x = 0, or half of a wide one
        ((0, -6, 0), (12, 6, 60), (2, 2, 5), ["12 x 12 x 60", "24 x 12 x 60"]),
    ],
)
def test_what_is_not_certain_is_refused_with_the_sizes_it_may_have(low, high, counts, sizes):
    points, cells = box(*counts, np.array(low) * 1e-3, np.array(high) * 1e-3)
    with pytest.raises(MeshError, match="it is not certain what part of the body it is") as told:
        own_body(points, cells)
    for size in sizes:
        assert f"a body of {size} mm" in str(told.value)
    whole = own_body(points, cells, Stated(symmetry="whole"))
    volume = float(np.prod(np.subtract(high, low))) * 1e-9
    assert 2 * meshes.volume(whole.half) == pytest.approx(volume, rel=1e-9)
    assert abs(whole.half.points[:, 0].sum()) < 1e-9


def test_what_is_stated_must_fit():
    with pytest.raises(MeshError, match=r'"eighth", which is cut in 3 planes .* on y = 0 and z = 0 alone'):
        own_body(*bar("half"), Stated(symmetry="eighth"))
    with pytest.raises(
        MeshError, match=r"stated as mesh_symmetry = \"half\".* none of x = 0 and y = 0, with"
    ):
        own_body(bar("whole")[0] - [0, 0, 0.1], bar("whole")[1], Stated(symmetry="half"))


@pytest.mark.parametrize(
    ("part", "planes"),
    [
        ("half", ((1, 3e-3),)),
        ("quarter", ((0, 1e-3), (1, 3e-3))),
        ("eighth", ((0, 1e-3), (1, 3e-3), (2, 0.0))),
    ],
)
def test_planes_of_symmetry_may_lie_anywhere(tmp_path, part, planes):
    points, cells = bar("quarter" if part == "eighth" else part)
    points[:, 2] *= 0.5 if part == "eighth" else 1.0
    at = np.array([1e-3, 3e-3, 0.0])  # the bottom of the half and the quarter lies on z = 0, and is none
    decks.write(tmp_path / "bar.vtu", points + at, cells)
    found = meshes.read_own(tmp_path / "bar.vtu", 1.0, Stated(planes=planes))
    assert found.told[-1] == "whole body: 12 x 12 x 60 mm, 8.64 cm3"
    if part != "eighth":
        with pytest.raises(MeshError, match=r'where it was cut: mesh_symmetry = "y = 3 mm", for example'):
            meshes.read_own(tmp_path / "bar.vtu", 1.0, Stated(part))


@pytest.mark.parametrize(
    ("tip", "own", "stated", "told"),
    [
        (
            None,
            (0, 1, 2),
            ((1, 2e-3),),
            r'"y = 2 mm", but it has no flat face there.*"y = 0 mm", for example',
        ),
        ("-y", (1, 2, 0), None, r'lies beside x = 0 without a flat face.*"x = 3 mm", for example'),
        (
            "-y",
            (1, 2, 0),
            ((1, 3e-3),),
            r'"y = 3 mm", but it has no flat face there.*"x = 3 mm", for example',
        ),
    ],
)
def test_refusals_tell_planes_as_they_lie_in_the_file(tmp_path, tip, own, stated, told):
    """A half whose cut lies at y = 0, or at x = 3 mm of a file in which the tip points to -y."""
    points, cells = box(4, 3, 8, (-6e-3, 0.0, 0.0), (6e-3, 5e-3, 60e-3))
    points[:, :2] *= 1.0 - 5.0 * points[:, 2:]
    decks.write(tmp_path / "bar.vtu", points[:, own] + [3e-3 if tip else 0.0, 0.0, 0.0], cells)
    with pytest.raises(MeshError, match=told):
        meshes.read_own(tmp_path / "bar.vtu", 1.0, Stated(tip=tip, planes=stated or ()))


def test_the_plane_of_a_body_cut_across_its_axis_is_told_as_it_lies_in_the_file(tmp_path):
    points, cells = box(4, 4, 8, (-6e-3, -5e-3, 0.0), (6e-3, 5e-3, 60e-3))
    decks.write(tmp_path / "bar.vtu", points, cells)
    told = meshes.read_own(tmp_path / "bar.vtu", 1.0, Stated(planes=((2, 0.0),))).told
    assert told[0] == "its plane of symmetry is taken at y = 0"


@pytest.mark.parametrize("tip", sorted(meshes.TIPS))
def test_the_tip_may_point_anywhere(tip):
    """A bar that tapers to its tip, laid so that the tip points along an axis of the file."""
    points, cells = taper(whole=True)
    axes = meshes.TIPS[tip]
    laid = np.empty_like(points)
    for own, (axis, sign) in enumerate(axes):
        laid[:, axis] = sign * points[:, own]
    found = own_body(laid, cells, Stated(tip=tip))
    plain = own_body(points, cells).half
    assert same(found.half, plain)
    if tip[1] != "z":
        with pytest.raises(MeshError, match=f'mesh_tip = "-{tip[1]}" or "\\+{tip[1]}"'):
            own_body(laid, cells)


def test_a_body_wider_than_long_needs_its_tip_stated():
    points, cells = box(4, 2, 1, (-12e-3, 0, 0), (12e-3, 12e-3, 4e-3))
    with pytest.raises(MeshError, match='or "-z" for a body that is wider than long'):
        own_body(points, cells)
    assert own_body(points, cells, Stated(tip="-z")).half.points[:, 2].max() == pytest.approx(4e-3)


def test_a_leaning_axis_is_told():
    points, cells = taper(end=1.0, whole=True)
    points[:, 0] += 0.1 * points[:, 2]
    assert "leans by 5.9" in " ".join(own_body(points, cells).told)
