"""Where the mesh of a scene is fine, and how fine: from the estimated contact, before any mesh is made."""

from dataclasses import dataclass, replace
from math import ceil, copysign, cos, floor, log2
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Bools
from fem_impact.case.bodies import Bodies
from fem_impact.case.cells import body_cell, contact_radius, levels_of, rod_cell
from fem_impact.case.effects.skin import skin_of
from fem_impact.case.plates import doublings, is_thin
from fem_impact.errors import SceneError
from fem_impact.physics.contact import FLAT, ContactEstimate, ContactPair
from fem_impact.physics.hardening import Skin
from fem_impact.physics.plate import plate_waves
from fem_impact.scene.barrier import Barrier
from meshes import HexMesh, Zone, thin_skin_rise
from rigid import Faceted

Corners = tuple[Array, Array]  # lowest and highest corner of a box, m
Extents = tuple[float, float, float]
Ways = tuple[float, float]  # down the slope, towards -t, and up it, m
Shares = tuple[tuple[float, Extents], ...]  # least cells over the contact's radius, shares along t, b, n

# half-widths of the fine zone in units of the estimated contact ellipse's semi-axes (depth: of their
# geometric mean), and how many cells it has at least
ALONG, AROUND, DEPTH, FEWEST = 2.2, 1.5, 2.0, 4.0
# so much further along t an edge flows that is pressed in, by how much wider it is then, at most: without it
# strains of .2 (pipe at 40 degrees) to 1.2 (sharp aluminium rod at 60 degrees) reached the end of its zone
EDGE = 2.0
# Shares of the fine zone along t, b and n in which cells are split to a level, by how many of its cells lie
# over the radius of the contact at least: small cells pay where steel flows most, right under the contact
BARRIER_SHARES: Shares = ((6.0, (0.5, 0.7, 0.2)), (3.0, (0.7, 0.9, 0.45)))
ROD_SHARES: Shares = ((3.0, (0.8, 1.0, 0.3)),)
BUFFER = 1  # whole cells between two levels
# size of the ellipsoid in which cells may yield, over that of the ellipsoid inscribed in the fine
# zone's box; cells in the corners of the box stay elastic. In the 13 sets on 0.59 mm, and four on 0.30 mm,
# plastic strains above 1e-3 ended at .93 of the inscribed one, above 1e-5 at 1.13
ROUND = 1.1
# the rod slides down the slope while it touches: length of the fine strip over depth and tan(alpha), and
# at least over the half-width along t, because the surface is dragged along in front of a rod that sticks
# (at 17 to 37 degrees, where 1.1 to 1.3 half-widths left the edge flowing by up to 0.5 %)
SLIDE, DRAG = 5.0, 0.6
# under a tip that sticks the plate shears in a layer some 0.05 mm thick: so many rows at its skin are drawn
# together, each to half the height of the next; the first no lower than a share of the indentation, or it is
# crushed at the edge of the contact
SKIN_ROWS, LOW = 3, 0.1
MOST_ROWS = 5  # that a hardened layer may ask for: cells 32 times as wide as high at most


