"""Sets of faces and nodes of mesh files of many programs: each names the faces of the body that it holds."""

import decks
import meshio
import numpy as np
import pytest
from own_bodies import box

import meshes
from meshes import Stated, own_body, read_own

LENGTH, WIDTH = 60.0, 12.0
WEDGES = [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]]
TETRAHEDRA = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]


def bar(low=(-6.0, -6.0, 0.0), counts=(2, 2, 5)):
    """Return a bar of 12 x 12 x 60 mm, in mm; its end of lower z is ``bottom``, that of higher x ``side``."""
    return box(*counts, low, (6.0, 6.0, LENGTH))


def quads_of(points, cells):
    """Return the quadrilaterals (k, 4) of the end and of the side of a bar of hexahedra."""
    outer = meshes.hexmesh.outer_faces(cells)
    quads = cells[outer[0][:, None], meshes.hexmesh.FACES[outer[1]]]
    bottom = (points[quads][:, :, 2] == 0.0).all(axis=1)
    side = (points[quads][:, :, 0] == 6.0).all(axis=1)
    return quads[bottom], quads[side]


def area(body, name):
    """Return area, mm2, and mean place, mm, of the faces of a set on the skin of the half."""
    (stored,) = [faces for one, faces in body.faces.items() if one.upper() == name.upper()]
    corners = body.half.points[body.half.faces[stored]] * 1e3
    cross = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    size = 0.5 * np.linalg.norm(cross, axis=1)
    return size.sum(), size @ corners.mean(axis=1) / size.sum()


def assert_bottom_and_side(body, bottom="bottom", side="side", moved=1e-9):
    size, place = area(body, bottom)
    assert size == pytest.approx(72.0, rel=1e-9)
    assert place == pytest.approx([0.0, 3.0, 0.0], abs=moved)
    size, place = area(body, side)
    assert size == pytest.approx(360.0, rel=1e-9)
    assert place == pytest.approx([6.0, 3.0, 30.0], abs=moved)


def lines_of(quads, width, first=1):
    rows = quads + 1
    return ["".join(f"{n:{width}d}" for n in (k, *row)) for k, row in enumerate(rows.tolist(), first)]


def abaqus_sides(points, cells, kind):
    """Return lines of surfaces by cell and S1 to S6, after the manual's order of corners."""
    sides = {
        "hexahedron": ["1234", "5876", "1562", "2673", "3784", "4851"],
        "wedge": ["123", "465", "1452", "2563", "3641"],
        "tetra": ["123", "142", "243", "341"],
    }[kind]
    found = {"BOTTOM": [], "SIDE": []}
    for number, cell in enumerate(cells, 1):
        for k, text in enumerate(sides, 1):
            corners = points[cell[[int(one) - 1 for one in text]]]
            if (corners[:, 2] == 0.0).all():
                found["BOTTOM"].append((number, f"S{k}"))
            if (corners[:, 0] == 6.0).all():
                found["SIDE"].append((number, f"S{k}"))
    return found


def numberings(kind):
    """Return the orders in which the corners of a cell may be numbered, which turn its faces about."""
    if kind == "hexahedron":
        return [meshes.order.TURNS[0, 0], meshes.order.TURNS[6, 1], meshes.order.TURNS[5, 2]]
    return {"wedge": [[0, 1, 2, 3, 4, 5], [4, 3, 5, 1, 0, 2], [2, 0, 1, 5, 3, 4]]}.get(
        kind, [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1]]
    )


