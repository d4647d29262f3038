"""Meshes of a scene in the barrier frame, with their fine zones."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import cos, sin, sqrt

import numpy as np

import meshes
from fem_impact.arrays import Array, Bools, Ints
from fem_impact.case.bodies import Bodies
from fem_impact.case.cells import body_cell
from fem_impact.case.layers import MOST_CELLS, block_of, moved_rows
from fem_impact.case.plates import widening
from fem_impact.case.recorded import AnyZones, RecordedZones
from fem_impact.case.size import no_rest
from fem_impact.case.zones import BUFFER, Zones
from fem_impact.errors import SceneError
from fem_impact.scene.projectile import ProjectileSpec
from meshes import Cloud, HexMesh, RodMesh, Zone
from rigid import Projectile, Turned

AHEAD = 1e-6  # of a cell of the body, by how much a node may lie lower than the place that touches first
POINTS = 2  # mass points that replace the cylinder behind the nose of a rigid rod
_OTHERWISE = "Give a longer rod, another accuracy.tip_size or a larger accuracy.across."


@dataclass(frozen=True, slots=True)
class Geometry:
    """Rod and barrier meshes with positions in the barrier frame (t, b, n).

    Attributes
    ----------
    rod : RodMesh
    rod_points : (n, 3) float64, m; the rod's lowest point lies at t = 0, n = gap: that of the round
        surface over a conforming barrier, else the lowest node
    barrier : HexMesh or None
    tip_size, barrier_size : finest cell edge of each body, m; that of the barrier along t and b
    conforming : whether the barrier flows under the whole contact, see `SurfaceContact`
    skin_rows : number of thin rows of cells at the top of the barrier
    may_yield : for ``rod`` and ``barrier``, (m,) bool, cells that yield if the material does
    touching : (m,) bool, cells of the rod that may touch a meshed barrier
    middle : place along t of the middle of a face that is pressed in, m; 0 of a contact about a point
    half : how far a contact that is a line goes to each side of it, m; else 0
    """

    rod: RodMesh
    rod_points: Array
    barrier: HexMesh | None
    tip_size: float
    barrier_size: float
    conforming: bool = False
    skin_rows: int = 0
    may_yield: Mapping[str, Bools] = field(default_factory=dict)
    touching: Bools | None = None
    middle: float = 0.0
    half: float = 0.0

    @property
    def count(self) -> int:
        """Return the number of cells of both bodies."""
        return len(self.rod.mesh.cells) + (0 if self.barrier is None else len(self.barrier.cells))


def to_barrier_frame(alpha: float) -> Array:
    """Return the rotation (3, 3) from the rod frame (x, y, z) to (t, b, n)."""
    return np.array([[cos(alpha), 0, sin(alpha)], [0, 1, 0], [-sin(alpha), 0, cos(alpha)]])


def tail_corners(bodies: Bodies) -> Array:
    """Return both corners (2, 3), m, of the rod's tail in the symmetry plane at the start; gap 0."""
    body = bodies.body
    radius = float(body.radius(np.array(body.length)))
    corners = np.array([[x * radius, 0.0, body.length] for x in (-1, 1)])
    return np.asarray((corners - bodies.lowest_point) @ to_barrier_frame(bodies.mesh_inclination).T)


def build_geometry(
    bodies: Bodies,
    zones: AnyZones,
    gap: float,
    meshed_barrier: bool,
    vibrating: bool = True,
    rod: RodMesh | None = None,
) -> Geometry:
    """Mesh the rod (its nose alone if it cannot vibrate) and, if wanted, the barrier block under it.

    A ``rod`` that has struck before keeps its mesh.
    """
    turn, lowest = to_barrier_frame(bodies.mesh_inclination), bodies.lowest_point
    rod = rod or _mesh(bodies, zones, vibrating)
    points = (rod.mesh.points - lowest) @ turn.T
    if isinstance(zones, Zones) and bodies.mesh_inclination:  # an upright body has no side that could strike
        _require_tip_first(points, body_cell(bodies), bodies.rod.own_mesh is not None)
    points[:, 2] += gap if zones.conforming else gap - points[:, 2].min()
    touching, flows = zones.touching(rod.mesh, points), zones.rod_flow(rod.mesh, points)
    for cells in (touching, flows):
        cells[rod.body_cells] = False  # slices have mass points in place of nodes, and one elastic operator
    if not vibrating:  # nodes of the rigid rest do not give way: a contact there would lose energy
        touching &= ~np.isin(rod.mesh.cells, rod.body_nodes).any(axis=1)
    may_yield = {"rod": flows & (material_numbers(bodies.rod, rod.mesh) == 0)}  # the others stay elastic
    barrier = None
    if meshed_barrier:
        barrier = _block(bodies, zones)
        may_yield["barrier"] = zones.barrier_flow(barrier)
    return Geometry(
        rod,
        points,
        barrier,
        zones.tip_size,
        zones.barrier_size,
        zones.conforming,
        zones.skin_rows,
        may_yield,
        touching,
        zones.middle,
        zones.line,
    )


