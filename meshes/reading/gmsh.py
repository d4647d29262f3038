"""Files of Gmsh (.msh), as text of the versions 1, 2, 4.0 and 4.1, binary of 2 and 4.1."""

from collections.abc import Iterator
from pathlib import Path

from meshes.common import MeshError
from meshes.reading.gmsh_binary import sections_of
from meshes.reading.stored import NODES, Elements, StoredMesh
from meshes.reading.text import decoded

KINDS = {4: "tetra", 5: "hexahedron", 6: "wedge", 7: "pyramid", 11: "tetra10", 12: "hexahedron27"}
KINDS |= {17: "hexahedron20", 18: "wedge15", 19: "pyramid13"}
FACES = {2: "triangle", 3: "quad", 9: "triangle", 10: "quad", 16: "quad"}
FLAT = {1: "line", 8: "line", 15: "point"}
# the middles of edges in VTK's order, by their places in Gmsh's
REORDERED = {
    "tetra10": (0, 1, 2, 3, 4, 5, 6, 7, 9, 8),
    "hexahedron20": (*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15),
    "wedge15": (*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11),
}
REORDERED["hexahedron27"] = (*REORDERED["hexahedron20"], *range(20, 27))


def is_gmsh(start: str) -> bool:
    """Return whether a file begins as one of Gmsh."""
    return start.split()[:1] in (["$NOD"], ["$MeshFormat"])


def gmsh(path: Path) -> StoredMesh:
    """Read the cells; a set is a physical group, or "VOLUME" or "SURFACE" and a number.

    Raises
    ------
    MeshError
        If a cell is of no kind that is read, or names what is not there.
    """
    data = path.read_bytes()
    is_binary = data.startswith(b"$MeshFormat") and data.split(b"\n", 2)[1].split()[1:2] == [b"1"]
    sections = sections_of(data) if is_binary else dict(_sections(decoded(data)))
    version = sections["MeshFormat"][0].split()[0] if "MeshFormat" in sections else "1"
    names = {}
    for line in sections.get("PhysicalNames", [])[1:]:
        numbers, _, name = line.partition('"')
        *dimension, number = map(int, numbers.split())
        for of in dimension or (2, 3):  # the first of version 2 name no dimension
            names[of, number] = name.strip().strip('"')
    if version.startswith("4"):
        numbered = _nodes_4(sections["Nodes"], version)
        cells = _cells_4(sections["Elements"], version)
        groups = {of: _groups(sections.get("Entities", []), of) for of in (2, 3)}
    else:
        lines = sections.get("NOD") or sections["Nodes"]
        rows = (line.split() for line in lines[1 : 1 + int(lines[0])])
        numbered = ((int(row[0]), [float(part) for part in row[1:4]]) for row in rows)
        cells = _cells_2(sections.get("ELM") or sections["Elements"], "ELM" in sections)
        groups = {2: {}, 3: {}}
    found, known = Elements(), dict[tuple[str, int, tuple[int, ...]], int]()
    for node, place in numbered:
        found.node(node, place)
    for kind, nodes, entity, marks in cells:
        of = 2 if kind in FACES else 3
        physical = [mark for mark in (*marks, *groups[of].get(entity, [])) if mark]
        sets = {names.get((of, mark), f"PHYSICAL {mark}") for mark in physical}
        if kind in FACES:
            found.add_face(FACES[kind], found.at(nodes), *sets, *([f"SURFACE {entity}"] if entity else []))
            continue
        if kind in FLAT:
            found.leave(f"cell of type {FLAT[kind]}")
            continue
        if kind not in KINDS:
            raise MeshError(f"holds cells of Gmsh's type {kind}, which are not read. Save them of order 1.")
        name = KINDS[kind]
        cell = name, entity, tuple(nodes[k] for k in REORDERED.get(name, range(NODES[name])))
        if cell in known:  # version 2 holds it once for each of its physical groups
            for one in sets:
                found.sets.setdefault(one, []).append(known[cell])
            continue
        known[cell] = len(found.cells)
        found.solid(name, cell[2], "a cell", *sets, f"VOLUME {entity}")
    return found.stored()


def _sections(text: str) -> Iterator[tuple[str, list[str]]]:
    """Yield the name and the lines of each section."""
    name, lines = "", list[str]()
    for line in text.split("\n"):
        bare = line.strip()
        if bare.startswith("$") and not name:
            name, lines = bare[1:], []
        elif bare.startswith("$E"):
            yield name, lines
            name = ""
        elif bare:
            lines.append(bare)


def _cells_2(lines: list[str], first_version: bool) -> Iterator[tuple[int, list[int], int, list[int]]]:
    """Yield type, nodes, volume or surface, and physical groups of each cell of versions 1 and 2."""
    for line in lines[1 : 1 + int(lines[0])]:
        row = [int(part) for part in line.split()]
        if first_version:  # number, type, physical, elementary, count, nodes
            yield row[1], row[5:], row[3], [abs(row[2])]
        else:
            tags = row[3 : 3 + row[2]]
            # a group of a surface that is turned round has a negative number
            yield row[1], row[3 + row[2] :], (*tags, 0, 0)[1], [abs(tag) for tag in tags[:1]]


def _nodes_4(lines: list[str], version: str) -> Iterator[tuple[int, list[float]]]:
    """Yield number and place of the nodes of version 4, without coordinates on their curve or surface."""
    blocks, at = int(lines[0].split()[0]), 1
    for _ in range(blocks):
        count = int(lines[at].split()[3])
        at += 1
        if version == "4.1":
            numbers, places = lines[at : at + count], lines[at + count : at + 2 * count]
            at += 2 * count
            rows = [[number, *line.split()] for number, line in zip(numbers, places, strict=True)]
        else:
            rows = [line.split() for line in lines[at : at + count]]
            at += count
        for row in rows:
            yield int(row[0]), [float(part) for part in row[1:4]]


def _cells_4(lines: list[str], version: str) -> Iterator[tuple[int, list[int], int, list[int]]]:
    blocks, at = int(lines[0].split()[0]), 1
    for _ in range(blocks):
        one, two, kind, count = (int(part) for part in lines[at].split())
        entity = two if version == "4.1" else one
        for line in lines[at + 1 : at + 1 + count]:
            row = [int(part) for part in line.split()]
            yield kind, row[1:], entity, []
        at += 1 + count


def _groups(lines: list[str], of: int) -> dict[int, list[int]]:
    """Return the physical groups of each volume (3) or surface (2) of version 4."""
    if not lines:
        return {}
    counts = [int(part) for part in lines[0].split()]
    found = {}
    for line in lines[1 + sum(counts[:of]) : 1 + sum(counts[: of + 1])]:
        parts = line.split()
        groups = int(parts[7])
        found[int(parts[0])] = [abs(int(part)) for part in parts[8 : 8 + groups]]
    return found
