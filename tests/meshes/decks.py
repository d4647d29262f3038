"""Writers of small mesh files in the forms of many programs, by hand, after their manuals."""

import meshio
import numpy as np

ABAQUS = {8: "C3D8R", 4: "C3D4", 6: "C3D6", 10: "C3D10", 20: "C3D20"}
NASTRAN = {8: "CHEXA", 4: "CTETRA", 6: "CPENTA", 10: "CTETRA", 20: "CHEXA"}
UPPER_LAST = [
    *range(12),
    *range(16, 20),
    *range(12, 16),
]  # middles between the ends before those of the upper


def rows(cells, width=None):
    return ["".join(f"{n:{width}d}" for n in cell) if width else ", ".join(map(str, cell)) for cell in cells]


def numbered(array):
    return enumerate(array.tolist(), 1)


def abaqus(points, cells):
    """Return a deck in lower case with two *NODE and two *ELEMENT blocks, and a shell on the first cell."""
    half, kind = len(cells) // 2, ABAQUS[cells.shape[1]]
    node = [f"{n}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in numbered(points)]
    element = [f"{n}, {line}" for n, line in enumerate(rows(cells + 1), 1)]
    element = [
        line
        if len(line) < 70
        else ",\n".join(line.rsplit(", ", 8)[:1]) + ",\n" + ", ".join(line.rsplit(", ", 8)[1:])
        for line in element
    ]
    return "\n".join(
        [
            *("*heading", "** made by hand", "*node, nset=all", *node[:7], "*Node", *node[7:]),
            *(f"*element, type={kind.lower()}, elset=low", *element[:half]),
            *(f"*ELEMENT, TYPE={kind}, ELSET=High", *element[half:]),
            *("*element, type=s3, elset=skin", "9001, 1, 2, 3", "*material, name=steel", ""),
        ]
    )


def nastran(points, cells, system=0, place=None):
    """Return bulk data in free fields, nodes given in a system of coordinates by ``place`` of each point."""
    given = points if place is None else np.array([place(point) for point in points])
    lines = ["SOL 101", "CEND", "BEGIN BULK", "$ nodes"]
    lines += [f"GRID*,{n},{system or ''},{x!r},{y!r}\n*,{z!r}" for n, (x, y, z) in numbered(given)]
    order = UPPER_LAST if cells.shape[1] == 20 else range(cells.shape[1])
    for n, cell in numbered(cells[:, order] + 1):
        fields = [NASTRAN[len(cell)], n, 7, *cell]
        first, more = fields[:9], fields[9:]
        lines.append(",".join(map(str, first)))
        lines += ["," + ",".join(map(str, more[k : k + 8])) for k in range(0, len(more), 8)]
    return "\n".join([*lines, "ENDDATA", ""])


def lsdyna(points, cells):
    """Return a keyword file, tetrahedra and wedges as hexahedra whose nodes fall together."""
    node = [f"{n:8d}{x:16.9e}{y:16.9e}{z:16.9e}" for n, (x, y, z) in numbered(points)]
    full = {8: range(8), 4: (0, 1, 2, 3, 3, 3, 3, 3), 6: (0, 1, 4, 3, 2, 2, 5, 5)}[cells.shape[1]]
    solid = [f"{n:8d}{3:8d}" + row for n, row in enumerate(rows(cells[:, full] + 1, 8), 1)]
    part = ["*PART", "striker", f"{3:10d}{1:10d}{1:10d}"]
    lines = ["*KEYWORD", *part, "*NODE", *node, "*ELEMENT_SOLID", *solid, "*RIGIDWALL_PLANAR", "0", "*END"]
    return "\n".join([*lines, ""])


def radioss(points, cells):
    name = {8: "BRICK", 4: "TETRA4", 6: "PENTA6"}[cells.shape[1]]
    node = [f"{n:10d}{x:20.12e}{y:20.12e}{z:20.12e}" for n, (x, y, z) in numbered(points)]
    solid = [f"{n:10d}" + row for n, row in enumerate(rows(cells + 1, 10), 1)]
    return "\n".join(
        ["#RADIOSS STARTER", "/NODE", *node, "/PART/4", "striker", "1 1 0", f"/{name}/4", *solid, ""]
    )


def ansys(points, cells):
    """Return an archive; wedges and tetrahedra of type 185 as hexahedra whose nodes fall together."""
    size = cells.shape[1]
    full = {8: range(8), 20: range(20), 10: range(10)}
    full |= {4: (0, 1, 2, 2, 3, 3, 3, 3), 6: (0, 1, 2, 2, 3, 4, 5, 5)}
    cells = cells[:, full[size]]
    kind = {8: 185, 20: 186, 10: 187}[cells.shape[1]]
    node = [f"{n:9d}{0:9d}{0:9d}{x:21.13e}{y:21.13e}{z:21.13e}" for n, (x, y, z) in numbered(points)]
    lines = [
        "/PREP7",
        f"ET,1,{kind}",
        f"NBLOCK,6,SOLID,{len(points)},{len(points)}",
        "(3i9,6e21.13e3)",
        *node,
    ]
    lines += ["N,R5.3,LOC,       -1,", f"EBLOCK,19,SOLID,{len(cells)},{len(cells)}", "(19i10)"]
    for n, cell in numbered(cells + 1):
        head = [1, 1, 1, 1, 0, 0, 0, 0, len(cell), 0, n]
        lines.append("".join(f"{v:10d}" for v in [*head, *cell[:8]]))
        lines += ["".join(f"{v:10d}" for v in cell[8:])] if len(cell) > 8 else []
    lines += [f"{-1:10d}", f"CMBLOCK,FIRST,ELEM,{2:8d}", "(8i10)", f"{1:10d}{-2:10d}", "FINISH", ""]
    return "\n".join(lines)


def universal(points, cells):
    kind = {8: 115, 4: 111, 6: 112}[cells.shape[1]]
    lines = [f"{-1:6d}", f"{2411:6d}"]
    for n, (x, y, z) in numbered(points):
        lines += [f"{n:10d}{1:10d}{1:10d}{11:10d}", f"{x:25.16e}{y:25.16e}{z:25.16e}".replace("e", "D")]
    lines += [f"{-1:6d}", f"{-1:6d}", f"{2412:6d}"]
    for n, cell in numbered(cells + 1):
        lines += [f"{n:10d}{kind:10d}{1:10d}{1:10d}{7:10d}{len(cell):10d}", "".join(f"{v:10d}" for v in cell)]
    return "\n".join([*lines, f"{-1:6d}", ""])


def kratos(points, cells):
    name = {8: "SmallDisplacementElement3D8N", 4: "Element3D4N", 6: "Element3D6N"}[cells.shape[1]]
    node = [f"{n} {x!r} {y!r} {z!r}" for n, (x, y, z) in numbered(points)]
    solid = [f"{n} 0 " + " ".join(map(str, cell)) for n, cell in numbered(cells + 1)]
    lines = ["Begin Nodes", *node, "End Nodes", f"Begin Elements {name} // mesh", *solid, "End Elements"]
    return "\n".join([*lines, "Begin Conditions SurfaceCondition3D3N", "1 0 1 2 3", "End Conditions", ""])


def ucd(points, cells):
    kind = {8: "hex", 4: "tet", 6: "prism"}[cells.shape[1]]
    node = [f"{n} {x!r} {y!r} {z!r}" for n, (x, y, z) in numbered(points)]
    solid = [f"{n} 2 {kind} " + " ".join(map(str, cell)) for n, cell in numbered(cells + 1)]
    return "\n".join(["# made by hand", f"{len(points)} {len(cells)} 0 0 0", *node, *solid, ""])


def exodus(path, points, cells, hdf5=False):
    """Write an Exodus file of one block."""
    kind = {8: b"HEX8", 4: b"TETRA", 6: b"WEDGE"}[cells.shape[1]]
    if hdf5:
        import h5py

        with h5py.File(path, "w") as file:
            file["coord"] = points.T
            file["connect1"] = (cells + 1).astype(np.int32)
            file["connect1"].attrs["elem_type"] = np.bytes_(kind)
        return
    from scipy.io import netcdf_file

    with netcdf_file(path, "w") as file:
        for name, size in (("n", len(points)), ("m", len(cells)), ("k", cells.shape[1])):
            file.createDimension(name, size)
        for axis, values in zip("xyz", points.T, strict=True):
            file.createVariable(f"coord{axis}", "d", ("n",))[:] = values
        connect = file.createVariable("connect1", "i", ("m", "k"))
        connect[:] = cells + 1
        connect.elem_type = kind


TEXTS = {
    ".inp": abaqus,
    ".bdf": nastran,
    ".k": lsdyna,
    ".rad": radioss,
    ".cdb": ansys,
    ".unv": universal,
    ".mdpa": kratos,
    ".ucd": ucd,
}
BY_MESHIO = (".vtu", ".vtk", ".msh", ".med", ".mesh", ".xdmf", ".su2", ".vol", ".f3grid", ".tec", ".hmf")
KINDS = {8: "hexahedron", 4: "tetra", 6: "wedge"}


def write(path, points, cells):
    """Write a mesh in the form of its ending."""
    if path.suffix in TEXTS:
        path.write_text(TEXTS[path.suffix](points, cells))
    elif path.suffix in (".e", ".exo"):
        exodus(path, points, cells, hdf5=path.suffix == ".exo")
    else:
        form = {"file_format": "gmsh"} if path.suffix == ".msh" else {}
        meshio.write(path, meshio.Mesh(points, [(KINDS[cells.shape[1]], cells)]), **form)
    return path


ENDINGS = (*TEXTS, ".e", ".exo", *BY_MESHIO)
