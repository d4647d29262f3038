"""Bulk data of Nastran, of any field width, with its systems of coordinates."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np

from meshes.common import FloatArray, MeshError
from meshes.reading.stored import ENDS_APART, Elements, PointMass, StoredMesh, keep
from meshes.reading.text import lines_of, number_of, place_of, whole_number

# kind of a cell by its card, and how many nodes of its kind with middles of edges
SOLIDS = {
    "CHEXA": (8, "hexahedron", 20, "hexahedron20"),
    "CPENTA": (6, "wedge", 15, "wedge15"),
    "CTETRA": (4, "tetra", 10, "tetra10"),
    "CPYRAM": (5, "pyramid", 13, "pyramid13"),
    "CPYRA": (5, "pyramid", 13, "pyramid13"),
}
MESH = ("GRID", *SOLIDS)
OTHER_SOLIDS = ("CHEX", "CIHEX", "CPEN", "CWEDGE", "CTET", "CPYR")
# places of the grid and of the mass among the fields of a card; None: on another card, or in a matrix
MASSES: dict[str, tuple[int | None, int | None]] = {
    "CONM2": (1, 3),
    "CONM1": (1, 3),
    "CMASS2": (2, 1),
    "CMASS1": (2, None),
}
MASSES |= {"CMASS3": (None, None), "CMASS4": (None, 1)}
SURFACES = (
    "CSHEAR",
    "CBAR",
    "CBEAM",
    "CROD",
    "CONROD",
    "CTUBE",
    "CBUSH",
    "CELAS",
    "CGAP",
    "PLOTEL",
    "RBE",
    "RBAR",
    "CBEND",
    "CWELD",
    "CFAST",
)
REFUSED = {
    "BEGIN SUPER": "holds superelements. Write it as one bulk section.",
    "SEBULK": "holds superelements. Write it as one bulk section.",
    "EGRID": "makes nodes by EGRID. Write it with all of its GRID cards.",
}


@dataclass(frozen=True, slots=True)
class _CoordinateSystem:
    """A system of coordinates: R, C or S, its origin (3,) and axes, rows of (3, 3), in the basic one."""

    kind: str
    origin: FloatArray
    axes: FloatArray

    def basic(self, place: FloatArray) -> FloatArray:
        """Return a place (3,), of which angles are in degrees, in the basic system."""
        a, b, c = place
        if self.kind == "C":
            place = np.array([a * np.cos(np.deg2rad(b)), a * np.sin(np.deg2rad(b)), c])
        if self.kind == "S":  # b is the angle from the third axis
            theta, phi = np.deg2rad(b), np.deg2rad(c)
            place = a * np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
        return np.asarray(self.origin + place @ self.axes)


BASIC = _CoordinateSystem("R", np.zeros(3), np.eye(3))


def nastran(path: Path) -> StoredMesh:
    """Read GRID cards, in their systems of coordinates, and solid elements; a set is a property number.

    Raises
    ------
    MeshError
        If the file makes nodes or cells by rules, or names what is not there.
    """
    # meshio writes cells with middles of edges as CHEXA_ or CTETRA_
    cards = [(name.rstrip("_"), fields) for name, fields in _cards(lines_of(path, "nastran"))]
    grids, defined, found, scale = dict[int, tuple[int, tuple[float, ...]]](), {}, Elements(), 1.0
    default = next((fields[1] for name, fields in cards if name == "GRDSET"), "")
    for name, fields in cards:
        if name == "GRID":
            number = whole_number(fields[0], "GRID")
            system = whole_number(fields[1] or default or "0", f"GRID {number}")
            keep(grids, number, (system, place_of(fields[2:5], number)), "nodes")
        elif name.startswith(("CORD1", "CORD2")):
            for number, one in _definitions(name, fields):
                defined[number] = one
        elif name == "PARAM" and fields[0].upper() == "WTMASS":
            scale = number_of(fields[1], "PARAM,WTMASS")
    systems = _Systems(defined, grids)
    for number in grids:
        found.node(number, systems.place(number).tolist())
    for name, fields in cards:
        if name in SOLIDS:
            _add(name, fields, found)
        elif name.startswith(OTHER_SOLIDS):
            raise MeshError(f"holds cells of type {name}, which are not read. Write them as CHEXA.")
        elif name in MASSES:
            grid, mass = (fields[at] if at is not None else "" for at in MASSES[name])
            weight = scale * number_of(mass, f"{name} {fields[0]}") if mass else nan
            at = found.at([whole_number(grid, name)])[0] if grid else -1
            found.masses.append(PointMass(name, weight, at))
        elif corners := 3 * name.startswith("CTRI") + 4 * name.startswith("CQUAD"):
            nodes = [int(text) if text.isdigit() else 0 for text in fields[2 : 2 + corners]]
            found.add_face(name, found.at(nodes), f"PID {fields[1] or fields[0]}")
        elif name.startswith(SURFACES):
            found.leave(f"cell of type {name}")
    return found.stored()


def _cards(lines: list[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield each card's name with its fields from the second on, those of its continuations joined."""
    begin = [k for k, line in enumerate(lines) if line.upper().split()[:2] == ["BEGIN", "BULK"]]
    name, fields = "", []
    for raw in lines[begin[0] + 1 if begin else 0 :]:
        line = raw.split("$")[0].rstrip().expandtabs(8)
        if not line:
            continue
        for start, problem in REFUSED.items():
            if line.upper().split("'")[0].startswith(start):
                raise MeshError(problem)
        if line.upper().startswith("ENDDATA"):
            break
        if line.startswith("=") and name in MESH:
            raise MeshError(f"repeats lines of {name} by =, which is not read. Write it with all lines.")
        first, more = _fields(line)
        if not first or first[0] in "+*":
            fields += more
            continue
        if name:
            yield name, fields
        name, fields = first.rstrip("*").upper(), more
    if name:
        yield name, fields


