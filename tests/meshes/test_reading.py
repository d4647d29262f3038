"""A mesh written in the form of each program and read back: mass, inertia and lowest point are the same."""

import re

import decks
import meshio
import numpy as np
import pytest
from own_bodies import taper

import meshes
from meshes import MeshError, own_body, read_own
from meshes.fallen import as_they_are
from meshes.hexahedra import as_hexahedra
from meshes.quality import corner_jacobians
from meshes.reading.read import stored_mesh
from meshes.reading.stored import StoredMesh
from meshes.reading.text import included

TETRAHEDRA = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
WEDGES = [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]]


def cells_of(kind, cells=(3, 2, 5), **sizes):
    """Return a tapered bar, in mm, of cells of a kind."""
    points, cells = taper(cells=cells, **sizes)
    split = {"tetra": TETRAHEDRA, "wedge": WEDGES}.get(kind)
    return 1e3 * points, cells[:, split].reshape(-1, len(split[0])) if split else cells


def summary(half):
    """Return mass, centre and inertia of a half body of density 1, and its lowest point."""
    part = meshes.cell_moments(half)
    sums = [part.volume.sum(), part.x.sum(), part.z.sum(), part.xx.sum(), part.zz.sum()]
    lowest = half.points[np.lexsort(half.points.T.round(9))[0]]
    scale = sums[0] * np.array([1.0, 0.06, 0.06, 0.06**2, 0.06**2])
    return np.concatenate([sums / scale, lowest / 0.06])


@pytest.mark.parametrize("ending", decks.ENDINGS)
@pytest.mark.parametrize("kind", ["hexahedron", "tetra", "wedge"])
def test_every_format_gives_mass_inertia_and_lowest_point(tmp_path, ending, kind):
    """Of a body drawn at random, and moved away from the origin along x and z."""
    rng = np.random.default_rng([*map(ord, ending), *map(ord, kind)])
    width, end, number = rng.uniform(4e-3, 20e-3), rng.uniform(0.3, 1.0), rng.integers(1, 5, 3)
    sizes = {"width": width, "end": end, "length": width * rng.uniform(1.5, 9.0)}
    points, cells = cells_of(kind, (1 + number[0], number[1], 2 + number[2]), **sizes)
    points += rng.uniform(-30.0, 30.0, 3).round(3) * [1.0, 0.0, 1.0]
    body = read_own(decks.write(tmp_path / f"bar{ending}", points, cells), 1e-3)
    made = as_hexahedra(points / 1e3, ((kind, cells),))
    wanted = summary(own_body(made.points, made.cells).half)
    assert summary(body.half) == pytest.approx(wanted, rel=1e-6, abs=1e-6)
    assert len(body.half.cells) == len(cells) * {"hexahedron": 1, "tetra": 4, "wedge": 6}[kind]
    same = own_body(made.points, made.cells).half
    assert (body.half.cells == same.cells).all()
    assert body.half.points == pytest.approx(same.points, abs=1e-9)


def volume_of(path, stated=None):
    return 2e9 * meshes.volume(read_own(path, 1e-3, stated).half)


def parts(text, moves="", more="", assembly=""):
    """Return a deck of one part of the bar, standing in an assembly."""
    body = text.partition("*node")[2].partition("*material")[0]
    instance = f"*INSTANCE, NAME=Rod-1, PART=rod\n{moves}*END INSTANCE\n"
    return (
        f"*PART, NAME=Rod\n*node{body}*END PART\n*ASSEMBLY, NAME=A\n{instance}{more}{assembly}*END ASSEMBLY\n"
    )


def square():
    """Return a whole bar of 12 x 12 x 60 mm, in mm."""
    points, cells = taper(end=1.0, cells=(2, 1, 5), whole=True)
    return 1e3 * points, cells


def test_an_instance_is_moved_and_then_turned(tmp_path):
    points, cells = square()
    laid = np.stack([points[:, 2], points[:, 1], -points[:, 0]], axis=1)  # turned about y by 90 deg
    there = laid - [10.0, 3.0, 0.0]
    moves = "10., 3., 0.\n0., 0., 0., 0., 1., 0., -90.\n"
    deck = tmp_path / "turned.inp"
    deck.write_text(parts(decks.abaqus(there, cells), moves))
    body = read_own(deck, 1e-3)
    plain = own_body(points / 1e3, cells).half
    assert summary(body.half) == pytest.approx(summary(plain), abs=1e-9)
    assert {"Rod-1".upper(), "LOW", "HIGH"} <= set(body.sets)


def test_two_instances_are_both_there_and_one_may_be_named(tmp_path):
    points, cells = square()
    second = "*INSTANCE, NAME=WALL-1, PART=ROD\n0., 0., -61.\n*END INSTANCE\n"
    deck = tmp_path / "two.inp"
    deck.write_text(parts(decks.abaqus(points, cells), more=second))
    with pytest.raises(MeshError, match=r'in 2 parts .* mesh_sets = \[\.\.\.\] of .*"ROD-1", "WALL-1"'):
        read_own(deck, 1e-3)
    assert volume_of(deck, meshes.Stated(sets=("rod-1",))) == pytest.approx(8640.0)
    with pytest.raises(MeshError, match="has no set of cells 'ROD-2'; it has HIGH, LOW, ROD-1, WALL-1"):
        read_own(deck, 1e-3, meshes.Stated(sets=("ROD-2",)))


def test_reference_points_and_shells_are_told(tmp_path):
    points, cells = square()
    point = "*NODE\n1, 0., 0., -10.\n*NSET, NSET=RP\n1,\n"
    beam = "*element, type=B32, elset=skin\n9002, 1, 2, 3\n*END PART"
    deck = tmp_path / "rp.inp"
    deck.write_text(parts(decks.abaqus(points, cells), assembly=point).replace("*END PART", beam))
    body = read_own(deck, 1e-3)
    assert body.told[0] == "left out: 1 cell of type S3, 1 cell of type B32"


