"""The projectile: a turned rod, its mass properties and where it touches an inclined barrier."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .arms import Arms, corner_arms, point_arms
from .chord import both_sides, mirrored_chord
from .inputs import ArrayLike, Floats, ShapeError
from .nose import SHAPES, Nose
from .rounds import Round, around
from .shapes import of_nose
from .slenderness import slenderness
from .touch import LEVEL, Touch, inclinations, level_part, on_side
from .turned import Turned


@dataclass(frozen=True, slots=True)
class Projectile:
    """A rod of circular section with one turned tip.

    Parameters
    ----------
    length, diameter : float
        Overall, m.
    tip : "A", "B", "plain" or another name in `rigid.nose.SHAPES`
        A: spherical nose of `tip_radius` to 60 degrees from the pole, then its tangent cone (an
        assumption: the published profile stops at the sphere); B: flat face with a rounded edge of
        `tip_radius`; plain: flat face, sharp edge.
    tip_radius : float
        m; not used by "plain", where it must be 0.
    density : float
        kg/m3.

    Examples
    --------
    >>> rod = Projectile(0.24, 0.019, "B", 0.003, 7850.0)
    >>> f"{rod.mass:.4f} kg, k2 {rod.k2:.4e} m2, z_c {1e3 * rod.z_c:.2f} mm"
    '0.5333 kg, k2 4.8076e-03 m2, z_c 120.19 mm'
    """

    length: float
    diameter: float
    tip: str
    tip_radius: float
    density: float

    def __post_init__(self) -> None:
        for name in ("length", "diameter", "density"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise ShapeError(f"{name} must be positive and finite, got {value}")
        if self.tip not in SHAPES:
            raise ShapeError(f"tip must be one of {', '.join(SHAPES)}, got {self.tip!r}")
        if self.tip == "plain" and self.tip_radius != 0:
            problem = "a plain tip has a sharp edge: tip_radius must be 0"
            raise ShapeError(f"{problem}, got {self.tip_radius * 1e3:.3g} mm")
        if self.tip != "plain" and not 0 < self.tip_radius <= self.diameter / 2:
            limit = f"must lie in 0 < tip_radius <= {self.diameter * 500:.3g} mm (the rod's radius)"
            raise ShapeError(f"tip_radius of tip {self.tip} {limit}, got {self.tip_radius * 1e3:.3g} mm")
        if not self.z_side < self.length:
            nose, rod = self.z_side * 1e3, self.length * 1e3
            raise ShapeError(f"the nose is {nose:.3g} mm long, the rod only {rod:.3g} mm")

    @property
    def nose(self) -> Nose:
        """Meridian of the tip."""
        return SHAPES[self.tip](self.diameter / 2, self.tip_radius)

    @property
    def z_side(self) -> float:
        """End of the nose and start of the cylinder, m from the tip end."""
        return self.nose.z_side

    @property
    def mass(self) -> float:
        """Mass of the whole rod, kg."""
        return _moments(self)[0]

    @property
    def x_c(self) -> float:
        """Place of the mass centre beside the axis, m: it lies on it."""
        return 0.0

    @property
    def z_c(self) -> float:
        """Distance of the mass centre from the tip end, m."""
        return _moments(self)[1]

    @property
    def k2(self) -> float:
        """Squared radius of gyration about a transverse axis through the mass centre, m2."""
        return _moments(self)[2]

    @property
    def gamma(self) -> float:
        """Slenderness coefficient (Eq 29), m^-0.3815."""
        return float(slenderness(self.length, self.diameter))

    def moments_behind(self, start: float) -> tuple[float, float, float, float]:
        """Mass (kg), centre x and z (m), squared radius of gyration (m2) of what lies behind `start`, m."""
        behind = self.length - start
        mass = self.density * math.pi * self.diameter**2 / 4 * behind
        return mass, 0.0, start + behind / 2, behind**2 / 12 + self.diameter**2 / 16

    def meridian(self, n: int = 33) -> Floats:
        """Meridian of the tip as (rho, z) points, m, from (0, 0) to (R, z_side).

        `n` points lie on the arc (both ends counted); the flat face and the cone add their ends only.
        Shape (m, 2), float64; every break point is exact.
        """
        if n < 2:
            raise ShapeError(f"an arc needs at least 2 points, got n = {n}")
        return self.nose.polyline(n)

    def contact_point(self, alpha: ArrayLike) -> tuple[Floats, Floats]:
        """Lowest point (x, z), m, of the outline at inclination `alpha` (rad), below 0 on the side x < 0.

        Of a face or a side that is equally low all along it is one end, the limit of a small tilt: see
        `touch`.
        """
        alpha = inclinations(alpha)
        rho, z = self.nose.lowest(np.abs(alpha))
        return on_side(rho, alpha), z

    def touch(self, alpha: float) -> Touch:
        """Return what is lowest at inclination `alpha` (rad): a point, or all of a face, a cone or a side."""
        x, z = (float(part) for part in self.contact_point(alpha))
        nose, R = self.nose, self.diameter / 2
        ends = np.array([(0.0, 0.0), (nose.face, 0.0), nose.arc_end, (R, self.z_side), (R, self.length)])
        places = np.vstack([both_sides(ends), [x, z]])  # on an arc the point lies below both of its ends
        return level_part(places, alpha, LEVEL * self.length) or Touch(x, z, 0.0)

    @property
    def face(self) -> float:
        """Radius of the flat face at the tip, m; 0 where there is none."""
        return self.nose.face

    def tip_curvature(self, alpha: float) -> float:
        """Radius of curvature, m, of the meridian at the lowest point; 0 on an edge."""
        nose = self.nose
        sharp = self.tip_radius == 0 or (nose.has_cone and abs(alpha) > nose.sweep)
        return 0.0 if sharp else self.tip_radius

    def reaches(self, alpha: float, height: float) -> tuple[float, float]:
        """How far, m, it goes down and up the slope at a `height` > 0, m, over the lowest point."""
        return mirrored_chord(_outline(self), alpha, height)

    def rounds(self) -> list[Round]:
        """Arcs and corners of the convex outline in the plane of motion, in order around it."""
        nose, R = self.nose, self.diameter / 2
        side = [Round(nose.face, nose.r, nose.r, 0.0 if nose.face else -nose.sweep, nose.sweep, 0)]
        if nose.has_cone:
            side.append(Round(R, nose.z_side, 0.0, nose.sweep, 0.5 * math.pi, 1))
        return around([*side, Round(R, self.length, 0.0, 0.5 * math.pi, math.pi, len(side))])

    def reversed(self) -> Turned:
        """Return the body with its tail as its tip."""
        outline = of_nose(self.nose, self.length)
        return Turned(outline, ((self.length, self.density),)).reversed()

    def radius(self, z: Floats) -> Floats:
        """Outer radius, m, at heights `z`, m."""
        outline = self.meridian()
        return np.asarray(np.interp(z, outline[:, 1], outline[:, 0]))

    def holds(self, rho: Floats, z: Floats) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Whether points at radii `rho` and heights `z`, m, lie inside."""
        outline = self.meridian()
        surface = np.interp(rho, outline[:, 0], outline[:, 1], right=np.inf)
        return np.asarray((z >= surface) & (z <= self.length))

    def arms(self, alpha: ArrayLike) -> Arms:
        """Arms d_c, d_d, m, of the tip's lowest point about the mass centre of the turned rod."""
        return point_arms(self.z_c, *self.contact_point(alpha), alpha)

    def corner_arms(self, alpha: ArrayLike) -> Arms:
        """Arms d_c, d_d, m, of the sharp corner of a plain cylinder of this size (Eq 6-7)."""
        return corner_arms(self.length, self.diameter, alpha)


