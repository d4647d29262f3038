"""Decks of Abaqus and CalculiX: parts, instances and assemblies, sets, systems of coordinates."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from meshes.arrays import FloatArray
from meshes.errors import MeshError
from meshes.reading.includes import full_text
from meshes.reading.stored import NODES, Elements, StoredMesh, number_of, whole_number

__all__ = ["abaqus"]

# Nodes of a cell by the letters of its type: continuum elements C3D8, C3D8R, C3D8I, CSS8, heat DC3D8, ...
VOLUME = ("C3D", "DC3D", "DCC3D", "AC3D", "Q3D", "CSS", "SC6", "SC8")
BY_COUNT = {NODES[kind]: kind for kind in NODES if kind != "pyramid13"}
MASSES = ("MASS", "ROTARYI")
UNUSABLE = {
    "CIN3D": "infinite",
    "EC3D": "Eulerian",
    "COH3D": "cohesive",
    "GK3D": "gasket",
    "PC3D": "particle",
}
# lines that make nodes and cells of others, or move them
MAKERS = (
    "NGEN",
    "NFILL",
    "NCOPY",
    "NMAP",
    "ELGEN",
    "ELCOPY",
    "IMPORT",
    "SYMMETRIC MODEL GENERATION",
)
STATED = ("MATERIAL", "SOLID SECTION", "STEP", "BOUNDARY", "CLOAD", "DLOAD", "INITIAL CONDITIONS", "TIE")


@dataclass(slots=True)
class _Card:
    """A keyword with its parameters, names in capitals, and its lines of data."""

    name: str
    options: dict[str, str]
    lines: list[list[str]] = field(default_factory=list)


@dataclass(slots=True)
class _Part:
    """Nodes, (3,) each, and cells (type, nodes) by number, and sets of cells, of a part or an instance."""

    nodes: dict[int, FloatArray] = field(default_factory=dict)
    cells: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    sets: dict[str, list[int]] = field(default_factory=dict)


@dataclass(slots=True)
class _Instance:
    """A part that stands in the assembly: turned after it was moved."""

    part: str
    own: _Part
    moves: list[list[str]]


def abaqus(path: Path) -> StoredMesh:
    """Read a deck: every instance of its parts where the assembly puts it, or nodes and cells as they are.

    Raises
    ------
    MeshError
        If the deck makes nodes or cells by rules, or names what is not there.
    """
    deck = _Deck()
    for card in _cards(full_text(path, "abaqus")):
        deck.take(card)
    return deck.stored()


def _cards(text: str) -> Iterator[_Card]:
    """Split a deck into its keywords; a keyword that ends in a comma goes on in the next line."""
    card, going = None, ""
    for raw in text.splitlines():
        line = raw.strip()
        if line.startswith("**") or not line:
            continue
        if line.startswith("*") or going:
            going += line
            if going.endswith(","):
                continue
            if card is not None:
                yield card
            card, going = _keyword(going), ""
        elif card is not None:
            card.lines.append([part.strip() for part in line.split(",")])
    if card is not None:
        yield card


def _keyword(line: str) -> _Card:
    name, *options = line[1:].split(",")
    pairs = (option.partition("=") for option in options)
    stated = {" ".join(key.upper().split()): value.strip().strip("\"'") for key, _, value in pairs}
    return _Card(" ".join(name.upper().split()), stated)


class _Deck:
    """A deck while its keywords are taken, one after the other."""

    def __init__(self) -> None:
        self.plain, self.assembly = _Part(), _Part()
        self.parts: dict[str, _Part] = {}
        self.instances: dict[str, _Instance] = {}
        self.here = self.plain
        self.system: tuple[FloatArray, FloatArray] | None = None
        self.level = ""  # what is open: a part, an assembly, an instance
        self.assembly_sets: dict[str, list[tuple[str, list[int]]]] = {}
        self.stated = False

    def take(self, card: _Card) -> None:
        """Take a keyword."""
        name = card.name
        if name in MAKERS:
            raise MeshError(
                f"makes nodes or cells by *{name}, which is not read. Write the deck with all of them, as "
                "Abaqus/CAE and PrePoMax do."
            )
        if "INPUT" in card.options and name in ("NODE", "ELEMENT", "ELSET"):
            other = card.options.get("INPUT", "")
            raise MeshError(
                f"takes a part of the mesh from another file by *{name}, {other!r}. Name that file as mesh "
                "if it holds all nodes and cells, or copy its lines into this one."
            )
        self.stated = self.stated or name in STATED
        taken = {
            "PART": self._part,
            "END PART": self._end,
            "ASSEMBLY": self._assembly,
            "END ASSEMBLY": self._end,
            "INSTANCE": self._instance,
            "END INSTANCE": self._end_instance,
            "SYSTEM": self._system,
            "NODE": self._nodes,
            "ELEMENT": self._elements,
            "ELSET": self._elset,
        }.get(name)
        if taken:
            taken(card)

    def _part(self, card: _Card) -> None:
        self.here = self.parts.setdefault(card.options.get("NAME", "").upper(), _Part())
        self.level, self.system = "part", None

    def _end(self, _: _Card) -> None:
        self.here, self.level, self.system = self.plain, "", None

    def _assembly(self, _: _Card) -> None:
        self.here, self.level, self.system = self.assembly, "assembly", None

    def _instance(self, card: _Card) -> None:
        if "LIBRARY" in card.options or "INSTANCE" in card.options:
            raise MeshError(
                "takes an instance from the results of another job. Write the deck with its mesh."
            )
        own = _Part()
        name, part = card.options.get("NAME", ""), card.options.get("PART", "").upper()
        self.instances[name.upper()] = _Instance(part, own, card.lines)
        self.here, self.level, self.system = own, "instance", None

    def _end_instance(self, _: _Card) -> None:
        self.here, self.level, self.system = self.assembly, "assembly", None

    def _system(self, card: _Card) -> None:
        numbers = [number_of(text, "*SYSTEM") for line in card.lines for text in line if text]
        if not numbers:
            self.system = None
            return
        origin = np.array((numbers + [0.0] * 6)[:3])
        first = np.array(numbers[3:6]) - origin if len(numbers) >= 6 else np.array([1.0, 0.0, 0.0])
        second = (
            np.array(numbers[6:9]) - origin if len(numbers) >= 9 else np.array([-first[1], first[0], 0.0])
        )
        x = first / np.linalg.norm(first)
        z = np.cross(x, second)
        z /= np.linalg.norm(z)
        self.system = origin, np.array([x, np.cross(z, x), z])

    def _nodes(self, card: _Card) -> None:
        kind = card.options.get("SYSTEM", "R").upper()[:1]
        for line in card.lines:
            number = whole_number(line[0], "*NODE")
            place = np.array([number_of(part, f"node {number}") for part in (line[1:4] + [""] * 3)[:3]])
            place = _cartesian(place, kind)
            if self.system is not None:
                origin, axes = self.system
                place = origin + place @ axes
            self.here.nodes[number] = place

    def _elements(self, card: _Card) -> None:
        kind, name = card.options.get("TYPE", "").upper(), card.options.get("ELSET", "").upper()
        wanted = _count_of(kind)
        numbers: list[int] = []
        for line in card.lines:
            if self.level == "assembly":  # joins nodes of instances, named as ROD-1.5
                line = [part.rpartition(".")[2] for part in line]
            numbers += [whole_number(part, f"*ELEMENT of type {kind}") for part in line if part]
            if len(numbers) < wanted + 1 if wanted else line[-1] == "":
                continue  # a line that ends in a comma goes on
            self.here.cells[numbers[0]] = kind, tuple(numbers[1:])
            if name:
                self.here.sets.setdefault(name, []).append(numbers[0])
            numbers = []
        if numbers:
            self.here.cells[numbers[0]] = kind, tuple(numbers[1:])

    def _elset(self, card: _Card) -> None:
        name, sets = card.options.get("ELSET", "").upper(), self.here.sets
        members: list[int] = []
        for line in card.lines:
            texts = [part for part in line if part]
            if "GENERATE" in card.options:
                low, high, step = (*(whole_number(text, f"*ELSET {name}") for text in texts), 1)[:3]
                members += range(low, high + 1, step)
                continue
            for text in texts:
                members += [int(text)] if text.lstrip("-").isdigit() else sets.get(text.upper(), [])
        instance = card.options.get("INSTANCE", "").upper()
        if self.level == "assembly":
            self.assembly_sets.setdefault(name, []).append((instance, members))
        else:
            sets.setdefault(name, []).extend(members)

    def stored(self) -> StoredMesh:
        """Return the cells of all instances, or those of the deck that has none."""
        found, points, more = Elements(), list[FloatArray](), list[str]()
        bodies: list[tuple[str, _Part, list[list[str]], dict[str, list[int]]]] = [
            ("", body, [], {}) for body in (self.plain, self.assembly)
        ]
        for name, one in self.instances.items():
            part = self.parts.get(one.part, one.own)
            if one.part and one.part not in self.parts and not one.own.nodes:
                raise MeshError(f"has the instance {name} of a part {one.part} that is not there.")
            own = one.own if one.own.nodes or one.own.cells else part
            named = {n: m for n, sets in self.assembly_sets.items() for to, m in sets if to == name}
            bodies.append((name, own, one.moves, part.sets | named))
        used = {one.part for one in self.instances.values()}
        if not self.instances:  # a part alone stands where its nodes are
            bodies += [(name, part, [], part.sets) for name, part in self.parts.items()]
            used = set(self.parts)
        more += [f"the part {name}, of which there is no instance" for name in self.parts if name not in used]
        for name, body, moves, sets in bodies:
            points.append(
                _placed(body, moves, found, sum(len(one) for one in points), name, sets | body.sets)
            )
        if self.stated:
            more.append("materials, supports, loads and steps of the deck: the scene states its own")
        return found.stored(np.concatenate(points), *more)


def _placed(
    body: _Part, moves: list[list[str]], found: Elements, first: int, name: str, sets: dict[str, list[int]]
) -> FloatArray:
    """Add the cells of a body to those ``found``; return its nodes (k, 3) where the instance puts them."""
    place = {number: first + k for k, number in enumerate(body.nodes)}
    members: dict[int, list[str]] = {}
    for one, numbers in sets.items():
        for number in set(numbers):
            members.setdefault(number, []).append(one)
    for number, (kind, all_nodes) in body.cells.items():
        # CalculiX gives nodes of its own to the incompatible modes of C3D8I
        nodes = all_nodes[:8] if kind == "C3D8I" else all_nodes
        told = _volume(kind, len(nodes))
        if told is None:
            found.leave(f"cell of type {kind}", mass=kind.startswith(MASSES))
            continue
        missing = [node for node in nodes if node not in place]
        if missing:
            raise MeshError(f"has a cell {number} that names the node {missing[0]}, which is not there.")
        found.add(
            told, tuple(place[node] for node in nodes), *([name] if name else []), *members.get(number, [])
        )
    points = np.array(list(body.nodes.values()), dtype=np.float64).reshape(-1, 3)
    return _moved(points, moves, name)


def _moved(points: FloatArray, moves: list[list[str]], name: str) -> FloatArray:
    """Return nodes moved by the first line of an instance, then turned about the axis of its second."""
    lines = [[number_of(part, f"*INSTANCE {name}") for part in line if part] for line in moves]
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


def _cartesian(place: FloatArray, kind: str) -> FloatArray:
    """Return a node given in a rectangular (R), cylindrical (C) or spherical (S) system; angles in deg."""
    if kind == "R":
        return place
    r, theta, last = place[0], np.deg2rad(place[1]), place[2]
    if kind == "C":
        return np.array([r * np.cos(theta), r * np.sin(theta), last])
    phi = np.deg2rad(last)  # from the plane of the first two axes
    return np.array([r * np.cos(theta) * np.cos(phi), r * np.sin(theta) * np.cos(phi), r * np.sin(phi)])


def _count_of(kind: str) -> int:
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
    count = _count_of(kind)
    if not kind.startswith("C3D") and not count:
        return None
    if nodes != count:
        raise MeshError(f"has a cell of type {kind} with {nodes} nodes, which is no solid that is known.")
    return BY_COUNT[count]