# by ending: what a deck of the bar is told of masses without volume, and where its last line comes after
MASSES = {
    ".inp": "*ELEMENT, TYPE=MASS, ELSET=M\n8001, 2\n*mass, elset=m\n0.5,\n",
    ".bdf": "CONM2,99,2,,0.25\nPARAM,WTMASS,2.\nENDDATA",
    ".k": f"*ELEMENT_MASS\n{9001:8d}{2:8d}{0.5:16.3f}\n*END",
    ".rad": f"/ADMAS/5/1\nlead\n{0.5:20.3f}{2:10d}\n",
    ".cdb": "ET,3,21\nR,7,0.5\nEBLOCK,19,SOLID\n(19i10)\n"
    + "".join(f"{v:10d}" for v in (1, 3, 7, 1, 0, 0, 0, 0, 1, 0, 9001, 2))
    + f"\n{-1:10d}\nFINISH\n",
}
MORE = {
    ".inp": "*NONSTRUCTURAL MASS, ELSET=LOW, UNITS=TOTAL MASS\n0.5,\n",
    ".bdf": "CMASS2,98,0.5,5,1\nENDDATA",
    ".k": f"*ELEMENT_MASS_PART\n{3:8d}{0.5:16.3f}\n*END",
    ".rad": f"/GRNOD/NODE/6\nsome\n         1         3\n/ADMAS/0/1\nlead\n{0.25:20.3f}{6:10d}\n",
    ".cdb": "ET,3,21\nRLBLOCK,1,7,7,7\n(2i8,6g16.9)\n(7g16.9)\n"
    + f"{7:8d}{7:8d}{0.5:16.9f}\n{0.0:16.9f}\n"
    + MASSES[".cdb"].partition("R,7,0.5\n")[2],
}


@pytest.mark.parametrize("ending", MASSES)
def test_masses_without_volume_are_known_with_their_place(tmp_path, ending):
    points, cells = square()
    path = decks.write(tmp_path / f"m{ending}", points, cells)
    text = re.split("ENDDATA|[*]END|FINISH", path.read_text())[0]
    path.write_text(text + MASSES[ending])
    (mass,) = read_own(path, 1e-3).masses
    assert (mass.count, mass.mass, mass.own) == (1, pytest.approx(0.5), True)
    assert mass.place == pytest.approx(points[1] / 1e3)
    path.write_text(text + MORE[ending])
    (mass,) = read_own(path, 1e-3).masses
    assert (mass.count, mass.mass, mass.own) == (1, pytest.approx(0.5), True)


def test_a_mass_at_a_node_of_another_body_is_not_the_bodys_own(tmp_path):
    points, cells = square()
    mass = "*NODE\n1, 0., 0., -10.\n*ELEMENT, TYPE=MASS, ELSET=M\n1, 1\n2, ROD-1.1\n*MASS, ELSET=M\n0.5,\n"
    deck = tmp_path / "m.inp"
    deck.write_text(parts(decks.abaqus(points, cells), assembly=mass))
    (both,) = read_own(deck, 1e-3).masses
    assert (both.count, both.mass, both.place, both.own) == (2, 1.0, pytest.approx((0, 0, -0.01)), True)
    other, own = read_own(deck, 1e-3, meshes.Stated(sets=("ROD-1",))).masses
    assert (other.own, own.own, own.place) == (False, True, None)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("*NGEN, LINE=C\n1, 5, 1", r"makes nodes or cells by \*NGEN with LINE, which is not read"),
        ("*NGEN\n1, 5000", r"by \*NGEN from the node 5000, which is not there"),
        ("*NFILL\nA, B, 3", r"names a set 'A' by \*NFILL, which is not there"),
        ("*INCLUDE, INPUT=mesh.inp", r"takes a part from the file 'mesh.inp', which is not beside it"),
        ("*NODE, INPUT=nodes.txt", r"takes a part from the file 'nodes.txt', which is not beside it"),
        ("*ELEMENT, TYPE=C3D8\n999, 1, 2, 3, 4, 5, 6, 7, 9999", "a cell 999 that names the node 9999"),
        ("*ELEMENT, TYPE=CIN3D8\n999, 1, 2, 3, 4, 5, 6, 7, 8", "infinite cells"),
    ],
)
def test_what_an_abaqus_deck_makes_by_other_rules_is_refused(tmp_path, line, reason):
    (tmp_path / "a.inp").write_text(decks.abaqus(*square()) + line + "\n")
    with pytest.raises(MeshError, match=reason):
        read_own(tmp_path / "a.inp", 1e-3)


def test_nodes_and_cells_by_rules_are_those_of_the_same_bar_written_out(tmp_path):
    """Rows, a filled bottom, a copy that is moved and turned, filled up; two rows of cells and their copy."""
    (tmp_path / "rules.inp").write_text("""*NODE
1,-6,-6,0
3,6,-6,0
201,-6,6,0
203,6,6,0
*NGEN,NSET=A
1,3
*NGEN,NSET=B
201,203,1
*NFILL,NSET=LOW
A,B,2,100
*NCOPY, OLD SET=LOW, CHANGE NUMBER=5000, SHIFT, NEW SET=HIGH
0,0,60
0,0,0,0,0,1,360
*NFILL
LOW,HIGH,5,1000
*ELEMENT,TYPE=C3D8
1,1,2,102,101,1001,1002,1102,1101
*ELGEN,ELSET=FRONT
1,2,1,1,1,0,0,5,1000,10
*ELCOPY,OLD SET=FRONT,ELEMENT SHIFT=100,SHIFT NODES=100,NEW SET=BACK
""")
    points, cells = square()
    plain = own_body(points / 1e3, cells).half
    body = read_own(tmp_path / "rules.inp", 1e-3)
    assert summary(body.half) == pytest.approx(summary(plain), abs=1e-9)
    assert len(body.half.cells) == len(plain.cells)
    assert set(body.sets) == {"BACK"}  # the half y >= 0


