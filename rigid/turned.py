"""A projectile turned from its profile: outer radius and bore along the axis, densities along the axis."""

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from .arms import Arms, point_arms
from .chord import both_sides, mirrored_chord
from .inputs import ArrayLike, Floats, ShapeError, TooLongError
from .rounds import LONG, Round, cut, hull, is_step, rounds_of
from .slenderness import slenderness
from .touch import LEVEL, Touch, inclinations, level_part, on_side

CORNER = math.radians(12.0)
"""A turn of the profile above this, rad, is an edge of the body, not a step of a smooth curve."""
_WITHIN = np.array([1e-6, 1 - 1e-6])  # of a straight piece: beside its ends, where a radius may jump


@dataclass(frozen=True, slots=True, eq=False)
class Turned:
    """A body of revolution.

    Parameters
    ----------
    outline : (k, 2) float64, m
        Vertices (rho, z) of the outer surface from the axis at the tip (0, 0) to the tail: to the axis, or to
        the edge of a flat tail. z grows from 0 and never turns back.
    density : sequence of (end, density)
        m from the tip and kg/m3, one entry a segment; the last end is the length.
    bore : (k, 2) float64, m, optional
        Vertices (rho, z) of the inner surface from its front to its rear end; a bore that ends inside is
        closed there by a flat face.

    Examples
    --------
    >>> tube = Turned([(0, 0), (0.01, 0), (0.01, 0.2)], [(0.2, 7850.0)], [(0.008, 0), (0.008, 0.2)])
    >>> f"{tube.mass:.4f} kg, k2 {tube.k2:.4e} m2, z_c {1e3 * tube.z_c:.1f} mm"
    '0.1776 kg, k2 3.3743e-03 m2, z_c 100.0 mm'
    """

    outline: Floats
    density: tuple[tuple[float, float], ...]
    bore: Floats | None = None
    _moments: tuple[float, float, float] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "outline", _vertices(self.outline, "profile"))
        object.__setattr__(self, "density", tuple((float(end), float(rho)) for end, rho in self.density))
        if np.abs(self.outline[0]).max() > 0:
            raise ShapeError(f"a profile starts on the axis at the tip, (0, 0), got {tuple(self.outline[0])}")
        if np.any(np.diff(self.outline[self.outline[:, 1] <= 0.0, 0]) < 0):
            raise ShapeError("the profile's radius shrinks at z = 0, where its flat face ends")
        if self.bore is not None:
            bore = _vertices(self.bore, "bore")
            object.__setattr__(self, "bore", bore)
            if bore[-1, 1] > self.length:
                end, length = bore[-1, 1] * 1e3, self.length * 1e3
                raise TooLongError(f"the bore ends at {end:.3g} mm, beyond the tail at {length:.3g} mm")
            z = np.unique(np.concatenate([bore[:, 1], self.outline[:, 1]]))
            z = (z[:-1, None] + np.diff(z)[:, None] * _WITHIN).ravel()  # both are straight between these
            inner, outer = self.inner_radius(z), self.radius(z)
            thin = np.flatnonzero(inner >= outer)
            if len(thin):
                # to .1 um: the place lies a little beside a vertex
                place, r, R = (f"{round(1e3 * x[thin[0]], 4):.3g} mm" for x in (z, inner, outer))
                raise ShapeError(f"the bore of radius {r} at {place} leaves no wall under radius {R}")
        ends = [0.0, *(end for end, _ in self.density)]
        if not all(a < b for a, b in pairwise(ends)):
            raise ShapeError(f"segments must end one behind the other, got ends at {ends[1:]} m")
        if not math.isclose(ends[-1], self.length, rel_tol=1e-9):
            raise ShapeError(f"the last segment ends at {ends[-1]} m, the body at {self.length} m")
        if not all(math.isfinite(rho) and rho > 0 for _, rho in self.density):
            raise ShapeError(f"densities must be positive and finite, got {self.density}")
        mass, _, z_c, k2 = self.moments_behind(0.0)
        object.__setattr__(self, "_moments", (mass, z_c, k2))

    @property
    def length(self) -> float:
        """Length, m."""
        return float(self.outline[-1, 1])

    @property
    def diameter(self) -> float:
        """Largest outer diameter, m."""
        return 2.0 * float(self.outline[:, 0].max())

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return self._moments[0]

    @property
    def x_c(self) -> float:
        """Place of the mass centre beside the axis, m: it lies on it."""
        return 0.0

    @property
    def z_c(self) -> float:
        """Distance of the mass centre from the tip, m."""
        return self._moments[1]

    @property
    def k2(self) -> float:
        """Squared radius of gyration about a transverse axis through the mass centre, m2."""
        return self._moments[2]

    @property
    def gamma(self) -> float:
        """Slenderness coefficient (Eq 29) with the largest outer diameter, m^-0.3815."""
        return float(slenderness(self.length, self.diameter))

    @property
    def face(self) -> float:
        """Outer radius of the flat face at the tip, m; 0 where there is none."""
        return float(self.outline[self.outline[:, 1] <= 0.0, 0].max())

    def radius(self, z: Floats) -> Floats:
        """Outer radius, m, at heights `z`, m."""
        return np.asarray(np.interp(z, self.outline[:, 1], self.outline[:, 0]))

    def inner_radius(self, z: Floats) -> Floats:
        """Radius of the bore, m, at heights `z`, m; 0 where the body is solid."""
        if self.bore is None:
            return np.zeros_like(np.asarray(z, dtype=np.float64))
        return np.asarray(np.interp(z, self.bore[:, 1], self.bore[:, 0], left=0.0, right=0.0))

    def meridian(self) -> Floats:
        """Outer surface as (rho, z) points, m, from the axis at the tip to the tail; (k, 2) float64."""
        return self.outline

    def discs(self, start: float = 0.0) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Gauss points along the axis, exact for the polynomials of straight pieces.

        Returns
        -------
        z, outer, inner, density, weight : float64 of one shape
            m, m, m, kg/m3, m; the weights add up to the length behind `start`, m.
        """
        ends = [start, *(end for end, _ in self.density)]
        breaks = [self.outline[:, 1], np.empty(0) if self.bore is None else self.bore[:, 1], np.array(ends)]
        z = np.unique(np.concatenate(breaks))
        z = z[z >= start]
        x, w = np.polynomial.legendre.leggauss(3)
        half = 0.5 * np.diff(z)[:, None]
        place = (0.5 * (z[1:] + z[:-1])[:, None] + half * x).ravel()
        index = np.searchsorted(ends[1:], place)
        density = np.array([rho for _, rho in self.density])[np.minimum(index, len(ends) - 2)]
        return place, self.radius(place), self.inner_radius(place), density, (half * w).ravel()

    def moments_behind(self, start: float) -> tuple[float, float, float, float]:
        """Mass (kg), centre x and z (m), squared radius of gyration (m2) of what lies behind `start`, m."""
        z, outer, inner, density, dz = self.discs(start)
        dm = density * np.pi * (outer**2 - inner**2) * dz
        mass = float(dm.sum())
        z_c = float(dm @ z) / mass
        return mass, 0.0, z_c, float(dm @ ((outer**2 + inner**2) / 4 + (z - z_c) ** 2)) / mass

    def contact_point(self, alpha: ArrayLike) -> tuple[Floats, Floats]:
        """Lowest point (x, z), m, of the outline at inclination `alpha` (rad), below 0 on the side x < 0.

        It is a vertex of the outline's convex hull; on a smooth curve, the point of the circle of curvature
        there whose normal is that of the barrier. Of a part that is equally low it is the wider end, of
        a side that nearest the tip: see `touch`.
        """
        alpha = inclinations(alpha)
        place, (low, high) = self._touching(alpha), self._normals()
        middle, half = 0.5 * (low + high)[place], 0.5 * (high - low)[place]
        turned = middle + np.clip(np.abs(alpha) - middle, -half, half)
        bend = self._bends()[place]
        rho = self.outline[place, 0] + bend * (np.sin(turned) - np.sin(middle))
        z = self.outline[place, 1] - bend * (np.cos(turned) - np.cos(middle))
        return on_side(np.maximum(rho, 0.0), alpha), z[()]

    def touch(self, alpha: float) -> Touch:
        """Return what is lowest at inclination `alpha` (rad): a point, or all of a straight face or side.

        Where a smooth curve meets the barrier with one of the steps by which it is stated, it is a point.
        """
        x, z = (float(part) for part in self.contact_point(alpha))
        part = level_part(both_sides(self.outline), alpha, LEVEL * self.length)
        vertex, (low, high) = int(self._touching(np.array(alpha))), self._normals()
        step = self._bends()[vertex] * (high - low)[vertex]  # 0 at an edge
        return Touch(x, z, 0.0) if part is None or part.length <= LONG * step else part

    def holds(self, rho: Floats, z: Floats) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Whether points at radii `rho` and heights `z`, m, lie inside."""
        inside = (rho <= self.radius(z)) & (rho >= self.inner_radius(z))
        return np.asarray(inside & (z >= 0.0) & (z <= self.length))

    def arms(self, alpha: ArrayLike) -> Arms:
        """Arms d_c, d_d, m, of the lowest point about the mass centre."""
        return point_arms(self.z_c, *self.contact_point(alpha), alpha)

    def tip_curvature(self, alpha: float) -> float:
        """Radius of curvature, m, of the meridian at the lowest point; 0 on an edge."""
        return float(self._bends()[self._touching(np.array(alpha))])

    def reaches(self, alpha: float, height: float) -> tuple[float, float]:
        """As `Projectile.reaches`; a face ends at its bore."""
        side = self.outline
        if self.bore is not None and self.bore[0, 1] <= 0.0:
            rim = self.bore[:1]
            return mirrored_chord(np.vstack([rim, side[(side > rim).any(axis=1)]]), alpha, height)
        return mirrored_chord(both_sides(side), alpha, height)

    def flank(self, alpha: float) -> tuple[float, float]:
        """Length of the straight side next to the lowest point, and its far end's height over the barrier, m.

        It is the flatter of both sides; a flat face at the tip is none. (0, inf) on a smooth curve.
        """
        first, alpha = int(self._touching(np.array(alpha))), abs(alpha)
        height = self.outline[:, 1] * math.cos(alpha) - self.outline[:, 0] * math.sin(alpha)
        found = [(0.0, math.inf)]
        for other in (first - 1, first + 1):
            on_face = other == first - 1 and self.outline[first, 1] <= 0.0
            if 0 <= other < len(self.outline) and not on_face:
                length = math.dist(tuple(self.outline[first]), tuple(self.outline[other]))
                found.append((length, float(height[other] - height[first])))
        return min(found, key=lambda side: side[1] / side[0] if side[0] else math.inf)

    def rounds(self) -> list[Round]:
        """Arcs and corners of the convex outline in the plane of motion, in order around it.

        An edge stays one where the convex outline, which passes over what lies beside it, turns little.
        """
        line = hull(both_sides(self.outline), LEVEL * self.length)
        sharp = set(map(tuple, self.outline[self._bends() == 0.0].tolist()))
        edges = np.array([(abs(x), z) in sharp for x, z in line.tolist()])
        return cut(rounds_of(line, CORNER, edges), math.pi)

    def reversed(self) -> "Turned":
        """Return the body with its tail as its tip."""
        behind, ends = self.outline[::-1] * (1, -1) + (0, self.length), [end for end, _ in self.density]
        if behind[0, 0] > 0.0:
            behind = np.vstack([[0.0, 0.0], behind])
        if behind[-2, 1] == behind[-1, 1]:
            behind = behind[:-1]  # a flat face that is now the tail ends at its edge
        starts = [0.0, *ends[:-1]]
        density = [(self.length - z, rho) for z, (_, rho) in zip(starts, self.density, strict=True)][::-1]
        bore = None if self.bore is None else self.bore[::-1] * (1, -1) + (0, self.length)
        return Turned(behind, tuple(density), bore)

    def _touching(self, alpha: Floats) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
        """Return the vertex that is lowest; of those equally low the widest nearest the tip."""
        alpha, (rho, z), level = np.abs(alpha), self.outline.T, LEVEL * self.length
        height = z * np.cos(alpha)[..., None] - rho * np.sin(alpha)[..., None]
        wide = np.where(height <= height.min(axis=-1)[..., None] + level, rho, -np.inf)
        return np.asarray(np.argmax(wide >= wide.max(axis=-1)[..., None] - level, axis=-1))

    def _normals(self) -> tuple[Floats, Floats]:
        """(k,) angle of the outward normal from the axis, rad, before and behind each vertex."""
        step = np.diff(self.outline, axis=0)
        slope = np.arctan2(step[:, 1], step[:, 0])
        return np.concatenate([[-slope[0]], slope]), np.concatenate([slope, [np.pi]])

    def _bends(self) -> Floats:
        """(k,) radius of curvature of the meridian at each vertex, m; 0 on an edge.

        A vertex between straight parts is an edge, however little the profile turns there.
        """
        length = np.hypot(*np.diff(self.outline, axis=0).T)
        shorter = np.minimum(np.append(length[0], length), np.append(length, length[-1]))
        low, high = self._normals()
        turn = high - low
        steps = np.where((turn > 0.0) & (turn < CORNER), shorter, 0.0)
        joined = is_step(length, steps[:-1], steps[1:])
        curved = np.append(joined[0], joined) | np.append(joined, joined[-1])
        return np.where(curved, shorter / np.where(curved, turn, 1.0), 0.0)


def _vertices(points: ArrayLike, what: str) -> Floats:
    """Return (k, 2) vertices, refused where they bound no body."""
    line = np.array(points, dtype=np.float64)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2:
        raise ShapeError(f"the {what} needs two rows (rho, z) or more, got shape {line.shape}")
    if not np.isfinite(line).all() or (line < 0).any():
        raise ShapeError(f"the {what} must have radii and heights of 0 or more, all finite")
    step = np.diff(line, axis=0)
    if (step[:, 1] < 0).any() or (np.hypot(*step.T) == 0).any():
        raise ShapeError(f"the {what} turns back along the axis or repeats a point")
    return line