def _mesh(bodies: Bodies, zones: AnyZones, vibrating: bool) -> RodMesh:
    """Return the mesh of the rod, of its nose alone if it cannot vibrate."""
    turn, lowest = to_barrier_frame(bodies.mesh_inclination), bodies.lowest_point
    rod = _rod(bodies, lowest, zones.in_rod(lowest, turn))
    if not bodies.rod.own_mesh and _lowest(rod, lowest, turn) < -AHEAD * body_cell(bodies):
        rod = _rod(bodies, lowest, zones.in_rod(lowest, turn), flush=True)
    if isinstance(zones, RecordedZones) and zones.rod_rows:
        part = zones.pressed(rod.mesh, turn) & (material_numbers(bodies.rod, rod.mesh) == 0)
        rod = replace(rod, mesh=meshes.with_thin_rows(rod.mesh, part, zones.tip_size, zones.rod_rows))
    if vibrating:
        return rod
    if bodies.rod.own_mesh:
        near = rod.mesh.cells[zones.rod_flow(rod.mesh, (rod.mesh.points - lowest) @ turn.T)]
        end = float(rod.mesh.points[near, 2].max())  # past all that may yield
        rod = RodMesh.cut(rod.mesh, max(end, bodies.rod.diameter / 3))
        if len(rod.rest_cells) in (0, len(rod.mesh.cells)):
            raise no_rest()
    elif len(rod.rest_cells) in (0, len(rod.mesh.cells)):  # of a disc: all nose, or slices alone
        return _cut_aslant(bodies, zones, rod, turn)
    return meshes.without_slices(rod, rest_points(*bodies.body.moments_behind(rod.body_start)[1:]))


def _cut_aslant(bodies: Bodies, zones: AnyZones, rod: RodMesh, turn: Array) -> RodMesh:
    """Return a body of revolution without what lies deep, seen from its contact towards its mass centre.

    That is beyond all that is split or may yield, and a third of the diameter at least.
    """
    body, lowest, mesh = bodies.body, bodies.lowest_point, rod.mesh
    inward = np.array([0.0, 0.0, body.z_c]) - lowest
    depth = (mesh.points - lowest) @ inward / np.linalg.norm(inward)
    flows = mesh.cells[zones.rod_flow(mesh, (mesh.points - lowest) @ turn.T)]
    cut = RodMesh.cut(mesh, max(float(depth[flows].max(initial=0.0)), bodies.rod.diameter / 3), depth)
    if len(cut.rest_cells) in (0, len(mesh.cells)) or len(bodies.rod.segments) > 1:
        raise no_rest()
    of, rest = meshes.cell_moments(mesh), cut.rest_cells
    volume, x, z, square = (part[rest].sum() for part in (of.volume, of.x, of.z, of.xx + of.zz))
    x, z = x / volume, z / volume
    cut = meshes.without_slices(cut, rest_points(x, z, square / volume - x**2 - z**2))
    share = float(volume / of.volume.sum())
    return replace(cut, body_start=rod.body_start, on_surface=rod.on_surface, rest_share=share)


def rest_points(x: float, z: float, k2: float) -> Array:
    """Return the two points (2, 3), m, that replace what has its centre at x and z, m.

    They lie on either side of it at the radius of gyration, of which ``k2`` is the square, m2.
    """
    return np.array([[x, 0.0, z - sqrt(k2)], [x, 0.0, z + sqrt(k2)]])


def _lowest(rod: RodMesh, contact: Array, turn: Array) -> float:
    """Return the height, m, of the lowest node of the rod over the place that touches first."""
    return float(((rod.mesh.points - contact) @ turn[2]).min())


def _rod(bodies: Bodies, lowest: Array, zones: Sequence[Zone | Cloud], flush: bool = False) -> RodMesh:
    """Return the mesh of the rod, its side ``flush`` with the exact one where that nearly touches.

    Raises
    ------
    SceneError
        It is too short or thin for its cells.
    """
    body, across = bodies.body, bodies.scene.across
    try:
        if own := bodies.rod.own_mesh:
            half = own.half()
            half = replace(half, region=np.arange(len(half.cells)))
            return RodMesh.plain(meshes.refine(half, zones, buffer=BUFFER) if zones else half)
        if isinstance(body, Turned):
            return meshes.turned(
                body.outline,
                across,
                zones,
                bore=body.bore,
                planes=[end for end, _ in body.density],
                contact=lowest,
                buffer=BUFFER,
                flush=flush,
            )
        assert isinstance(body, Projectile), "a body with facets has a mesh of its own"
        if not flush and all(zone.corners()[:, 2].max() < body.z_side + body.diameter for zone in zones):
            return meshes.rod(
                body.meridian(), body.length, across, None, zones, contact=lowest, buffer=BUFFER
            )
        side = np.vstack([body.meridian(), [body.diameter / 2, body.length]])
        return meshes.turned(side, across, zones, contact=lowest, buffer=BUFFER, flush=flush)
    except meshes.MeshError as error:
        raise SceneError(f"cannot be meshed: {error}.", key="projectile", remedy=_OTHERWISE) from None