def test_a_mesh_of_calculix_is_known_by_its_content(tmp_path):
    (tmp_path / "all.msh").write_text(decks.abaqus(*square()))
    assert volume_of(tmp_path / "all.msh") == pytest.approx(8640.0)


def test_a_name_means_the_set_of_just_its_letters_or_the_only_one_alike(tmp_path):
    """Gmsh tells CORE from Core; a group that is turned round has a negative number in version 2."""
    points, cells = square()
    blocks = [("hexahedron", cells)]
    marks = {"gmsh:physical": [np.where(points[cells][:, :, 2].mean(axis=1) < 24.0, -1, 2)]}
    marks["gmsh:geometrical"] = [np.ones(len(cells), int)]
    names = {"CORE": np.array([1, 3]), "Core": np.array([2, 3])}
    mesh = meshio.Mesh(points, blocks, cell_data=marks, field_data=names)
    meshio.write(tmp_path / "c.msh", mesh, file_format="gmsh22", binary=False)
    stored = stored_mesh(tmp_path / "c.msh")
    sizes = {name: len(of) for name, of in stored.sets.items()}
    assert (sizes["CORE"], sizes["Core"]) == (8, 12)
    with pytest.raises(MeshError, match="has no set of cells 'core', but CORE and Core: name one of them"):
        read_own(tmp_path / "c.msh", 1e-3, meshes.Stated("whole", sets=("core",)))
    for name, count in (("CORE", 8), ("Core", 12)):
        chosen = read_own(tmp_path / "c.msh", 1e-3, meshes.Stated("whole", "-z", sets=(name,)))
        assert 2e9 * meshes.volume(chosen.half) == pytest.approx(432.0 * count)


def test_the_first_gmsh_files_of_version_2_name_groups_without_a_dimension(tmp_path):
    points, cells = square()
    lines = [
        "$MeshFormat",
        "2.0 0 8",
        "$EndMeshFormat",
        "$PhysicalNames",
        "1",
        '7"my bar"',
        "$EndPhysicalNames",
    ]
    lines += ["$Nodes", str(len(points)), *(f"{n} {x} {y} {z}" for n, (x, y, z) in decks.numbered(points))]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{n} 5 2 7 1 {' '.join(map(str, cell))}" for n, cell in decks.numbered(cells + 1)]
    (tmp_path / "two.msh").write_text("\n".join([*lines, "$EndElements", ""]))
    assert set(read_own(tmp_path / "two.msh", 1e-3).sets) == {"VOLUME 1", "my bar"}


def test_an_abaqus_system_moves_and_turns_the_nodes_that_follow(tmp_path):
    points, cells = square()
    local = np.stack([points[:, 1], -points[:, 0], points[:, 2] - 5.0], axis=1)
    text = decks.abaqus(local, cells).replace("*node, nset=all", "*SYSTEM\n0,0,5, 0,1,5\n-1,0,5\n*node")
    (tmp_path / "s.inp").write_text(text)
    plain = own_body(points / 1e3, cells).half
    # the second axis of the system is -x: its x axis is y
    assert summary(read_own(tmp_path / "s.inp", 1e-3).half) == pytest.approx(summary(plain), abs=1e-9)


def cylindrical(point):
    x, y, z = point
    return np.array([np.hypot(x, y), np.degrees(np.arctan2(y, x)), z])


def spherical(point):
    r = np.linalg.norm(point)
    around = np.degrees(np.arctan2(point[1], point[0]))
    return np.array([r, np.degrees(np.arccos(point[2] / r)) if r else 0.0, around])


@pytest.mark.parametrize(
    ("card", "place"),
    [
        ("CORD2R,5,,1.,2.,3.,1.,2.,4.,\n,1.,3.,3.", lambda p: np.array([p[1] - 2, 1 - p[0], p[2] - 3])),
        ("CORD2C,5,,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.", cylindrical),
        ("CORD2S,5,,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.", spherical),
    ],
)
@pytest.mark.parametrize("default", [False, True])
def test_nastran_coordinates_are_those_of_their_system(tmp_path, card, place, default):
    points, cells = square()
    text = decks.nastran(points, cells, 0 if default else 5, place)
    more = f"{card}\nGRDSET,,5\n" if default else f"{card}\n"
    (tmp_path / "c.bdf").write_text(text.replace("ENDDATA", f"{more}ENDDATA"))
    body = read_own(tmp_path / "c.bdf", 1e-3)
    assert summary(body.half) == pytest.approx(summary(own_body(points / 1e3, cells).half), abs=1e-9)
    assert list(body.sets) == ["PID 7"]


def test_nastran_fields_of_eight_characters(tmp_path):
    points, cells = square()
    lines = [f"GRID    {n:8d}        {x:8.3f}{y:8.3f}{z:8.3f}" for n, (x, y, z) in decks.numbered(points)]
    lines[0] = lines[0].replace("  -6.000", "  -6.0+0")
    for n, cell in decks.numbered(cells + 1):
        six, two = "".join(f"{v:8d}" for v in cell[:6]), "".join(f"{v:8d}" for v in cell[6:])
        lines += [f"CHEXA   {n:8d}{3:8d}{six}+E{n}", f"+E{n}".ljust(8) + two]
    (tmp_path / "f.nas").write_text("\n".join(lines))
    assert volume_of(tmp_path / "f.nas") == pytest.approx(8640.0)


