"""Zones around which a mesh is refined: an oriented box, or a cloud of points."""

from dataclasses import dataclass

import numpy as np

from meshes.common import FloatArray, MeshError

_CORNERS = np.indices((2, 2, 2)).reshape(3, -1).T  # (8, 3) sides, low (0) or high (1), of a box


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
        return self.centre + np.where(_CORNERS == 0, self.low, self.high) @ self.axes


@dataclass(frozen=True, slots=True)
class Cloud:
    """All places within given distances of points, such as where a body touched or flowed.

    Attributes
    ----------
    points : (k, 3) float64, m
    radii : (k,) float64, m
        Distance from each point up to which a place belongs to the zone.

    Raises
    ------
    MeshError
        If there is no point, or not one radius for each.
    """

    points: FloatArray
    radii: FloatArray

    def __post_init__(self) -> None:
        """Refuse a cloud without points, or with radii of another number."""
        if not len(self.points) or self.radii.shape != (len(self.points),):
            raise MeshError(
                f"a cloud needs points, each with a radius, not {self.points.shape} and {self.radii.shape}"
            )

    @property
    def centre(self) -> FloatArray:
        """(3,) mean of the points, m."""
        return np.asarray(self.points.mean(axis=0))

    def gap(self, corners: FloatArray, skin: FloatArray) -> FloatArray:
        """Distance from the cloud to the bounding boxes of cells, from the point nearest to their middles.

        Parameters and result are those of `Zone.gap`.
        """
        from scipy.spatial import KDTree  # .1 s, for which no help text should wait

        low, high = corners.min(axis=1), corners.max(axis=1)
        nearest = np.full(len(corners), np.inf)
        for radius in np.unique(self.radii):
            points = self.points[self.radii == radius]
            _, found = KDTree(points).query(0.5 * (low + high))
            apart = np.maximum(low - points[found], points[found] - high) + skin[:, None]
            away = np.linalg.norm(np.maximum(apart, 0.0), axis=-1)
            nearest = np.minimum(nearest, np.maximum(away - radius, 0.0))
        return np.asarray(nearest)

    def corners(self) -> FloatArray:
        """(8, 3) corners of the box around the cloud, m."""
        low = (self.points - self.radii[:, None]).min(axis=0)
        high = (self.points + self.radii[:, None]).max(axis=0)
        return np.asarray(np.where(_CORNERS == 0, low, high))
