"""Starter files of Radioss: nodes and solid elements by part."""

from collections.abc import Iterator
from math import nan
from pathlib import Path

from meshes.common import MeshError
from meshes.reading.stored import ENDS_APART, Elements, PointMass, StoredMesh, part_names
from meshes.reading.text import fixed_fields, lines_of, number_of, place_of, sections, whole_number

SOLIDS = {"BRICK": 8, "TETRA4": 4, "PENTA6": 6, "TETRA10": 10, "BRIC20": 20}
KINDS = {8: "hexahedron", 4: "tetra", 6: "wedge", 10: "tetra10", 20: "hexahedron20"}
FLAT = {"SHELL": 4, "SH3N": 3}
OTHERS = ("TRUSS", "BEAM", "SPRING", "QUAD", "TRIA", "SPHCEL", "XELEM")
# kinds of /ADMAS of which each line states a mass to add: to a group of nodes, to parts, to a node
ADDED, EACH, NODE = ("0", "1", "3", "5", "6"), "0", "5"
REFUSED = {
    "TRANSFORM": "moves nodes by /{0}. Write the deck with the nodes where they are.",
    "SUBMODEL": "holds a submodel by /{0}. Write it as one model.",
    "SHEL16": "holds cells of /{0}, which are not read. Mesh the body with /BRICK or /BRIC20.",
}


def radioss(path: Path) -> StoredMesh:
    """Read /NODE, /BRICK, /TETRA4, /PENTA6, /TETRA10 and /BRIC20; a set is a part, by number and title.

    /SURF/SEG, /GRNOD/NODE, and /SHELL and /SH3N of a part may name faces.

    Raises
    ------
    MeshError
        If the deck includes or moves what it does not hold, or names what is not there.
    """
    titles: dict[str, str] = {}
    solids: list[tuple[str, list[int]]] = []
    found, flat, segments = Elements(), list[tuple[str, str, list[int]]](), list[tuple[set[str], list[int]]]()
    groups: list[tuple[set[str], list[int]]] = []
    masses: list[tuple[str, list[str]]] = []
    for name, lines in sections(lines_of(path, "radioss"), "/", "#"):
        stated, after_title = ([line for line in some if line] for some in (lines, lines[1:]))
        for start, problem in REFUSED.items():
            if name.removeprefix("/").startswith(start):
                raise MeshError(problem.format(name))
        kind, _, part = name.partition("/")
        if kind == "NODE":
            for line in stated:
                number, *rest = _split(line, [10, 20, 20, 20])
                found.node(whole_number(number, "/NODE"), place_of(rest, number))
        elif kind == "PART" and lines:
            titles[part.split("/")[0]] = lines[0].strip()
        elif kind in SOLIDS:
            solids += [(part, nodes) for nodes in _solids(kind, stated)]
        elif kind in FLAT:
            flat += [(kind, part, _numbers(line, name)[1 : 1 + FLAT[kind]]) for line in stated]
        elif name.startswith(("SURF/SEG/", "GRNOD/NODE/")) and lines:
            names = {lines[0].strip(), " ".join([kind, name.split("/")[2]])} - {""}
            rows = [_numbers(line, name) for line in after_title]
            if kind == "SURF":
                segments += [(names, row[1:5]) for row in rows]
            else:
                groups += [(names, row) for row in rows]
        elif kind in OTHERS:
            found.leave(f"line of /{kind}", len(stated))
        elif kind == "ADMAS":
            masses += [(part.split("/")[0], _split(line, [20, 10])) for line in after_title]
        elif kind == "RWALL":
            found.leave("wall (/RWALL)")
    for part, nodes in solids:
        names_of = part_names(part, titles.get(part, ""))
        found.solid(KINDS[len(nodes)], nodes, f"a solid of part {part}", *names_of)
    for kind, part, nodes in flat:
        found.add_face(kind, found.at(nodes), *part_names(part, titles.get(part, "")))
    for names, nodes in segments:
        found.add_face("", found.at(nodes), *names)
    for names, nodes in groups:
        for one in names:
            found.add_nodes(one, nodes)
    for kind, (text, of, *_) in masses:
        times = len(found.node_sets.get(f"GRNOD {of}", [])) if kind == EACH else 1
        mass = times * number_of(text, "/ADMAS") if kind in ADDED and times else nan
        node = found.at([whole_number(of, "/ADMAS")])[0] if kind == NODE else -1
        found.masses.append(PointMass(f"/ADMAS/{kind}", mass, node))
    return found.stored()


def _split(line: str, widths: list[int]) -> list[str]:
    """Return the fields of a line: of fixed widths, or between spaces where they are shorter than these."""
    parts = line.split()
    return parts if len(parts) >= len(widths) or len(line) <= widths[0] else fixed_fields(line, widths)


def _numbers(line: str, name: str) -> list[int]:
    """Return the whole numbers of a line, those that are left out not."""
    texts = [line[k : k + 10] for k in range(0, len(line), 10)] if len(line) > 80 else line.split()
    return [whole_number(text, f"/{name}") for text in texts if text.strip()]


def _solids(kind: str, lines: list[str]) -> Iterator[list[int]]:
    """Yield the nodes of each solid; those of ten and twenty nodes go on after the line of their number."""
    count, numbers = SOLIDS[kind], list[int]()
    for line in lines:
        numbers += _numbers(line, kind)
        if len(numbers) > count:
            nodes = numbers[1 : count + 1]
            yield [nodes[k] for k in ENDS_APART.get(KINDS[count], range(count))]
            numbers = []
    if numbers:
        raise MeshError(f"ends within a cell of /{kind}.")
