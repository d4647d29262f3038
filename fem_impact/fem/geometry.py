"""Meshes of a scene in the barrier frame: where the fine zones lie and how large they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import cos, floor, log2, sin
from typing import TYPE_CHECKING

import numpy as np

import meshes
from fem_impact.arrays import Array, Bools
from fem_impact.errors import SceneError
from fem_impact.physics.contact import (
    ContactEstimate,
    approach,
    barrier_conforms,
    contact_estimate,
    projectile,
    sliding,
)
from meshes import HexMesh, RodMesh, Zone

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


# half-widths of the fine zone in units of the estimated contact ellipse's semi-axes (depth: of their
# geometric mean), and how many cells it has at least
ALONG, AROUND, DEPTH, FEWEST = 2.2, 1.5, 2.0, 4.0
MOST_CELLS = 3e5  # of a block before it is refined: about a gigabyte
# in the corners of that box cells stay elastic: those may yield that an ellipsoid reaches, so many times as
# large as the one in the box. In the 13 sets on 0.59 mm, and four on 0.30 mm, strains above 1e-3 ended at .93
# of the latter, above 1e-5 at 1.13
ROUND = 1.1
# the rod slides down the slope while it touches: length of the fine strip over depth and tan(alpha), and
# at least over the half-width along t, because the surface is dragged along in front of a rod that sticks
# (at 17 to 37 degrees, where 1.1 to 1.3 half-widths left the edge flowing by up to 0.5 %)
SLIDE, DRAG = 5.0, 0.6
# a flat face whose middle is no higher than this many depths may touch as a whole
FLAT = 2.0
# under a tip that sticks the plate shears in a layer some 0.05 mm thick: so many rows at its skin are drawn
# together, each to half the height of the next; the first no lower than a share of the indentation, or it is
# crushed at the edge of the contact
SKIN_ROWS, LOW = 3, 0.1
# a row is as heavy as if it were so high, in cells, so that thin ones do not set the step. At 0.8 that took
# .001 from e of t5b on 0.59 and 0.30 mm, and closing rose to 4e-4 and 1.2e-4 of E_0; both go with the square
HEAVY = 0.65


@dataclass(frozen=True, slots=True)
class Geometry:
    """Rod and barrier meshes with positions in the barrier frame (t, b, n).

    Attributes
    ----------
    rod : RodMesh; rod_points : (n, 3) float64, m, lowest point at t = 0, n = gap: that of the round surface
        over a conforming barrier, else that of the nodes
    barrier : HexMesh or None
    tip_size : finest cell edge, m; in the barrier along t and b
    conforming : the barrier flows under all of the contact, see `SurfaceContact`
    skin_rows : thin rows of cells at the top of the barrier
    may_yield : (m,) cells of ``rod`` and ``barrier`` that yield if the material does
    """

    rod: RodMesh
    rod_points: Array
    barrier: HexMesh | None
    tip_size: float
    conforming: bool = False
    skin_rows: int = 0
    may_yield: Mapping[str, Bools] = field(default_factory=dict)


def to_barrier_frame(alpha: float) -> Array:
    """Return the rotation (3, 3) from the rod frame (x, y, z) to (t, b, n)."""
    return np.array([[cos(alpha), 0, sin(alpha)], [0, 1, 0], [-sin(alpha), 0, cos(alpha)]])


def tail_corners(scene: Scene) -> Array:
    """Return the highest and lowest point (2, 3) of the rod's tail at the start, m, the gap apart."""
    body = projectile(scene)
    corners = np.array([[x * body.diameter / 2, 0.0, body.length] for x in (-1, 1)])
    return np.asarray((corners - _lowest(scene)) @ to_barrier_frame(scene.impact.angle).T)


def _lowest(scene: Scene) -> Array:
    """Return the rod's lowest point (3,) in its own frame, m."""
    rho, z = projectile(scene).contact_point(scene.impact.angle)
    return np.array([float(rho), 0.0, float(z)])


def levels_of(scene: Scene) -> int:
    """Return how often base cells are split to come nearest to the wanted tip size."""
    base = scene.projectile.diameter / scene.accuracy.across
    return max(0, round(float(np.log2(base / scene.accuracy.tip_size))))


def half_widths(size: ContactEstimate, h: float) -> tuple[float, float, float]:
    """Return the fine zone's extents along t (each side), b and n, m."""
    depth = DEPTH * np.sqrt(size.a_t * size.a_b)
    return max(ALONG * size.a_t, FEWEST * h), max(AROUND * size.a_b, FEWEST * h), max(depth, FEWEST * h)


