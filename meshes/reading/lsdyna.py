"""Keyword files of LS-DYNA: nodes, solid elements, parts."""

from collections.abc import Iterator
from math import nan
from pathlib import Path

import numpy as np

from meshes.errors import MeshError
from meshes.reading.includes import full_text
from meshes.reading.sections import fixed_fields, sections
from meshes.reading.stored import Elements, PointMass, StoredMesh, number_of, whole_number

__all__ = ["lsdyna"]

REFUSED = {
    "INCLUDE_": "takes a part of the mesh from another file by *{0}, which is not read. Copy its lines into "
    "this one.",
    "NODE_TRANSFORM": "moves nodes by *{0}. Write the deck with the nodes where they are.",
    "NODE_MERGE": "merges nodes by *{0}. Write the deck with merged nodes.",
    "NODE_SCALAR": "has nodes by *{0}, which are not read. Leave them out.",
    "PARAMETER": "states numbers as parameters by *{0}. Write the deck with the numbers themselves.",
    "ELEMENT_SOLID_NURBS": "holds cells of *{0}, which are no hexahedra. Mesh the body with hexahedra.",
}
SOLIDS = ("ELEMENT_SOLID", "ELEMENT_SOLID_TITLE", "ELEMENT_TSHELL")
LINES_MORE = {"ORTHO": 2, "DOF": 1}  # that an option adds to each element
# widths of the fields of a line of masses, long ones, and which of them is the mass
MASSES = {
    "ELEMENT_MASS": ([8, 8, 16], [20, 20, 20], 2),
    "ELEMENT_MASS_NODE_SET": ([8, 8, 16], [20, 20, 20], 2),
    "ELEMENT_MASS_PART": ([8, 16], [20, 20], 1),
    "ELEMENT_MASS_PART_SET": ([8, 16], [20, 20], 1),
}


def lsdyna(path: Path) -> StoredMesh:
    """Read *NODE and *ELEMENT_SOLID, fixed or free fields; a set is a part, by its number and its title.

    Sets of segments and nodes, and shells of a part, may name faces.

    Raises
    ------
    MeshError
        If the deck includes or moves what it does not hold, or names what is not there.
    """
    place: dict[int, int] = {}
    points: list[list[float]] = []
    titles: dict[int, str] = {}
    solids: list[tuple[int, list[int]]] = []
    found, flat, sets = Elements(), list[list[int]](), list[tuple[str, bool, list[str]]]()
    masses: list[tuple[str, bool, str]] = []
    for name, long, lines in _keywords(full_text(path, "lsdyna")):
        for start, problem in REFUSED.items():
            if name.startswith(start):
                raise MeshError(problem.format(name))
        if name == "NODE":
            for line in lines:
                number, *rest = _split(line, [20] * 4 if long else [8, 16, 16, 16])
                place[whole_number(number, "*NODE")] = len(points)
                points.append([number_of(text, f"node {number}") for text in (rest + [""] * 3)[:3]])
        elif name == "PART":
            for title, numbers in zip(lines[::2], lines[1::2], strict=False):
                part = whole_number(_split(numbers, [20 if long else 10])[0], "*PART")
                titles[part] = title.strip()
        elif name.startswith(("ELEMENT_SOLID", "ELEMENT_TSHELL")):
            solids += _solids(name, lines, 20 if long else 8)
        elif name == "ELEMENT_SHELL":
            flat += [_numbers(line, 20 if long else 8, name, 6) for line in lines]
        elif name.startswith(("SET_SEGMENT", "SET_NODE_LIST")):
            sets.append((name, long, lines))
        elif name.startswith(("ELEMENT_MASS", "ELEMENT_INERTIA")):
            masses += [(name, long, line) for line in lines]
        elif name.startswith("ELEMENT_"):
            found.leave(f"line of *{name}", len(lines))
        elif name.startswith("RIGIDWALL"):
            found.leave(f"wall (*{name})")
    for part, nodes in solids:
        kind = {8: "hexahedron", 10: "tetra10"}[len(nodes)]
        found.add_of_part(kind, nodes, place, str(part), titles.get(part, ""))
    for _, part, *nodes in flat:
        names = {f"PART {part}", titles.get(part, "")} - {""}
        found.add_face("SHELL", [place.get(node, -1) for node in nodes], *names)
    for name, long, line in masses:
        found.masses.append(_mass(name, long, line, place))
    for name, long, lines in sets:
        _take_set(name, lines, 20 if long else 10, place, found)
    return found.stored(np.array(points, dtype=np.float64).reshape(-1, 3))


