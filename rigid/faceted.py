"""A projectile bounded by flat facets, of any shape with a plane of symmetry, such as that of a mesh."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .arms import Arms, point_arms
from .chord import mirrored_chord
from .inputs import ArrayLike, Floats, ShapeError
from .rounds import Round, cut, hull, rounds_of, steps_of
from .slenderness import slenderness
from .touch import Touch, inclinations, level_part, on_side
from .turned import CORNER

LEVEL = 1e-6
"""Share of the length within which places count as equally low, and places on a straight line as in it.

Coordinates in a text file of six digits or more lie so near to where they should.
"""
STEEP = math.sin(math.radians(45.0))
"""Sine of the angle to the convex outline from which on a facet at one of its vertices makes that an edge."""
UNEVEN = 0.3
"""Share by which a wall around the axis may differ from that of a ring, as that of a square tube does."""
HEIGHTS = 400
"""Heights at which the width of the body is tabulated."""


@dataclass(frozen=True, slots=True, eq=False)
class Faceted:
    """The half y >= 0 of a body whose tip stands at z = 0.

    Its side x > 0 comes down first at an inclination above 0, its side x < 0 at one below.

    Parameters
    ----------
    points : (k, 3) float64, m
        Nodes of the outer surface.
    facets : (m, 4) int64
        Their numbers at the corners of each facet.
    parts : (n, 7) float64
        Of each part of the half body: least and greatest z, m; mass, kg; first moments over x and z, kg m;
        second moments over x and z, kg m2.

    Examples
    --------
    >>> corners = np.array([[x, y, z] for x in (-1, 1) for y in (0, 1) for z in (0, 6.0)]) / 100
    >>> face = np.array([[0, 2, 6, 4]])
    >>> bar = Faceted(corners, face, np.array([[0, 0.06, 0.1, 0, 0.003, 1e-5 / 3, 12e-5]]))
    >>> f"{bar.mass:.2f} kg, k2 {bar.k2:.4e} m2, z_c {1e3 * bar.z_c:.1f} mm"
    '0.20 kg, k2 3.3333e-04 m2, z_c 30.0 mm'
    """

    points: Floats
    facets: NDArray[np.int64]
    parts: Floats
    _outline: Floats = field(init=False)
    _sharp: NDArray[np.bool_] = field(init=False)
    _half_widths: tuple[Floats, Floats] = field(init=False)

    def __post_init__(self) -> None:
        if not (self.parts[:, 2] > 0).all() or not np.isfinite(self.parts).all():
            raise ShapeError("each part of a body needs a mass above 0, and finite moments")
        object.__setattr__(self, "_outline", hull(self.points[:, [0, 2]], LEVEL * self.length))
        object.__setattr__(self, "_sharp", self._sharp_vertices())
        # heights, and the half width along x there, m, of the edges of facets that cross them
        z = np.linspace(0.0, self.length, HEIGHTS)
        (x, _, low), (u, _, high) = np.moveaxis(self.points[_edges(self.facets)], (2, 3), (0, 1))
        width, slack = np.zeros(HEIGHTS), LEVEL * self.length
        for k, height in enumerate(z):
            crossed = (np.minimum(low, high) - slack <= height) & (height <= np.maximum(low, high) + slack)
            a, b, rise = x[crossed], u[crossed], (high - low)[crossed]
            level = np.abs(rise) <= slack
            share = np.clip((height - low[crossed]) / np.where(level, 1.0, rise), 0.0, 1.0)
            wide = np.where(level, np.maximum(np.abs(a), np.abs(b)), np.abs(a + share * (b - a)))
            width[k] = wide.max(initial=0.0)
        object.__setattr__(self, "_half_widths", (z, width))

    @property
    def length(self) -> float:
        """Length, m."""
        return float(self.points[:, 2].max())

    @property
    def diameter(self) -> float:
        """Largest width, m, along x or y."""
        return float(max(np.ptp(self.points[:, 0]), 2.0 * self.points[:, 1].max()))

    @property
    def mass(self) -> float:
        """Mass of the whole body, kg."""
        return 2.0 * float(self.parts[:, 2].sum())

    @property
    def x_c(self) -> float:
        """Place of the mass centre along x, m."""
        return float(self.parts[:, 3].sum() / self.parts[:, 2].sum())

    @property
    def z_c(self) -> float:
        """Distance of the mass centre from the tip, m."""
        return float(self.parts[:, 4].sum() / self.parts[:, 2].sum())

    @property
    def k2(self) -> float:
        """Squared radius of gyration about an axis along y through the mass centre, m2."""
        return float(self.parts[:, 5:].sum() / self.parts[:, 2].sum()) - self.x_c**2 - self.z_c**2

    def moments_behind(self, start: float) -> tuple[float, float, float, float]:
        """Mass (kg), centre x and z (m), squared radius of gyration (m2) of parts from `start`, m, on."""
        mass, x, z, xx, zz = 2.0 * self.parts[self.parts[:, 0] >= start, 2:].sum(axis=0)
        return mass, x / mass, z / mass, (xx + zz - (x**2 + z**2) / mass) / mass

    @property
    def gamma(self) -> float:
        """Slenderness coefficient (Eq 29) with the largest width, m^-0.3815."""
        return float(slenderness(self.length, self.diameter))

    def reversed(self) -> "Faceted":
        """Return the body with its tail as its tip: turned by half a turn in the plane of motion."""
        low, high, mass, x, z, xx, zz = self.parts.T
        length = self.length
        moved = (length - high, length - low, mass, -x, length * mass - z, xx)
        parts = np.column_stack([*moved, length**2 * mass - 2.0 * length * z + zz])
        return Faceted(self.points * [-1, 1, -1] + [0, 0, length], self.facets, parts)

    @property
    def face(self) -> float:
        """Half width along x of the flat face at the tip, m; 0 where there is none."""
        low = self.points[self.points[:, 2] <= LEVEL * self.length, 0]
        return 0.5 * float(np.ptp(low))

    def contact_point(self, alpha: ArrayLike) -> tuple[Floats, Floats]:
        """Lowest point (x, z), m, at inclination `alpha` (rad).

        Of a part that is equally low it is the end on the side that comes down first, nearest the tip: see
        `touch`.
        """
        alpha = inclinations(alpha)
        place = self._outline[self._lowest(alpha)]
        return place[..., 0][()], place[..., 1][()]

    def touch(self, alpha: float) -> Touch:
        """Return what is lowest in the plane of motion at `alpha` (rad): a point, or all of a side."""
        x, z = (float(part) for part in self.contact_point(alpha))
        return level_part(self._outline, alpha, LEVEL * self.length) or Touch(x, z, 0.0)

    def arms(self, alpha: ArrayLike) -> Arms:
        """Arms d_c, d_d, m, of the lowest point about the mass centre."""
        x, z = self.contact_point(alpha)
        return point_arms(self.z_c, x - self.x_c, z, alpha)

    def off_axis(self) -> float:
        """Distance, m, of the middle of the lowest places of the upright body from its mass centre's axis."""
        low = self.points[self.points[:, 2] <= LEVEL * self.length, 0]
        return abs(0.5 * float(low.min() + low.max()) - self.x_c)

    def tip_curvature(self, alpha: float) -> float:
        """Radius of curvature, m, of the outline in the plane of motion at the lowest point; 0 on an edge.

        Facets that meet at an angle above `CORNER`, or between straight sides, make an edge.
        """
        k = int(self._lowest(np.array(alpha)))
        turn, shorter, joined = steps_of(self._outline, CORNER, self._sharp)
        return float(shorter[k] / turn[k]) if joined[k] or joined[k - 1] else 0.0

    def reaches(self, alpha: float, height: float) -> tuple[float, float]:
        """As `Projectile.reaches`, of the convex outline."""
        outline = self._outline if alpha >= 0 else self._outline[::-1] * [-1.0, 1.0]
        highest = int(np.argmax(outline @ (-math.sin(abs(alpha)), math.cos(alpha))))
        around = np.roll(outline, -highest, axis=0)
        return mirrored_chord(np.vstack([around, around[:1]]), alpha, height)

    def section(self, alpha: float, height: float) -> float:
        """Area, m2, of the body in the plane at a `height`, m, over the lowest point, of all its pieces."""
        x, y, z = np.moveaxis(self._cut(self.heights(alpha) - height), 2, 0)
        t = x * math.cos(alpha) + z * math.sin(alpha)
        steps = np.unique(t)
        return 2.0 * float(np.diff(steps) @ _inside(t, y, 0.5 * (steps[1:] + steps[:-1])))

    def strips(self, z: float) -> Floats:
        """Least and greatest x, m, (k, 2) of each piece of the section at `z`, m; gaps along x part them."""
        low, high = np.sort(self._cut(self.points[:, 2] - z)[:, :, 0], axis=1).T
        order = np.argsort(low)
        low, reached = low[order], np.maximum.accumulate(high[order])
        parts = np.flatnonzero(low[1:] > reached[:-1] + LEVEL * self.length)
        return np.column_stack([low[np.append(0, parts + 1)], reached[np.append(parts, len(low) - 1)]])

    def _cut(self, over: Floats) -> Floats:
        """Return the lines (m, 2, 3), m, in which a plane cuts facets; its nodes are ``over`` it, (k,) m."""
        ends = _edges(self.facets)
        heights = over[ends]
        crosses = (heights.min(axis=2) < 0.0) & (heights.max(axis=2) >= 0.0)
        cut = crosses.sum(axis=1) == 2  # a plane cuts a facet along a line between two of its edges
        ends, heights = ends[cut][crosses[cut]], heights[cut][crosses[cut]]
        share = (heights[:, 0] / (heights[:, 0] - heights[:, 1]))[:, None]
        places = self.points[ends[:, 0]] * (1.0 - share) + self.points[ends[:, 1]] * share
        return np.asarray(places.reshape(-1, 2, 3))

    def half_widths(self, start: Floats, end: Floats, share: Floats) -> Floats:
        """Half widths across, m, of the flat side on a straight part of the outline from `start` to `end`.

        Both are (x, z), m; `share` are shares of the way. 0 where an edge alone or nothing lies in it. Gaps
        between pieces of the side do not count.
        """
        way = end - start
        length = float(np.hypot(*way))
        x, z = ((self.points[:, [0, 2]] - start) @ np.array([way, [-way[1], way[0]]]).T / length).T
        flat = self.facets[(np.abs(z) < LEVEL * self.length)[self.facets].all(axis=1)]
        edges = _edges(flat).reshape(-1, 2)
        places = np.clip(share, LEVEL, 1.0 - LEVEL) * length
        return _inside(x[edges], self.points[edges, 1], places)

    def curvature_around(self, alpha: float) -> float:
        """Radius of curvature, m, across the plane of motion at the lowest point; inf along a straight edge.

        It is the largest that a node of a facet there stands for, b^2 / (2 n) at b beside and n above it; of
        a body on two feet beside its plane of symmetry, b is measured from a foot.
        """
        height, level, away = self.heights(alpha), LEVEL * self.length, self.beside(alpha)
        b = np.abs(self.points[:, 1] - away)
        here = np.flatnonzero((height < level) & (b <= level))
        near = np.unique(self.facets[np.isin(self.facets, here).any(axis=1)])
        near = near[b[near] > level]
        ratio = b[near] ** 2 / np.maximum(2.0 * height[near], 1e-300)
        return math.inf if (height[near] < level).any() else float(ratio.max(initial=0.0))

    def beside(self, alpha: float) -> float:
        """How far, m, the lowest point lies beside the plane of symmetry; 0 but of a body on two feet."""
        low = self.points[self.heights(alpha) < LEVEL * self.length, 1]
        least = float(low.min())
        return least if least > LEVEL * self.length else 0.0

    def heights(self, alpha: float) -> Floats:
        """(k,) heights, m, of the nodes of the surface over the lowest of them."""
        height = self.points[:, 2] * math.cos(alpha) - self.points[:, 0] * math.sin(alpha)
        return np.asarray(height - height.min())

    def spread(self, alpha: float, height: float, radii: tuple[float, float]) -> tuple[float, float, float]:
        """How far, m, a body no higher than `height`, m, goes beyond a round surface: along -t, t and b.

        `radii` are its principal radii, m, along t and b. Along t corners of the outline count, so that nodes
        within a straight flank do not.
        """
        limit = max(height, LEVEL * self.length)
        sin, cos = math.sin(alpha), math.cos(alpha)
        t, over = self._outline @ (cos, sin), self._outline @ (-sin, cos)
        lowest = int(self._lowest(np.array(alpha)))
        t, over = t - t[lowest], over - over.min()
        t, along = t[over <= limit], np.sqrt(2.0 * radii[0] * over[over <= limit])
        nodes = self.heights(alpha)
        low = nodes <= limit
        side = self.points[low, 1] - np.sqrt(2.0 * radii[1] * nodes[low])
        back, ahead, beside = (max(float(part.max()), 0.0) for part in (-t - along, t - along, side))
        return back, ahead, beside

    def radius(self, z: Floats) -> Floats:
        """Half width, m, along x at heights `z`, m."""
        return np.asarray(np.interp(z, *self._half_widths))

    def holds(self, rho: Floats, z: Floats) -> NDArray[np.bool_]:
        """Whether points at distances `rho` from the axis and heights `z`, m, lie within the outer width."""
        return np.asarray((rho <= self.radius(z)) & (z >= 0.0) & (z <= self.length))

    def wall(self, z: Floats) -> tuple[Floats, Floats]:
        """Outer and inner radii, m, (k,) of a wall around the axis at heights `z`, m; inner 0 where none is.

        The plane of motion cuts such a wall twice, alike on both sides, and the section is that of a ring.
        """
        ends = _edges(self.facets).reshape(-1, 2)
        ends = ends[(np.abs(self.points[ends, 1]) <= LEVEL * self.length).all(axis=1)]
        (a, low), (b, high) = np.moveaxis(self.points[ends][:, :, [0, 2]], 0, -1)
        found, looked, ring = np.zeros((2, len(z))), np.zeros(4), False
        for k, height in enumerate(z):
            cut = (low > height) != (high > height)
            x = np.sort((a + (height - low) / np.where(high == low, 1.0, high - low) * (b - a))[cut])
            if len(x) != 4:
                continue
            outer, inner = 0.5 * (x[3] - x[0]), 0.5 * (x[2] - x[1])
            if np.abs(x - looked).max() > LEVEL * self.length:
                area, apart = math.pi * (outer**2 - inner**2), x[1] - x[0] - (x[3] - x[2])
                even = abs(apart) < UNEVEN * (outer - inner) and len(self.strips(height)) == 1
                looked, ring = x, even and abs(self.section(0.0, height) / area - 1.0) < UNEVEN
            if ring:
                found[:, k] = outer, inner
        return found[0], found[1]

    def within(self, x: Floats, z: Floats) -> NDArray[np.bool_]:
        """Whether points (x, z), m, lie inside the body where the plane of motion cuts it (even-odd rule)."""
        ends = _edges(self.facets).reshape(-1, 2)
        cut = (np.abs(self.points[ends, 1]) <= LEVEL * self.length).all(axis=1)
        (a, low), (b, high) = np.moveaxis(self.points[ends[cut]][:, :, [0, 2]], 0, -1)
        x, z = np.asarray(x)[..., None], np.asarray(z)[..., None]
        share = (z - low) / np.where(high == low, 1.0, high - low)
        crossed = ((low > z) != (high > z)) & (a + share * (b - a) > x)
        return np.asarray(crossed.sum(axis=-1) % 2 == 1)

    def sections(self, z: Floats, factor: Floats | float = 1.0) -> Floats:
        """Mass, kg/m, and second moment over x about its centre, kg m, of a metre, (k, 2), of the whole body.

        They are means between heights `z` (k + 1,), m; each part is spread evenly over its own height. A
        `factor` of each part (n,) gives other sums than that of masses, such as stiffness.
        """
        low, high = self.parts[:, 0], self.parts[:, 1]
        share = np.clip((np.asarray(z)[:, None] - low) / (high - low), 0.0, 1.0)
        moments = self.parts[:, [2, 3, 5]] * np.broadcast_to(factor, len(low))[:, None]
        mass, x, xx = 2.0 * (np.diff(share @ moments, axis=0) / np.diff(z)[:, None]).T
        return np.column_stack([mass, xx - x**2 / mass])

    def rounds(self) -> list[Round]:
        """Corners of the convex outline in the plane of motion, in order around it."""
        return rounds_of(self._outline)

    def curves(self, side: float = 1.0) -> list[Round]:
        """Arcs and corners of the outline of the body, or at a ``side`` below 0 of its mirror image.

        Facets that turn by less than `CORNER` are steps of a smooth curve.
        """
        line = self._outline if side > 0 else self._outline[::-1] * [-1.0, 1.0]
        return cut(rounds_of(line, CORNER, self._sharp if side > 0 else self._sharp[::-1]), math.pi)

    def _sharp_vertices(self) -> NDArray[np.bool_]:
        """Return which vertices (k,) of the convex outline are edges, as those of a collar.

        The outline passes over what lies beside them, so that it turns little there: a facet is steep to it.
        """
        corners, line = self.points[self.facets], self._outline
        normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        flat = np.hypot(normal[:, 0], normal[:, 2])
        own = flat > STEEP * np.abs(normal[:, 1])  # no side of the body that lies along the plane of motion
        facets, across = self.facets[own], normal[own][:, [0, 2]] / flat[own][:, None]
        along = np.roll(line, -1, axis=0) - np.roll(line, 1, axis=0)
        edges = np.zeros(len(line), bool)
        for k in np.flatnonzero(steps_of(line, CORNER)[0] < CORNER):
            at = np.abs(self.points[:, [0, 2]] - line[k]).max(axis=1) <= LEVEL * self.length
            middle = at & (np.abs(self.points[:, 1]) <= LEVEL * self.length)
            at = middle if middle.any() else at  # a notch beside the plane of motion makes no edge in it
            here = across[at[facets].any(axis=1)]
            edges[k] = (np.abs(here @ along[k]) > STEEP * np.hypot(*along[k])).any()
        return edges

    def _lowest(self, alpha: Floats) -> NDArray[np.int64]:
        """Return the vertex of the outline that is lowest; of those equally low, see `contact_point`."""
        x, z = self._outline.T
        height = z * np.cos(alpha)[..., None] - x * np.sin(alpha)[..., None]
        low = height <= height.min(axis=-1)[..., None] + LEVEL * self.length
        ahead = np.where(low, on_side(x, np.asarray(alpha)[..., None]), -np.inf)
        foremost = ahead >= ahead.max(axis=-1)[..., None] - LEVEL * self.length
        return np.asarray(np.argmin(np.where(foremost, z, np.inf), axis=-1))


def _edges(facets: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the nodes (m, 4, 2) at the ends of each edge of facets (m, 4)."""
    return np.stack([facets, np.roll(facets, -1, axis=1)], axis=-1)


def _inside(t: Floats, y: Floats, places: Floats) -> Floats:
    """How much of each line across, y from 0 up at a place, m, lies within lines (m, 2) that bound an area.

    By the even-odd rule: a line that bounds two facets counts twice, and so not at all.
    """
    (a, b), (low, high) = t.T, y.T
    crossed = (a > places[:, None]) != (b > places[:, None])
    share = (places[:, None] - a) / np.where(a == b, 1.0, b - a)
    heights = np.sort(np.where(crossed, low + share * (high - low), 0.0), axis=1)[:, ::-1]
    return np.asarray(heights[:, ::2].sum(axis=1) - heights[:, 1::2].sum(axis=1))
