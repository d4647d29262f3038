"""Keyword files of LS-DYNA: nodes, solid elements, parts."""

from collections.abc import Iterator
from itertools import pairwise
from math import nan
from pathlib import Path

import numpy as np

from meshes.common import MeshError
from meshes.reading.lsdyna_moves import WIDE, Moves, filled, parameters, split
from meshes.reading.stored import Elements, PointMass, StoredMesh, keep, part_names
from meshes.reading.text import lines_of, number_of, numbers_between, place_of, sections, whole_number

PATHS = ("INCLUDE_PATH", "INCLUDE_PATH_RELATIVE")  # files that a deck takes lie beside it
REFUSED = {
    "INCLUDE_": "takes a part of the mesh from another file by *{0}, which is not read. Copy its lines into "
    "this one.",
    "NODE_MERGE": "merges nodes by *{0}. Write the deck with merged nodes.",
    "NODE_SCALAR": "has nodes by *{0}, which are not read. Leave them out.",
    "ELEMENT_SOLID_NURBS": "holds cells of *{0}, which are no hexahedra. Mesh the body with hexahedra.",
}
SOLIDS = ("ELEMENT_SOLID", "ELEMENT_SOLID_TITLE", "ELEMENT_TSHELL")
LINES_MORE = {"ORTHO": 2, "DOF": 1}  # that an option adds to each element
# how many whole numbers stand before the mass
MASSES = {"ELEMENT_MASS": 2, "ELEMENT_MASS_NODE_SET": 2, "ELEMENT_MASS_PART": 1, "ELEMENT_MASS_PART_SET": 1}
GENERATED = ("SET_NODE_LIST_GENERATE", "SET_NODE_GENERATE")
SETS = ("SET_SEGMENT", "SET_NODE", "SET_NODE_LIST", *GENERATED)


def lsdyna(path: Path) -> StoredMesh:
    """Read *NODE and *ELEMENT_SOLID, fixed or free fields; a set is a part, by its number and its title.

    Sets of segments and nodes, and shells of a part, may name faces. Numbers of *PARAMETER are put in, nodes
    of *NODE_TRANSFORM are moved.

    Raises
    ------
    MeshError
        If the deck includes or moves what it does not hold, or names what is not there.
    """
    titles, places = dict[int, str](), dict[int, tuple[float, ...]]()
    solids: list[tuple[int, list[int]]] = []
    found, flat, sets = Elements(), list[list[int]](), list[tuple[str, int, list[str]]]()
    masses: list[tuple[str, int, str]] = []
    moves, moved = Moves(), list[list[int]]()
    for name, width, lines in _filled(_keywords(lines_of(path, "lsdyna"))):
        stated = [line for line in lines if line]
        for start, problem in REFUSED.items():
            if name.startswith(start) and name not in PATHS:
                raise MeshError(problem.format(name))
        if name == "NODE":
            for line in stated:
                number, *rest = split(line, [width] + [_wide(width)] * 3)
                keep(places, whole_number(number, "*NODE"), place_of(rest, number), "nodes")
        elif name == "DEFINE_TRANSFORMATION":
            moves.define(stated, name)
        elif name == "NODE_TRANSFORM":
            moved += [_numbers(line, WIDE, name, 2) for line in stated]
        elif name == "PART":
            for title, numbers in zip(lines[::2], lines[1::2], strict=False):
                if (number := split(numbers, [max(width, WIDE)])[0]).isdigit():
                    titles[int(number)] = title.strip()
        elif name.startswith(("ELEMENT_SOLID", "ELEMENT_TSHELL")):
            solids += _solids(name, lines, width)
        elif name == "ELEMENT_SHELL":
            flat += [_numbers(line, width, name, 6) for line in stated]
        elif name.removesuffix("_TITLE") in SETS:
            sets.append((name, max(width, WIDE), lines))
        elif name.startswith(("SET_SEGMENT", "SET_NODE")):
            found.leave(f"set (*{name})")
        elif name.startswith(("ELEMENT_MASS", "ELEMENT_INERTIA")):
            masses += [(name, width, line) for line in stated]
        elif name.startswith("ELEMENT_"):
            found.leave(f"line of *{name}", len(stated))
        elif name.startswith("RIGIDWALL"):
            found.leave(f"wall (*{name})")
    for pair in moved:
        _move(places, moves, pair, sets)
    for node, place in places.items():
        found.node(node, place)
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
        name = head.partition("(")[0].rstrip("+-% ").strip()  # as in (ten nodes format)
        if name == "END":
            return
        yield name, {"+": 20, "%": 10, "-": 8}.get(head[-1:], every), held