def _keywords(text: str) -> Iterator[tuple[str, bool, list[str]]]:
    """Yield each keyword up to *END, whether its fields are long, and its lines."""
    every = False
    for head, lines in sections(text, "*", "$"):
        if head.startswith("KEYWORD"):
            every = "LONG=Y" in head.replace(" ", "")
        long = (every or head.endswith("+")) and not head.endswith("-")
        name = head.rstrip("+-% ").strip()
        if name == "END":
            return
        yield name, long, lines


def _split(line: str, widths: list[int]) -> list[str]:
    """Return the fields of a line: between commas, or of fixed widths."""
    return [part.strip() for part in line.split(",")] if "," in line else fixed_fields(line, widths)


def _numbers(line: str, width: int, name: str, most: int = 10) -> list[int]:
    """Return the whole numbers in the first ``most`` fields of a line, those that are left out not."""
    return [whole_number(text, f"*{name}") for text in _split(line, [width] * most)[:most] if text]


def _mass(name: str, long: bool, line: str, place: dict[int, int]) -> PointMass:
    """Return the mass of a line; of a part that is given its final mass, it is not known."""
    if name not in MASSES:
        return PointMass(name)
    short, wide, at = MASSES[name]
    fields = _split(line, wide if long else short)
    number = number_of(fields[at], f"*{name}")
    node = place.get(whole_number(fields[1], name), -1) if name == "ELEMENT_MASS" else -1
    return PointMass(name, number if number or "PART" not in name else nan, node)


def _take_set(name: str, lines: list[str], width: int, place: dict[int, int], found: Elements) -> None:
    """Add a set of segments or nodes, by its number and its title."""
    titled = name.endswith("_TITLE")
    head, *rest = lines[titled:]
    number = whole_number(_split(head, [width])[0], f"*{name}")
    names = {lines[0].strip() if titled else "", f"{'SEGMENT' if 'SEGMENT' in name else 'NODE'} SET {number}"}
    for line in rest:
        # attributes of a segment follow its nodes
        nodes = [place.get(node, -1) for node in _numbers(line, width, name, 4 if "SEGMENT" in name else 8)]
        if "SEGMENT" in name:
            found.add_face("", nodes, *(names - {""}))
            continue
        for one in names - {""}:
            found.node_sets.setdefault(one, []).extend(node for node in nodes if node >= 0)


def _solids(name: str, lines: list[str], width: int) -> Iterator[tuple[int, list[int]]]:
    """Yield part and nodes of each solid, on one line of ten numbers, or on two."""
    option = (
        name.removeprefix("ELEMENT_SOLID").removeprefix("ELEMENT_TSHELL").strip("_").removesuffix("_TITLE")
    )
    if option not in ("", "TITLE", *LINES_MORE):
        raise MeshError(f"holds cells of *{name}, which is not read. Write them as *ELEMENT_SOLID.")
    more, at = LINES_MORE.get(option, 0), 0
    while at < len(lines):
        line = lines[at]
        while line.rstrip().endswith(",") and at + 1 < len(lines):
            at += 1
            line += lines[at]
        head = [whole_number(text, name) for text in _split(line, [width] * 10) if text]
        at += 1
        if len(head) <= 2:
            if at >= len(lines):
                raise MeshError(f"ends within a cell of *{name}.")
            nodes = [whole_number(text, name) for text in _split(lines[at], [width] * 10) if text]
            at += 1
        else:
            nodes = head[2:]
        at += more
        nodes = [node for node in nodes if node]
        if len(nodes) == 10 and nodes[8] != nodes[9]:
            yield head[1], nodes
        elif len(nodes) >= 4:
            yield head[1], (nodes + [nodes[-1]] * 8)[:8] if len(nodes) < 8 else nodes[:8]
        else:
            raise MeshError(f"has a cell {head[0]} of *{name} with {len(nodes)} nodes.")
