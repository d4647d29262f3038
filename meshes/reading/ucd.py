"""Files of AVS UCD (.inp, .avs, .ucd): nodes and cells by number, a set is a material."""

from pathlib import Path

import numpy as np

from meshes.errors import MeshError
from meshes.reading.stored import Elements, StoredMesh, number_of, whole_number

__all__ = ["is_ucd", "ucd"]

KINDS = {"hex": ("hexahedron", 8), "tet": ("tetra", 4), "prism": ("wedge", 6), "pyr": ("pyramid", 5)}


def is_ucd(text: str) -> bool:
    """Return whether the first line beside comments is that of a UCD file: five whole numbers."""
    line = next((one for one in text.splitlines() if one.strip() and not one.startswith("#")), "")
    parts = line.split()
    return len(parts) == 5 and all(part.isdigit() for part in parts)


def ucd(path: Path) -> StoredMesh:
    """Read nodes and cells; values at nodes and cells are left out.

    Raises
    ------
    MeshError
        If it ends too early, or a cell names what is not there.
    """
    lines = [line.split() for line in path.read_text(encoding="latin-1").splitlines()]
    lines = [parts for parts in lines if parts and not parts[0].startswith("#")]
    if not lines or len(lines[0]) != 5:
        raise MeshError("does not begin with the five counts of a UCD file.")
    nodes, cells = (whole_number(text, "the counts") for text in lines[0][:2])
    if len(lines) < 1 + nodes + cells:
        raise MeshError(f"ends before its {nodes} nodes and {cells} cells.")
    place = {whole_number(parts[0], "a node"): k for k, parts in enumerate(lines[1 : 1 + nodes])}
    points = [[number_of(text, f"node {parts[0]}") for text in parts[1:4]] for parts in lines[1 : 1 + nodes]]
    found = Elements()
    for parts in lines[1 + nodes : 1 + nodes + cells]:
        kind, count = KINDS.get(parts[2].lower(), ("", 0))
        if parts[2].lower() in ("tri", "quad"):
            around = [place.get(whole_number(text, f"cell {parts[0]}"), -1) for text in parts[3:]]
            found.add_face(parts[2], around, f"MATERIAL {parts[1]}")
            continue
        if not kind:
            found.leave(f"cell of type {parts[2]}")
            continue
        numbers = [whole_number(text, f"cell {parts[0]}") for text in parts[3:]]
        missing = [node for node in numbers if node not in place]
        if missing or len(numbers) != count:
            what = f"the node {missing[0]}, which is not there" if missing else f"{len(numbers)} nodes"
            raise MeshError(f"has a cell {parts[0]} of type {parts[2]} that names {what}.")
        corners = tuple(place[node] for node in numbers)
        found.add(kind, corners[1:] + corners[:1] if kind == "pyramid" else corners, f"MATERIAL {parts[1]}")
    return found.stored(np.array(points, dtype=np.float64).reshape(-1, 3))