def test_archives_keep_components_and_lsdyna_titles(tmp_path):
    points, cells = square()
    body = read_own(decks.write(tmp_path / "a.cdb", points, cells), 1e-3)
    assert set(body.sets) <= {"FIRST"}
    body = read_own(decks.write(tmp_path / "a.k", points, cells), 1e-3)
    assert set(body.sets) == {"PART 3", "striker"}
    assert body.told[0] == "left out: 1 wall (*RIGIDWALL_PLANAR)"


@pytest.mark.parametrize("ending", [".inp", ".bdf", ".cdb"])
def test_middles_of_edges_shape_the_body(tmp_path, ending):
    """Hexahedra of 20 nodes whose outer edges bulge along x by 1 mm hold 2/3 of it more width."""
    points, cells = taper(end=1.0, cells=(1, 1, 1))
    points = 1e3 * points
    ends = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    middles = np.array([points[cells[0, list(pair)]].mean(axis=0) for pair in ends])
    upright = middles[:, 2] == 30.0
    middles[upright, 0] *= 1.0 + 1.0 / 6.0  # halfway up it is 14 mm wide instead of 12 mm
    fine = np.concatenate([cells[0], len(points) + np.arange(12)])[None]
    path = decks.write(tmp_path / f"m{ending}", np.vstack([points, middles]), fine)
    body = read_own(path, 1e-3, meshes.Stated("half"))
    assert len(body.half.cells) == 8
    # the facets between 12 mm and 14 mm: the mean width is 13 mm
    assert 2e9 * meshes.volume(body.half) == pytest.approx(13.0 * 12.0 * 60.0, rel=1e-9)


@pytest.mark.parametrize("ending", [".vtu", ".vtk"])
def test_wedges_with_middles_of_edges_are_read_from_vtk(tmp_path, ending):
    """As above; meshio reads such wedges, but lacks their dimension."""
    import pyvista

    points, cells = taper(end=1.0, cells=(1, 1, 1))
    edges = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
    places, wedges = list(1e3 * points), []
    for corners in cells[0][np.array(WEDGES)].tolist():
        middles = [0.5 * (places[corners[a]] + places[corners[b]]) for a, b in edges]
        scaled = [place * [7 / 6 if place[2] == 30.0 else 1.0, 1.0, 1.0] for place in middles]
        wedges.append([*corners, *range(len(places), len(places) + 9)])
        places += scaled
    kind = pyvista.CellType.QUADRATIC_WEDGE
    pyvista.UnstructuredGrid({kind: np.array(wedges)}, np.array(places)).save(tmp_path / f"w{ending}")
    body = read_own(tmp_path / f"w{ending}", 1e-3, meshes.Stated("half"))
    assert len(body.half.cells) == 12
    assert 2e9 * meshes.volume(body.half) == pytest.approx(13.0 * 12.0 * 60.0, rel=1e-9)


@pytest.mark.parametrize("kind", ["hexahedron", "tetra", "wedge"])
def test_nodes_numbered_the_other_way_round_are_put_right_where_all_agree(tmp_path, kind):
    """As in MED, of which Salome numbers hexahedra with the upper face first."""
    points, cells = cells_of(kind)
    order = {"hexahedron": [4, 5, 6, 7, 0, 1, 2, 3], "tetra": [0, 2, 1, 3], "wedge": [3, 4, 5, 0, 1, 2]}[kind]
    body = read_own(decks.write(tmp_path / "bar.med", points, cells[:, order]), 1e-3)
    plain = read_own(decks.write(tmp_path / "bar.vtu", points, cells), 1e-3)
    assert summary(body.half) == pytest.approx(summary(plain.half), abs=1e-12)
    assert f"the order of the nodes of each {kind} is turned round" in body.told


def test_a_missing_library_has_its_own_exit_code(tmp_path, monkeypatch):
    from fem_impact.errors import MissingLibraryError
    from fem_impact.scene.own_mesh import OwnMesh

    points, cells = cells_of("hexahedron")
    mesh = OwnMesh.of(str(decks.write(tmp_path / "bar.exo", points, cells)), "mm")
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(
        MissingLibraryError, match=r"bar\.exo: a file \.exo is read by the library h5py"
    ) as told:
        mesh.body()
    assert told.value.exit_code == 7


@pytest.mark.parametrize("ending", [".inp", ".bdf", ".rad", ".k"])
def test_included_files_are_read_and_part_of_the_content(tmp_path, ending):
    from fem_impact.scene.own_mesh import OwnMesh

    points, cells = square()
    text = decks.write(tmp_path / f"bar{ending}", points, cells).read_text()
    mark = {".inp": "*element", ".bdf": "CHEXA,1,", ".rad": "/PART", ".k": "*ELEMENT_SOLID"}[ending]
    line = {
        ".inp": "*Include, input=more.txt\n",
        ".bdf": "INCLUDE 'more.txt'\n",
        ".rad": "#include more.txt\n",
        ".k": "*INCLUDE\n$ the cells\nmore.txt\n",
    }[ending]
    first, _, more = text.partition(mark)
    main, other = tmp_path / f"main{ending}", tmp_path / "more.txt"
    other.write_text(mark + more)
    main.write_text(first + line)
    assert volume_of(main) == pytest.approx(8640.0)
    if ending == ".inp":  # the lines of data of a keyword alone
        rows = first.partition("*Node\n")
        (tmp_path / "nodes.txt").write_text(rows[2])
        main.write_text(f"{rows[0]}*Node, Input=nodes.txt, nset=n\n{line}")
        assert volume_of(main) == pytest.approx(8640.0)
        assert len(included(main)) == 2
    before = OwnMesh.of(str(main), "mm").content
    other.write_text(mark + more + "\n")
    assert OwnMesh.of(str(main), "mm").content != before
    other.unlink()
    with pytest.raises(MeshError, match=r"takes a part from the file 'more.txt', which is not beside it"):
        read_own(main, 1e-3)