@pytest.mark.parametrize("kind", ["hexahedron", "wedge", "tetra"])
@pytest.mark.parametrize("where", ["alone", "part", "assembly"])
@pytest.mark.parametrize("numbering", [0, 1, 2])
def test_surfaces_of_abaqus_are_faces_of_cells_or_of_sets_of_cells(tmp_path, kind, where, numbering):
    points, cells = bar((-6.0, 0.0, 0.0), (2, 1, 5))
    split = {"tetra": TETRAHEDRA, "wedge": WEDGES}.get(kind)
    cells = cells[:, split].reshape(-1, len(split[0])) if split else cells
    cells = cells[:, numberings(kind)[numbering]]
    found = abaqus_sides(points, cells, kind)
    mesh = decks.abaqus(points, cells).partition("*node")[2].partition("*element, type=s3")[0]
    prefix = "Rod-1." if where == "assembly" else ""
    instance = ", instance=Rod-1" if where == "assembly" else ""
    lines = ["*SURFACE, NAME=Side, TYPE=ELEMENT", *(f"{prefix}{n}, {side}" for n, side in found["SIDE"])]
    surface = ["*surface, type=element, name=Bottom"]
    for side in sorted({one for _, one in found["BOTTOM"]}):
        members = [f"{n}," for n, one in found["BOTTOM"] if one == side]
        lines += [f"*Elset, elset=_Bottom_{side}, internal{instance}", *members]
        surface.append(f"_Bottom_{side}, {side}")
    text = "\n".join([*lines, *surface, ""])
    if where == "alone":
        text = f"*node{mesh}{text}"
    else:
        inner, outer = (text, "") if where == "part" else ("", text)
        text = (
            f"*PART, NAME=Rod\n*node{mesh}{inner}*END PART\n*ASSEMBLY, NAME=A\n"
            f"*INSTANCE, NAME=Rod-1, PART=Rod\n0, 0, 5\n*END INSTANCE\n{outer}*END ASSEMBLY\n"
        )
    (tmp_path / "bar.inp").write_text(text)
    body = read_own(tmp_path / "bar.inp", 1e-3, Stated("half"))
    assert_bottom_and_side(body)
    assert "sets of faces: BOTTOM, SIDE" in " ".join(body.told)


def test_surfaces_of_nodes_of_shells_and_of_all_sides_are_read_and_others_told(tmp_path):
    points, cells = bar()
    bottom, side = quads_of(points, cells)
    mesh = decks.abaqus(points, cells).partition("*material")[0]
    low = np.unique(bottom) + 1
    lines = [
        *("*NSET, NSET=LOW", *map(str, low[:-1]), "*SURFACE, TYPE=NODE, NAME=BOTTOM", "low,", f"{low[-1]},"),
        *(
            "*ELEMENT, TYPE=SFM3D4R, ELSET=SIDE",
            *(f"{800 + n}, {str(q.tolist())[1:-1]}" for n, q in enumerate(side + 1)),
        ),
        *("*SURFACE, NAME=ALL", "LOW,", "HIGH,", "*SURFACE, NAME=WALL, TYPE=CYLINDER", "0, 0, 0", ""),
    ]
    path = tmp_path / "bar.inp"
    path.write_text(mesh + "\n".join(lines))
    body = read_own(path, 1e-3, Stated("whole"))
    assert_bottom_and_side(body)
    assert area(body, "ALL")[0] == pytest.approx(2 * 72 + 2 * 360 + 720, rel=1e-9)
    told = " ".join(body.told)
    assert "SFM3D4R" not in told  # it carries a set alone
    assert "left out: 1 cell of type S3" in told  # no face of the body
    assert "the surface WALL, which is of type CYLINDER" in told


def nastran(points, cells, bottom, side):
    rows = [(11, quad) for quad in bottom + 1] + [(12, quad) for quad in side + 1]
    shells = [f"CQUAD4,{700 + n},{pid},{','.join(map(str, quad))}" for n, (pid, quad) in enumerate(rows)]
    return decks.nastran(points, cells).replace("ENDDATA", "\n".join([*shells, "ENDDATA"]))


def gmsh(points, cells, bottom, side):
    """Return a text file of version 4.1 with a volume and two surfaces, each of a physical group."""
    box_of = "-6 -6 0 6 6 60"
    lines = [
        "$MeshFormat",
        "4.1 0 8",
        "$EndMeshFormat",
        "$PhysicalNames",
        "2",
        '2 7 "bottom"',
        '2 8 "my side"',
    ]
    lines += ["$EndPhysicalNames", "$Entities", "0 0 2 1", f"3 {box_of} 1 7 0", f"4 {box_of} 1 8 0"]
    lines += [f"1 {box_of} 1 1 2 3 4", "$EndEntities", "$Nodes", f"1 {len(points)} 1 {len(points)}"]
    lines += [f"3 1 0 {len(points)}", *(str(n + 1) for n in range(len(points)))]
    lines += [" ".join(map(repr, place)) for place in points.tolist()]
    lines += ["$EndNodes", "$Elements", f"3 {len(cells) + len(bottom) + len(side)} 1 999"]
    for dimension, entity, kind, rows in ((2, 3, 3, bottom), (2, 4, 3, side), (3, 1, 5, cells)):
        lines.append(f"{dimension} {entity} {kind} {len(rows)}")
        lines += [f"{n} {' '.join(map(str, row))}" for n, row in enumerate((rows + 1).tolist(), 100 * entity)]
    return "\n".join([*lines, "$EndElements", ""])