@lru_cache(maxsize=128)
def _outline(rod: Projectile) -> Floats:
    """Return the vertices (k, 2), (x, z), m, of both sides of the meridian, without the tail."""
    return both_sides(np.vstack([rod.meridian(), [rod.diameter / 2, rod.length]]))


@lru_cache(maxsize=128)
def _moments(rod: Projectile) -> tuple[float, float, float]:
    """Return mass (kg), distance of the mass centre from the tip (m), squared radius of gyration (m2).

    The solid of revolution is integrated by discs dm = density pi rho^2 dz, of the moment rho^2/4 dm about a
    diameter. Gauss points are exact for the straight pieces and reach round-off on the arc.
    """
    x, weight = np.polynomial.legendre.leggauss(24)
    unit, weight = 0.5 * (x + 1), 0.5 * weight
    tip = rod.nose
    sin, cos = np.sin(tip.sweep * unit), np.cos(tip.sweep * unit)
    start, z_start = tip.arc_end
    cone, body = tip.z_side - z_start, rod.length - tip.z_side
    # of arc, cone and cylinder
    z = np.concatenate([tip.r * (1 - cos), z_start + cone * unit, tip.z_side + body * unit])
    rho_arc, rho_cone = tip.face + tip.r * sin, start + (tip.radius - start) * unit
    rho2 = np.concatenate([rho_arc**2, rho_cone**2, np.full_like(unit, tip.radius**2)])
    dz = np.concatenate([tip.r * sin * tip.sweep * weight, cone * weight, body * weight])
    dm = rod.density * np.pi * rho2 * dz
    mass = float(dm.sum())
    z_c = float(dm @ z) / mass
    return mass, z_c, float(dm @ (rho2 / 4 + (z - z_c) ** 2)) / mass