@pytest.mark.parametrize(
    ("kind", "order"), [("tetra", [0, 2, 1, 3]), ("hexahedron", [4, 5, 6, 7, 0, 1, 2, 3])]
)
def test_cells_may_be_numbered_either_way_round_in_one_file(tmp_path, kind, order):
    points, cells = cells_of(kind)
    mixed = np.where(np.arange(len(cells))[:, None] % 3 == 0, cells[:, order], cells)
    body = read_own(decks.write(tmp_path / "bar.inp", points, mixed), 1e-3)
    plain = read_own(decks.write(tmp_path / "bar.vtu", points, cells), 1e-3)
    assert summary(body.half) == pytest.approx(summary(plain.half), abs=1e-12)


def test_a_cell_pulled_through_its_neighbour_is_not_put_right(tmp_path):
    """The lowest layer is pulled up beyond the next one: all of its cells are inside out."""
    points, cells = cells_of("hexahedron", end=1.0)
    points[points[:, 2] == 0.0, 2] = 15.0
    with pytest.raises(MeshError, match="6 of 30 cells that are folded or inside out"):
        read_own(decks.write(tmp_path / "bar.vtu", points, cells), 1e-3, meshes.Stated("half"))


def test_middles_that_are_left_out_lie_halfway_and_pyramids_are_refused(tmp_path):
    points, cells = cells_of("hexahedron")
    text = decks.nastran(points, cells)
    fine = text.replace("CHEXA,1,7,", "CHEXA,1,7,", 1).splitlines()
    at = next(k for k, line in enumerate(fine) if line.startswith("CHEXA,1,"))
    fine[at + 1] += ",,,,,,"  # the continuation holds the last corners; one middle follows
    middle = points[cells[0, :2]].mean(axis=0).tolist()
    fine[at + 1] = ",".join([*fine[at + 1].split(",")[:3], "999"])
    fine.insert(4, f"GRID*,999,,{middle[0]!r},{middle[1]!r}\n*,{middle[2]!r}")
    (tmp_path / "m.bdf").write_text("\n".join(fine))
    body = read_own(tmp_path / "m.bdf", 1e-3)
    assert len(body.half.cells) == 8 * len(cells)
    pyramid = "*ELEMENT, TYPE=C3D5\n9999, 1, 2, 3, 4, 9\n"
    (tmp_path / "p.inp").write_text(decks.abaqus(points, cells) + pyramid)
    with pytest.raises(MeshError, match="holds 1 pyramid, which cannot be split"):
        read_own(tmp_path / "p.inp", 1e-3)


def test_the_type_of_a_cell_says_how_many_of_its_nodes_are_its_corners(tmp_path):
    points, cells = square()
    text = decks.abaqus(points, cells)
    lines = text.replace("C3D8R", "C3D8I").replace("c3d8r", "c3d8i").splitlines()
    more = [line + ", 1, 2" if line.count(",") == 8 else line for line in lines]
    (tmp_path / "i.inp").write_text("\n".join(more))
    assert volume_of(tmp_path / "i.inp") == pytest.approx(8640.0)
    (tmp_path / "r.inp").write_text("\n".join(more).replace("C3D8I", "C3D8R"))
    with pytest.raises(MeshError, match=r"has a cell of type C3D8R with 10 nodes"):
        read_own(tmp_path / "r.inp", 1e-3)


def test_a_pointer_of_git_lfs_is_told_as_one(tmp_path):
    (tmp_path / "bar.vtu").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n")
    with pytest.raises(MeshError, match="is a pointer of Git LFS, not the file itself"):
        read_own(tmp_path / "bar.vtu")


@pytest.mark.parametrize("version", ["gmsh22", "gmsh", "parametric", "first", "gmsh22 binary", "gmsh binary"])
@pytest.mark.parametrize("kind", ["hexahedron", "tetra"])
def test_files_of_every_version_of_gmsh_are_read(tmp_path, version, kind):
    points, cells = cells_of(kind)
    marks = np.ones(len(cells), np.int32)
    stored = meshio.Mesh(points, [(kind, cells)])
    stored.cell_data = {"gmsh:physical": [7 * marks], "gmsh:geometrical": [marks]}
    path, form = (
        tmp_path / "bar.msh",
        "gmsh22" if version == "first" else version.replace("parametric", "gmsh").removesuffix(" binary"),
    )
    meshio.write(path, stored, file_format=form, binary="binary" in version)
    text = path.read_bytes().decode("latin-1")
    if version == "parametric":  # each node with two more numbers, its place on a surface
        head, _, rest = text.partition("$Nodes\n")
        nodes, _, rest = rest.partition("$EndNodes")
        nodes = "\n".join(f"{line} 0.1 0.2" if line.count(".") == 3 else line for line in nodes.splitlines())
        text = f"{head}$Nodes\n{nodes}\n$EndNodes{rest}"
    if version == "first":
        code = {"hexahedron": 5, "tetra": 4}[kind]
        node = [f"{n} {x!r} {y!r} {z!r}" for n, (x, y, z) in decks.numbered(points)]
        cell = [f"{n} {code} 7 1 {len(c)} {' '.join(map(str, c))}" for n, c in decks.numbered(cells + 1)]
        lines = ["$NOD", str(len(points)), *node, "$ENDNOD", "$ELM", str(len(cells)), *cell, "$ENDELM"]
        text = "\n".join(lines)
    path.write_text(text, encoding="latin-1", newline="")
    plain, body = (read_own(one, 1e-3) for one in (decks.write(tmp_path / "bar.vtu", points, cells), path))
    assert summary(body.half) == pytest.approx(summary(plain.half), abs=1e-12)
    assert set(body.sets) == {"VOLUME 1"} | ({"PHYSICAL 7"} if form == "gmsh22" else set())


