"""A part of an Abaqus deck: its nodes, cells, sets and surfaces, and where an instance puts them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import nan

import numpy as np

from meshes.common import FloatArray, MeshError
from meshes.reading.stored import NODES, Elements, PointMass
from meshes.reading.text import number_of

# Nodes of a cell by the letters of its type: continuum elements C3D8, C3D8R, C3D8I, CSS8, heat DC3D8, ...
VOLUME = ("C3D", "DC3D", "DCC3D", "AC3D", "Q3D", "CSS", "SC6", "SC8")
BY_COUNT = {NODES[kind]: kind for kind in NODES if kind != "pyramid13"}
UNUSABLE = {
    "CIN3D": "infinite",
    "EC3D": "Eulerian",
    "COH3D": "cohesive",
    "GK3D": "gasket",
    "PC3D": "particle",
}
# corners of the faces S1, S2, ... of a cell, in order around each
SIDES = {
    4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    6: ((0, 1, 2), (3, 5, 4), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    8: ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
}
SIDES |= {10: SIDES[4], 15: SIDES[6], 20: SIDES[8], 27: SIDES[8]}
LINES = ("B2", "B3", "T2D", "T3D", "PIPE", "SPRING", "DASHPOT", "CONN", "ELBOW", "FRAME")  # cells along lines
SHELL_SIDES = ("SPOS", "SNEG", "")


@dataclass(slots=True)
class AbaqusPart:
    """What a part or an instance holds.

    Attributes
    ----------
    nodes : (3,) each, by number
    cells : type and nodes by number
    sets, node_sets : numbers of cells, of nodes, by name
    surfaces : by name, pairs of a cell or a set of cells and what of it is meant, such as S3
    masses : of each of a set of points of mass, by its name
    """

    nodes: dict[int, tuple[float, ...]] = field(default_factory=dict)
    cells: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    sets: dict[str, list[int]] = field(default_factory=dict)
    node_sets: dict[str, list[int]] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    masses: dict[str, float] = field(default_factory=dict)

    def keep(self, of: str, name: str, rows: list[tuple[str, str]]) -> None:
        """Add rows to the set or surface of a name; ``of`` says to which of the three kinds."""
        if of == "surfaces":
            self.surfaces.setdefault(name, []).extend(rows)
            return
        sets: dict[str, list[int]] = getattr(self, of)
        found = _numbers([text for text, _ in rows], sets)
        sets.setdefault(name, []).extend(found)

    def numbered_as(self, other: "AbaqusPart") -> "AbaqusPart":
        """Return the part with the sets and surfaces of another that numbers the same nodes and cells."""
        return AbaqusPart(
            self.nodes,
            self.cells,
            {name: list(cells) for name, cells in (other.sets | self.sets).items()},
            {name: list(nodes) for name, nodes in (other.node_sets | self.node_sets).items()},
            {name: list(rows) for name, rows in (other.surfaces | self.surfaces).items()},
            other.masses | self.masses,
        )


def place(body: AbaqusPart, moves: list[list[str]], found: Elements, name: str) -> None:
    """Add a body to the elements ``found``, where the moves of its instance put it."""
    first = len(found.place)
    number = {own: first + k for k, own in enumerate(body.nodes)}  # all instances count their nodes from 1
    points = np.array(list(body.nodes.values()), dtype=np.float64).reshape(-1, 3)
    for own, point in enumerate(moved(points, moves, f"*INSTANCE {name}").tolist(), first):
        found.node(own, point)
    members: dict[int, list[str]] = {}
    for one, numbers in body.sets.items():
        for cell in set(numbers):
            members.setdefault(cell, []).append(one)
    for cell, (kind, all_nodes) in body.cells.items():
        # CalculiX gives nodes of its own to the incompatible modes of C3D8I
        nodes = all_nodes[:8] if kind == "C3D8I" else all_nodes
        told, named = _volume(kind, len(nodes)), members.get(cell, [])
        places = [number.get(node, -1) for node in nodes]
        if told is None and kind == "MASS":
            stated = [body.masses[one] for one in named if one in body.masses]
            found.masses.append(PointMass("MASS", (*stated, nan)[0], places[0]))
        elif told is None and kind.startswith(LINES):
            found.leave(f"cell of type {kind}")
        elif told is None:
            found.add_face(kind, places, *named)
        elif min(places) < 0:
            missing = nodes[places.index(-1)]
            raise MeshError(f"has a cell {cell} that names the node {missing}, which is not there.")
        else:
            found.add(told, tuple(places), *([name] if name else []), *named)
    for surface, rows in body.surfaces.items():
        for text, side in rows:
            for cell in _numbers([text], body.sets):
                for face in _faces(*body.cells.get(cell, ("", ())), side):
                    found.add_face("", [number.get(node, -1) for node in face], surface)
    for one, numbers in body.node_sets.items():
        found.add_nodes(one, (number.get(node, -1) for node in numbers))


def _numbers(texts: list[str], sets: Mapping[str, list[int]]) -> list[int]:
    """Return the numbers of nodes or cells that are given one by one, or by the names of sets."""
    found: list[int] = []
    for text in texts:
        found += [int(text)] if text.lstrip("-").isdigit() else sets.get(text.strip("\"'").upper(), [])
    return found


def _faces(kind: str, nodes: tuple[int, ...], side: str) -> list[tuple[int, ...]]:
    """Return the nodes of the face of a cell that a surface names, such as S3; of all where it names none."""
    if not count_of(kind):
        return [nodes] if side in SHELL_SIDES else []
    sides = SIDES.get(count_of(kind), ())
    chosen = sides if not side else [one for k, one in enumerate(sides, 1) if side == f"S{k}"]
    return [tuple(nodes[k] for k in face) for face in chosen if len(nodes) > max(face)]


def moved(points: FloatArray, moves: list[list[str]], name: str) -> FloatArray:
    """Return nodes moved by the first line of ``name``, then turned about the axis of its second."""
    lines = [[number_of(part, name) for part in line if part] for line in moves]
    if lines:
        points = points + np.array((lines[0] + [0.0] * 3)[:3])
    if len(lines) > 1:
        a, b, angle = np.array(lines[1][:3]), np.array(lines[1][3:6]), np.deg2rad(lines[1][6])
        axis = (b - a) / np.linalg.norm(b - a)
        away = points - a
        points = (
            a
            + away * np.cos(angle)
            + np.cross(axis, away) * np.sin(angle)
            + np.outer(away @ axis, axis) * (1.0 - np.cos(angle))
        )
    return points


def count_of(kind: str) -> int:
    """Return how many nodes a type of volume cells has by its name, 0 where it is none."""
    digits = "".join(" " if not char.isdigit() else char for char in kind.replace("3D", "  ")).split()
    return int(digits[0]) if digits and kind.startswith(VOLUME) and int(digits[0]) in BY_COUNT else 0


def _volume(kind: str, nodes: int) -> str | None:
    """Return the kind of volume cells that a type stands for, None of points, lines and surfaces.

    Raises
    ------
    MeshError
        If it is no solid, or not named.
    """
    for start, what in UNUSABLE.items():
        if kind.startswith(start):
            raise MeshError(f"holds {what} cells ({kind}), which are no solid. Leave them out of the file.")
    if not kind:
        raise MeshError("has *ELEMENT without TYPE. Name the type of its cells, such as C3D8.")
    count = count_of(kind)
    if not kind.startswith("C3D") and not count:
        return None
    if nodes != count:
        raise MeshError(f"has a cell of type {kind} with {nodes} nodes, which is no solid that is known.")
    return BY_COUNT[count]
