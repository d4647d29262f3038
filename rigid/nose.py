"""The meridian of a turned tip: a flat face, an arc, and a cone up to the cylinder.

One shape covers the three tips: a face out to radius `face`, an arc of radius `r` that turns the
outward normal from the axis by `sweep`, then the tangent cone up to the rod's radius. Positions are
(rho, z) in m, z along the axis from the tip end.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .inputs import ArrayLike, Floats, floats

CONE = np.radians(60.0)


@dataclass(frozen=True, slots=True)
class Nose:
    """Meridian of a tip.

    Attributes
    ----------
    radius : float
        Of the rod, m.
    face : float
        Radius of the flat face, m.
    r : float
        Radius of the arc, m (0 for a sharp edge).
    sweep : float
        Angle through which the arc turns, rad.
    """

    radius: float
    face: float
    r: float
    sweep: float

    @property
    def arc_end(self) -> tuple[float, float]:
        """End of the arc, (rho, z) in m."""
        return self.face + self.r * np.sin(self.sweep), self.r * (1.0 - np.cos(self.sweep))

    @property
    def has_cone(self) -> bool:
        """Whether the arc ends short of the rod's side."""
        return self.sweep < np.pi / 2

    @property
    def z_side(self) -> float:
        """Start of the cylinder, m from the tip end."""
        if not self.has_cone:
            return self.r
        rho, z = self.arc_end
        return float(z + (self.radius - rho) * np.tan(self.sweep))

    def polyline(self, n: int) -> Floats:
        """Meridian as points: `n` on the arc, and the ends of face, arc and cone.

        Parameters
        ----------
        n : int
            Points on the arc, both ends counted (at least 2).

        Returns
        -------
        (m, 2) float64, m
            (rho, z) from (0, 0) to (R, z_side).
        """
        theta = np.linspace(0.0, self.sweep, n if self.r else 1)
        arc = np.column_stack([self.face + self.r * np.sin(theta), self.r * (1.0 - np.cos(theta))])
        pole = [[0.0, 0.0]] if self.face else []
        points = np.concatenate([np.reshape(pole, (-1, 2)), arc])
        if self.has_cone:
            return np.concatenate([points, [[self.radius, self.z_side]]])
        points[-1] = self.radius, self.z_side
        return points

    def lowest(self, alpha: ArrayLike) -> tuple[Floats, Floats]:
        """Point of the meridian that touches a barrier inclined at `alpha`.

        The outward normal there is -n, that is (sin alpha, -cos alpha) in (rho, z), so the arc is
        touched at the angle alpha itself, until the arc ends and the shoulder of the cone comes down.
        At alpha = 0 a flat face touches everywhere: its edge is given, the limit of a small tilt.

        Parameters
        ----------
        alpha : array_like
            Inclination, rad, 0 <= alpha <= pi/2.

        Returns
        -------
        rho, z : float64 of the shape of `alpha`, m
        """
        (alpha,) = floats(alpha)
        shoulder = self.has_cone & (alpha > self.sweep)
        rho = np.where(shoulder, self.radius, self.face + self.r * np.sin(alpha))
        z = np.where(shoulder, self.z_side, self.r * (1.0 - np.cos(alpha)))
        return rho[()], z[()]


SHAPES: dict[str, Callable[[float, float], Nose]] = {
    # published only as a 7 mm hemispherical end on a 19 mm rod; that the sphere goes to 60 degrees and its
    # tangent cone on to the rod's side is an assumption
    "A": lambda radius, r: Nose(radius, 0.0, r, float(CONE)),
    "B": lambda radius, r: Nose(radius, radius - r, r, np.pi / 2),
    "plain": lambda radius, r: Nose(radius, radius, 0.0, np.pi / 2),
}
"""Tips by name: each makes the meridian from the rod's radius and the tip's radius, m. Add yours here."""
