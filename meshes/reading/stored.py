"""What a mesh file holds: its nodes, its volume cells, their sets, and what of it is left out."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import nan
from typing import NamedTuple, TypeVar

import numpy as np

from meshes.common import BoolArray, FloatArray, IntArray, MeshError

T = TypeVar("T")
#: Nodes of each kind of volume cell; corners first, then the middles of edges, in VTK's order.
NODES = {
    "tetra": 4,
    "tetra10": 10,
    "pyramid": 5,
    "pyramid13": 13,
    "wedge": 6,
    "wedge15": 15,
    "hexahedron": 8,
    "hexahedron20": 20,
    "hexahedron27": 27,
}
#: Of formats that number the middles of edges between both ends of a cell before those of its upper end, the
#: places of its nodes in VTK's order.
ENDS_APART = {
    "hexahedron20": (*range(12), *range(16, 20), *range(12, 16)),
    "hexahedron27": (*range(12), *range(16, 20), *range(12, 16), *range(20, 27)),
    "wedge15": (*range(9), 12, 13, 14, 9, 10, 11),
}
#: Corners of a face or a cell of a surface by the number of its nodes.
FACE_CORNERS = {3: 3, 6: 3, 7: 3, 4: 4, 8: 4, 9: 4}


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Cells of surfaces, and faces of volume cells, that a file holds beside these.

    Attributes
    ----------
    corners : (n, 4) int64, nodes around each; the last is -1 where there are three
    kinds : (n,) what each is in the file, "" of a face that is no cell of its own
    sets : by name, numbers of faces
    nodes : by name of a set of nodes, their numbers: it stands for the faces that have all corners in it
    """

    corners: IntArray = field(default_factory=lambda: np.zeros((0, 4), np.int64))
    kinds: tuple[str, ...] = ()
    sets: Mapping[str, IntArray] = field(default_factory=dict)
    nodes: Mapping[str, IntArray] = field(default_factory=dict)

    def counts(self, chosen: BoolArray) -> tuple[str, ...]:
        """Return how many of the chosen (n,) are cells of each kind."""
        kinds = [kind for kind, taken in zip(self.kinds, chosen, strict=True) if taken and kind]
        return tuple(counted(kinds.count(kind), f"cell of type {kind}") for kind in dict.fromkeys(kinds))


class PointMass(NamedTuple):
    """A mass without volume, of a kind of the file: how large in its unit, nan if unknown, at which node.

    The node is -1 where it stands at none of the nodes that are read.
    """

    what: str
    mass: float = nan
    node: int = -1


@dataclass(frozen=True, slots=True)
class StoredMesh:
    """The volume cells of a file.

    Attributes
    ----------
    points : (n, 3) float64, in the unit of the file
    blocks : pairs of a kind, a key of `NODES`, and its cells, (m, k) int64; the middle of an edge is -1 where
        the file leaves it out
    sets : by name, numbers of cells, counted through all blocks
    ignored : what the file holds beside the cells and is left out, one phrase each
    masses : masses without volume
    surfaces : cells of surfaces, and sets of faces
    """

    points: FloatArray
    blocks: tuple[tuple[str, IntArray], ...]
    sets: Mapping[str, IntArray] = field(default_factory=dict)
    ignored: tuple[str, ...] = ()
    masses: tuple[PointMass, ...] = ()
    surfaces: Surfaces = field(default_factory=Surfaces)


