"""The surface of a body of revolution, onto which the nodes of split cells are moved, its edges included."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshes.common import FloatArray

# A turn of the polyline above this, rad, is an edge of the body, not a step of a smooth curve.
CORNER = np.deg2rad(12.0)
SAME = 1e-7  # of the largest radius: within it a node lies on an edge


@dataclass(frozen=True)
class TurnedSurface:
    """Polylines turned about the axis.

    Attributes
    ----------
    lines : tuple of (k, 2) float64, m
        Vertices (rho, z).
    faceted : tuple of (j, 2) float64, m
        Further ones: points nearer to these stay where they are, on the facets of the coarse cells.
    """

    lines: tuple[FloatArray, ...]
    faceted: tuple[FloatArray, ...] = ()

    @cached_property
    def edges(self) -> FloatArray:
        """(e, 2) circles (rho, z), m, along which the surface has an edge."""
        sharp = []
        for line in self.lines:
            step = np.diff(line, axis=0)
            before, after = step[:-1], step[1:]
            cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
            turn = np.abs(np.arctan2(cross, (before * after).sum(axis=1)))
            sharp += [line[1:-1][turn > CORNER], line[[0, -1]]]
        edges = np.concatenate(sharp)
        return np.asarray(np.unique(edges[edges[:, 0] > 0.0], axis=0))

    def snap(self, points: FloatArray, parents: FloatArray) -> FloatArray:
        """Move points onto the surface, azimuth kept.

        A point between two others of an edge belongs to that edge, any other to the nearest place.

        Parameters
        ----------
        points : (k, 3) float64, m
        parents : (k, c, 3) float64, m
            Nodes in whose middle each point lies: ends of an edge of a cell, or corners of its face.

        Returns
        -------
        (k, 3) float64, m
        """
        place = _in_plane(points)
        feet = np.stack([closest_on(line, place) for line in (*self.lines, *self.faceted)])
        nearest = np.linalg.norm(feet - place, axis=2).argmin(axis=0)
        feet[len(self.lines) :] = place
        target, ends = feet[nearest, np.arange(len(place))], _in_plane(parents)
        same = SAME * max(float(line[:, 0].max()) for line in self.lines)
        for edge in self.edges:
            target[(np.linalg.norm(ends - edge, axis=-1) < same).all(axis=1)] = edge
        scale = np.where(place[:, 0] > 0.0, target[:, 0] / np.where(place[:, 0] > 0.0, place[:, 0], 1.0), 1.0)
        return np.stack([points[:, 0] * scale, points[:, 1] * scale, target[:, 1]], axis=1)


def _in_plane(points: FloatArray) -> FloatArray:
    """(..., 2) places (rho, z), m, of points (..., 3), m."""
    return np.stack([np.hypot(points[..., 0], points[..., 1]), points[..., 2]], axis=-1)


def closest_on(line: FloatArray, points: FloatArray) -> FloatArray:
    """Closest points of a polyline.

    Parameters
    ----------
    line : (k, 2) float64
    points : (p, 2) float64

    Returns
    -------
    (p, 2) float64
    """
    step = np.diff(line, axis=0)
    from_start = points[:, None, :] - line[:-1]
    along = (from_start * step).sum(axis=-1) / np.hypot(*step.T) ** 2
    foot = line[:-1] + np.clip(along, 0.0, 1.0)[..., None] * step
    best = np.linalg.norm(foot - points[:, None, :], axis=-1).argmin(axis=1)
    return np.asarray(foot[np.arange(len(points)), best])
