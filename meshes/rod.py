"""Half a rod with a shaped tip: a nose that follows its meridian, and a body of identical slices."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from meshes.common import FloatArray, IntArray, MeshError
from meshes.hexmesh import HexMesh, from_cells, half_body_tags
from meshes.meridian import Meridian
from meshes.nose import NoseMesh, inner_corner, lay_nose
from meshes.quality import require_positive
from meshes.refine import reach, refine
from meshes.section import Section, section
from meshes.surface import TurnedSurface
from meshes.zone import Cloud, Zone


@dataclass(frozen=True, slots=True)
class RodMesh:
    """Half a rod, y >= 0, in the rod frame: z along the axis from the tip (0) to the tail.

    Attributes
    ----------
    mesh : HexMesh
    body_nodes : (n_section, n_layers) int64
        Nodes of the slices; column 0 is the interface to the nose (or the flat face), the last the tail.
    body_cells : (n_section_cells, n_slices) int64
        Cells of a row are translates of each other along z; never refined.
    slice_length : float, m
    body_start : float, m
        z of the interface.
    interface : (n_section,) int64
        Nodes of the section behind which no cell is refined.
    rest_cells : (k,) int64
        Cells behind the interface.
    on_surface : tuple of (low, high), m
        Ranges of z in which the nodes of the skin lie on the exact surface, so that the flat faces of the
        mesh cut some of the body off; elsewhere the section has the exact area.
    rest_share : float
        Share of the volume that a rest has which was cut away and which no section bounds; 0: one does.
    """

    mesh: HexMesh
    body_nodes: IntArray
    body_cells: IntArray
    slice_length: float
    body_start: float
    interface: IntArray
    rest_cells: IntArray
    on_surface: tuple[tuple[float, float], ...]
    rest_share: float = 0.0

    @classmethod
    def plain(cls, mesh: HexMesh) -> "RodMesh":
        """Return a mesh as a body without slices, every cell of which may be refined."""
        none = np.zeros(0, dtype=np.int64)
        return cls(mesh, none.reshape(0, 1), none.reshape(0, 0), 0.0, 0.0, none, none, ())

    @classmethod
    def cut(cls, mesh: HexMesh, start: float, depth: FloatArray | None = None) -> "RodMesh":
        """Return a mesh as a body without slices that has a rest.

        The rest are the cells that begin at ``start``, m, or further from the tip, beyond all refined ones;
        or by another ``depth`` (n,) of the nodes than z, m.
        """
        depth = mesh.points[:, 2] if depth is None else depth
        start = max(start, float(depth[mesh.cells[mesh.level > 0]].max(initial=0.0)))
        behind = depth[mesh.cells].min(axis=1) >= start
        shared = np.intersect1d(mesh.cells[behind], mesh.cells[~behind])
        whole = cls.plain(mesh)
        return replace(whole, body_start=start, interface=shared, rest_cells=np.flatnonzero(behind))


def rod(
    meridian: FloatArray,
    length: float,
    across: int = 8,
    slice_length: float | None = None,
    zones: Sequence[Zone | Cloud] = (),
    *,
    contact: FloatArray | None = None,
    nose: bool = True,
    buffer: int = 2,
) -> RodMesh:
    """Mesh half a rod.

    Parameters
    ----------
    meridian : (k, 2) float64, m
        (rho, z) of the tip from the pole (0, 0) to the start of the cylinder.
    length : float, m
    across : int
        Cells over the diameter, even, at least 6.
    slice_length : float, m, optional
        Wanted height of the slices (default: diameter / across); adjusted to divide the body evenly.
    zones, buffer
        See `refine`; zones are in the rod frame. The nose is made long enough to hold the refinement.
    contact : (3,) float64, m, optional
        Point of the tip, by default the centre of the last zone: where its shape allows it, it lies in the
        middle of a finest cell.
    nose : bool
        False: only slices, from a flat face at z = 0 (the meridian then gives the radius alone).

    Raises
    ------
    MeshError
        If the rod is too short for its nose, or a cell folds.
    """
    shape = Meridian(meridian)
    half = section(across)
    pitch = 2.0 * shape.radius / across
    wanted = pitch if slice_length is None else slice_length
    if not nose and zones:
        raise MeshError("a rod of slices alone cannot be refined: leave the zones out or keep the nose")
    if contact is None and zones:
        contact = zones[-1].centre
    near = None if contact is None else np.array([np.hypot(*contact[:2]), contact[2]])
    split = shape.shoulder(near, pitch / 2 ** len(zones))
    start = _body_start(shape, split, half.plug, pitch, zones, buffer) if nose else 0.0
    if not wanted > 0.0:
        raise MeshError(f"slice_length must be positive, not {wanted} m")
    if length < start + 0.5 * pitch:
        raise MeshError(
            f"length {length} m leaves no body above the nose, which needs {start:.6g} m: "
            "take a longer rod, a smaller zone or fewer levels"
        )
    count = max(1, round((length - start) / wanted))
    slab = (length - start) / count
    flat = half.swell * shape.radius * half.unit  # of the exact area of the circle
    heights = np.asarray(start + slab * np.arange(count + 1), np.float64)
    points = stacked(np.broadcast_to(flat, (count + 1, *flat.shape)), heights)
    cells = (half.slab + len(flat) * np.arange(count)[:, None, None]).reshape(-1, 8)
    body_cells = np.arange(len(cells)).reshape(count, -1).T
    body_nodes = np.arange(len(points)).reshape(count + 1, -1).T
    if nose:
        grid = lay_nose(shape, start, split, half, pitch)
        more, below = nose_cells(half, grid, len(points), np.arange(len(half.unit)))
        points, cells = np.concatenate([points, more]), np.concatenate([cells, below])
    mesh = from_cells(points, cells, half_body_tags)
    require_positive(mesh)
    if zones:
        frozen = np.arange(len(cells)) < body_cells.size
        surface = TurnedSurface((shape.extended(length).line,))
        mesh = refine(mesh, zones, surface.snap, buffer=buffer, frozen=frozen)
        require_positive(mesh)
    rest = np.arange(body_cells.size)
    return RodMesh(mesh, body_nodes, body_cells, slab, start, body_nodes[:, 0], rest, ((-np.inf, start),))


def _body_start(
    shape: Meridian, split: float, plug: float, pitch: float, zones: Sequence[Zone | Cloud], buffer: int
) -> float:
    """Height z, m, at which the slices begin: above the tip's shape and all cells that are to be split."""
    inner = float(inner_corner(shape, split, plug)[1])
    start = max(shape.height + pitch, inner + 1.5 * pitch, 2.0 * shape.radius / 3.0)
    tops = (
        float(zone.corners()[:, 2].max()) + float(reach(1.4 * pitch, 1, level, buffer)) + 1.5 * pitch
        for level, zone in enumerate(zones, 1)
    )
    return max([start, *tops])