def _wide(width: int) -> int:
    """Return the width of the numbers that stand beside whole ones of a ``width``."""
    return 20 if width == 20 else 16


def _filled(keywords: Iterator[tuple[str, int, list[str]]]) -> Iterator[tuple[str, int, list[str]]]:
    """Yield the keywords that are read with the numbers of *PARAMETER in their lines."""
    known: dict[str, str] = {}
    for name, width, lines in keywords:
        if name in ("PARAMETER", "PARAMETER_LOCAL"):
            known |= parameters(lines)
        elif name.startswith(("NODE", "ELEMENT", "SET_", "DEFINE_TRANS")):
            wide = width if name.startswith("ELEMENT") else max(width, WIDE)
            widths = [width] + [_wide(width)] * 3 if name == "NODE" else [wide] * WIDE
            bare = lines[:1] if name.endswith("_TITLE") else []
            rest = [filled(line, widths, known) if "&" in line else line for line in lines[len(bare) :]]
            yield name, width, [*bare, *rest]
        else:
            yield name, width, lines


def _move(
    places: dict[int, tuple[float, ...]],
    moves: Moves,
    pair: list[int],
    sets: list[tuple[str, int, list[str]]],
) -> None:
    """Move the nodes of a set: the ``pair`` is of the numbers of the transformation and the set."""
    move, number = (*pair, 0)[:2]
    chosen = [nodes for one in sets if "NODE" in one[0] for of, nodes in [_nodes_of(*one)] if of == number]
    if not chosen:
        raise MeshError(f"moves the nodes of a set {number} that is not there.")
    for node in chosen[0]:
        if node in places:
            places[node] = tuple(moves.moved(move, np.array([places[node]]))[0].tolist())


def _numbers(line: str, width: int, name: str, most: int = 10) -> list[int]:
    """Return the whole numbers in the first ``most`` fields of a line, those that are left out not."""
    return [whole_number(text, f"*{name}") for text in split(line, [width] * most)[:most] if text]


def _mass(name: str, width: int, line: str, found: Elements) -> PointMass:
    """Return the mass of a line; of a part that is given its final mass, it is not known."""
    if name not in MASSES:
        return PointMass(name)
    at = MASSES[name]
    fields = split(line, [width] * at + [_wide(width)])
    number = number_of(fields[at], f"*{name}")
    node = found.at([whole_number(fields[1], name)])[0] if name == "ELEMENT_MASS" else -1
    return PointMass(name, number if number or "PART" not in name else nan, node)


def _nodes_of(name: str, width: int, lines: list[str]) -> tuple[int, list[int]]:
    """Return the number of a set of nodes, and those in it."""
    head, *rest = lines[name.endswith("_TITLE") :]
    found: list[int] = []
    for line in filter(None, rest):
        nodes = _numbers(line, width, name, 8)
        if name.removesuffix("_TITLE") in GENERATED:
            pairs = list(pairwise(nodes))[::2]
            nodes = [node for low, high in pairs for node in numbers_between(low, high, 1, f"*{name}")]
        found += nodes
    return whole_number(split(head, [width])[0], f"*{name}"), found


def _take_set(name: str, lines: list[str], width: int, found: Elements) -> None:
    """Add a set of segments or nodes, by its number and its title."""
    titled, what = name.endswith("_TITLE"), "SEGMENT" if "SEGMENT" in name else "NODE"
    title = lines[0].strip() if titled else ""
    if what == "NODE":
        number, nodes = _nodes_of(name, width, lines)
        for one in {title, f"NODE SET {number}"} - {""}:
            found.add_nodes(one, nodes)
        return
    head, *rest = lines[titled:]
    number = whole_number(split(head, [width])[0], f"*{name}")
    for line in filter(None, rest):  # attributes of a segment follow its nodes
        corners = found.at(_numbers(line, width, name, 4))
        found.add_face("", corners, *({title, f"SEGMENT SET {number}"} - {""}))


def _solids(name: str, lines: list[str], width: int) -> Iterator[tuple[int, list[int]]]:
    """Yield part and nodes of each solid, on one line of ten numbers, or on two."""
    bare = name.removeprefix("ELEMENT_SOLID").removeprefix("ELEMENT_TSHELL")
    option = bare.strip("_").removesuffix("_TITLE")
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
        head = [whole_number(text, name) for text in split(line, [width] * 10) if text]
        at += 1
        if len(head) <= 2:
            if at >= len(lines):
                raise MeshError(f"ends within a cell of *{name}.")
            nodes = [whole_number(text, name) for text in split(lines[at], [width] * 10) if text]
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
