"""A user's own mesh of hexahedra: read from a file, checked, and cut to its half y >= 0."""

from pathlib import Path

import numpy as np
import scipy.sparse as sp

from meshes.arrays import BoolArray, FloatArray, IntArray
from meshes.errors import MeshError
from meshes.files import stored_cells
from meshes.gauss import jacobians
from meshes.hexmesh import SYMMETRY, HexMesh, face_keys, from_cells, half_body_tags
from meshes.quality import edge_lengths, scaled_jacobians
from meshes.topology import FACES

__all__ = ["own_half", "read_own"]

FLAT = ("vertex", "line", "triangle", "quad")  # cells of points, lines and surfaces, which fill no volume
HEXAHEDRA = 'Use 8-node hexahedra alone (meshio: "hexahedron", Abaqus: C3D8, Gmsh: recombined, first order).'
NEAR = 1e-5  # of the largest diameter: nodes so near to the plane of symmetry lie on it
SAME = 1e-6  # of the shortest edge: nodes so near to each other are one place


def read_own(path: str | Path, unit: float = 1.0) -> HexMesh:
    """Read and check a mesh of a body; see `own_half` for what is asked of it.

    Parameters
    ----------
    path : path
        Any format that meshio reads; points, lines and surface cells in it are left out.
    unit : float
        Metres in one unit of the file.

    Raises
    ------
    MeshError
        If the file cannot be read, holds other volume cells than hexahedra of 8 nodes, or is no such body.
    """
    points, blocks = stored_cells(path)
    others = {kind: len(cells) for kind, cells in blocks.items() if not kind.startswith(FLAT)}
    count = others.pop("hexahedron", 0)
    if others:
        told = " and ".join(f"{number} cells of type {kind}" for kind, number in sorted(others.items()))
        raise MeshError(f"holds {told} beside {count} hexahedra. {HEXAHEDRA}")
    if not count:
        raise MeshError(f"holds no volume cells, only {sorted(blocks) or 'nothing'}. {HEXAHEDRA}")
    if points.shape[1:] != (3,):
        raise MeshError(f"has points of {points.shape[1]} coordinates: a body needs three.")
    return own_half(points.astype(np.float64) * unit, blocks["hexahedron"].astype(np.int64))


def own_half(points: FloatArray, cells: IntArray) -> HexMesh:
    """Return the half y >= 0 of a body of hexahedra, moved so that its tip stands at z = 0.

    The axis is parallel to z, the tip is the lowest end, y = 0 is the plane of symmetry: all of the body may
    be given, with nodes on that plane, or its half y >= 0. The centre of the volume is moved to x = 0.

    Parameters
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64
        VTK hexahedron order.

    Raises
    ------
    MeshError
        If a cell is folded, the body is in parts, its surface is not closed, it does not lie along z, or it
        is not symmetric about y = 0.
    """
    if not np.isfinite(points).all() or cells.min() < 0 or cells.max() >= len(points):
        raise MeshError(
            "has points that are no finite numbers, or cells that name points that are not there."
        )
    used, new = np.unique(cells, return_inverse=True)
    mesh = from_cells(points[used], new.reshape(cells.shape), half_body_tags)
    _require_unfolded(mesh)
    _require_joined(mesh)
    _require_one(mesh)
    _require_closed(mesh)
    _require_upright(mesh)
    half = _placed(_half(mesh))
    if not (half.face_tag == SYMMETRY).any():
        raise MeshError("has no face on the plane y = 0, its plane of symmetry. Move it there.")
    return half


def _require_unfolded(mesh: HexMesh) -> None:
    worst = np.minimum(scaled_jacobians(mesh).min(axis=1), np.linalg.det(jacobians(mesh)).min(axis=1))
    bad = np.flatnonzero(~(worst > 0.0))
    if not len(bad):
        return
    where = _place(mesh.points[mesh.cells[bad[0]]].mean(axis=0))
    turned = "All are: turn the order of their nodes round. " if len(bad) == len(worst) else ""
    raise MeshError(
        f"has {len(bad)} of {len(worst)} cells that are folded or inside out, the first cell {bad[0]} about "
        f"{where}. {turned}Each cell needs positive Jacobians at its corners and Gauss points."
    )


def _require_joined(mesh: HexMesh) -> None:
    """Refuse nodes that lie on each other, or in the middle of an edge or face of another cell."""
    from scipy.spatial import cKDTree  # here: every command imports this room, few read such a mesh

    least = SAME * float(edge_lengths(mesh).min())
    tree = cKDTree(mesh.points)
    if pairs := tree.query_pairs(least):
        a, _ = min(pairs)
        raise MeshError(
            f"has {len(pairs)} pairs of nodes in one place, the first at {_place(mesh.points[a])}: "
            "the cells there are not joined. Merge equal nodes."
        )
    corners = mesh.points[mesh.faces]
    middles = np.concatenate(
        [0.5 * (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3), corners.mean(axis=1)]
    )
    near = np.isfinite(tree.query(middles, distance_upper_bound=least)[0])
    if near.any():
        raise MeshError(
            f"has nodes in the middle of an edge or face of another cell, the first at "
            f"{_place(middles[near][0])}: hanging nodes are not tied. Use cells that share whole faces."
        )


