"""Half a body of revolution of any profile: a nose grid at each end, scaled sections between them."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from meshes.arrays import BoolArray, FloatArray, IntArray
from meshes.ends import ShapeEnd, end_of
from meshes.errors import ClosedEndError, MeshError
from meshes.hexmesh import HexMesh, from_cells, half_body_tags
from meshes.quality import require_positive, scaled_jacobians
from meshes.refine import reach, refine
from meshes.rod import RodMesh, nose_cells
from meshes.section import Section, bored_section, section
from meshes.surface import CORNER, Surface
from meshes.zone import Cloud, Zone

__all__ = ["contact_radius", "turned"]

STEEPEST = np.tan(np.deg2rad(75.0))  # of the radius over z between two sections
WORST = 0.12  # least scaled Jacobian of a cell
SLIVER = 0.02  # of a cell: fixed heights that lie nearer to each other are one
SAME = 1e-9  # relative difference of radii and heights of slices that count as equal


@dataclass(frozen=True, slots=True)
class _Body:
    """The body in its half plane.

    Attributes
    ----------
    line, bore : (k, 2) outer and inner surface, (rho, z), m; a body without a bore has no rows
    half : section; across : cells over the diameter
    """

    line: FloatArray
    bore: FloatArray
    half: Section
    across: int

    @property
    def length(self) -> float:
        return float(self.line[-1, 1])

    @property
    def hollow(self) -> FloatArray:
        """(j, 2) inner surface with the flat faces that close it, (rho, z), m."""
        first, last = self.bored_from_to
        front = [[0.0, first]] if first > 0.0 else []
        rear = [[0.0, last]] if last < self.length else []
        return np.array([*front, *self.bore, *rear])

    @property
    def bored_from_to(self) -> tuple[float, float]:
        """Heights at which a bore begins and ends, m; without one, infinitely far from both ends."""
        return (float(self.bore[0, 1]), float(self.bore[-1, 1])) if len(self.bore) else (np.inf, -np.inf)

    def radius(self, z: FloatArray) -> FloatArray:
        """(n,) outer radius at heights z (n,), m."""
        return np.asarray(np.interp(z, self.line[:, 1], self.line[:, 0]))

    def pitch(self, z: FloatArray) -> FloatArray:
        """(n,) wanted height of the cells, m."""
        radius = np.maximum(self.radius(z), 1e-3 * self.line[:, 0].max())
        return np.asarray(2.0 * radius / self.across)

    def split_radius(self, z: FloatArray) -> FloatArray:
        """(n,) radius of the circle along which a bore runs; beyond its ends, of as large a share."""
        outer = self.radius(z)
        if not len(self.bore):
            return self.half.plug * outer
        first, last = self.bore[0], self.bore[-1]
        share = np.array([first[0], last[0]]) / self.radius(np.array([first[1], last[1]]))
        inside = np.interp(z, self.bore[:, 1], self.bore[:, 0])
        return np.where(z < first[1], share[0] * outer, np.where(z > last[1], share[1] * outer, inside))

    def bored(self, low: FloatArray, high: FloatArray) -> BoolArray:
        """(n,) whether cells between these heights lie along the bore."""
        if not len(self.bore):
            return np.zeros(len(low), dtype=bool)
        first, last = self.bored_from_to
        middle = 0.5 * (low + high)
        return np.asarray((middle > first) & (middle < last))

    @property
    def surface(self) -> Surface:
        """All of the surface, the flat face at the tail included."""
        outer = np.concatenate([self.line, [[0.0, self.length]]]) if self.line[-1, 0] > 0.0 else self.line
        return Surface((outer, self.hollow) if len(self.bore) else (outer,))


def turned(
    outline: FloatArray,
    across: int = 8,
    zones: Sequence[Zone | Cloud] = (),
    *,
    bore: FloatArray | None = None,
    planes: Sequence[float] = (),
    contact: FloatArray | None = None,
    buffer: int = 2,
) -> RodMesh:
    """Mesh half a body of revolution.

    Parameters
    ----------
    outline : (k, 2) float64, m
        (rho, z) of the surface from the axis at the tip, (0, 0), to the tail: to the axis, or to the edge of
        a flat tail.
    across : int
        Cells over the diameter, even, at least 6, everywhere.
    zones, buffer
        See `refine`; zones are in the body's frame.
    bore : (k, 2) float64, m, optional
        (rho, z) of the inner surface, from its front to its rear end.
    planes : sequence of float, m
        Heights at which no cell may straddle, such as ends of segments.
    contact : (3,) float64, m, optional
        Point of the surface, by default the centre of the last zone: where its shape allows it, it lies in
        the middle of a finest cell.

    Raises
    ------
    MeshError
        If an end is too sharp or a step too steep for hexahedra, or the body too short for its cells.
    """
    body = _body(np.array(outline, np.float64), bore, across)
    if contact is None and zones:
        contact = zones[-1].centre
    near = None if contact is None else np.array([np.hypot(*contact[:2]), contact[2]])
    tip = _tip(body, near, len(zones))
    tail = None
    if body.line[-1, 0] <= 0.0:
        tail = end_of(_mirrored(body.line), body.half, across, closed=body.length - body.bored_from_to[1])
    low, high = _reached(body, tip, zones, buffer)
    heights = _heights(body, tip.start, body.length - (tail.start if tail else 0.0), planes)
    tail_start = body.length - tail.start if tail else np.inf
    exact = ((-np.inf, tip.start), (low, high), (tail_start, np.inf))
    points, cells, layer_of = _sections(body, heights, exact)
    nodes = len(body.half.unit)
    parts = [(cells, layer_of)]
    for end, layer, flipped in (
        (tip, np.arange(nodes), False),
        (tail, len(points) - nodes + np.arange(nodes), True),
    ):
        if end is not None:
            more, below = _nose(body, end, len(points), layer, flipped)
            points = np.concatenate([points, more])
            parts.append((below, np.full(len(below), len(heights) if flipped else -1)))
    return _finished(body, points, parts, heights, exact, zones, buffer)


def contact_radius(
    outline: FloatArray, contact: FloatArray, across: int, bore: FloatArray | None = None
) -> float:
    """Return the radius, m, over whose double `across` cells lie at a place (rho, z), m, of the surface.

    It is that of the nose, or of the section at the height of the place; of a nose that a bore leaves no room
    for cells, that without the bore.
    """
    body = _body(np.array(outline, np.float64), bore, across)
    try:
        tip = _tip(body)
    except ClosedEndError:
        tip = end_of(body.line, body.half, across)
    if contact[1] > tip.start:
        return float(body.radius(np.array(contact[1])))
    return tip.radius


def _tip(body: _Body, near: FloatArray | None = None, levels: int = 0) -> ShapeEnd:
    """Return the end at the tip."""
    first, _ = body.bored_from_to
    if first <= 0.0:
        return end_of(body.line, body.half, body.across, near, levels, body.bore)
    return end_of(body.line, body.half, body.across, near, levels, closed=first)


def _body(line: FloatArray, bore: FloatArray | None, across: int) -> _Body:
    """Return the body with the section that fits its bore."""
    if line.ndim != 2 or line.shape[1] != 2 or not line[-1, 1] > 0.0 or np.any(np.diff(line[:, 1]) < 0.0):
        raise MeshError("an outline needs rows (rho, z) with z growing from 0 at the tip to the tail")
    same = SAME * line[:, 0].max()  # heights, m
    if np.any(np.diff(line[line[:, 1] <= same, 0]) <= 0.0):
        raise MeshError(
            "the radius of the flat face at the tip shrinks at z = 0: give its points from the axis out"
        )
    if np.any(np.diff(line[line[:, 1] >= line[-1, 1] - same, 0]) >= 0.0):
        raise MeshError(
            f"the radius of the flat face at the tail grows at z = {line[-1, 1]:.6g} m: give its points from "
            "the edge in, without a rim of no thickness"
        )
    if bore is None:
        return _Body(line, np.zeros((0, 2)), section(across), across)
    front = np.interp(max(bore[0, 1], 1e-9 * line[-1, 1]), line[:, 1], line[:, 0])
    half = bored_section(across, float(bore[0, 0] / front))
    return _Body(line, np.array(bore, np.float64), half, across)


def _mirrored(line: FloatArray) -> FloatArray:
    return np.asarray(np.stack([line[::-1, 0], line[-1, 1] - line[::-1, 1]], axis=1))


def _reached(body: _Body, tip: ShapeEnd, zones: Sequence[Zone | Cloud], buffer: int) -> tuple[float, float]:
    """Return the range of z, m, in which cells may be split."""
    if not zones:
        return 0.0, tip.start
    ends = np.array([[zone.corners()[:, 2].min(), zone.corners()[:, 2].max()] for zone in zones])
    around = np.linspace(ends.min() - body.line[:, 0].max(), ends.max() + body.line[:, 0].max(), 50)
    pitch = float(body.pitch(np.clip(around, 0.0, body.length)).max())
    beyond = np.array([float(reach(1.4 * pitch, 1, level, buffer)) for level in range(1, len(zones) + 1)])
    low, high = (ends[:, 0] - beyond).min() - 1.5 * pitch, (ends[:, 1] + beyond).max() + 1.5 * pitch
    return float(low), max(float(high), tip.start)


def _heights(body: _Body, start: float, end: float, planes: Sequence[float]) -> FloatArray:
    """(n + 1,) heights of the sections, m: as far apart as cells are wide, the planes among them."""
    if end < start + 0.3 * float(body.pitch(np.array(start))):
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
    parts = [np.array([start])]
    for low, high in pairwise(ends):
        z = np.linspace(low, high, 41)
        count = np.concatenate(
            [[0.0], np.cumsum(0.5 * (1 / body.pitch(z[1:]) + 1 / body.pitch(z[:-1])) * (z[1] - z[0]))]
        )
        cells = max(1, round(count[-1]))
        parts.append(np.interp(np.arange(1, cells + 1) * count[-1] / cells, count, z))
    return np.concatenate(parts)


def _sections(
    body: _Body, heights: FloatArray, exact: tuple[tuple[float, float], ...]
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
    round_here = np.any([(heights >= low) & (heights <= high) for low, high in exact[1:2]], axis=0)
    share = share * np.where(round_here, 1.0, half.swell)[:, None]
    flat = share[:, :, None] * half.direction
    height = np.broadcast_to(heights[:, None, None], (len(heights), len(half.unit), 1))
    points = np.concatenate([flat, height], axis=2).reshape(-1, 3)
    slab = np.concatenate([half.quads, half.quads + len(half.unit)], axis=1)
    bored = body.bored(heights[:-1], heights[1:])
    cells = [
        (slab[half.bore_quads :] if hollow else slab) + len(half.unit) * k for k, hollow in enumerate(bored)
    ]
    layer_of = np.repeat(np.arange(len(cells)), [len(part) for part in cells])
    return points, np.concatenate(cells), layer_of


def _nose(
    body: _Body, end: ShapeEnd, first: int, layer: IntArray, flipped: bool
) -> tuple[FloatArray, IntArray]:
    """Nodes and cells of the nose at one end; at the tail it is flipped over."""
    points, cells = nose_cells(body.half, end.grid, first, layer, end.hollow)
    if flipped:
        points[:, 2] = body.length - points[:, 2]
        cells = cells[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    return points, cells


def _finished(
    body: _Body,
    points: FloatArray,
    parts: list[tuple[IntArray, IntArray]],
    heights: FloatArray,
    exact: tuple[tuple[float, float], ...],
    zones: Sequence[Zone | Cloud],
    buffer: int,
) -> RodMesh:
    """Put the parts together, the cells that stay whole first; refine; find the slices."""
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
    _require_fair(mesh)
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
    run = _run(body, heights, first, high) if rest else len(heights)
    whole = [np.flatnonzero(layer[:rest] == k) for k in range(run, len(heights) - 1)]
    body_cells = np.array(whole, dtype=np.int64).T if whole else np.zeros((0, 0), dtype=np.int64)
    kept = section_nodes[-1] >= 0
    body_nodes = section_nodes[run:, kept].T if whole else np.zeros((0, 1), dtype=np.int64)
    slab = float(heights[-1] - heights[-2])
    return RodMesh(
        mesh, body_nodes, body_cells, slab, start, interface[interface >= 0], np.arange(rest), exact
    )


def _refined(
    body: _Body, mesh: HexMesh, zones: Sequence[Zone | Cloud], buffer: int, frozen: BoolArray | None = None
) -> HexMesh:
    fine = refine(mesh, zones, body.surface.snap, buffer=buffer, frozen=frozen)
    require_positive(fine)
    return fine


def _require_fair(mesh: HexMesh) -> None:
    worst = scaled_jacobians(mesh).min(axis=1)
    cell = int(np.argmin(worst))
    if worst[cell] < WORST:
        z = float(mesh.points[mesh.cells[cell], 2].mean())
        raise MeshError(
            f"cells about z = {z:.6g} m are too skewed (scaled Jacobian {worst[cell]:.2g}, least {WORST}): "
            "make the shape smoother there or take more cells across"
        )


def _run(body: _Body, heights: FloatArray, first: int, high: float) -> int:
    """Return the first section from which on to a flat tail all slices are the same; else their number.

    Sections up to the height ``high`` are round, those above have the area of the circle.
    """
    if body.line[-1, 0] <= 0.0:
        return len(heights)
    step, outer, split = np.diff(heights), body.radius(heights), body.split_radius(heights)
    hollow = body.bored(heights[:-1], heights[1:])
    same = (np.abs(step / step[-1] - 1.0) < SAME) & (hollow == hollow[-1]) & (heights[:-1] > high)
    for radius in (outer, split):
        same &= np.abs(radius[:-1] / radius[-1] - 1.0) < SAME
    start = int(np.flatnonzero(~same)[-1]) + 1 if (~same).any() else 0
    return max(start, first) if len(heights) - 1 - max(start, first) >= 2 else len(heights)