def test_cells_with_more_nodes_than_their_type_has_are_refused(tmp_path):
    points, cells = cells_of("hexahedron")
    text = decks.universal(points, cells).replace(f"{7:10d}{8:10d}\n", f"{7:10d}{9:10d}\n", 1)
    first = "".join(f"{v:10d}" for v in cells[0] + 1)
    (tmp_path / "u.unv").write_text(text.replace(first, first + f"{1:10d}", 1))
    with pytest.raises(MeshError, match="a cell of type hexahedron with 9 nodes instead of 8"):
        read_own(tmp_path / "u.unv")
    bulk = decks.nastran(points, cells).splitlines()
    at = next(k for k, line in enumerate(bulk) if line.startswith("CHEXA,1,"))
    bulk[at + 1] += ",1,2,3,4,5,6\n,1,2,3,4,5,6,7,8\n,1,2"
    (tmp_path / "n.bdf").write_text("\n".join(bulk))
    with pytest.raises(MeshError, match="CHEXA 1 of more than 20 nodes"):
        read_own(tmp_path / "n.bdf")


HARD = b"1e400 nan 99999999999999999999 2147483648 -5 1.5.2 \xff\xfe 0x10 9999999".split()


@pytest.mark.parametrize("ending", [*decks.TEXTS, ".msh", ".e", ".exo", ".vtu", ".mesh", ".med"])
def test_damaged_files_are_refused_and_never_raise_anything_else(tmp_path, ending, capfd):
    """Cut off, with bytes or numbers changed, with lines doubled or left out, or in another encoding."""
    points, cells = cells_of("hexahedron")
    good = decks.write(tmp_path / f"good{ending}", points, cells).read_bytes()
    rng, refused = np.random.default_rng(11), 0
    for number in range(40):
        data = bytearray(good)
        if number % 4 == 0:
            data = data[: rng.integers(1, len(data))]
        elif number % 4 == 1:
            for place in rng.integers(0, len(data), 5):
                data[place] = rng.choice(list(b"0159-.,*$/ \nAx\x00\xff"))
        elif number % 4 == 2:
            numbers = list(re.finditer(rb"\d+", bytes(data)))
            changed = numbers[rng.integers(0, min(len(numbers), 40))]
            data[changed.start() : changed.end()] = HARD[rng.integers(0, len(HARD))]
        else:
            lines = bytes(data).split(b"\n")
            at = int(rng.integers(0, len(lines)))
            data = bytearray(b"\n".join(lines[:at] + lines[at + 1 + number % 2 :] + lines[at : at + 2]))
        if number == 39:
            data = bytearray(good.decode("latin-1").encode("utf-16"))
        path = tmp_path / f"bad{ending}"
        path.write_bytes(bytes(data))
        try:
            read_own(path, 1e-3)
        except MeshError as error:
            refused += 1
            assert "\n" not in str(error)
    assert refused > 5
    assert capfd.readouterr() == ("", "")


def test_binary_files_of_gmsh_that_are_not_read_are_told_as_such(tmp_path):
    path = tmp_path / "bar.msh"
    for begin, reason in (
        (b"4 1 8\n\x01\0\0\0\n", "is a binary file of Gmsh 4, which is not read. Save it as version 4.1"),
        (b"4.1 1 8\n\0\0\0\x01\n", "in the other order of bytes. Save it as text"),
        (b"4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Nodes\n\xff\xff", "states other counts than it holds"),
    ):
        path.write_bytes(b"$MeshFormat\n" + begin)
        with pytest.raises(MeshError, match=reason):
            read_own(path)


def test_what_would_not_end_is_refused(tmp_path):
    """A range of numbers without end, a file that includes itself, more than once."""
    points, cells = cells_of("hexahedron")
    text = decks.abaqus(points, cells)
    (tmp_path / "a.inp").write_text(text + "*ELSET, ELSET=A, GENERATE\n1, 99999999999, 1\n")
    with pytest.raises(MeshError, match=r"1 to 99999999999 in steps of 1 for a range of numbers of \*ELSET"):
        read_own(tmp_path / "a.inp")
    archive = decks.ansys(points, cells).replace(f"{1:10d}{-2:10d}", f"{1:10d}-999999999")
    (tmp_path / "a.cdb").write_text(archive)
    with pytest.raises(MeshError, match="for a range of numbers of CMBLOCK"):
        read_own(tmp_path / "a.cdb")
    (tmp_path / "b.inp").write_text("*INCLUDE, INPUT=b.inp\n" * 9 + text)
    with pytest.raises(MeshError, match=r"includes the file 'b\.inp' within itself"):
        read_own(tmp_path / "b.inp")


