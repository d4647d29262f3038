"""The meridian of a tip: a polyline along which grid lines lie."""

from dataclasses import dataclass

import numpy as np

from meshes.common import FloatArray, MeshError
from meshes.surface import CORNER, closest_on

# A grid can turn from face to side where the line has turned by FIRST to LAST, rad, outside OFF_AXIS radii.
FIRST, LAST = np.deg2rad([16.0, 64.0])
OFF_AXIS = 0.66


@dataclass(frozen=True, slots=True)
class Meridian:
    """A polyline of (rho, z) from the pole (0, 0) to the side of a rod, by arc length.

    Attributes
    ----------
    line : (k, 2) float64, m
        Vertices; the last is where the cylinder begins, at the radius of the rod.
    behind : (j, 2) float64, m, optional
        Vertices of the surface behind the last one, where that is no cylinder.

    Raises
    ------
    MeshError
        If the line does not start at the pole, turns back, or stands still.
    """

    line: FloatArray
    behind: FloatArray | None = None

    def __post_init__(self) -> None:
        """Convert to an array, and refuse a line that bounds no tip."""
        line = np.array(self.line, dtype=np.float64)
        object.__setattr__(self, "line", line)
        if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2:
            raise MeshError(f"meridian has shape {line.shape}: give at least two rows (rho, z)")
        step = np.diff(line, axis=0)
        if np.any(np.abs(line[0]) > 1e-12 * line[-1, 0]):
            raise MeshError(f"meridian starts at {line[0].tolist()} m: it must start at the pole (0, 0)")
        if np.any(step < -1e-12 * line[-1, 0]) or np.any(np.hypot(*step.T) <= 0.0):
            raise MeshError("meridian turns back or repeats a point: rho and z must grow along it")

    @property
    def radius(self) -> float:
        """Radius of the rod, m."""
        return float(self.line[-1, 0])

    @property
    def height(self) -> float:
        """Height z at which the cylinder begins, m."""
        return float(self.line[-1, 1])

    @property
    def arc(self) -> FloatArray:
        """(k,) arc length at the vertices, m."""
        return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.line, axis=0).T))])

    @property
    def slope(self) -> FloatArray:
        """(k - 1,) angle of each segment from the radial direction, rad."""
        step = np.diff(self.line, axis=0)
        return np.asarray(np.arctan2(step[:, 1], step[:, 0]))

    def extended(self, height: float) -> "Meridian":
        """Extend the line along the cylinder, or the surface behind it, up to `height` (m)."""
        if height <= self.height:
            return self
        if self.behind is None:
            return Meridian(np.concatenate([self.line, [[self.radius, height]]]))
        more = self.behind[self.behind[:, 1] < height]
        end = np.interp(height, self.behind[:, 1], self.behind[:, 0])
        return _Surface(np.concatenate([self.line, more, [[end, height]]]))

    def at(self, arc: FloatArray) -> FloatArray:
        """(..., 2) points at arc lengths (...), m."""
        known = self.arc
        return np.stack([np.interp(arc, known, self.line[:, i]) for i in (0, 1)], axis=-1)

    def corners(self) -> FloatArray:
        """(c,) arc lengths of the sharp edges, m."""
        turn = np.abs(np.diff(self.slope))
        return np.asarray(self.arc[1:-1][turn > CORNER])

    def shoulder(self, near: FloatArray | None = None, cell: float = 0.0) -> float:
        """Arc length where a grid turns from the face to the side, m.

        It lies where the line has turned by 45 degrees, but at least 0.6 of the radius from the axis, so that
        the face cells of pointed tips stay wide. With `near`, (rho, z) in m, it moves so that the place
        closest to that is the middle of a `cell` (m): next to the turn where possible, else some whole cells
        away. It does not move on an edge, or where the line is too flat, steep or sharp.
        """
        middle = max(
            self._turned(np.pi / 4.0), float(np.interp(0.6 * self.radius, self.line[:, 0], self.arc))
        )
        if near is None:
            return middle
        foot = closest_on(self.line, np.asarray(near, np.float64)[None])
        # rho + z grows along the line, as the arc does
        wanted = float(np.interp(foot.sum(), self.line.sum(axis=1), self.arc))
        if np.any(np.abs(self.extended(self.height + cell).corners() - wanted) < 0.5 * cell):
            return middle  # a row of nodes lies on an edge anyway
        beside = wanted + 0.5 * cell * (1.0 if wanted < middle + 0.25 * cell else -1.0)
        if self.at(np.array(beside))[0] < OFF_AXIS * self.radius:
            beside = wanted + cell * (np.ceil((middle - wanted) / cell - 0.5) + 0.5)
        return float(beside if self._turned(FIRST) <= beside <= self._turned(LAST) else middle)

    def _turned(self, angle: float) -> float:
        """Arc length at which the line has turned by an angle from the face, m."""
        slope, arc = self.slope, self.arc
        middle = 0.5 * (arc[1:] + arc[:-1])
        after = int(np.argmax(slope >= angle)) if np.any(slope >= angle) else len(slope)
        if after in (0, len(slope)) or slope[after] - slope[after - 1] > CORNER:
            return float(arc[after])
        pair = slice(after - 1, after + 1)
        return float(np.interp(angle, slope[pair], middle[pair]))

    def inward(self, arc: float, reach: float) -> FloatArray:
        """(2,) unit vector into the body, normal to the mean of the chords over `reach` (m) to both sides."""
        sides = self.at(np.array([arc - reach, arc, arc + reach]))
        step = np.diff(sides, axis=0)
        step = step / np.hypot(*step.T)[:, None]
        mean = step.sum(axis=0)
        if not mean.any():  # the surface turns back upon itself
            mean = step[1]
        mean = mean / np.hypot(*mean)
        return np.array([-mean[1], mean[0]])


class _Surface(Meridian):
    """A meridian carried on behind the nose, where its radius may shrink again."""

    __slots__ = ()

    def __post_init__(self) -> None:
        """Accept any line."""
