"""Exodus II files (.e, .exo, .ex2, .g): blocks of elements, from netCDF classic or netCDF-4 (HDF5)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from meshes.common import IntArray, MeshError
from meshes.reading.stored import ENDS_APART, NODES, Elements, PointMass, StoredMesh, counted

KEPT = ("coord", "connect", "eb_", "ss_", "ns_", "elem_ss", "side_ss", "node_ns")
COUNT = "num_el_in_blk"
HDF5 = b"\x89HDF"
CLASSIC = b"CDF\x01", b"CDF\x02"
NAMES = {"HEX": "hexahedron", "TET": "tetra", "WED": "wedge", "PYR": "pyramid"}  # by their first letters
FLAT = ("TRI", "QUAD", "SHELL")
MASSES = ("SPHERE", "POINT")
# corners of the sides of a cell
SIDES = {
    "hexahedron": ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)),
    "tetra": ((0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)),
    "wedge": ((0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2), (0, 2, 1), (3, 4, 5)),
}


def exodus(path: Path) -> StoredMesh:
    """Read the blocks of elements; each is a set, by its name or "BLOCK" with its number.

    Sets of sides and of nodes have their names or "SIDE SET" and "NODE SET" with a number.

    Raises
    ------
    MeshError
        If it is neither of the two kinds of netCDF, or is no Exodus file.
    """
    kept = _variables(path)
    if "coord" in kept:
        points = np.asarray(kept["coord"], np.float64).T
    else:
        axes = [kept[f"coord{axis}"] for axis in "xyz" if f"coord{axis}" in kept]
        points = np.asarray(axes, np.float64).T
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError(
            "has no nodes of three coordinates (coordx, coordy, coordz): it is no body in Exodus."
        )
    blocks, ignored, masses, found = [], [], list[PointMass](), Elements()
    sets: dict[str, IntArray] = {}
    every: list[tuple[str | None, IntArray]] = []  # kind and nodes of the cells of each block, of any kind
    first, k = 0, 1
    while f"connect{k}" in kept or f"{COUNT}{k}" in kept:
        if f"connect{k}" in kept:
            cells, kind = kept[f"connect{k}"], _text(kept.get(f"connect{k}:elem_type", b""))
            told, cells = _kind(kind, cells.shape[1]), np.asarray(cells, np.int64) - 1
            every.append((told, cells))
            if told:
                blocks.append((told, cells[:, ENDS_APART.get(told, range(cells.shape[1]))]))
                here = np.arange(first, first + len(cells))
                sets |= dict.fromkeys(_names(kept, "eb", k, "BLOCK"), here)
                first += len(cells)
            elif kind.upper().startswith(FLAT):
                for nodes in cells.tolist():
                    found.add_face(kind, nodes, *_names(kept, "eb", k, "BLOCK"))
            elif kind.upper().startswith(MASSES):
                masses += [PointMass(kind, node=int(node)) for node in cells[:, 0]]
            else:
                ignored.append(counted(len(cells), f"cell of type {kind}"))
        k += 1
    _add_sets(kept, every, found)
    return StoredMesh(points, tuple(blocks), sets, tuple(ignored), tuple(masses), found.surfaces())


def _names(kept: Mapping[str, Any], of: str, k: int, what: str) -> list[str]:
    """Return the names of the k-th block or set, from 1 on: that of the file, ``what`` with its number."""
    names, numbers = kept.get(f"{of}_names", ()), kept.get(f"{of}_prop1", ())
    name = _text(names[k - 1]) if k <= len(names) else ""
    number = f"{what} {int(numbers[k - 1]) if k <= len(numbers) else k}"
    return [name, number] if name else [number]


def _add_sets(kept: Mapping[str, Any], blocks: list[tuple[str | None, IntArray]], found: Elements) -> None:
    """Add the sets of sides of cells, which are counted through all blocks, and those of nodes."""
    first = np.cumsum([0, *(len(cells) for _, cells in blocks)])
    for k in _numbered(kept, "elem_ss"):
        for number, side in zip(kept[f"elem_ss{k}"], kept[f"side_ss{k}"], strict=True):
            of = int(np.searchsorted(first, number, side="left")) - 1
            kind, cells = blocks[of]
            sides = next((one for name, one in SIDES.items() if kind and kind.startswith(name)), ())
            nodes = cells[number - 1 - first[of]]
            if 1 <= side <= len(sides):
                found.add_face("", nodes[list(sides[side - 1])].tolist(), *_names(kept, "ss", k, "SIDE SET"))
    for k in _numbered(kept, "node_ns"):
        nodes = (np.asarray(kept[f"node_ns{k}"], np.int64) - 1).tolist()
        found.node_sets |= dict.fromkeys(_names(kept, "ns", k, "NODE SET"), nodes)


def _numbered(kept: Mapping[str, Any], stem: str) -> list[int]:
    """Return the numbers of the variables of one kind; empty sets have a number and no variable."""
    return sorted(int(name.removeprefix(stem)) for name in kept if name.startswith(stem))


def _variables(path: Path) -> Mapping[str, Any]:
    """Return the arrays of a file by name, and the type of each block's elements."""
    kept: dict[str, Any] = {}
    with path.open("rb") as header:
        start = header.read(4)
    if start == HDF5:
        import h5py

        with h5py.File(path) as file:
            for name, array in file.items():
                if name.startswith(KEPT):
                    kept[name] = array[()]
                    if "elem_type" in array.attrs:
                        kept[f"{name}:elem_type"] = array.attrs["elem_type"]
                elif name.startswith(COUNT):
                    kept[name] = len(array)
    elif start in CLASSIC:
        from scipy.io import netcdf_file

        with netcdf_file(path, mmap=False) as file:
            for name, array in file.variables.items():
                if name.startswith(KEPT):
                    kept[name] = array.data.copy()
                    if hasattr(array, "elem_type"):
                        kept[f"{name}:elem_type"] = array.elem_type
            kept |= {name: size for name, size in file.dimensions.items() if name.startswith(COUNT)}
    else:
        raise MeshError(
            f"begins with {start!r}: it is no Exodus file of netCDF classic, of 64-bit offsets or netCDF-4. "
            "Convert it by nccopy -k nc4."
        )
    return kept


def _text(value: Any) -> str:
    """Return text that is stored as bytes, as a row of letters or as a string."""
    if isinstance(value, np.ndarray):
        value = value.tobytes()
    text = value.decode("latin-1") if isinstance(value, bytes) else str(value)
    return text.split("\0")[0].strip()


def _kind(name: str, count: int) -> str | None:
    """Return the kind of cells of a block, None where they fill no volume."""
    stem = NAMES.get(name.upper()[:3])
    if stem is None:
        return None
    kind = next((kind for kind, nodes in NODES.items() if kind.startswith(stem) and nodes == count), None)
    if kind is None:
        raise MeshError(f"has a block of {name} with {count} nodes a cell, which is not read.")
    return kind
