"""Rigid motion of the rod in the plane (t, n) and its deformation magnified for drawing."""

from __future__ import annotations

import numpy as np

_CORNERS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]],
    float,
)


def hex_volumes(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return ``(m,) m3`` volumes by the Jacobian at the centre of ``(m, 8)`` hexahedra (one-point rule)."""
    volumes: np.ndarray = 8.0 * np.linalg.det(_jacobian(points, cells))
    return volumes


def _jacobian(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    jacobian: np.ndarray = np.einsum("ki,mkj->mij", _CORNERS / 8.0, points[cells])
    return jacobian


def stretch(points: np.ndarray, moved: np.ndarray, cells: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Return the stretch |F a| ``(m,)`` of a fibre along ``axis`` a at the cell centres, F = dx/dX.

    It does not depend on the rigid motion.

    Parameters
    ----------
    points, moved : (n, 3) float64, m
        Reference and present positions.
    cells : (m, 8) int
    axis : (3,) float64
        Unit vector in the reference positions.
    """
    along = np.linalg.solve(_jacobian(points, cells).transpose(0, 2, 1), axis[:, None])
    lengths: np.ndarray = np.linalg.norm(_jacobian(moved, cells).transpose(0, 2, 1) @ along, axis=(1, 2))
    return lengths


def axis_of(points: np.ndarray) -> np.ndarray:
    """Return the unit vector ``(3,)`` in the plane (t, n) of the largest spread of the points."""
    arm = points[:, [0, 2]] - points[:, [0, 2]].mean(axis=0)
    t, n = np.linalg.svd(arm, full_matrices=False)[2][0]
    return np.array([t, 0.0, n])


def nodal_volumes(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return ``(n,) m3``: an eighth of each hexahedron's volume at each of its nodes."""
    share = np.repeat(hex_volumes(points, cells) / 8.0, 8)
    return np.bincount(cells.ravel(), weights=share, minlength=len(points))


def to_points(cells: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Return ``(count,)``: at each point the mean of the ``(m,)`` values of the cells around it."""
    total = np.bincount(cells.ravel(), weights=np.repeat(values, cells.shape[1]), minlength=count)
    return total / np.maximum(np.bincount(cells.ravel(), minlength=count), 1)


def rigid_motion(points: np.ndarray, moved: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the points ``(n, 3) m`` moved by the best-fitting rigid motion in the plane (t, n).

    The rotation about b that minimises the weighted square distance to the moved half has the tangent
    ``sum w (X x x)_b / sum w X . x``, with X and x taken from the weighted centres.

    Parameters
    ----------
    points : (n, 3) float64, m
        Reference positions (t, b, n).
    moved : (n, 3) float64, m
        Present positions.
    weights : (n,) float64
        Volumes at the points.
    """
    plane = [0, 2]
    centre = np.average(points[:, plane], axis=0, weights=weights)
    present = np.average(moved[:, plane], axis=0, weights=weights)
    arm, now = points[:, plane] - centre, moved[:, plane] - present
    cross = weights @ (arm[:, 0] * now[:, 1] - arm[:, 1] * now[:, 0])
    angle = np.arctan2(cross, weights @ np.einsum("ij,ij->i", arm, now))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    carried = points.copy()
    carried[:, plane] = arm @ turn + present
    return carried


def magnified(rigid: np.ndarray, moved: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """Return ``(n, 3) m``: the rigid motion as it is, the deformation times ``(n,)`` factors."""
    shown: np.ndarray = rigid + factor[:, None] * (moved - rigid)
    return shown


def nice_factor(wanted: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20, 50, ... not above ``wanted``, and 1 at least."""
    if not np.isfinite(wanted) or wanted <= 1.0:
        return 1.0
    decade = 10.0 ** np.floor(np.log10(wanted))
    return float(decade * max(step for step in (1.0, 2.0, 5.0) if step * decade <= wanted * (1.0 + 1e-12)))
