"""A user's own mesh: read in any format, checked, cut to its half; its mass and shape."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from own_bodies import box, taper, write

import meshes
from meshes import MeshError, own_body, read_own

TURNED = [4, 5, 6, 7, 0, 1, 2, 3]


@pytest.mark.parametrize("ending", [".msh", ".inp", ".vtu", ".vtk", ".bdf", ".mesh"])
@pytest.mark.parametrize("whole", [False, True])
def test_formats_of_meshio_give_the_same_half(tmp_path, ending, whole):
    points, cells = taper(whole=whole)
    half = read_own(write(tmp_path / f"bar{ending}", (1e3 * points).round(6), cells), 1e-3).half
    plain = own_body(*taper()).half
    assert len(half.cells) == 80
    assert (half.cells == plain.cells).all()
    assert half.points == pytest.approx(plain.points, abs=1e-9)
    assert half.faces_with(meshes.SYMMETRY).shape == (40, 4)
    assert (half.points[np.unique(half.faces_with(meshes.SYMMETRY)), 1] == 0.0).all()


def test_a_read_mesh_keeps_every_bit(tmp_path):
    points, cells = taper()
    half = read_own(write(tmp_path / "bar.vtu", points, cells)).half
    order = np.lexsort(points.round(9).T)
    assert (half.points == points[order]).all()
    assert {frozenset(row) for row in order[half.cells].tolist()} == {
        frozenset(row) for row in cells.tolist()
    }


def test_surface_cells_and_loose_points_are_left_out(tmp_path):
    points, cells = taper()
    quads = cells[:, [0, 1, 2, 3]]
    path = write(tmp_path / "bar.vtu", np.vstack([points, [[9.0, 9.0, 9.0]]]), cells, quad=quads)
    assert len(read_own(path).half.points) == len(points)


@given(
    end=st.floats(0.3, 1.0),
    shift=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    cells=st.tuples(st.integers(1, 3), st.integers(1, 2), st.integers(2, 6)),
)
@example(end=1.0, shift=(5.96e-8, 0.0), cells=(1, 1, 2))
@settings(max_examples=30, deadline=None)
def test_anywhere_along_x_and_z_a_body_has_the_same_half_and_volume(end, shift, cells):
    points, hexes = taper(end=end, cells=cells, whole=True)
    half = own_body(points + np.array([shift[0], 0.0, shift[1]]), hexes).half
    a, b, length = 12e-3 * end, 12e-3, 60e-3
    assert 2 * meshes.volume(half) == pytest.approx(length / 3 * (a * a + a * b + b * b), rel=0.01)
    moment = meshes.cell_moments(half)
    assert moment.volume.sum() == pytest.approx(meshes.volume(half), rel=1e-12)
    # a body so near to its place stays there: 1e-5 of its diameter
    assert abs(moment.x.sum()) < 1e-5 * 2 * b * moment.volume.sum()
    assert half.points[:, 2].min() == 0.0
    assert (half.points[:, 1] >= 0.0).all()


def with_node(move):
    points, cells = taper()
    points[cells[7, 6]] += move
    return points, cells


def doubled(factor):
    points, cells = taper()
    return np.vstack([points, points + factor]), np.vstack([cells, cells + len(points)])


def stacked():
    """Two equal boxes, one on the other, whose nodes between them were not merged."""
    points, cells = box(4, 4, 5, (0, 0, 0), (1, 1, 3))
    return np.vstack([points, points + np.array([0, 0, 3])]), np.vstack([cells, cells + len(points)])


def cracked(width):
    """A bar whose upper half has nodes of its own, ``width`` edges higher, on a layer but at its rim."""
    points, cells = taper(end=1.0)
    inside = np.flatnonzero((points[:, 2] == 30e-3) & (np.abs(points[:, 0]) < 5e-3))
    new = np.arange(len(points))
    new[inside] = len(points) + np.arange(len(inside))
    upper = points[cells][:, :, 2].mean(axis=1) > 30e-3
    return (
        np.vstack([points, points[inside] + [0.0, 0.0, width * 3e-3]]),
        np.where(upper[:, None], new[cells], cells),
    )


def hanging():
    points, cells = box(1, 1, 1, (0, 0, 0), (1, 1, 1))
    more, fine = box(2, 2, 2, (0, 0, 1), (1, 1, 2))
    both = np.vstack([points, more])
    places, new = np.unique(both.round(9), axis=0, return_inverse=True)
    return places, new.reshape(-1)[np.vstack([cells, fine + len(points)])]


def edge_to_edge():
    """A wall of 3 by 4 cells with two holes that meet at an edge."""
    points, cells = box(3, 1, 4, (0, 0, 0), (3, 1, 4))
    x, _, z = np.floor(points[cells].mean(axis=1)).T
    return points, cells[~((x == 1) & (z == 1) | (x == 0) & (z == 2))]


def leaning():
    """A whole bar whose layers of cells lean across the plane of symmetry."""
    points, cells = taper(whole=True, end=1.0)
    points[:, 1] += 0.5 * points[:, 0]
    return points, cells


REFUSED = {
    "folded": (lambda: with_node([0, 0, 20e-3]), r"has \d+ of 80 cells that are folded or inside out"),
    "some inside out": (
        lambda: (taper()[0], np.where(np.arange(80)[:, None] < 3, taper()[1][:, TURNED], taper()[1])),
        "3 of 80 cells that are folded or inside out",
    ),
    "two bodies": (lambda: doubled([0.0, 0.0, 0.1]), r"is in 2 parts .* \(of 80, 80 cells\)"),
    "nodes not merged": (lambda: stacked(), r"has 25 pairs of nodes in one place"),
    "a crack": (lambda: cracked(1e-4), r"has 9 pairs of nodes in one place, up to 0.0003 mm apart"),
    "hanging nodes": (hanging, "in the middle of an edge or face of another cell"),
    "edge to edge": (edge_to_edge, "not closed: .* 4 outer faces meet"),
    "along x": (
        lambda: (taper()[0][:, [2, 1, 0]] * [1, 1, -1], taper()[1]),
        "12 mm long along z and 60 mm along x",
    ),
    "plane within cells": (leaning, r"has \d+ cells across the plane y = 0"),
    "plane beside the middle": (
        lambda: (taper(whole=True, cells=(2, 1, 4))[0] + [0, 1e-3, 0], taper(whole=True, cells=(2, 1, 4))[1]),
        r"is not symmetric about the plane y = 0",
    ),
    "beside the plane": (lambda: (taper()[0] + [0, 1e-3, 0], taper()[1]), "lies beside y = 0 without"),
}


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_what_is_no_half_body_is_refused_with_its_reason(name):
    make, reason = REFUSED[name]
    with pytest.raises(MeshError, match=reason):
        own_body(*make())


def test_an_unsymmetric_body_is_refused():
    points, cells = taper(whole=True)
    far = points[:, 1] > 1e-6
    points[far, 1] *= 1.1
    with pytest.raises(MeshError, match=r"is not symmetric about the plane y = 0: \d+ of 275 nodes"):
        own_body(points, cells)


@pytest.mark.parametrize("away", [4e-6, 3e-3])
@pytest.mark.parametrize("tip", ["-z", "+x", "-y"])
def test_a_whole_mesh_beside_its_plane_has_the_same_half(tmp_path, away, tip):
    """It was refused, or, of tetrahedra, cut beside the middle of its width."""
    points, cells = taper(whole=True)
    in_place = own_body(points, cells).half
    points = points + np.array([0.0, away, 0.0])
    moved = {"-z": points, "+x": points[:, [2, 1, 0]] * [-1, 1, 1], "-y": points[:, [1, 2, 0]]}[tip]
    found = read_own(write(tmp_path / "bar.vtu", moved, cells), 1.0, meshes.Stated(tip=tip))
    assert meshes.volume(found.half) == pytest.approx(meshes.volume(in_place), rel=1e-9)
    assert found.half.points == pytest.approx(in_place.points, abs=1e-9)
    axis = "x" if tip == "-y" else "y"
    assert found.told[0] == f"its plane of symmetry is taken at {axis} = {1e3 * away:g} mm"


def test_half_at_negative_y_is_mirrored():
    points, cells = taper()
    half = own_body(points * [1, -1, 1], cells[:, TURNED]).half
    assert half.points[:, 1].min() == 0.0
    assert meshes.volume(half) == pytest.approx(meshes.volume(own_body(points, cells).half), rel=1e-12)


@pytest.mark.parametrize("ending", [".stl", ".ply", ".vtu"])
def test_of_surfaces_alone_it_is_told_whether_they_are_closed(tmp_path, ending):
    half = own_body(*taper()).half
    triangles = half.faces[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    path = write(tmp_path / f"skin{ending}", half.points, triangles, "triangle")
    told = f"no volume cells: {len(triangles)} cells of type triangle alone. The surface is closed: fill it"
    with pytest.raises(MeshError, match=told):
        read_own(path)
    with pytest.raises(MeshError, match="cells that name points that are not there"):
        read_own(write(tmp_path / "cut.vtu", half.points[:9], triangles, "triangle"))
    write(path, half.points, triangles[1:], "triangle")
    told = f"The surface is open: 3 of {len(triangles) * 3 // 2} edges bound one face, 0 more than two"
    with pytest.raises(MeshError, match=told):
        read_own(path)


GRID = "PUnstructuredGrid"
XML = f'<VTKFile type="{GRID}"><{GRID}><PPoints>{{}}</PPoints>{{}}</{GRID}></VTKFile>'


def test_pieces_of_one_mesh_are_joined_and_are_its_content(tmp_path):
    points, cells = taper()
    for name, part in (("a", cells[:40]), ("b", cells[40:])):
        used, new = np.unique(part, return_inverse=True)
        write(tmp_path / f"{name}.vtu", points[used], new.reshape(-1, 8))
    pieces = '<Piece Source="a.vtu"/><Piece Source="b.vtu"/>'
    array = '<PDataArray type="Float64" NumberOfComponents="3"/>'
    (tmp_path / "all.pvtu").write_text(XML.format(array, pieces))
    assert meshes.volume(read_own(tmp_path / "all.pvtu").half) == pytest.approx(
        meshes.volume(own_body(points, cells).half)
    )
    assert [one.name for one in meshes.included(tmp_path / "all.pvtu")] == ["a.vtu", "b.vtu"]


@pytest.mark.parametrize("ending", [".msh", ".inp", ".vtu", ".vtk", ".bdf", ".med"])
def test_files_of_garbage_are_refused_in_one_sentence(tmp_path, ending):
    path = tmp_path / f"bad{ending}"
    path.write_bytes(b"\x00\xff garbage\n" * 50)
    with pytest.raises(MeshError, match=r"not readable|holds no volume cells") as told:
        read_own(path)
    assert "\n" not in str(told.value)


def test_missing_files_and_unknown_endings_are_refused(tmp_path):
    with pytest.raises(MeshError, match="no such file"):
        read_own(tmp_path / "none.vtu")
    with pytest.raises(MeshError, match=r"is a drawing without a mesh\. Mesh it"):
        read_own(tmp_path / "part.step")


def test_nodes_and_cells_of_one_body_have_one_order():
    """Whatever the order in the file, that of the corners of a cell included."""
    points, cells = taper(cells=(3, 2, 4))
    plain, rng = own_body(points, cells).half, np.random.default_rng(5)
    quarter = [1, 2, 3, 0, 5, 6, 7, 4]  # turned about one axis of the cell, and about another
    over = [3, 2, 6, 7, 0, 1, 5, 4]
    mixed = cells.copy()
    for turn in (quarter, over, over, quarter):
        chosen = rng.random(len(cells)) < 0.6
        mixed[chosen] = mixed[chosen][:, turn]
    nodes, rows = rng.permutation(len(points)), rng.permutation(len(cells))
    new = np.argsort(nodes)
    other = own_body(points[nodes], new[mixed][rows]).half
    assert (other.points == plain.points).all()
    assert (other.cells == plain.cells).all()
