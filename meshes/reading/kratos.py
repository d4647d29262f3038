"""Model parts of Kratos Multiphysics (.mdpa): nodes, elements by their name, sub model parts."""

import re
from pathlib import Path

from meshes.common import MeshError
from meshes.reading.stored import ENDS_APART, Elements, PointMass, StoredMesh, keep
from meshes.reading.text import lines_of, place_of, whole_number

KINDS = {4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron", 10: "tetra10", 15: "wedge15"}
KINDS |= {20: "hexahedron20", 27: "hexahedron27"}
SURFACES = (
    "SHELL",
    "MEMBRANE",
    "CONDITION",
    "SURFACE",
    "CABLE",
    "TRUSS",
    "BEAM",
    "LINE",
    "QUADRI",
    "TRIANGLE",
)


def kratos(path: Path) -> StoredMesh:
    """Read nodes and the elements whose name ends in 3D and a number of nodes; a set is a sub model part.

    Conditions and nodes of sub model parts may name faces.

    Raises
    ------
    MeshError
        If a cell names what is not there, or a number stands for two.
    """
    cells: dict[int, tuple[str | None, list[int], str]] = {}
    conditions: dict[int, tuple[str, list[int]]] = {}
    members: dict[str, dict[int, list[str]]] = {"Elements": {}, "Conditions": {}, "Nodes": {}}
    found, opened = Elements(), list[tuple[str, str]]()
    for raw in lines_of(path):
        line = raw.split("//")[0].strip()
        words = line.split()
        if not words:
            continue
        if words[0] == "Begin":
            opened.append((words[1], words[2] if len(words) > 2 else ""))
        elif words[0] == "End" and opened:
            opened.pop()
        elif opened and opened[-1][0] == "Nodes":
            found.node(whole_number(words[0], "Nodes"), place_of(words[1:], words[0]))
        elif opened and opened[-1][0] == "Elements":
            name = opened[-1][1]
            numbers = [whole_number(text, name) for text in words]
            solid = re.search(r"3D\d*N?$", name) and not any(word in name.upper() for word in SURFACES)
            kind = KINDS.get(len(numbers) - 2) if solid else None
            keep(cells, numbers[0], (kind, numbers[2:], f"PROPERTIES {numbers[1]}"), "cells")
        elif opened and (of := opened[-1][0].removeprefix("SubModelPart")) in members and len(opened) > 1:
            names = [name for kind, name in opened if kind == "SubModelPart"]
            members[of].setdefault(whole_number(words[0], opened[-1][0]), []).extend(names)
        elif opened and opened[-1][0] == "Conditions":
            numbers = [whole_number(text, "Conditions") for text in words]
            keep(conditions, numbers[0], (opened[-1][1], numbers[2:]), "conditions")
    if opened:
        raise MeshError(f"ends within {opened[-1][0]}, without its End: it is cut off. Write it again.")
    for number, (kind, nodes, properties) in cells.items():
        named = members["Elements"].get(number, [])
        if kind is None and len(nodes) == 1:
            found.masses.append(PointMass("element of 1 node", node=found.at(nodes)[0]))
        elif kind is None:
            found.add_face(f"{len(nodes)} nodes that fills no volume", found.at(nodes), *named)
        else:
            nodes = [nodes[k] for k in ENDS_APART.get(kind, range(len(nodes)))]
            found.solid(kind, nodes, f"a cell {number}", properties, *named)
    for number, (name, nodes) in conditions.items():
        found.add_face(name, found.at(nodes), *members["Conditions"].get(number, []))
    for node, names in members["Nodes"].items():
        for one in names:
            found.add_nodes(one, [node])
    return found.stored()