def lsdyna(points, cells, bottom, side):
    segments = [
        "*SET_SEGMENT_TITLE",
        "bottom",
        f"{4:10d}",
        *("".join(f"{n:10d}" for n in q) + f"{0.0:10.1f}" * 4 for q in bottom + 1),  # attributes follow
    ]
    nodes = ["*SET_NODE_LIST_TITLE", "side", f"{5:10d}", *(f"{n:10d}" for n in np.unique(side) + 1)]
    return decks.lsdyna(points, cells).replace("*END\n", "\n".join([*segments, *nodes, "*END", ""]))


def radioss(points, cells, bottom, side):
    lines = ["/SURF/SEG/4", "bottom", *lines_of(bottom, 10), "/PART/9", "side", "1 1 0"]
    return "\n".join([decks.radioss(points, cells), *lines, "/SHELL/9", *lines_of(side, 10, 700), ""])


def ansys(points, cells, bottom, side):
    nodes = np.unique(bottom) + 1
    block = [f"CMBLOCK,BOTTOM,NODE,{len(nodes):8d}", "(8i10)", *(f"{n:10d}" for n in nodes)]
    shells = ["ET,2,154", f"EBLOCK,19,SOLID,{len(side)},{len(side)}", "(19i10)"]
    shells += [
        "".join(f"{v:10d}" for v in (1, 2, 1, 1, 0, 0, 0, 0, 4, 0, 700 + n, *q))
        for n, q in enumerate((side + 1).tolist())
    ]
    shells += [
        f"{-1:10d}",
        f"CMBLOCK,SIDE,ELEM,{len(side):8d}",
        "(8i10)",
        *(f"{700 + n:10d}" for n in range(len(side))),
    ]
    return decks.ansys(points, cells).replace("FINISH", "\n".join([*shells, *block, "FINISH"]))


def universal(points, cells, bottom, side):
    cell = [
        line
        for n, q in enumerate((bottom + 1).tolist(), 700)
        for line in (f"{n:10d}{94:10d}{1:10d}{1:10d}{7:10d}{4:10d}", "".join(f"{v:10d}" for v in q))
    ]
    nodes = np.unique(side) + 1
    lines = [f"{-1:6d}", f"{2412:6d}", *cell, f"{-1:6d}", f"{-1:6d}", f"{2467:6d}"]
    for k, (name, kind, members) in enumerate(
        (("bottom", 8, range(700, 700 + len(bottom))), ("side", 7, nodes)), 1
    ):
        lines += ["".join(f"{v:10d}" for v in (k, 0, 0, 0, 0, 0, 0, len(members))), name]
        lines += [f"{kind:10d}{n:10d}{0:10d}{0:10d}" for n in members]
    return decks.universal(points, cells) + "\n".join([*lines, f"{-1:6d}", ""])


def kratos(points, cells, bottom, side):
    conditions = [f"{n} 0 {' '.join(map(str, q))}" for n, q in enumerate((bottom + 1).tolist(), 1)]
    lines = [
        "Begin Conditions SurfaceCondition3D4N",
        *conditions,
        "End Conditions",
        "Begin SubModelPart bottom",
    ]
    lines += [
        "Begin SubModelPartConditions",
        *(str(n + 1) for n in range(len(bottom))),
        "End SubModelPartConditions",
    ]
    lines += ["End SubModelPart", "Begin SubModelPart side", "Begin SubModelPartNodes"]
    lines += [*(str(n) for n in np.unique(side) + 1), "End SubModelPartNodes", "End SubModelPart", ""]
    return decks.kratos(points, cells).partition("Begin Conditions")[0] + "\n".join(lines)


def ucd(points, cells, bottom, side):
    _, *rest = decks.ucd(points, cells).splitlines()[1:]
    flat = [f"{700 + n} {5} quad {' '.join(map(str, q))}" for n, q in enumerate((bottom + 1).tolist())]
    flat += [f"{800 + n} {6} quad {' '.join(map(str, q))}" for n, q in enumerate((side + 1).tolist())]
    return "\n".join([f"{len(points)} {len(cells) + len(flat)} 0 0 0", *rest, *flat, ""])


TEXTS = {
    ".msh": (gmsh, "bottom", "my side"),
    ".bdf": (nastran, "PID 11", "PID 12"),
    ".k": (lsdyna, "bottom", "NODE SET 5"),
    ".rad": (radioss, "SURF 4", "side"),
    ".cdb": (ansys, "BOTTOM", "SIDE"),
    ".unv": (universal, "bottom", "side"),
    ".mdpa": (kratos, "bottom", "side"),
    ".ucd": (ucd, "MATERIAL 5", "MATERIAL 6"),
}