# by ending: what is put for what in a deck of the bar, and what is told of it
SPOILED = {
    "two nodes.inp": ("*material", "*NODE\n1, 9., 9., 9.\n*material", "two nodes 1 that differ"),
    "two cells.inp": (
        "*material",
        "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 9\n*material",
        "two cells 1 that differ",
    ),
    "moved.inp": ("*material", "*IMPERFECTION, FILE=a\n*material", r"makes nodes or cells by \*IMPERFECTION"),
    "short.inp": (
        "*element, type=s3",
        "*ELEMENT, TYPE=C3D8\n900, 1, 2\n*element, type=s3",
        "ends within the cell 900",
    ),
    "two nodes.bdf": ("ENDDATA", "GRID,1,,9.,9.,9.\nENDDATA", "two nodes 1 that differ"),
    "repeated.bdf": ("ENDDATA", "GRID,900,,9.,9.,9.\n=,*(1),=,*(1.)\nENDDATA", "repeats lines of GRID by ="),
    "long.bdf": ("ENDDATA", "CTETRA,900,7,1,2,3,9,1,2,3,4,5,6\nENDDATA", "more than ten fields"),
    "old.bdf": ("ENDDATA", "CIHEX1,900,7,1,2,3,9\nENDDATA", "cells of type CIHEX1, which are not read"),
    "two nodes.k": ("*END", f"*NODE\n{1:8d}{9:16d}{9:16d}{9:16d}\n*END", "two nodes 1 that differ"),
    "two nodes.rad": ("/PART", f"/NODE\n{1:10d}{9:20d}{9:20d}{9:20d}\n/PART", "two nodes 1 that differ"),
    "thick.rad": ("/PART", "/SHEL16/4\n1\n/PART", "cells of /SHEL16/4, which are not read"),
    "untyped.cdb": ("ET,1,185", "ET,MAT,185", "a cell 1 of a type 1 that no command ET of it defines"),
    "cut.cdb": (
        f"{-1:10d}\nCMBLOCK,FIRST,ELEM,{2:8d}\n(8i10)\n{1:10d}{-2:10d}\nFINISH\n",
        "",
        "ends within an EBLOCK",
    ),
    "cut.mdpa": ("End Elements", "", "ends within Elements, without its End"),
    "two nodes.mdpa": ("End Nodes", "1 9. 9. 9.\nEnd Nodes", "two nodes 1 that differ"),
}


@pytest.mark.parametrize("name", SPOILED)
def test_what_would_change_the_body_in_silence_is_refused(tmp_path, name):
    """Numbers that stand for two nodes or cells, and cells by rules or of kinds that are not read."""
    path = decks.write(tmp_path / name, *square())
    old, new, reason = SPOILED[name]
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(MeshError, match=reason):
        read_own(path, 1e-3)


@pytest.mark.parametrize("ending", [".inp", ".bdf", ".k", ".rad", ".cdb", ".unv", ".mdpa", ".ucd"])
def test_letters_of_any_alphabet_and_a_mark_at_the_beginning_do_not_matter(tmp_path, ending):
    """The last byte of an A with a ring is an end of line in some encodings: it must not end a comment."""
    path = decks.write(tmp_path / f"a{ending}", *square())
    comment = {".inp": "** ", ".bdf": "$ ", ".k": "$ ", ".rad": "#", ".cdb": "!", ".mdpa": "//", ".ucd": "# "}
    head = f"{comment[ending]}\u00c5ngstr\u00f6m\n" if ending in comment else ""
    path.write_bytes(f"\ufeff{head}{path.read_text()}".replace("\n", "\r\n").encode())
    assert volume_of(path) == pytest.approx(8640.0)


@pytest.mark.parametrize("stated", ["*KEYWORD I10=Y", "*KEYWORD", "*KEYWORD LONG=Y"])
def test_fields_of_ten_letters_of_lsdyna(tmp_path, stated):
    points, cells = square()
    wide, far = (20, 20) if "LONG" in stated else (10, 16)
    node = [f"{n:{wide}d}{x:{far}.4f}{y:{far}.4f}{z:{far}.4f}" for n, (x, y, z) in decks.numbered(points)]
    solid = ["".join(f"{v:{wide}d}" for v in (n, 3, *cell)) for n, cell in decks.numbered(cells + 1)]
    mark = "%" if stated == "*KEYWORD" else ""
    part = ["*PART", "", f"{3:{wide}d}", "with a blank title", f"{4:{wide}d}", ""]
    some = [
        "*SET_NODE_GENERAL",
        "1",
        "NODE, 1, 4",
        f"*ELEMENT_MASS{mark}",
        f"{900:{wide}d}{2:{wide}d}{0.5:{far}.3f}",
    ]
    lines = [stated, *part, f"*NODE{mark}", *node, "", f"*ELEMENT_SOLID{mark}", "", *solid, *some, "*END", ""]
    (tmp_path / "i.k").write_text("\n".join(lines))
    assert volume_of(tmp_path / "i.k") == pytest.approx(8640.0)
    body = read_own(tmp_path / "i.k", 1e-3)
    assert (set(body.sets), body.masses[0].mass) == ({"PART 3"}, 0.5)
    assert body.told[0] == "left out: 1 set (*SET_NODE_GENERAL)"


ROTATE = f"ROTATE    {'&zero':>10}{1.0:10.1f}" + f"{0.0:10.1f}" * 4 + f"{'-&half':>10}\n"


@pytest.mark.parametrize("steps", [ROTATE, "MIRROR,0,0,&tall,0,0,0\n", "TRANSL,1,,5\nTRANSL,0,0,2\n"])
def test_lsdyna_moves_nodes_and_takes_numbers_from_parameters(tmp_path, steps):
    """The bar lies along x, is turned over, or stands elsewhere: the same body each time."""
    points, cells = square()
    laid = points[:, [2, 1, 0]] * [1, 1, -1] if steps is ROTATE else points
    head, part, text = decks.lsdyna(laid, cells).partition("*NODE")
    stated = f"*PARAMETER\nRzero, 0.0, Ihalf,90\nR{'tall':<9}{30.0:10.1f}\n"
    nodes = "*SET_NODE_LIST_GENERATE_TITLE\nThe R&D rod\n9\n1, 9000\n"
    moved = f"*NODE_TRANSFORM\n4,9\n*DEFINE_TRANSFORMATION\n         4\n{steps}"
    (tmp_path / "a.k").write_text(head + stated + nodes + moved + part + text)
    plain = read_own(decks.write(tmp_path / "b.k", points, cells), 1e-3)
    assert summary(read_own(tmp_path / "a.k", 1e-3).half) == pytest.approx(summary(plain.half), abs=1e-9)