@dataclass(frozen=True, slots=True)
class Zones:
    """Sizes of the fine zones about the contact, m.

    Attributes
    ----------
    base : edge of the barrier's cells; rod_base : of the rod's, at the contact, the same but in a user's mesh
    rod, barrier : for each level of splitting, the coarsest first: half-widths along t and b, depth along n
    half : those of the zone in which cells may yield
    reach : how far the rod's zone follows its face down and up the slope; along : the same of the barrier's
    conforming : the barrier flows under all of the contact, so that its surface takes the rod's form
    skin_rows : thin rows of cells at the top of the barrier; rod_rows : of the rod, which has none
    edges : how far a plate that is meshed through its thickness goes beyond its fine zone; else 0
    """

    base: float
    rod_base: float
    rod: tuple[Extents, ...]
    barrier: tuple[Extents, ...]
    half: Extents
    reach: Ways
    along: Ways
    conforming: bool
    skin_rows: int
    edges: float = 0.0
    rod_rows: int = 0
    # what a run finds of a contact, and its estimate does not know
    line: ClassVar[float] = 0.0
    lasts: ClassVar[float | None] = None
    ends: ClassVar[tuple[float, float] | None] = None

    @property
    def tip_size(self) -> float:
        """Return the finest cell edge of the rod, m."""
        return self.rod_base * 0.5 ** len(self.rod)

    @property
    def barrier_size(self) -> float:
        """Return the finest cell edge of the barrier along t and b, m."""
        return self.base * 0.5 ** len(self.barrier)

    @property
    def rise(self) -> float:
        """Return by how much, m, the barrier's bottom rises where the rows at its skin are drawn together."""
        return thin_skin_rise(self.skin_rows) * self.barrier_size

    @property
    def whole(self) -> Corners:
        """Return the box, from the contact along t, b and n, in which the rod may touch and yield."""
        t, b, n = self.half
        return _box(t, self.reach, -n, b, n)

    @property
    def rod_boxes(self) -> list[Corners]:
        """Return the box of the rod's zone of each level, from the contact along t, b and n."""
        return [
            _box(t, self.reach, -self.rod_base / 2**level, b, n)
            for level, (t, b, n) in enumerate(self.rod, 1)
        ]

    @property
    def barrier_boxes(self) -> list[Corners]:
        """Return the box of each level of the barrier, before its rows at the skin are drawn together."""
        return [self._below(extents) for extents in self.barrier]

    def block(self, margin: float) -> Corners:
        """Return the corners of the barrier's block, ``margin``, m, wider than the zone that may yield."""
        low, high = self._below(self.half)
        return low - np.array([margin, 0.0, margin]), high + np.array([margin, margin, 0.0])

    @property
    def middle(self) -> float:
        """Return the place along t, m, of the middle of a face that is pressed in; 0 about a point."""
        return 0.5 * (self.reach[1] - self.reach[0])

    def in_rod(self, lowest: Array, turn: Array) -> list[Zone]:
        """Return the zone of each level in the frame of the projectile's mesh.

        ``lowest`` (3,), m, is its lowest point there; ``turn`` (3, 3) turns that frame into (t, b, n).
        """
        return [Zone(lowest, turn, *box) for box in self.rod_boxes]

    def in_barrier(self) -> list[Zone]:
        """Return the zone of each level along t, b and n, before the rows at the skin are drawn together."""
        return [Zone(np.zeros(3), np.eye(3), *box) for box in self.barrier_boxes]

    def touching(self, mesh: HexMesh, points: Array) -> Bools:
        """Return the mask (m,) of the rod's cells that may touch, ``points`` (n, 3), m, along t, b and n.

        They are the finest; of a user's mesh that is fine as it is, those about the contact.
        """
        return mesh.finest if mesh.level.any() else self._near(mesh, points)

    def rod_flow(self, mesh: HexMesh, points: Array) -> Bools:
        """Return the mask (m,) of the rod's cells that may yield, split ones; ``points`` as above."""
        fine = mesh.level > 0 if mesh.level.any() else self._near(mesh, points)
        return np.asarray(fine & _round(mesh, points, self.reach, self.half))

    def barrier_flow(self, mesh: HexMesh) -> Bools:
        """Return the mask (m,) of the barrier's cells that may yield."""
        return np.asarray((mesh.level > 0) & _round(mesh, mesh.points, self.along, self.half))

    def _near(self, mesh: HexMesh, points: Array) -> Bools:
        """Return the mask (m,) of the cells that reach into the zone in which the rod may touch."""
        gap = Zone(np.zeros(3), np.eye(3), *self.whole).gap(points[mesh.cells], np.zeros(len(mesh.cells)))
        return np.asarray(gap <= 0)

    def _below(self, extents: Extents) -> Corners:
        """Return the box of a zone of the barrier; it goes on under the path of the rod."""
        t, b, n = extents
        return _box(t, self.along, -n - self.rise, b, 0.0)