def stacked(flat: FloatArray, heights: FloatArray) -> FloatArray:
    """(k n, 3) nodes, layer after layer, of sections (k, n, 2) at heights (k,)."""
    height = np.broadcast_to(heights[:, None, None], (*flat.shape[:2], 1))
    return np.concatenate([flat, height], axis=2).reshape(-1, 3)


def nose_cells(
    half: Section, grid: NoseMesh, first: int, layer: IntArray, hollow: bool = False
) -> tuple[FloatArray, IntArray]:
    """Nodes of a nose, numbered from `first` on, and its cells; its last row is the body's `layer`, (n,).

    A hollow nose has no cells inside the bore of the section.
    """
    inner = half.plug_nodes
    rows = len(grid.side) - 1
    below = first + np.arange(inner)
    plug = np.concatenate(
        [first + inner * (1 + np.arange(rows))[:, None] + np.arange(inner), [layer[:inner]]]
    )
    rim = len(half.unit) - inner
    outer = first + inner * (rows + 1) + rim * np.arange(rows - 1)[:, None] + np.arange(rim)
    side = np.concatenate([[below[-rim:]], outer, [layer[inner:]]])
    body = np.concatenate([plug, side], axis=1)
    quads = half.quads[half.bore_quads if hollow else 0 :]
    layers = [_between(below, plug[0], quads[: half.plug_quads - (len(half.quads) - len(quads))])]
    layers += [_between(body[k], body[k + 1], quads) for k in range(rows)]
    around, at_rim = half.direction[:inner], half.direction[inner:]
    blocks = [_turn(row, around) for row in (grid.face, *grid.plug[:-1])]
    blocks += [_turn(np.broadcast_to(place, (rim, 2)), at_rim) for place in grid.side[1:-1]]
    return np.concatenate(blocks), np.concatenate(layers)


def _between(low: IntArray, high: IntArray, quads: IntArray) -> IntArray:
    """(k, 8) cells between two layers of the same section."""
    return np.concatenate([low[quads], high[quads]], axis=1)


def _turn(meridian: FloatArray, direction: FloatArray) -> FloatArray:
    """(k, 3) points from (rho, z) and the direction of their half plane."""
    return np.concatenate([meridian[:, :1] * direction, meridian[:, 1:]], axis=1)