def _require_one(mesh: HexMesh) -> None:
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
            "parts node by node, or leave the others out."
        )


def _require_closed(mesh: HexMesh) -> None:
    """Refuse a face that three cells share, and an edge at which more than two outer faces meet."""
    keys = face_keys(mesh.cells[:, FACES].reshape(-1, 4))
    if (np.unique(keys, return_counts=True)[1] > 2).any():
        raise MeshError("has a face that three cells share: they lie in each other. Remove doubled cells.")
    ends = np.sort(np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, count = np.unique(ends, axis=0, return_counts=True)
    if (count != 2).any():
        where = _place(mesh.points[edges[count != 2][0]].mean(axis=0))
        raise MeshError(
            f"has an outer surface that is not closed: at the edge about {where} {count[count != 2][0]} "
            "outer faces meet, not two. Cells that touch at an edge alone must share a face or no node."
        )


def _require_upright(mesh: HexMesh) -> None:
    extent = np.ptp(mesh.points, axis=0)
    if extent[2] < (1.0 - NEAR) * extent.max():
        longest = "xyz"[int(np.argmax(extent))]
        raise MeshError(
            f"is {_mm(extent[2])} long along z and {_mm(extent.max())} along {longest}: the axis of a "
            "projectile is z, with the tip at the lowest z. Turn the mesh."
        )


def _half(mesh: HexMesh) -> HexMesh:
    """Return the half y >= 0, cut from the whole or as it is; its nodes on the plane lie there exactly."""
    points = mesh.points.copy()
    near = NEAR * float(np.ptp(points[:, :2], axis=0).max())
    points[np.abs(points[:, 1]) < near, 1] = 0.0
    if points[:, 1].max() <= 0.0:
        raise MeshError("lies on the side y < 0 alone. Give the half y >= 0 of the body, or all of it.")
    if points[:, 1].min() >= 0.0:
        return from_cells(points, mesh.cells, half_body_tags)
    y = points[mesh.cells][:, :, 1]
    across = np.flatnonzero((y.min(axis=1) < 0.0) & (y.max(axis=1) > 0.0))
    if len(across):
        where = _place(points[mesh.cells[across[0]]].mean(axis=0))
        raise MeshError(
            f"has {len(across)} cells across the plane y = 0, the first about {where}. The plane of symmetry "
            "must lie between cells: give a mesh with faces there, or the half y >= 0."
        )
    _require_mirrored(points, mesh.cells, near)
    cells = mesh.cells[y.max(axis=1) > 0.0]
    used, new = np.unique(cells, return_inverse=True)
    return from_cells(points[used], new.reshape(cells.shape), half_body_tags)


def _require_mirrored(points: FloatArray, cells: IntArray, near: float) -> None:
    """Refuse a body whose nodes or cells on both sides of y = 0 are not mirror images of each other."""
    from scipy.spatial import cKDTree  # here: every command imports this room, few read such a mesh

    for what, places in (("node", points), ("cell", points[cells].mean(axis=1))):
        away = cKDTree(places).query(places * [1.0, -1.0, 1.0])[0]
        lonely: BoolArray = away > 2.0 * near
        if lonely.any():
            raise MeshError(
                f"is not symmetric about the plane y = 0: {int(lonely.sum())} of {len(places)} {what}s have "
                f"no mirror image, the first at {_place(places[lonely][0])}. The model holds half of a "
                "symmetric body: mirror the mesh, turn it, or give the half y >= 0."
            )


def _placed(mesh: HexMesh) -> HexMesh:
    """Return the half with the tip at z = 0 and the centre of its volume at x = 0."""
    share = np.linalg.det(jacobians(mesh)).sum(axis=1)
    centre = float(share @ mesh.points[mesh.cells, 0].mean(axis=1) / share.sum())
    moved = abs(centre) > NEAR * float(np.ptp(mesh.points[:, 0]))
    shift = np.array([centre if moved else 0.0, 0.0, mesh.points[:, 2].min()])
    return from_cells(mesh.points - shift, mesh.cells, half_body_tags)


def _mm(length: float) -> str:
    return f"{length * 1e3:.4g} mm"


def _place(point: FloatArray) -> str:
    x, y, z = (1e3 * float(part) for part in point)
    return f"({x:.4g}, {y:.4g}, {z:.4g}) mm"
