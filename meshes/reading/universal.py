"""Universal files of I-DEAS (.unv), as Salome and Gmsh write them: nodes, elements and groups."""

from collections.abc import Iterator
from pathlib import Path

from meshes.common import MeshError
from meshes.reading.stored import Elements, PointMass, StoredMesh, keep
from meshes.reading.text import fixed_fields, lines_of, place_of

KINDS = {
    111: "tetra",
    112: "wedge",
    113: "wedge15",
    114: "pyramid",
    115: "hexahedron",
    116: "hexahedron20",
    118: "tetra10",
}
# cells of surfaces, in plane stress, of shells and so on, by the last figure: every so many nodes is a corner
FLAT = {1: 1, 2: 2, 4: 1, 5: 2}
NODE, ELEMENT = 7, 8  # what a member of a group is
LINES = {11, 21, 22, 23, 24}  # beams and rods, of which a line of their section follows
MASSES = {161}
# the middles of edges stand between the corners in the order of the walk around each end
REORDERED = {
    116: (0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11),
    118: (0, 2, 4, 9, 1, 3, 5, 6, 7, 8),
    113: (0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8),
}


def universal(path: Path) -> StoredMesh:
    """Read the sets of data 2411 or 781 (nodes), 2412 (elements) and 2467, 2477 or 2452 (groups).

    Raises
    ------
    MeshError
        If it gives nodes in local systems of coordinates, or names what is not there.
    """
    found = Elements()
    cells: dict[int, tuple[int, list[int]]] = {}
    groups: dict[int, dict[int, list[str]]] = {NODE: {}, ELEMENT: {}}
    local = False
    for number, lines in _sets(lines_of(path)):
        if number in (2411, 781):
            for head, line in zip(lines[::2], lines[1::2], strict=False):
                label, system, *_ = head.split()
                texts = line.split() if len(line.split()) == 3 else fixed_fields(line, [25] * 3)
                found.node(int(label), place_of(texts, label))
                local |= system not in ("0", "1")
        elif number == 2412:
            _cells(iter(lines), cells)
        elif number in (2467, 2477, 2452, 2435):
            _groups(iter(lines), groups)
    if local:
        raise MeshError("gives nodes in local systems of coordinates. Write it in the global one.")
    for number, (kind, nodes) in cells.items():
        named = groups[ELEMENT].get(number, [])
        if 41 <= kind <= 99 and kind % 10 in FLAT:
            found.add_face(str(kind), found.at(nodes[:: FLAT[kind % 10]]), *named)
        elif kind in MASSES:
            found.masses.append(PointMass(f"type {kind}", node=found.at(nodes)[0]))
        elif kind in KINDS:
            nodes = [nodes[k] for k in REORDERED.get(kind, range(len(nodes)))]
            found.solid(KINDS[kind], nodes, f"a cell {number}", *named)
        else:
            found.leave(f"cell of type {kind}")
    for node, names in groups[NODE].items():
        for name in names:
            found.add_nodes(name, [node])
    return found.stored()


def _sets(every: list[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield the number of each set of data with its lines."""
    lines, open_ = list[str](), False
    for line in every:
        if line.strip() != "-1":
            lines.append(line)
            continue
        if open_ and lines and lines[0].split()[:1] and lines[0].split()[0].isdigit():
            yield int(lines[0].split()[0]), lines[1:]
        lines, open_ = [], not open_


def _numbers(lines: Iterator[str], count: int) -> list[int]:
    """Return the whole numbers of the next lines, so many or a line more; fewer where these end."""
    found: list[int] = []
    while len(found) < count and (line := next(lines, None)) is not None:
        found += [int(part) for part in line.split()]
    return found


def _cells(lines: Iterator[str], cells: dict[int, tuple[int, list[int]]]) -> None:
    for line in lines:
        head = [int(part) for part in line.split()]
        if head[1] in LINES:
            next(lines, None)
        nodes = _numbers(lines, head[5])
        if len(nodes) != head[5]:
            raise MeshError(f"has a cell {head[0]} with {len(nodes)} nodes instead of {head[5]}.")
        keep(cells, head[0], (head[1], nodes), "cells")


def _groups(lines: Iterator[str], groups: dict[int, dict[int, list[str]]]) -> None:
    """Add the names of groups by node or element."""
    for head, name in zip(lines, lines, strict=False):
        numbers = _numbers(lines, 4 * int(head.split()[7]))
        for kind, number in zip(numbers[::4], numbers[1::4], strict=False):
            if kind in groups:
                groups[kind].setdefault(number, []).append(name.strip())
