"""Archives of Ansys Mechanical APDL (.cdb): NBLOCK, EBLOCK, CMBLOCK and the types of elements."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import nan
from pathlib import Path

from meshes.common import MeshError
from meshes.reading.stored import Elements, PointMass, StoredMesh, keep
from meshes.reading.text import lines_of, number_of, numbers_between, place_of, whole_number

# numbers of the types of elements that are solids; those of ten nodes; points of mass
SOLIDS = {5, 45, 62, 64, 65, 69, 70, 90, 95, 96, 97, 117, 122, 128, 147, 162, 164, 185, 186, 190, 226, 231}
SOLIDS |= {239, 278, 279}
TETRA10 = {87, 92, 98, 123, 127, 148, 168, 187, 227, 232, 237, 291}
TETRA4 = {72, 285}
MASSES = {21, 166}
LINES = {4, 8, 10, 14, 16, 20, 44, 180, 188, 189, 288, 289, 290}  # beams, links, pipes and springs
MAKERS = ("NGEN", "EGEN", "NSCALE", "TRANSFER", "NSYM", "ESYM", "EN", "E", "N")


@dataclass(slots=True)
class _Archive:
    """What was read of an archive.

    Attributes
    ----------
    nodes : by number, (3,)
    types : number of the element's type by its number in the file
    cells : by number: type, nodes
    real, constants : number of its set of constants by cell, and the first of each set
    components, node_sets : by name: numbers of elements, of nodes
    """

    nodes: dict[int, tuple[float, ...]] = field(default_factory=dict)
    types: dict[int, int] = field(default_factory=dict)
    cells: dict[int, tuple[int, list[int]]] = field(default_factory=dict)
    real: dict[int, int] = field(default_factory=dict)
    constants: dict[int, float] = field(default_factory=dict)
    components: dict[str, list[int]] = field(default_factory=dict)
    node_sets: dict[str, list[int]] = field(default_factory=dict)


def ansys(path: Path) -> StoredMesh:
    """Read an archive as CDWRITE writes it; a set is a component of elements or nodes.

    Raises
    ------
    MeshError
        If it makes nodes or cells by commands, or names what is not there.
    """
    archive, lines = _Archive(), iter(lines_of(path))
    for line in lines:
        words = [word.strip() for word in line.split("!")[0].split(",")]
        name = words[0].upper()
        if name == "ET":
            if words[1].isdigit():  # those of contact are numbered by a parameter
                archive.types[int(words[1])] = whole_number(re.sub(r"\D", "", words[2]), "ET")
        elif name == "ETBLOCK":
            _types(lines, archive)
        elif name == "R" and words[1].isdigit():
            archive.constants[int(words[1])] = number_of((*words[2:3], "")[0], "R")
        elif name == "RLBLOCK":
            _constants(lines, whole_number(words[1], "RLBLOCK"), archive)
        elif name == "NBLOCK":
            _nodes(lines, archive)
        elif name == "EBLOCK":
            _cells(lines, archive, "SOLID" in line.upper())
        elif name == "CMBLOCK":
            of = archive.components if words[2].upper().startswith("ELEM") else archive.node_sets
            of[words[1].upper()] = _members(lines, whole_number(words[3], "CMBLOCK"))
        elif name in MAKERS:
            raise MeshError(
                f"makes nodes or cells by the command {name}. Write it by CDWRITE,DB with blocks."
            )
    return _stored(archive)


def _widths(line: str) -> tuple[int, int, int]:
    """Return count and width of whole numbers, and width of numbers, of a line such as (3i9,6e21.13e3)."""
    found = re.match(r"\s*\((\d+)i(\d+)(?:,\d+[eg](\d+))?", line.lower())
    if not found:
        raise MeshError(f"has a block with the format {line.strip()!r}, which is not read.")
    return int(found[1]), int(found[2]), int(found[3] or 0)


def _nodes(lines: Iterator[str], archive: _Archive) -> None:
    count, width, wide = _widths(next(lines, ""))
    for line in lines:
        if line.strip().startswith(("N,", "-1")):
            return
        number, start = whole_number(line[:width], "NBLOCK"), count * width
        texts = [line[start + k * wide : start + (k + 1) * wide] for k in range(3)]
        keep(archive.nodes, number, place_of(texts, number), "nodes")
    raise MeshError("ends within an NBLOCK: it is cut off. Write it again.")


def _constants(lines: Iterator[str], count: int, archive: _Archive) -> None:
    """Read so many sets of constants, each on a line with its number and on lines of seven."""
    _, width, wide = _widths(next(lines, ""))
    next(lines, "")
    for _ in range(count):
        line = next(lines, "")
        number, held = (whole_number(line[k * width : (k + 1) * width], "RLBLOCK") for k in (0, 1))
        archive.constants[number] = number_of(line[2 * width : 2 * width + wide], "RLBLOCK")
        for _ in range(0, held - 6, 7):
            next(lines, "")


def _types(lines: Iterator[str], archive: _Archive) -> None:
    _widths(next(lines, ""))
    for line in lines:
        parts = line.split()
        if parts[:1] in ([], ["-1"]):
            return
        archive.types[int(parts[0])] = int(parts[1])


def _cells(lines: Iterator[str], archive: _Archive, solid: bool) -> None:
    """Read a block of elements: of solids with eleven numbers before the nodes, of others with five."""
    _, width, _ = _widths(next(lines, ""))
    wanted, numbers = 0, list[int]()
    for line in lines:
        parts = [whole_number(line[k : k + width], "EBLOCK") for k in range(0, len(line.rstrip()), width)]
        if parts[:1] == [-1]:
            return
        numbers += parts
        if solid and len(numbers) >= 11:
            wanted = 11 + numbers[8]
        if len(numbers) >= wanted:
            kind, number, nodes = (
                (numbers[1], numbers[10], numbers[11:]) if solid else (0, numbers[0], numbers[5:])
            )
            keep(archive.cells, number, (kind, nodes), "cells")
            archive.real[number] = numbers[2] if solid else 0
            numbers = []
    raise MeshError("ends within an EBLOCK: it is cut off. Write it again.")


def _members(lines: Iterator[str], left: int) -> list[int]:
    """Read a list of so many numbers, of which one below 0 ends a range that the one before it begins."""
    _, width, _ = _widths(next(lines, ""))
    found: list[int] = []
    while left > 0:
        line = next(lines, "").rstrip()
        for k in range(0, min(len(line), left * width), width):
            one = whole_number(line[k : k + width], "CMBLOCK")
            found += numbers_between(found[-1] + 1, -one, 1, "CMBLOCK") if one < 0 and found else [one]
        left -= max(len(line) // width, 1)
    return found


def _stored(archive: _Archive) -> StoredMesh:
    found, sets = Elements(), dict[int, list[str]]()
    for number, place in archive.nodes.items():
        found.node(number, place)
    for name, members in archive.components.items():
        for member in members:
            sets.setdefault(member, []).append(name)
    for number, (slot, nodes) in archive.cells.items():
        if slot and slot not in archive.types and len(nodes) >= 4:
            raise MeshError(f"has a cell {number} of a type {slot} that no command ET of it defines.")
        kind = archive.types.get(slot, 0)
        told = _kind(kind, len(nodes))
        if told:
            found.solid(told, nodes, f"a cell {number}", *sets.get(number, []))
        elif kind in MASSES:
            mass = archive.constants.get(archive.real[number], nan)
            found.masses.append(PointMass(f"MASS{kind}", mass, found.at(nodes)[0]))
        elif kind in LINES:
            found.leave(f"cell of type {kind}")
        elif kind:
            found.add_face(str(kind), found.at(nodes), *sets.get(number, []))
        else:
            found.leave("cell outside of solid blocks")
    for name, members in archive.node_sets.items():
        found.add_nodes(name, members)
    return found.stored()


def _kind(kind: int, count: int) -> str | None:
    """Return the kind of volume cells of a type of element, None where it is no solid."""
    if kind not in SOLIDS | TETRA4 | TETRA10:
        return None
    kinds = {8: "hexahedron", 20: "hexahedron20", 4: "tetra", 10: "tetra10"}
    if count not in kinds or (kind in TETRA10 and count != 10):
        raise MeshError(f"has a solid of type {kind} with {count} nodes, which is not read.")
    return kinds[count]
