"""Half a body of revolution of any profile: a nose grid at each end, scaled sections between them.

A body that is no longer than wide, with two flat faces that end in edges, is sections alone: a disc, a ring,
a lid, a short pin. Chamfers are rows of their own.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from meshes.common import BoolArray, ClosedEndError, FloatArray, IntArray, MeshError
from meshes.ends import ShapeEnd, end_of
from meshes.hexmesh import TURNED, HexMesh, from_cells, half_body_tags
from meshes.quality import require_positive, scaled_jacobians
from meshes.refine import reach, refine
from meshes.revolved import SAME, Revolved, revolved, upside_down
from meshes.rod import RodMesh, nose_cells, stacked
from meshes.shoulders import STEEPEST
from meshes.surface import CORNER, TurnedSurface, closest_on
from meshes.zone import Cloud, Zone

WORST = 0.12  # least scaled Jacobian of a cell
# A body of more than ROWS rows of cells as high as wide has higher ones behind what its contact may reach, up
# to HIGHEST times as high as wide, with a change over GROWTH of its diameters
ROWS, HIGHEST, GROWTH = 500, 6.0, 6.0
SLIVER = 0.02  # of a cell: fixed heights that lie nearer to each other are one


def turned(
    outline: FloatArray,
    across: int = 8,
    zones: Sequence[Zone | Cloud] = (),
    *,
    bore: FloatArray | None = None,
    planes: Sequence[float] = (),
    contact: FloatArray | None = None,
    buffer: int = 2,
    flush: bool = False,
) -> RodMesh:
    """Mesh half a body of revolution.

    Parameters
    ----------
    outline : (k, 2) float64, m
        (rho, z) of the surface from the axis at the tip, (0, 0), to the tail: to the axis, or to the edge of
        a flat tail.
    across : int
        Cells over the diameter, even, at least 6, everywhere; a body of sections alone has more where it is
        thin, see `meshes.revolved.revolved`.
    zones, buffer
        See `refine`; zones are in the body's frame.
    bore : (k, 2) float64, m, optional
        (rho, z) of the inner surface, from its front to its rear end.
    planes : sequence of float, m
        Heights at which no cell may straddle, such as ends of segments.
    contact : (3,) float64, m, optional
        Point of the surface, by default the centre of the last zone: where its shape allows it, it lies in
        the middle of a finest cell.
    flush : bool
        Whether both lines of nodes in y = 0 lie on the surface along all of the body. Nodes of sections that
        have the area of the circle stand out over it elsewhere.

    Raises
    ------
    MeshError
        If an end is too sharp or a step too steep for hexahedra, or the body too short for its cells.
    """
    body = revolved(np.array(outline, np.float64), bore, across)
    if contact is None and zones:
        contact = zones[-1].centre
    near = None if contact is None else np.array([np.hypot(*contact[:2]), contact[2]])
    tip = None if body.is_stack else _tip(body, near, len(zones))
    tail = None
    if body.line[-1, 0] <= 0.0:
        tail = end_of(upside_down(body.line), body.half, across, closed=body.length - body.bored_from_to[1])
    start = tip.start if tip else 0.0
    low, high = _reached(body, start, zones, buffer)
    heights = _heights(body, start, body.length - (tail.start if tail else 0.0), planes, high)
    tail_start = body.length - tail.start if tail else np.inf
    exact = ((-np.inf, start), (low, high), (tail_start, np.inf))
    nodes = len(body.half.unit)
    points, cells, layer_of = _sections(body, heights, exact)
    if flush:
        outer, radius = np.arange(body.half.plug_nodes, nodes), body.radius(heights)
        ring = points.reshape(len(heights), nodes, 3)[:, outer]
        swollen = ring[:, 0, 0] > (1.0 + SAME) * radius
        ring[swollen, 1:-1, :2] *= body.half.flush_swell / body.half.swell
        ring[:, [0, -1], 0] = radius[:, None] * [1.0, -1.0]
        points.reshape(len(heights), nodes, 3)[:, outer] = ring
    for edge, row in ((body.line[1], 0), (body.line[-1], len(heights) - 1)):
        if body.is_stack and np.linalg.norm(closest_on(body.exact, edge[None]) - edge) > SAME * edge[0]:
            rim = row * nodes + np.flatnonzero(body.half.radius > 1.0 - SAME)  # it stands for a rounding
            points[rim] = body.surface.snap(points[rim], points[rim, None])
    parts = [(cells, layer_of)]
    for end, layer, flipped in (
        (tip, np.arange(nodes), False),
        (tail, len(points) - nodes + np.arange(nodes), True),
    ):
        if end is not None:
            more, below = nose_cells(body.half, end.grid, len(points), layer, end.hollow)
            if flipped:
                more[:, 2] = body.length - more[:, 2]
                below = below[:, TURNED]
            points = np.concatenate([points, more])
            parts.append((below, np.full(len(below), len(heights) if flipped else -1)))
    joint = max((z for z in planes if z < (1.0 - SAME) * body.length), default=0.0)
    return _finished(body, points, parts, heights, exact, zones, buffer, joint)


def contact_radius(
    outline: FloatArray, contact: FloatArray, across: int, bore: FloatArray | None = None
) -> float:
    """Return the radius, m, over whose double `across` cells lie at a place (rho, z), m, of the surface.

    It is that of the nose, or of the section at the height of the place, smaller where more cells lie across
    it; of a nose that a bore leaves no room for cells, that without the bore.
    """
    body = revolved(np.array(outline, np.float64), bore, across)
    if body.is_stack:
        return float(body.radius(np.array(contact[1]))) * across / body.across
    try:
        tip = _tip(body)
    except ClosedEndError:
        tip = end_of(body.line, body.half, across)
    return float(body.radius(np.array(contact[1]))) if contact[1] > tip.start else tip.radius


def cells_across(outline: FloatArray, across: int, bore: FloatArray | None = None) -> int:
    """Return the cells over the diameter of a body for which `across` are asked."""
    return revolved(np.array(outline, np.float64), bore, across).across


def _tip(body: Revolved, near: FloatArray | None = None, levels: int = 0) -> ShapeEnd:
    """Return the end at the tip."""
    first, _ = body.bored_from_to
    if first <= 0.0:
        return end_of(body.line, body.half, body.across, near, levels, body.bore)
    return end_of(body.line, body.half, body.across, near, levels, closed=first)


def _reached(body: Revolved, start: float, zones: Sequence[Zone | Cloud], buffer: int) -> tuple[float, float]:
    """Return the range of z, m, in which cells may be split; they may in the nose, up to ``start``, m."""
    if not zones:
        return 0.0, start
    ends = np.array([[zone.corners()[:, 2].min(), zone.corners()[:, 2].max()] for zone in zones])
    around = np.linspace(ends.min() - body.line[:, 0].max(), ends.max() + body.line[:, 0].max(), 50)
    pitch = float(body.pitch(np.clip(around, 0.0, body.length)).max())
    beyond = np.array([float(reach(1.4 * pitch, 1, level, buffer)) for level in range(1, len(zones) + 1)])
    low, high = (ends[:, 0] - beyond).min() - 1.5 * pitch, (ends[:, 1] + beyond).max() + 1.5 * pitch
    return float(low), max(float(high), start)


def _heights(body: Revolved, start: float, end: float, planes: Sequence[float], reached: float) -> FloatArray:
    """(n + 1,) heights of the sections, m: as far apart as cells are wide, the planes among them.

    Above the height, m, ``reached`` by cells that may be split, those of a long body are farther apart.
    """
    if not body.is_stack and end < start + 0.3 * float(body.pitch(np.array(start))):
        raise MeshError(
            f"length {body.length:.6g} m leaves no body between its ends, which need {start:.6g} m and "
            f"{body.length - end:.6g} m: take a longer body or more cells across"
        )
    turn = np.abs(np.diff(np.arctan2(*np.diff(body.line, axis=0).T)))
    edges = body.line[1:-1, 1][turn > CORNER]
    fixed = np.unique(np.concatenate([edges, body.bore[:, 1], np.asarray(planes, np.float64)]))
    least = max(1e-6 * body.length, SLIVER * float(body.pitch(np.array(start))))
    fixed = fixed[(fixed > start + least) & (fixed < end - least)]
    ends = [start, *fixed[np.diff(fixed, prepend=start) > least], end]
    heights = np.concatenate([[start], *(_rows(body, low, high, reached) for low, high in pairwise(ends))])
    if body.is_stack:  # with a row alone it would not bend
        for low, high in body.plates:
            inside = heights[(heights > low - least) & (heights < high + least)]
            if len(inside) == 2:
                heights = np.union1d(heights, inside.mean())
    return heights


def _rows(body: Revolved, low: float, high: float, reached: float) -> FloatArray:
    """(k,) heights, m, behind ``low`` up to ``high`` of sections, see `_heights`."""
    z, width = np.linspace(low, high, 41), 2.0 * float(body.line[:, 0].max())
    most = np.clip(body.length * body.across / width / ROWS, 1.0, HIGHEST)
    pitch = body.pitch(z) * (1.0 + (most - 1.0) * np.clip((z - reached) / (GROWTH * width), 0.0, 1.0))
    count = np.concatenate([[0.0], np.cumsum(0.5 * (1 / pitch[1:] + 1 / pitch[:-1]) * (z[1] - z[0]))])
    cells = max(1, round(count[-1]))
    return np.asarray(np.interp(np.arange(1, cells + 1) * count[-1] / cells, count, z))


def _sections(
    body: Revolved, heights: FloatArray, exact: tuple[tuple[float, float], ...]
) -> tuple[FloatArray, IntArray, IntArray]:
    """Nodes and cells of the sections, layer after layer, and the layer of each cell."""
    half, outer, split = body.half, body.radius(heights), body.split_radius(heights)
    if np.abs(np.diff(outer) / np.diff(heights)).max() > STEEPEST:
        k = int(np.argmax(np.abs(np.diff(outer) / np.diff(heights))))
        raise MeshError(
            f"the radius steps from {outer[k]:.6g} m to {outer[k + 1]:.6g} m between z = {heights[k]:.6g} m "
            f"and {heights[k + 1]:.6g} m: spread it over {abs(outer[k + 1] - outer[k]) / 2:.3g} m or more"
        )
    circle = half.bore or half.plug
    inside = half.radius / circle
    beyond = np.clip((half.radius - circle) / (1.0 - circle), 0.0, 1.0)
    share = np.where(
        half.radius <= circle, inside * split[:, None], split[:, None] + beyond * (outer - split)[:, None]
    )
    low, high = exact[1]
    round_here = (heights >= low) & (heights <= high)
    share = share * np.where(round_here, 1.0, half.swell)[:, None]
    points = stacked(share[:, :, None] * half.direction, heights)
    slab = half.slab
    bored = body.bored(heights[:-1], heights[1:])
    cells = [
        (slab[half.bore_quads :] if hollow else slab) + len(half.unit) * k for k, hollow in enumerate(bored)
    ]
    layer_of = np.repeat(np.arange(len(cells)), [len(part) for part in cells])
    return points, np.concatenate(cells), layer_of


def _finished(
    body: Revolved,
    points: FloatArray,
    parts: list[tuple[IntArray, IntArray]],
    heights: FloatArray,
    exact: tuple[tuple[float, float], ...],
    zones: Sequence[Zone | Cloud],
    buffer: int,
    joint: float,
) -> RodMesh:
    """Put the parts together, the cells that stay whole first; refine; find slices above ``joint``, m."""
    cells, layer = (np.concatenate(part) for part in zip(*parts, strict=True))
    (low, high), nodes = exact[1], len(body.half.unit)
    first = min(int(np.searchsorted(heights, high - SAME * body.length)), len(heights) - 1)
    behind = layer >= first if low <= heights[0] else np.zeros(len(layer), bool)
    order = np.argsort(~behind, kind="stable")
    cells, layer, rest = cells[order], layer[order], int(behind.sum())
    used, new = np.unique(cells, return_inverse=True)
    place = np.full(len(points), -1, dtype=np.int64)
    place[used] = np.arange(len(used))
    mesh = from_cells(points[used], new.reshape(cells.shape), half_body_tags)
    worst = scaled_jacobians(mesh).min(axis=1)
    cell = int(np.argmin(worst))
    if worst[cell] < WORST:
        z = float(mesh.points[mesh.cells[cell], 2].mean())
        raise MeshError(
            f"cells about z = {z:.6g} m are too skewed (scaled Jacobian {worst[cell]:.2g}, least {WORST}): "
            "make the shape smoother there or take more cells across"
        )
    if zones:
        try:
            mesh = _refined(body, mesh, zones, buffer, np.arange(len(cells)) < rest)
        except MeshError:
            if high <= heights[-1]:
                raise
            rest = 0  # of a stout body even the cells of the rounded tail are split
            mesh = _refined(body, mesh, zones, buffer)
    section_nodes = place[: nodes * len(heights)].reshape(-1, nodes)
    interface = section_nodes[first] if rest else np.zeros(0, dtype=np.int64)
    start = float(heights[first]) if rest else body.length
    run = _run(body, heights, first, high, joint) if rest else len(heights)
    whole = [np.flatnonzero(layer[:rest] == k) for k in range(run, len(heights) - 1)]
    body_cells = np.array(whole, dtype=np.int64).T if whole else np.zeros((0, 0), dtype=np.int64)
    kept = section_nodes[-1] >= 0
    body_nodes = section_nodes[run:, kept].T if whole else np.zeros((0, 1), dtype=np.int64)
    slab = float(heights[-1] - heights[-2])
    return RodMesh(
        mesh, body_nodes, body_cells, slab, start, interface[interface >= 0], np.arange(rest), exact
    )


def _refined(
    body: Revolved, mesh: HexMesh, zones: Sequence[Zone | Cloud], buffer: int, frozen: BoolArray | None = None
) -> HexMesh:
    """Refine; where that folds a cell beside the bore, whose facets are wider than it, keep these facets."""
    surface = body.surface
    try:
        fine = refine(mesh, zones, surface.snap, buffer=buffer, frozen=frozen)
        require_positive(fine)
    except MeshError:
        if not len(body.bore):
            raise
        kept = TurnedSurface(surface.lines[:1], faceted=surface.lines[1:])
        fine = refine(mesh, zones, kept.snap, buffer=buffer, frozen=frozen)
        require_positive(fine)
    return fine


def _run(body: Revolved, heights: FloatArray, first: int, high: float, joint: float) -> int:
    """Return the first section from which on to a flat tail all slices are the same; else their number.

    Sections up to the height ``high`` are round, those above have the area of the circle. Slices below the
    last ``joint``, m, may be of another material.
    """
    if body.line[-1, 0] <= 0.0:
        return len(heights)
    step, outer, split = np.diff(heights), body.radius(heights), body.split_radius(heights)
    hollow = body.bored(heights[:-1], heights[1:])
    same = (np.abs(step / step[-1] - 1.0) < SAME) & (hollow == hollow[-1]) & (heights[:-1] > high)
    same &= heights[:-1] > joint - SAME * body.length
    for radius in (outer, split):
        same &= np.abs(radius[:-1] / radius[-1] - 1.0) < SAME
    start = int(np.flatnonzero(~same)[-1]) + 1 if (~same).any() else 0
    return max(start, first) if len(heights) - 1 - max(start, first) >= 2 else len(heights)