@pytest.mark.parametrize("ending", TEXTS)
def test_each_program_names_faces_in_its_way(tmp_path, ending):
    points, cells = bar()
    make, bottom, side = TEXTS[ending]
    (tmp_path / f"bar{ending}").write_text(make(points, cells, *quads_of(points, cells)))
    assert_bottom_and_side(read_own(tmp_path / f"bar{ending}", 1e-3, Stated("whole")), bottom, side)


@pytest.mark.parametrize("form", ["gmsh22", "med", "vtu"])
def test_cells_of_surfaces_beside_solids_name_faces(tmp_path, form):
    points, cells = bar()
    bottom, side = quads_of(points, cells)
    quads = np.repeat([2, 3], [len(bottom), len(side)])
    mesh, names = meshio.Mesh(points, [("hexahedron", cells), ("quad", np.concatenate([bottom, side]))]), None
    marks = [np.ones(len(cells), np.int64), quads]
    if form == "gmsh22":
        mesh.cell_data = {"gmsh:physical": marks, "gmsh:geometrical": marks}
        mesh.field_data = {"rod": np.array([1, 3]), "BOTTOM": np.array([2, 2]), "SIDE": np.array([3, 2])}
    elif form == "med":
        mesh.cell_data, mesh.cell_tags = (
            {"cell_tags": [-part for part in marks]},
            {-2: ["BOTTOM"], -3: ["SIDE"]},
        )
    else:
        mesh.cell_data, names = {"region": marks}, ("region 2", "region 3")
    path = tmp_path / ("bar.msh" if form == "gmsh22" else f"bar.{form}")
    meshio.write(path, mesh, file_format=form, **({"binary": False} if form == "gmsh22" else {}))
    body = read_own(path, 1e-3, Stated("whole"))
    assert_bottom_and_side(body, *(names or ("BOTTOM", "SIDE")))
    assert "left out" not in " ".join(body.told)


@pytest.mark.parametrize("hdf5", [False, True])
@pytest.mark.parametrize("kind", ["hexahedron", "wedge", "tetra"])
@pytest.mark.parametrize("numbering", [0, 1, 2])
def test_side_and_node_sets_of_exodus_name_faces(tmp_path, hdf5, kind, numbering):
    """Sides in the order of the manual."""
    points, cells = bar((-6.0, 0.0, 0.0), (2, 1, 5))
    split = {"tetra": TETRAHEDRA, "wedge": WEDGES}.get(kind)
    cells = cells[:, split].reshape(-1, len(split[0])) if split else cells
    cells = cells[:, numberings(kind)[numbering]]
    sides = {
        "hexahedron": ["1265", "2376", "3487", "1584", "1432", "5678"],
        "wedge": ["1254", "2365", "1463", "132", "456"],
        "tetra": ["124", "234", "143", "132"],
    }[kind]
    found = [
        (n, k)
        for n, cell in enumerate(cells, 1)
        for k, text in enumerate(sides, 1)
        if (points[cell[[int(one) - 1 for one in text]], 2] == 0.0).all()
    ]
    path = tmp_path / "bar.e"
    decks.exodus(path, points, cells, hdf5)
    more = {"elem_ss1": [n for n, _ in found], "side_ss1": [k for _, k in found]}
    more |= {"ss_prop1": [30], "node_ns1": np.flatnonzero(points[:, 0] == 6.0) + 1}
    if hdf5:
        import h5py

        with h5py.File(path, "a") as file:
            for name, values in more.items():
                file[name] = np.array(values, np.int32)
    else:
        from scipy.io import netcdf_file

        with netcdf_file(path, "a") as file:
            for name, values in more.items():
                file.createDimension(f"of_{name}", len(values))
                file.createVariable(name, "i", (f"of_{name}",))[:] = values
    assert_bottom_and_side(read_own(path, 1e-3, Stated("half")), "SIDE SET 30", "NODE SET 1")