def _fields(line: str) -> tuple[str, list[str]]:
    """Return the first field of a line, and its fields of data: 8 of them, or 4 of 16 characters."""
    if "," in line:
        first, *rest = (part.strip() for part in line.split(","))
        wide = 4 if first.endswith("*") or first.startswith("*") else 8
        if any(rest[wide + 1 :]) and first.rstrip("*").upper() in MESH:  # the mark of a continuation is one
            raise MeshError(f"has a line {line[:30]!r} of more than ten fields. Continue it in the next.")
        return first, (rest + [""] * wide)[:wide]
    first = line[:8].strip()
    width, count = (16, 4) if first.endswith("*") or first.startswith("*") else (8, 8)
    return first, [line[8 + k * width : 8 + (k + 1) * width].strip() for k in range(count)]


def _definitions(
    name: str, fields: list[str]
) -> Iterator[tuple[int, tuple[str, int, list[FloatArray] | list[int]]]]:
    """Yield the number of a system, with its letter, the system it is given in, and three places or nodes."""
    if name.startswith("CORD2"):
        numbers = [number_of(text, name) for text in (fields[2:11] + [""] * 9)[:9]]
        places = [np.array(numbers[k : k + 3]) for k in (0, 3, 6)]
        yield whole_number(fields[0], name), (name[5:6], whole_number(fields[1] or "0", name), places)
        return
    for k in (0, 4):
        if fields[k : k + 1] not in ([], [""]):
            nodes = [whole_number(text, name) for text in fields[k + 1 : k + 4]]
            yield whole_number(fields[k], name), (name[5:6], 0, nodes)


class _Systems:
    """The systems of coordinates of a file, each worked out at its first use."""

    def __init__(
        self,
        defined: dict[int, tuple[str, int, list[FloatArray] | list[int]]],
        grids: dict[int, tuple[int, tuple[float, ...]]],
    ) -> None:
        self.defined, self.grids, self.known = defined, grids, {0: BASIC}

    def place(self, node: int) -> FloatArray:
        """Return a node (3,) in the basic system."""
        if node not in self.grids:
            raise MeshError(f"has a system of coordinates that names the node {node}, which is not there.")
        system, place = self.grids[node]
        return self.system(system).basic(np.array(place))

    def system(self, number: int, asked: tuple[int, ...] = ()) -> _CoordinateSystem:
        """Return a system by its number."""
        if number in self.known:
            return self.known[number]
        if number not in self.defined or number in asked:
            raise MeshError(
                f"has no system of coordinates {number} (CORD2R, CORD1C, ...) that nodes are given in."
            )
        kind, given_in, three = self.defined[number]
        a, b, c = (
            self.place(one) if isinstance(one, int) else self.system(given_in, (*asked, number)).basic(one)
            for one in three
        )
        z = (b - a) / np.linalg.norm(b - a)  # b lies on the third axis, c in the plane of the first and third
        y = np.cross(z, c - a)
        y /= np.linalg.norm(y)
        self.known[number] = _CoordinateSystem(kind, a, np.array([np.cross(y, z), y, z]))
        return self.known[number]


def _add(name: str, fields: list[str], found: Elements) -> None:
    """Add a solid element; middles of edges that are left out have no place."""
    corners, kind, all_nodes, fine = SOLIDS[name]
    what = f"a cell {name} {fields[0]}"
    nodes = [whole_number(text, f"{name} {fields[0]}") if text else 0 for text in fields[2 : 2 + all_nodes]]
    if any(fields[2 + all_nodes :]):
        raise MeshError(f"has {what} of more than {all_nodes} nodes, which is none.")
    if len(nodes) < corners or not all(nodes[:corners]):
        raise MeshError(f"has {what} that names fewer than {corners} corners.")
    names = (f"PID {fields[1] or fields[0]}",)
    if not any(nodes[corners:]):
        found.solid(kind, nodes[:corners], what, *names)
        return
    nodes += [0] * (all_nodes - len(nodes))
    found.solid(fine, [nodes[k] for k in ENDS_APART.get(fine, range(all_nodes))], what, *names)