@pytest.mark.parametrize(
    ("steps", "reason"),
    [
        ("TRANSL,1,0,0\nROTATE,0,1,0,0,0,0,90\n", r"_TRANSFORMATION 4 in steps whose order matters"),
        ("ROTATE,1,2,90\n", r"moves nodes by ROTATE of \*DEFINE_TRANSFORMATION, which is not read"),
        ("TRANSL,&far,0,0\n", r"has the parameter &far, which no \*PARAMETER of it states"),
    ],
)
def test_moves_of_lsdyna_that_are_not_certain_are_refused(tmp_path, steps, reason):
    text = decks.lsdyna(*square())
    (tmp_path / "a.k").write_text(text.replace("*NODE", f"*DEFINE_TRANSFORMATION\n4\n{steps}*NODE", 1))
    with pytest.raises(MeshError, match=reason):
        read_own(tmp_path / "a.k", 1e-3)


def test_a_blank_title_of_radioss_is_one_line(tmp_path):
    path = decks.write(tmp_path / "a.rad", *square())
    group = f"/GRNOD/NODE/6\n\n{1:10d}\n{3:10d}\n/ADMAS/0/1\n\n{0.25:20.3f}{6:10d}\n"
    path.write_text(path.read_text() + group)
    (mass,) = read_own(path, 1e-3).masses
    assert mass.mass == pytest.approx(0.5)


def test_a_cell_that_gmsh_writes_once_for_each_of_its_groups_is_one(tmp_path):
    points, cells = square()
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += [f"{n} {x} {y} {z}" for n, (x, y, z) in decks.numbered(points)]
    rows = [f"5 2 {group} 1 {' '.join(map(str, cell))}" for group in (7, 8) for cell in (cells + 1).tolist()]
    lines += ["$EndNodes", "$Elements", str(len(rows)), *(f"{n} {row}" for n, row in enumerate(rows, 1))]
    (tmp_path / "two.msh").write_text("\n".join([*lines, "$EndElements", ""]))
    assert volume_of(tmp_path / "two.msh") == pytest.approx(8640.0)
    assert set(read_own(tmp_path / "two.msh", 1e-3).sets) == {"VOLUME 1", "PHYSICAL 7", "PHYSICAL 8"}


@pytest.mark.parametrize("ending", [".vtk", ".vtu", ".vti"])
@pytest.mark.parametrize("binary", [True, False])
def test_grids_and_voxels_of_vtk_are_hexahedra_with_their_regions(tmp_path, ending, binary):
    import pyvista

    grid = pyvista.ImageData(dimensions=(3, 3, 6), spacing=(6.0, 6.0, 12.0), origin=(-6.0, -6.0, 0.0))
    grid.cell_data["region"] = np.repeat([1, 2], 10)
    (grid if ending == ".vti" else grid.cast_to_unstructured_grid()).save(
        tmp_path / f"g{ending}", binary=binary
    )
    body = read_own(tmp_path / f"g{ending}", 1e-3, meshes.Stated("whole"))
    assert 2e9 * meshes.volume(body.half) == pytest.approx(8640.0)
    assert set(body.sets) == {"region 1", "region 2"}


def test_a_wedge_given_as_a_hexahedron_of_20_nodes_keeps_the_middles_of_its_edges():
    """One edge of length 2 at x = 0 bulges by 0.3: the two faces and the volume beside it follow."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2], [1, 0, 2], [0, 1, 2]], dtype=float)
    wedge = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
    middles = np.array([corners[list(pair)].mean(axis=0) for pair in wedge])
    middles[6, 0] -= 0.3
    points = np.vstack([corners, middles])
    plain = as_hexahedra(points, (("wedge15", np.arange(15)[None]),))
    fallen = [0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14]
    stored = as_they_are(StoredMesh(points, (("hexahedron20", np.array([fallen])),)))
    found = as_hexahedra(points, stored.blocks)
    places = [np.unique(one.points[one.cells].reshape(-1, 3).round(9), axis=0) for one in (found, plain)]
    assert places[0] == pytest.approx(places[1])
    assert (found.points[:, 0].min(), len(found.cells)) == (-0.3, 6)


def test_a_kratos_prism_of_15_nodes_has_its_upright_edges_before_the_upper_ones(tmp_path):
    """As `Prism3D15` of Kratos lists them; in the order of VTK a straight prism was folded (-0.89)."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]], float)
    pairs = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)]
    points = [*corners, *(corners[list(pair)].mean(axis=0) for pair in pairs)]
    nodes = "\n".join(f"{number} {x} {y} {z}" for number, (x, y, z) in enumerate(points, 1))
    prism = " ".join(str(number) for number in range(1, 16))
    path = tmp_path / "prism.mdpa"
    path.write_text(
        f"Begin Nodes\n{nodes}\nEnd Nodes\n"
        f"Begin Elements SmallDisplacementElement3D15N\n1 0 {prism}\nEnd Elements\n"
    )
    found = stored_mesh(path)
    cells = as_hexahedra(found.points, found.blocks)
    assert corner_jacobians(cells.points[cells.cells]).min() > 0.5


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron20"])
def test_cells_with_middles_of_edges_that_meshio_wrote_as_nastran_are_read(tmp_path, kind):
    """It names them CTETRA_ and CHEXA_, which were refused."""
    corners = np.array(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float
    )
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    if kind == "tetra10":
        corners, edges = corners[[0, 1, 3, 4]], [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    points = np.concatenate([corners, [corners[list(pair)].mean(axis=0) for pair in edges]])
    written = meshio.Mesh(points, [(kind, np.arange(len(points))[None])])
    written.write(tmp_path / "c.bdf")
    found = stored_mesh(tmp_path / "c.bdf")
    assert [name for name, _ in found.blocks] == [kind]
    cells = as_hexahedra(found.points, found.blocks)
    assert corner_jacobians(cells.points[cells.cells]).min() > 0.1
