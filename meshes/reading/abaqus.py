"""Decks of Abaqus and CalculiX: parts, instances and assemblies, sets, systems of coordinates."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import nan
from pathlib import Path

import numpy as np

from meshes.common import FloatArray, MeshError
from meshes.reading import abaqus_rules
from meshes.reading.abaqus_part import AbaqusPart, count_of, place
from meshes.reading.stored import Elements, PointMass, StoredMesh, keep
from meshes.reading.text import lines_of, number_of, numbers_between, place_of, whole_number

# lines that make nodes and cells of others, or move them
MAKERS = ("NMAP", "IMPORT", "IMPERFECTION", "SYMMETRIC MODEL GENERATION")
FLAT = re.compile(r"(?:S|DS|M3D|SFM3D|R3D|CPS|CPE|CAX)(\d)")  # types of surfaces, with their nodes
STATED = ("MATERIAL", "SOLID SECTION", "STEP", "BOUNDARY", "CLOAD", "DLOAD", "INITIAL CONDITIONS", "TIE")


@dataclass(slots=True)
class _Card:
    """A keyword with its parameters, names in capitals, and its lines of data."""

    name: str
    options: dict[str, str]
    lines: list[list[str]] = field(default_factory=list)


@dataclass(slots=True)
class _Instance:
    """A part that stands in the assembly: turned after it was moved."""

    part: str
    own: AbaqusPart
    moves: list[list[str]]


def abaqus(path: Path) -> StoredMesh:
    """Read a deck: every instance of its parts where the assembly puts it, or nodes and cells as they are.

    Raises
    ------
    MeshError
        If the deck makes nodes or cells by rules, or names what is not there.
    """
    deck = _Deck()
    for card in _cards(lines_of(path, "abaqus")):
        deck.take(card)
    return deck.stored()


def _cards(lines: list[str]) -> Iterator[_Card]:
    """Split a deck into its keywords; a keyword that ends in a comma goes on in the next line."""
    card, going = None, ""
    for raw in lines:
        line = raw.strip()
        if line.startswith("**") or not line:
            continue
        if line.startswith("*") or going:
            going += line
            if going.endswith(","):
                continue
            if card is not None:
                yield card
            name, *options = going[1:].split(",")
            pairs = (option.partition("=") for option in options)
            stated = {" ".join(key.upper().split()): value.strip().strip("\"'") for key, _, value in pairs}
            card, going = _Card(" ".join(name.upper().split()), stated), ""
        elif card is not None:
            card.lines.append([part.strip() for part in line.split(",")])
    if card is not None:
        yield card


class _Deck:
    """A deck while its keywords are taken, one after the other."""

    def __init__(self) -> None:
        self.plain, self.assembly = AbaqusPart(), AbaqusPart()
        self.parts: dict[str, AbaqusPart] = {}
        self.instances: dict[str, _Instance] = {}
        self.here = self.plain
        self.system: tuple[FloatArray, FloatArray] | None = None
        self.level = ""  # what is open: a part, an assembly, an instance
        # kind, name, instance, cell, node or set, side: of the sets and surfaces that the assembly makes
        self.of_assembly: list[tuple[str, str, str, str, str]] = []
        self.stated, self.more, self.spread = False, list[str](), list[PointMass]()

    def take(self, card: _Card) -> None:
        """Take a keyword."""
        name = card.name
        if name in MAKERS:
            raise MeshError(
                f"makes nodes or cells by *{name}, which is not read. Write the deck with all of them, as "
                "Abaqus/CAE and PrePoMax do."
            )
        self.stated = self.stated or name in STATED
        if name in abaqus_rules.KNOWN:
            abaqus_rules.make(name, card.options, card.lines, self.here)
        taken = {
            "PART": self._part,
            "END PART": self._end,
            "ASSEMBLY": self._assembly,
            "END ASSEMBLY": self._end,
            "INSTANCE": self._instance,
            "END INSTANCE": self._assembly,
            "SYSTEM": self._system,
            "NODE": self._nodes,
            "ELEMENT": self._elements,
            "ELSET": self._set,
            "NSET": self._set,
            "SURFACE": self._surface,
            "MASS": self._mass,
            "NONSTRUCTURAL MASS": self._spread_mass,
        }.get(name)
        if taken:
            taken(card)

    def _part(self, card: _Card) -> None:
        self.here = self.parts.setdefault(card.options.get("NAME", "").upper(), AbaqusPart())
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
        own = AbaqusPart()
        name, part = card.options.get("NAME", ""), card.options.get("PART", "").upper()
        self.instances[name.upper()] = _Instance(part, own, card.lines)
        self.here, self.level, self.system = own, "instance", None

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
            place = _cartesian(np.array(place_of(line[1:], number)), kind)
            if self.system is not None:
                origin, axes = self.system
                place = origin + place @ axes
            keep(self.here.nodes, number, tuple(place.tolist()), "nodes")
            if nset := card.options.get("NSET"):
                self.here.node_sets.setdefault(nset.upper(), []).append(number)

    def _elements(self, card: _Card) -> None:
        kind, name = card.options.get("TYPE", "").upper(), card.options.get("ELSET", "").upper()
        flat = FLAT.match(kind)
        wanted = count_of(kind) or (int(flat[1]) if flat else 0)
        numbers: list[int] = []
        for line in card.lines:
            if self.level == "assembly":  # joins nodes of instances, named as ROD-1.5: none of its own
                line = ["-" * ("." in part) + part.rpartition(".")[2] for part in line]
            numbers += [whole_number(part, f"*ELEMENT of type {kind}") for part in line if part]
            if len(numbers) < wanted + 1 if wanted else line[-1] == "":
                continue  # a line that ends in a comma goes on
            keep(self.here.cells, numbers[0], (kind, tuple(numbers[1:])), "cells")
            if name:
                self.here.sets.setdefault(name, []).append(numbers[0])
            numbers = []
        if numbers and count_of(kind):
            raise MeshError(f"ends within the cell {numbers[0]} of *ELEMENT of type {kind}.")
        if numbers:
            self.here.cells[numbers[0]] = kind, tuple(numbers[1:])

    def _set(self, card: _Card) -> None:
        of, key = ("sets", "ELSET") if card.name == "ELSET" else ("node_sets", "NSET")
        texts: list[str] = []
        for line in card.lines:
            found = [part for part in line if part]
            if "GENERATE" in card.options:
                low, high, step = (*(whole_number(text, f"*{key}") for text in found), 1)[:3]
                found = list(map(str, numbers_between(low, high, step, f"*{key}")))
            texts += found
        self._keep(of, card, key, [(text, "") for text in texts])

    def _surface(self, card: _Card) -> None:
        kind, name = card.options.get("TYPE", "ELEMENT").upper(), card.options.get("NAME", "")
        if kind not in ("ELEMENT", "NODE") or "COMBINE" in card.options:
            other = "combines others" if "COMBINE" in card.options else f"is of type {kind}"
            self.more.append(f"the surface {name}, which {other}")
            return
        rows = [(line[0], (*line, "")[1].upper()) for line in card.lines]
        self._keep("node_sets" if kind == "NODE" else "surfaces", card, "NAME", rows)

    def _mass(self, card: _Card) -> None:
        number = number_of(card.lines[0][0] if card.lines else "", "*MASS")
        self.here.masses[card.options.get("ELSET", "").upper()] = number

    def _spread_mass(self, card: _Card) -> None:
        whole = card.lines and card.options.get("UNITS", "").upper() == "TOTAL MASS"
        number = number_of(card.lines[0][0], "*NONSTRUCTURAL MASS") if whole else nan
        self.spread.append(PointMass("NONSTRUCTURAL MASS", number))

    def _keep(self, of: str, card: _Card, key: str, rows: list[tuple[str, str]]) -> None:
        name, instance = card.options.get(key, "").upper(), card.options.get("INSTANCE", "").upper()
        if self.level != "assembly":
            self.here.keep(of, name, rows)
            return
        for text, side in rows:  # of an instance, named as ROD-1.5, or of what the assembly itself names
            to, _, bare = text.rpartition(".")
            self.of_assembly.append((of, name, to.upper() or instance, bare, side))

    def stored(self) -> StoredMesh:
        """Return the cells of all instances, or those of the deck that has none."""
        found = Elements(masses=self.spread)
        bodies: list[tuple[str, AbaqusPart, list[list[str]]]] = [
            ("", body, []) for body in (self.plain, self.assembly)
        ]
        for name, one in self.instances.items():
            part = self.parts.get(one.part, one.own)
            if one.part and one.part not in self.parts and not one.own.nodes:
                raise MeshError(f"has the instance {name} of a part {one.part} that is not there.")
            own = (one.own if one.own.nodes or one.own.cells else part).numbered_as(part)
            for of, set_name, to, text, side in self.of_assembly:
                if to == name or (not to and not text.isdigit()):
                    own.keep(of, set_name, [(text, side)])
            bodies.append((name, own, one.moves))
        used = {one.part for one in self.instances.values()}
        if not self.instances:  # a part alone stands where its nodes are
            bodies += [(name, part, []) for name, part in self.parts.items()]
            used = set(self.parts)
        more = [f"the part {name}, of which there is no instance" for name in self.parts if name not in used]
        for name, body, moves in bodies:
            place(body, moves, found, name)
        if self.stated:
            more.append("materials, supports, loads and steps of the deck: the scene states its own")
        return found.stored(*self.more, *more)


def _cartesian(place: FloatArray, kind: str) -> FloatArray:
    """Return a node given in a rectangular (R), cylindrical (C) or spherical (S) system; angles in deg."""
    if kind == "R":
        return place
    r, theta, last = place[0], np.deg2rad(place[1]), place[2]
    if kind == "C":
        return np.array([r * np.cos(theta), r * np.sin(theta), last])
    phi = np.deg2rad(last)  # from the plane of the first two axes
    return np.array([r * np.cos(theta) * np.cos(phi), r * np.sin(theta) * np.cos(phi), r * np.sin(phi)])