def _require_tip_first(points: Array, base: float, on_feet: bool) -> None:
    """Raise SceneError where the side of an inclined rod, a polygon in the mesh, lies lower than its tip.

    A mesh of a user's own may stand ``on_feet`` beside the plane of symmetry.
    """
    tip = np.hypot(points[:, 0], 0.0 if on_feet else points[:, 1]) < 1.5 * base
    if not tip.any():  # the nose of a rigid rest ends before the contact
        raise no_rest()
    ahead = float(points[tip, 2].min() - points[:, 2].min())
    if ahead > AHEAD * base:
        raise SceneError(
            f"lets the meshed rod's side, a polygon, strike {ahead * 1e6:.2g} um before its tip.",
            key="impact.angle",
            remedy="Give a smaller accuracy.tip_size, a smaller angle or a larger accuracy.across.",
        )


def material_numbers(rod: ProjectileSpec, mesh: HexMesh) -> Ints:
    """Return which of a projectile's materials each cell (m,) of its mesh is of; 0 is that which touches."""
    if mesh.region is not None:
        return np.asarray(rod.cell_materials()[mesh.region])
    ends = [part.to for part in rod.segments[:-1]]
    return np.asarray(np.searchsorted(ends, mesh.points[mesh.cells, 2].mean(axis=1)))


def _block(bodies: Bodies, zones: AnyZones) -> HexMesh:
    """Return the barrier block, rows of its cells at the interfaces of its layers and at its underside."""
    h, base = zones.barrier_size, zones.base
    low, high = block_of(bodies, zones)  # springs replace the half-space beyond
    rows, depths = moved_rows(bodies, zones)
    boxes = [_before_moving(zone, zones, rows, depths) for zone in zones.in_barrier()]
    count = float(np.prod((high - low) / base))
    if count > MOST_CELLS:
        raise SceneError(
            f"makes a block of {count:.1g} cells, {base * 1e6:.3g} um wide, under a contact that is much "
            "wider.",
            key="accuracy.across",
            value=str(bodies.scene.across),
            remedy="Give a smaller one.",
        )
    pressed, width = zones.ends, (float(low[0]), float(high[0]))
    columns = None if pressed is None else meshes.drawn_to_ends(pressed, h, width)
    if columns is not None:
        boxes = [_before_columns(zone, *columns) for zone in boxes]
    coarse = meshes.block(low, high, base, boxes, buffer=BUFFER)
    if columns is not None:
        coarse = meshes.with_columns_at(coarse, *columns)
    if zones.edges:
        widest = widening(bodies, base)
        coarse = meshes.with_free_bottom(
            meshes.with_wide_edges(coarse, 2 * zones.edges / (1 + widest), widest)
        )
    block = meshes.with_thin_skin(coarse, h, zones.skin_rows)
    if bodies.barrier.layers or zones.edges:
        block = meshes.with_rows_at(block, rows, depths)
    return replace(block, points=block.points + np.array([bodies.scene.accuracy.grid_shift * h, 0.0, 0.0]))


def _before_columns(zone: Zone | Cloud, columns: Array, places: Array) -> Cloud:
    """Return the zone whose cells fill another one once columns have moved."""
    assert isinstance(zone, Cloud), "zones from a record are clouds"

    def before(t: Array) -> Array:
        return np.asarray(np.interp(t, places, columns))

    t, beside = zone.points[:, 0], zone.points[:, 1:]
    shifted = (before(t + way * zone.radii) - way * zone.radii for way in (-1.0, 0.0, 1.0))
    points = np.vstack([np.column_stack([at, beside]) for at in shifted])
    return Cloud(points, np.tile(zone.radii, 3))


def _before_moving(zone: Zone | Cloud, zones: AnyZones, rows: Array, depths: Array) -> Zone | Cloud:
    """Return the zone whose cells fill another one once rows have moved to the depths of interfaces."""
    if len(rows) <= 2 and not zones.edges:
        return zone

    def depth(n: Array) -> Array:
        return np.asarray(-np.interp(-n - zones.rise, depths, rows) - zones.rise)

    if isinstance(zone, Cloud):
        return Cloud(np.column_stack([zone.points[:, :2], depth(zone.points[:, 2])]), zone.radii)
    low = np.array([*zone.low[:2], depth(zone.low[2])])
    return Zone(zone.centre, zone.axes, low, zone.high)