def _box(t: float, ways: Ways, low: float, b: float, high: float) -> Corners:
    """Return the corners of a box half ``t`` wide, m, that goes on down and up the slope."""
    return np.array([-t - ways[0], 0.0, low]), np.array([t + ways[1], b, high])


def _round(mesh: HexMesh, points: Array, along: Ways, radii: tuple[float, float, float]) -> Bools:
    """Return the mask (m,) of the cells that reach into an ellipsoid about the contact.

    The ellipsoid has half axes ``radii``, m, and is swept by ``along``, m, down and up the slope.
    """
    down, up = (np.array([way, 0.0, 0.0]) / radii for way in along)
    core = Zone(np.zeros(3), np.eye(3), -down, up)
    away = core.gap(points[mesh.cells] / radii, np.zeros(len(mesh.cells)))
    return np.asarray(away < ROUND)


def zones_of(bodies: Bodies) -> Zones:
    """Return the fine zones of two bodies that touch, wide enough for each material of a layered barrier."""
    size, pair = widest_contact(bodies.contact, bodies.barrier), bodies.contact
    base, rod_base, levels, below = base_cells(bodies)
    reach, wide = face_reach(bodies)
    conforming = pair.barrier_conforms
    rows = skin_rows(bodies, base / 2**below) if conforming and pair.f > 0 else 0
    graded = bodies.scene.accuracy.fine_zone != "even"

    def extents(h: float, shares: Shares) -> Extents:
        t, b, n = half_widths(size, h, share_of(contact_radius(bodies) / h, shares if graded else ()))
        return t, max(b, wide), n

    slid = slide(bodies, half_widths(size, base / 2**below)[0])
    return Zones(
        base,
        rod_base,
        rod=tuple(extents(rod_base / 2**level, ROD_SHARES) for level in range(1, levels + 1)),
        barrier=tuple(extents(base / 2**level, BARRIER_SHARES) for level in range(1, below + 1)),
        half=extents(min(rod_base / 2**levels, base / 2**below), ()),
        reach=reach,
        along=(reach[0] + slid[0], reach[1] + slid[1]),
        conforming=conforming,
        skin_rows=rows,
        edges=plate_waves(pair)[1] if is_thin(bodies) else 0.0,
    )


def base_cells(bodies: Bodies) -> tuple[float, float, int, int]:
    """Return the edges, m, of the cells of barrier and rod, and how often those of rod and barrier are split.

    The cells of a plate that is meshed through may be larger than those at its contact, see `doublings`.
    """
    (levels, below), edge = levels_of(bodies), body_cell(bodies)
    larger = doublings(bodies, edge)
    return edge * 2**larger, rod_cell(bodies), levels, below + larger


def widest_contact(pair: ContactPair, barrier: Barrier) -> ContactEstimate:
    """Return the largest extents of the contact estimated with each material of a layered barrier alone."""
    sizes = [pair.estimate, *(replace(pair, barrier=metal).estimate for _, metal in barrier.strata[1:])]
    widest = {key: max(getattr(size, key) for size in sizes) for key in ("depth", "a_t", "a_b")}
    return replace(pair.estimate, **widest)


def share_of(cells: float, shares: Shares) -> Extents:
    """Return the share of the fine zone for a level of which ``cells`` lie over the radius of the contact."""
    return next((share for least, share in shares if cells >= least), (1.0, 1.0, 1.0))


def half_widths(size: ContactEstimate, h: float, share: Extents = (1.0, 1.0, 1.0)) -> Extents:
    """Return a zone's extents along t (each side), b and n, m; ``h``, m, is the edge of its cells."""
    along = ALONG * min(size.wider, EDGE)
    whole = along * size.a_t, AROUND * size.a_b, DEPTH * size.radius
    t, b, n = (max(part * length, FEWEST * h) for part, length in zip(share, whole, strict=True))
    return t, b, n


