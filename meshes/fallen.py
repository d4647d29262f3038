"""Hexahedra whose nodes fall together, as decks write tetrahedra, wedges and pyramids, as what they are."""

from dataclasses import replace

import numpy as np

from meshes.common import IntArray
from meshes.hexahedra import HEXAHEDRON, TETRA, WEDGE
from meshes.reading.stored import NODES, StoredMesh


def as_they_are(stored: StoredMesh) -> StoredMesh:
    """Return a mesh whose hexahedra of four, five or six corners are tetrahedra, pyramids or wedges.

    Other hexahedra whose nodes fall together stay: `as_hexahedra` refuses them.
    """
    blocks, numbers, first = list[tuple[str, IntArray]](), list[IntArray](), 0
    for kind, cells in stored.blocks:
        own = first + np.arange(len(cells))
        first += len(cells)
        if kind.startswith("hexahedron") and cells.shape[1:] == (NODES[kind],):
            distinct = 1 + (np.diff(np.sort(cells[:, :8], axis=1), axis=1) != 0).sum(axis=1)
            whole, found = np.ones(len(cells), dtype=bool), dict[str, tuple[list[list[int]], list[int]]]()
            for at in np.flatnonzero(np.isin(distinct, (4, 5, 6))).tolist():
                if made := _made(cells[at].tolist()):
                    rows, places = found.setdefault(made[0], ([], []))
                    rows.append(made[1])
                    places.append(at)
                    whole[at] = False
            blocks += [(name, np.array(rows, np.int64)) for name, (rows, _) in found.items()]
            numbers += [own[places] for _, places in found.values()]
            cells, own = cells[whole], own[whole]
        if len(own):
            blocks.append((kind, cells))
            numbers.append(own)
    order = np.concatenate([*numbers, np.zeros(0, np.int64)])
    new = np.argsort(order)  # where each cell of the file is now
    sets = {name: np.sort(new[cells]) for name, cells in stored.sets.items()}
    return replace(stored, blocks=tuple(blocks), sets=sets)


def _made(cell: list[int]) -> tuple[str, list[int]] | None:
    """Return the kind and nodes of a hexahedron of four to six corners, with the middles of its edges."""
    corners = list(dict.fromkeys(cell[:8]))
    if len(corners) == 5:
        return "pyramid", corners
    kind = TETRA if len(corners) == 4 else WEDGE
    if kind is WEDGE and not (corners := _wedge(cell[:8])):
        return None
    middles = {
        frozenset((cell[a], cell[b])): k for (a, b), k in zip(HEXAHEDRON.edges, cell[8:], strict=False)
    }
    if not middles:
        return kind.name, corners
    of_edges = [middles.get(frozenset((corners[a], corners[b])), -1) for a, b in kind.edges]
    return f"{kind.name}{len(corners) + len(of_edges)}", [*corners, *of_edges]


def _wedge(corners: list[int]) -> list[int]:
    """Return the corners of a wedge that is given as a hexahedron with two edges of no length; else none."""
    ends = [tuple(dict.fromkeys(corners[k] for k in face)) for face in HEXAHEDRON.faces]
    ends = [face for face in ends if len(face) == 3]
    joined = {frozenset((corners[a], corners[b])) for a, b in HEXAHEDRON.edges}
    if len(ends) != 2 or set(ends[0]) & set(ends[1]):
        return []
    low, high = ends
    facing = [next((b for b in high if frozenset((a, b)) in joined), -1) for a in low]
    return [*low, *facing] if sorted(facing) == sorted(high) else []
