"""Keyword files of LS-DYNA: nodes, solid elements, parts."""

from collections.abc import Iterator
from math import nan
from pathlib import Path

from meshes.common import MeshError
from meshes.reading.stored import Elements, PointMass, StoredMesh, part_names
from meshes.reading.text import fixed_fields, lines_of, number_of, place_of, sections, whole_number

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
# how many whole numbers stand before the mass
MASSES = {"ELEMENT_MASS": 2, "ELEMENT_MASS_NODE_SET": 2, "ELEMENT_MASS_PART": 1, "ELEMENT_MASS_PART_SET": 1}
SETS = ("SET_SEGMENT", "SET_NODE", "SET_NODE_LIST")


def lsdyna(path: Path) -> StoredMesh:
    """Read *NODE and *ELEMENT_SOLID, fixed or free fields; a set is a part, by its number and its title.

    Sets of segments and nodes, and shells of a part, may name faces.

    Raises
    ------
    MeshError
        If the deck includes or moves what it does not hold, or names what is not there.
    """
    titles: dict[int, str] = {}
    solids: list[tuple[int, list[int]]] = []
    found, flat, sets = Elements(), list[list[int]](), list[tuple[str, int, list[str]]]()
    masses: list[tuple[str, int, str]] = []
    for name, width, lines in _keywords(lines_of(path, "lsdyna")):
        stated = [line for line in lines if line]
        for start, problem in REFUSED.items():
            if name.startswith(start):
                raise MeshError(problem.format(name))
        if name == "NODE":
            for line in stated:
                number, *rest = _split(line, [width] + [_wide(width)] * 3)
                found.node(whole_number(number, "*NODE"), place_of(rest, number))
        elif name == "PART":
            for title, numbers in zip(lines[::2], lines[1::2], strict=False):
                if (number := _split(numbers, [max(width, 10)])[0]).isdigit():
                    titles[int(number)] = title.strip()
        elif name.startswith(("ELEMENT_SOLID", "ELEMENT_TSHELL")):
            solids += _solids(name, lines, width)
        elif name == "ELEMENT_SHELL":
            flat += [_numbers(line, width, name, 6) for line in stated]
        elif name.removesuffix("_TITLE") in SETS:
            sets.append((name, max(width, 10), lines))
        elif name.startswith(("SET_SEGMENT", "SET_NODE")):
            found.leave(f"set (*{name})")
        elif name.startswith(("ELEMENT_MASS", "ELEMENT_INERTIA")):
            masses += [(name, width, line) for line in stated]
        elif name.startswith("ELEMENT_"):
            found.leave(f"line of *{name}", len(stated))
        elif name.startswith("RIGIDWALL"):
            found.leave(f"wall (*{name})")
    for part, nodes in solids:
        kind = {8: "hexahedron", 10: "tetra10"}[len(nodes)]
        found.solid(kind, nodes, f"a solid of part {part}", *part_names(part, titles.get(part, "")))
    for _, part, *nodes in flat:
        found.add_face("SHELL", found.at(nodes), *part_names(part, titles.get(part, "")))
    for name, width, line in masses:
        found.masses.append(_mass(name, width, line, found))
    for name, width, lines in sets:
        _take_set(name, lines, width, found)
    return found.stored()


def _keywords(lines: list[str]) -> Iterator[tuple[str, int, list[str]]]:
    """Yield each keyword up to *END, the width of its whole numbers, and its lines.

    The width is 8 letters; 10 where the deck states I10 or a keyword ends in %, 20 where it states LONG or +.
    """
    every = 8
    for head, held in sections(lines, "*", "$"):
        if head.startswith("KEYWORD"):
            bare = head.replace(" ", "")
            every = 20 if "LONG=Y" in bare else 10 if "I10=Y" in bare else 8
        name = head.rstrip("+-% ").strip()
        if name == "END":
            return
        yield name, {"+": 20, "%": 10, "-": 8}.get(head[-1:], every), held


def _wide(width: int) -> int:
    """Return the width of the numbers that stand beside whole ones of a ``width``."""
    return 20 if width == 20 else 16


def _split(line: str, widths: list[int]) -> list[str]:
    """Return the fields of a line: between commas, or of fixed widths."""
    return [part.strip() for part in line.split(",")] if "," in line else fixed_fields(line, widths)


def _numbers(line: str, width: int, name: str, most: int = 10) -> list[int]:
    """Return the whole numbers in the first ``most`` fields of a line, those that are left out not."""
    return [whole_number(text, f"*{name}") for text in _split(line, [width] * most)[:most] if text]


def _mass(name: str, width: int, line: str, found: Elements) -> PointMass:
    """Return the mass of a line; of a part that is given its final mass, it is not known."""
    if name not in MASSES:
        return PointMass(name)
    at = MASSES[name]
    fields = _split(line, [width] * at + [_wide(width)])
    number = number_of(fields[at], f"*{name}")
    node = found.at([whole_number(fields[1], name)])[0] if name == "ELEMENT_MASS" else -1
    return PointMass(name, number if number or "PART" not in name else nan, node)


def _take_set(name: str, lines: list[str], width: int, found: Elements) -> None:
    """Add a set of segments or nodes, by its number and its title."""
    titled, what = name.endswith("_TITLE"), "SEGMENT" if "SEGMENT" in name else "NODE"
    head, *rest = lines[titled:]
    number = whole_number(_split(head, [width])[0], f"*{name}")
    names = {lines[0].strip() if titled else "", f"{what} SET {number}"} - {""}
    for line in filter(None, rest):
        # attributes of a segment follow its nodes
        nodes = _numbers(line, width, name, 4 if what == "SEGMENT" else 8)
        if what == "SEGMENT":
            found.add_face("", found.at(nodes), *names)
            continue
        for one in names:
            found.add_nodes(one, nodes)


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
        if not line:
            at += 1
            continue
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