@dataclass(slots=True)
class Elements:
    """Nodes and cells while a deck is read.

    Attributes
    ----------
    nodes : by number, (3,) in the unit of the file
    place : of each node in the list of points, by number
    kinds : kind of each cell
    cells : places of the nodes of each
    sets : names of sets, with the places of their cells
    left_out : what is left out, with its count
    masses : masses without volume
    faces, face_kinds, face_sets, node_sets : as in `Surfaces`
    """

    nodes: dict[int, tuple[float, ...]] = field(default_factory=dict)
    place: dict[int, int] = field(default_factory=dict)
    kinds: list[str] = field(default_factory=list)
    cells: list[tuple[int, ...]] = field(default_factory=list)
    sets: dict[str, list[int]] = field(default_factory=dict)
    faces: list[tuple[int, ...]] = field(default_factory=list)
    face_kinds: list[str] = field(default_factory=list)
    face_sets: dict[str, list[int]] = field(default_factory=dict)
    node_sets: dict[str, list[int]] = field(default_factory=dict)
    left_out: dict[str, int] = field(default_factory=dict)
    masses: list[PointMass] = field(default_factory=list)

    def node(self, number: int, place: Iterable[float]) -> None:
        """Add a node at its place (3,).

        Raises
        ------
        MeshError
            If its number stands for another place already.
        """
        keep(self.nodes, number, tuple(place), "nodes")
        self.place.setdefault(number, len(self.place))

    def at(self, nodes: Iterable[int]) -> list[int]:
        """Return the places of nodes in the list of points, -1 of those that are not there."""
        return [self.place.get(node, -1) for node in nodes]

    def solid(self, kind: str, nodes: Sequence[int], what: str, *names: str) -> None:
        """Add a cell by the numbers of its nodes, 0 for the middle of an edge that is left out.

        Raises
        ------
        MeshError
            If a node is not there, or their number is not that of the kind; ``what`` says which cell it is.
        """
        corners = NODES[kind.rstrip("0123456789")]
        for k, node in enumerate(nodes):
            if node not in self.place and (node or k < corners):
                raise MeshError(f"has {what} that names the node {node}, which is not there.")
        self.add(kind, tuple(self.at(nodes)), *names)

    def add(self, kind: str, nodes: tuple[int, ...], *names: str) -> None:
        """Add a cell, by the places of its nodes, that is in sets of those names.

        Raises
        ------
        MeshError
            If it has another number of nodes than its kind.
        """
        if len(nodes) != NODES[kind]:
            raise MeshError(f"has a cell of type {kind} with {len(nodes)} nodes instead of {NODES[kind]}.")
        for name in names:
            self.sets.setdefault(name, []).append(len(self.cells))
        self.kinds.append(kind)
        self.cells.append(nodes)

    def add_face(self, kind: str, nodes: Sequence[int], *names: str) -> None:
        """Add a cell of a ``kind`` that may be one of a surface, or a face (""), in sets of those names.

        Nodes are places in the list of points; what has a node that is not there (-1) bounds no solid.
        """
        corners = tuple(nodes[: FACE_CORNERS.get(len(nodes), 0)])
        if not corners or min(corners) < 0:
            if kind:
                self.leave(f"cell of type {kind}")
            return
        for name in names:
            self.face_sets.setdefault(name, []).append(len(self.faces))
        self.faces.append((*corners, -1)[:4])
        self.face_kinds.append(kind)

    def add_nodes(self, name: str, nodes: Iterable[int]) -> None:
        """Add nodes, by their numbers, to the set of a name; those that are not there are left out."""
        self.node_sets.setdefault(name, []).extend(place for place in self.at(nodes) if place >= 0)

    def leave(self, what: str, count: int = 1) -> None:
        """Count what is left out, in one word or more."""
        self.left_out[what] = self.left_out.get(what, 0) + count

    def stored(self, *more: str) -> StoredMesh:
        """Return what was read, cells of one kind together, with ``more`` that is left out."""
        kinds = np.array(self.kinds)
        order, blocks = [], []
        for kind in dict.fromkeys(self.kinds):
            here = np.flatnonzero(kinds == kind)
            order.append(here)
            blocks.append((kind, np.array([self.cells[k] for k in here], dtype=np.int64)))
        new = np.empty(len(kinds), dtype=np.int64)
        new[np.concatenate([*order, np.zeros(0, np.int64)])] = np.arange(len(kinds))
        sets = {name: np.unique(new[places]) for name, places in self.sets.items() if places}
        told = (counted(count, what) for what, count in self.left_out.items())
        points = np.array(list(self.nodes.values()), dtype=np.float64).reshape(-1, 3)
        return StoredMesh(points, tuple(blocks), sets, (*told, *more), tuple(self.masses), self.surfaces())

    def surfaces(self) -> Surfaces:
        """Return the faces and the sets of faces and nodes that were read."""
        of_faces, of_nodes = (
            {name: np.unique(places) for name, places in named.items() if len(places)}
            for named in (self.face_sets, self.node_sets)
        )
        corners = np.array(self.faces, dtype=np.int64).reshape(-1, 4)
        return Surfaces(corners, tuple(self.face_kinds), of_faces, of_nodes)


def keep(known: dict[int, T], number: int, new: T, what: str) -> None:
    """Add what a number stands for.

    Raises
    ------
    MeshError
        If it stands for something else already; ``what`` says for nodes or cells.
    """
    if known.setdefault(number, new) != new:
        raise MeshError(f"has two {what} {number} that differ. Number them apart, or leave one of them out.")


def part_names(part: int | str, title: str) -> list[str]:
    """Return the names of the set of a part: its number and its title, if there is one."""
    return [f"PART {part}", title] if title else [f"PART {part}"]


def sets_named(name: str, known: Iterable[str]) -> list[str]:
    """Return the known sets that a name may mean: the one of just this name, else all but for case."""
    alike = sorted(one for one in known if one.upper() == name.upper())
    return [name] if name in alike else alike


def counted(count: int, what: str) -> str:
    """Return "1 cell of type S4R" or "3 cells of type S4R": the first word is the one that is counted."""
    first, _, rest = what.partition(" ")
    plural = first if count == 1 else f"{first}es" if first.endswith("s") else f"{first}s"
    return f"{count} {plural} {rest}".rstrip()
