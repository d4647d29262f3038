"""Files of AVS UCD (.inp, .avs, .ucd): nodes and cells by number, a set is a material."""

from pathlib import Path

from meshes.common import MeshError
from meshes.reading.stored import Elements, StoredMesh
from meshes.reading.text import lines_of, place_of, whole_number

KINDS = {"hex": "hexahedron", "tet": "tetra", "prism": "wedge", "pyr": "pyramid"}


def is_ucd(text: str) -> bool:
    """Return whether the first line beside comments is that of a UCD file: five whole numbers."""
    line = next((one for one in text.split("\n") if one.strip() and not one.startswith("#")), "")
    parts = line.split()
    return len(parts) == 5 and all(part.isdigit() for part in parts)


def ucd(path: Path) -> StoredMesh:
    """Read nodes and cells; values at nodes and cells are left out.

    Raises
    ------
    MeshError
        If it ends too early, or a cell names what is not there.
    """
    lines = [line.split() for line in lines_of(path)]
    lines = [parts for parts in lines if parts and not parts[0].startswith("#")]
    if not lines or len(lines[0]) != 5:
        raise MeshError("does not begin with the five counts of a UCD file.")
    nodes, cells = (whole_number(text, "the counts") for text in lines[0][:2])
    if len(lines) < 1 + nodes + cells:
        raise MeshError(f"ends before its {nodes} nodes and {cells} cells.")
    found = Elements()
    for number, *texts in lines[1 : 1 + nodes]:
        found.node(whole_number(number, "a node"), place_of(texts, number))
    for number, material, name, *texts in lines[1 + nodes : 1 + nodes + cells]:
        kind, around = name.lower(), [whole_number(text, f"cell {number}") for text in texts]
        if kind in ("tri", "quad"):
            found.add_face(name, found.at(around), f"MATERIAL {material}")
        elif kind in KINDS:
            around = around[1:] + around[:1] if kind == "pyr" else around
            found.solid(KINDS[kind], around, f"a cell {number} of type {name}", f"MATERIAL {material}")
        else:
            found.leave(f"cell of type {name}")
    return found.stored()