@pytest.mark.parametrize("tip", ["-z", "+z", "-x", "+y", (1.0, 0.0, -1.0)])
@pytest.mark.parametrize("part", ["whole", "half", "quarter"])
def test_faces_follow_a_body_that_is_turned_and_mirrored(tmp_path, tip, part):
    """The end at the tip and one side, of a file that gives them along another axis or as a part."""
    if tip == (1.0, 0.0, -1.0) and part == "quarter":
        pytest.skip("an oblique body is whole or a half")
    low = {"whole": (-6.0, -6.0, 0.0), "half": (-6.0, 0.0, 0.0), "quarter": (0.0, 0.0, 0.0)}[part]
    points, cells = bar(low, [2 if one < 0 else 1 for one in low[:2]] + [5])
    bottom, side = quads_of(points, cells)
    if isinstance(tip, tuple):
        angle = np.pi / 4
        turn = np.array([[np.cos(angle), 0, -np.sin(angle)], [0, 1, 0], [np.sin(angle), 0, np.cos(angle)]])
        placed = points @ turn.T
    else:
        axes = meshes.TIPS[tip]
        placed = np.zeros_like(points)
        for own, (axis, sign) in enumerate(axes):
            placed[:, axis] = sign * points[:, own]
    mesh = meshio.Mesh(placed, [("hexahedron", cells), ("quad", bottom), ("quad", side)])
    mesh.cell_data = {"region": [np.full(len(one), k) for k, one in enumerate((cells, bottom, side))]}
    meshio.write(tmp_path / "bar.vtu", mesh)
    body = read_own(tmp_path / "bar.vtu", 1e-3, Stated(part, tip))
    assert area(body, "region 1")[0] == pytest.approx(72.0, rel=1e-9)
    assert area(body, "region 1")[1] == pytest.approx([0.0, 3.0, 0.0], abs=1e-9)
    size, place = area(body, "region 2")
    both = 2 if part == "quarter" else 1  # mirrored to the other side too
    assert size == pytest.approx(both * 360.0, rel=1e-9)
    assert abs(place[0]) == pytest.approx(0.0 if both == 2 else 6.0, abs=1e-9)
    assert place[1:] == pytest.approx([3.0, 30.0], abs=1e-9)


def test_faces_of_cells_that_are_cut_keep_their_names(tmp_path):
    """Layers of hexahedra and tetrahedra across y = 0; nodes of tetrahedra near it give way by 0.1 mm."""
    points, cells = bar(counts=(2, 3, 5))
    bottom, side = (np.unique(quads) + 1 for quads in quads_of(points, cells))
    for split, moved in ((None, 1e-9), (TETRAHEDRA, 0.1)):
        made = cells[:, split].reshape(-1, 4) if split else cells
        text = decks.abaqus(points, made).partition("*element, type=s3")[0]
        text += "\n".join(["*NSET, NSET=BOTTOM", *map(str, bottom), "*NSET, NSET=SIDE", *map(str, side), ""])
        (tmp_path / "bar.inp").write_text(text)
        assert_bottom_and_side(read_own(tmp_path / "bar.inp", 1e-3, Stated("whole")), moved=moved)


@pytest.mark.parametrize(("ending", "nodes", "size"), [(".k", "NODE SET 5", 360.0), (".cdb", "BOTTOM", 72.0)])
def test_tetrahedra_written_as_hexahedra_are_cut_and_keep_their_faces(tmp_path, ending, nodes, size):
    """LS-DYNA and Ansys write all solids with eight nodes; a set of nodes lost faces of such cells."""
    points, cells = bar(counts=(2, 3, 5))
    tetrahedra = cells[:, TETRAHEDRA].reshape(-1, 4)
    (tmp_path / f"b{ending}").write_text(TEXTS[ending][0](points, tetrahedra, *quads_of(points, cells)))
    body = read_own(tmp_path / f"b{ending}", 1e-3, Stated("whole"))
    assert any("tetrahedra lie across the plane y = 0 and are cut there" in one for one in body.told)
    assert area(body, nodes)[0] == pytest.approx(size, rel=1e-9)


def test_a_set_on_one_side_of_the_plane_alone_is_known_as_lopsided(tmp_path):
    points, cells = bar()
    upper = np.flatnonzero(points[cells][:, :, 1].mean(axis=1) > 0) + 1
    nodes = np.flatnonzero((points[:, 1] <= 0.0) & (points[:, 2] == 0.0)) + 1
    text = decks.abaqus(points, cells).partition("*element, type=s3")[0]
    lines = ["*ELSET, ELSET=UPPER", *map(str, upper), "*NSET, NSET=LOWER", *map(str, nodes), ""]
    (tmp_path / "bar.inp").write_text(text + "\n".join(lines))
    body = read_own(tmp_path / "bar.inp", 1e-3, Stated("whole"))
    assert body.lopsided == {"UPPER", "LOWER"}
    half = own_body(*bar((-6.0, 0.0, 0.0), (2, 1, 5)), Stated("half"))
    assert half.lopsided == frozenset()
