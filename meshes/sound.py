"""What is asked of a user's cells: not folded, joined node by node, one body with a closed surface."""

import numpy as np
import scipy.sparse as sp

from meshes.common import MeshError
from meshes.hexmesh import EDGES, FACES, HexMesh, face_keys
from meshes.quality import edge_lengths, least_jacobians
from meshes.symmetry import place_text

# Of the shortest edge there: nodes so near to each other are one place. No mesher leaves so narrow a gap by
# intent, but rounded coordinates do, in files that were never merged
SAME = 1e-3


def require_sound(mesh: HexMesh, hint: str) -> None:
    """Refuse cells that are folded, not joined, in parts (told with a ``hint``), or open (MeshError)."""
    _require_unfolded(mesh)
    _require_joined(mesh)
    _require_one(mesh, hint)
    _require_closed(mesh)


def _require_unfolded(mesh: HexMesh) -> None:
    worst = least_jacobians(mesh)
    bad = np.flatnonzero(~(worst > 0.0))
    if not len(bad):
        return
    where = place_text(mesh.points[mesh.cells[bad[0]]].mean(axis=0))
    raise MeshError(
        f"has {len(bad)} of {len(worst)} cells that are folded or inside out, the first cell {bad[0]} about "
        f"{where}. A corner or a node on an edge of such a cell lies beyond its other faces. Mend them in "
        "the mesher: smooth the mesh there, or make it anew with smaller cells or with straight edges."
    )


def _require_joined(mesh: HexMesh) -> None:
    """Refuse nodes that lie on each other, or in the middle of an edge or face of another cell."""
    from scipy.spatial import cKDTree  # here: every command imports this room, few read such a mesh

    edges = edge_lengths(mesh)
    shortest = np.full(len(mesh.points), np.inf)  # of the edges at each node
    np.minimum.at(shortest, mesh.cells[:, EDGES], edges[:, :, None])
    tree = cKDTree(mesh.points)
    pairs = tree.query_pairs(SAME * float(edges.min(axis=1).max()), output_type="ndarray")
    ends = mesh.points[pairs]
    away = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    near = np.flatnonzero(away <= SAME * shortest[pairs].min(axis=1))
    if len(near):
        widest = 1e3 * float(away[near].max())
        apart = f", up to {widest:.2g} mm apart" if widest else ""
        raise MeshError(
            f"has {len(near)} pairs of nodes in one place{apart}, the first at "
            f"{place_text(ends[near[0], 0])}: the cells there are not joined. Merge such nodes, in ParaView "
            "by Clean to Grid for example, with a tolerance as large."
        )
    corners = mesh.points[mesh.faces]
    middles = np.concatenate(
        [0.5 * (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3), corners.mean(axis=1)]
    )
    hanging = np.isfinite(tree.query(middles, distance_upper_bound=SAME * float(edges.min()))[0])
    if hanging.any():
        raise MeshError(
            "has nodes in the middle of an edge or face of another cell, the first at "
            f"{place_text(middles[hanging][0])}: hanging nodes are not tied. "
            "Use cells that share whole faces."
        )


def _require_one(mesh: HexMesh, hint: str) -> None:
    """Refuse cells that are not all joined face by face."""
    keys = face_keys(mesh.cells[:, FACES].reshape(-1, 4))
    order = np.argsort(keys, kind="stable")
    inside = np.flatnonzero(np.diff(keys[order]) == 0)
    pairs = order[inside] // 6, order[inside + 1] // 6
    joined = sp.coo_matrix((np.ones(len(inside)), pairs), shape=(len(mesh.cells),) * 2)
    parts, part = sp.csgraph.connected_components(joined, directed=False)
    if parts > 1:
        sizes = ", ".join(str(size) for size in np.sort(np.bincount(part))[::-1][:5])
        raise MeshError(
            f"is in {parts} parts that share no faces (of {sizes} cells). A projectile is one body: join its "
            f"parts node by node, or leave the others out.{hint}"
        )


def _require_closed(mesh: HexMesh) -> None:
    """Refuse a face that three cells share, and an edge at which more than two outer faces meet."""
    keys = face_keys(mesh.cells[:, FACES].reshape(-1, 4))
    if (np.unique(keys, return_counts=True)[1] > 2).any():
        raise MeshError("has a face that three cells share: they lie in each other. Remove doubled cells.")
    ends = np.sort(np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, count = np.unique(ends, axis=0, return_counts=True)
    if (count != 2).any():
        where = place_text(mesh.points[edges[count != 2][0]].mean(axis=0))
        raise MeshError(
            f"has an outer surface that is not closed: at the edge about {where} {count[count != 2][0]} "
            "outer faces meet, not two. Cells that touch at an edge alone must share a face or no node."
        )