def build_geometry(scene: Scene, gap: float, meshed_barrier: bool, vibrating: bool = True) -> Geometry:
    """Mesh the rod (its nose alone if it cannot vibrate) and, if wanted, the barrier block under it."""
    body, alpha = projectile(scene), scene.impact.angle
    base, levels = body.diameter / scene.accuracy.across, levels_of(scene)
    conforming = meshed_barrier and barrier_conforms(scene)
    turn, lowest = to_barrier_frame(alpha), _lowest(scene)
    h = base / 2**levels
    t, b, n, reach = _fine_zone(scene, h, float(lowest[0]))
    zone = Zone(lowest, turn, np.array([-t - reach, 0.0, -h]), np.array([t, b, n]))
    rod = _rod(scene, zone, levels)
    if not vibrating:
        from fem_impact.solid.rigid_rest import rest_points

        rod = meshes.without_slices(rod, rest_points(rod.body_start, body.length, body.diameter))
    points = (rod.mesh.points - lowest) @ turn.T
    _require_tip_first(points, base)
    points[:, 2] += gap if conforming else gap - points[:, 2].min()
    sticks = conforming and "friction" in scene.active and scene.surface.friction > 0
    rows = skin_rows(scene, h) if sticks else 0
    may_yield, barrier = {"rod": _round(rod.mesh, points, reach, (t, b, n))}, None
    if meshed_barrier:
        along = reach + slide(scene, t)
        barrier = _block(scene, base, levels, (t, b, n), along, rows)
        may_yield["barrier"] = _round(barrier, barrier.points, along, (t, b, n))
    return Geometry(rod, points, barrier, h, conforming, rows, may_yield)


def _rod(scene: Scene, zone: Zone, levels: int) -> RodMesh:
    """Return the mesh of the rod; SceneError where it has no room for its cells."""
    body = projectile(scene)
    try:
        return meshes.rod(body.meridian(), body.length, scene.accuracy.across, zone=zone, levels=levels)
    except meshes.MeshError as error:
        remedy = "Give a longer rod, another accuracy.tip_size or a larger accuracy.across."
        raise SceneError(f"cannot be meshed: {error}.", key="projectile", remedy=remedy) from None


def _require_tip_first(points: Array, base: float) -> None:
    """Refuse a rod that lies so flat that its side, a polygon, comes down before its tip at the origin."""
    tip = np.hypot(points[:, 0], points[:, 1]) < 1.5 * base
    ahead = float(points[tip, 2].min() - points[:, 2].min())
    if ahead > 1e-6 * base:
        raise SceneError(
            f"lets the meshed rod's side, a polygon, strike {ahead * 1e6:.2g} um before its tip.",
            key="impact.angle",
            remedy="Give a smaller angle or a larger accuracy.across.",
        )


def _round(mesh: HexMesh, points: Array, along: float, radii: tuple[float, float, float]) -> Bools:
    """Return which of the finest cells (m,) reach into an ellipsoid about the contact, drawn out along -t."""
    core = Zone(np.zeros(3), np.eye(3), np.array([-along, 0.0, 0.0]) / radii, np.zeros(3))
    away = core.gap(points[mesh.cells] / radii, np.zeros(len(mesh.cells)))
    return np.asarray(mesh.finest & (away < ROUND))


def _fine_zone(scene: Scene, h: float, rho: float) -> tuple[float, float, float, float]:
    """Return half-widths along t, b and n, and how far it follows a flat face, all m."""
    t, b, n = half_widths(contact_estimate(scene), h)
    reach = face_reach(scene, rho)
    return t, max(b, rho) if reach > 0 else b, n, reach


def skin_rows(scene: Scene, h: float) -> int:
    """Return how many rows of cells ``h`` m high are drawn together at the skin of a plate that may stick."""
    halvings = floor(log2(h / (LOW * contact_estimate(scene).depth)))
    return min(max(halvings, 0), SKIN_ROWS)


def face_reach(scene: Scene, rho: float) -> float:
    """Return how far the fine zone must follow the flat face, m: 0 unless the face nearly lies flat.

    The face rises from the contact by tan(alpha); if its middle stands no higher than `FLAT` depths of the
    estimated indentation, all of it may touch.
    """
    depth, alpha = contact_estimate(scene).depth, scene.impact.angle
    return 2 * rho * cos(alpha) if rho * sin(alpha) <= FLAT * depth else 0.0


def slide(scene: Scene, t: float) -> float:
    """Return how far the fine zone of a barrier goes on down the slope, m, ``t`` m its half-width there."""
    down = -sliding(scene)
    if down <= 0:
        return 0.0
    way = SLIDE * contact_estimate(scene).depth * down / max(approach(scene), 1e-6)
    return max(way, DRAG * t)


def _block(
    scene: Scene, base: float, levels: int, half: tuple[float, float, float], along: float, rows: int
) -> HexMesh:
    """Return the block; its fine zone has half-widths ``half`` and goes ``along`` m on down the slope."""
    h, (t, b, n) = base / 2**levels, half
    n += meshes.thin_skin_rise(rows) * h
    box = Zone(np.zeros(3), np.eye(3), np.array([-t - along, 0.0, -n]), np.array([t, b, 0.0]))
    margin = scene.accuracy.block_margin  # the springs of the boundary stand for the rest
    low = np.array([-t - along - margin, 0.0, -n - margin])
    high = np.array([t + margin, b + margin, 0.0])
    count = float(np.prod((high - low) / base))
    if count > MOST_CELLS:
        raise SceneError(
            f"makes a block of {count:.1g} cells, since they are {base * 1e6:.3g} um wide.",
            key="accuracy.block_margin",
            value=f"{margin * 1e3:g} mm",
            remedy="Give less: a third of the diameter does.",
        )
    block = meshes.with_thin_skin(meshes.block(low, high, base, zone=box, levels=levels), h, rows)
    return replace(block, points=block.points + np.array([scene.accuracy.grid_shift * h, 0.0, 0.0]))
