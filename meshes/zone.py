"""The zone around which a mesh is refined: an oriented box."""

from dataclasses import dataclass

import numpy as np

from meshes.arrays import FloatArray
from meshes.errors import MeshError

__all__ = ["Zone"]


@dataclass(frozen=True, slots=True)
class Zone:
    """An oriented box.

    Attributes
    ----------
    centre : (3,) float64, m
    axes : (3, 3) float64
        Rows are orthonormal.
    low, high : (3,) float64, m
        Extents along the axes, from the centre.

    Raises
    ------
    MeshError
        If the axes are not orthonormal or low exceeds high.
    """

    centre: FloatArray
    axes: FloatArray
    low: FloatArray
    high: FloatArray

    def __post_init__(self) -> None:
        """Convert plain sequences to arrays, and refuse axes or extents that make no box."""
        for name in ("centre", "axes", "low", "high"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=np.float64))
        if not np.allclose(self.axes @ self.axes.T, np.eye(3), atol=1e-9):
            raise MeshError(f"zone axes are not orthonormal: {self.axes.tolist()}; give three unit rows")
        if np.any(self.low > self.high):
            raise MeshError(f"zone low {self.low.tolist()} exceeds high {self.high.tolist()}: swap them")

    def local(self, points: FloatArray) -> FloatArray:
        """(..., 3) coordinates along the axes of the box, from its centre, m, of points (..., 3), m."""
        return (points - self.centre) @ self.axes.T

    def distance(self, points: FloatArray) -> FloatArray:
        """(...) distances to the box, m, 0 inside, of points (..., 3), m."""
        x = self.local(points)
        return np.asarray(np.linalg.norm(np.maximum(np.maximum(self.low - x, x - self.high), 0.0), axis=-1))

    def gap(self, corners: FloatArray, skin: FloatArray) -> FloatArray:
        """Distance from the box to the bounding boxes (in its axes) of cells.

        Parameters
        ----------
        corners : (m, 8, 3) float64, m
        skin : (m,) float64, m
            Overlap that does not count: a cell that only abuts the zone does not touch it.

        Returns
        -------
        (m,) float64, m
        """
        x = self.local(corners)
        apart = np.maximum(self.low - x.max(axis=1), x.min(axis=1) - self.high) + skin[:, None]
        return np.asarray(np.linalg.norm(np.maximum(apart, 0.0), axis=-1))

    def corners(self) -> FloatArray:
        """(8, 3) corners of the box, m."""
        pick = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        return self.centre + np.where(pick == 0, self.low, self.high) @ self.axes