def skin_rows(bodies: Bodies, h: float) -> int:
    """Return how many rows of cells ``h`` m high are drawn together at the skin of a plate that may stick.

    A hardened layer in force may ask for more of them, until `SKIN_ROWS` lie in it; with the fine zone "skin"
    they do.
    """
    halvings = floor(log2(h / (LOW * bodies.estimate.depth)))
    skin = skin_of(bodies.contact.barrier) if "machined-skin" in bodies.effects else None
    most = max(SKIN_ROWS, rows_for(skin.depth, h)) if skin else SKIN_ROWS
    return most if follows_skin(bodies, skin, h) else min(max(halvings, 0), most)


def follows_skin(bodies: Bodies, skin: Skin | None, h: float) -> bool:
    """Return whether cells ``h`` m wide are drawn as flat as a layer in force asks for."""
    flat = bodies.scene.accuracy.fine_zone == "skin"
    return skin is not None and flat and rows_for(skin.depth, h) <= MOST_ROWS


def rows_for(depth: float, h: float) -> int:
    """Return how many rows of cells ``h`` high are drawn together so that `SKIN_ROWS` lie in a depth, m.

    Examples
    --------
    >>> [rows_for(0.05, h) for h in (0.15, 0.05, 0.01)]
    [5, 3, 1]
    """
    return max(0, ceil(log2(h * (2**SKIN_ROWS - 1) / depth)))


def face_reach(bodies: Bodies) -> tuple[Ways, float]:
    """Return how far the fine zone must follow a face that is pressed in, along t and to the side, m.

    Of a turned body's face all may touch where it nearly lies flat, else as much as is pressed in. Of a body
    with facets, all nodes no higher than `FLAT` depths of the estimated indentation may that lie further out
    than those of the round surface of the estimate.
    """
    size, alpha = bodies.estimate, bodies.mesh_inclination
    body, rho = bodies.body, float(bodies.lowest_point[0])
    if isinstance(body, Faceted):
        down, up, side = body.spread(alpha, FLAT * size.depth, (size.R1, size.R2))
        reach = (0.0, up) if alpha < 0 else (down, 0.0)
        return reach, side + AROUND * size.a_b if side > 0 else 0.0
    if bodies.contact.nearly_flat(size.depth):
        return _ways(-2 * rho * cos(alpha)), abs(rho)
    return _ways(-2 * size.shift), 0.0


def _ways(t: float) -> Ways:
    """Return the ways down and up the slope of one along t, m."""
    return max(-t, 0.0), max(t, 0.0)


def slide(bodies: Bodies, t: float) -> Ways:
    """Return how far the fine zone of a barrier goes on where the rod slides, m, ``t`` m its half-width."""
    speed = bodies.contact.sliding
    if speed == 0:
        return 0.0, 0.0
    way = SLIDE * bodies.estimate.depth * abs(speed) / max(bodies.contact.approach, 1e-6)
    return _ways(copysign(max(way, DRAG * t), speed))


def require_fine_zone(bodies: Bodies) -> None:
    """Refuse a tip without a fine zone where one is needed (SceneError)."""
    levels, below = levels_of(bodies)
    split = below if bodies.rod.own_mesh else levels  # a mesh of its own is as fine as the user made it
    if split == 0 and (bodies.contact.compliant or bodies.contact.rod_yields):
        base = body_cell(bodies)
        raise SceneError(
            "leaves the tip as coarse as the rod: nothing could yield, and the barrier has no fine zone.",
            key="accuracy.tip_size",
            value=f"{(bodies.scene.accuracy.tip_size or base) * 1e3:.3g} mm",
            remedy=f"Give at most {0.7 * base * 1e3:.2g} mm, or the barrier-rigid effect on an elastic rod.",
        )
